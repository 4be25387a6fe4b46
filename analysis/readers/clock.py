"""Times of day and dates as text: ``14:03:07.25``, ``2025-03-01T14:03:07Z``, ``01.03.2025``.

``03/04/2025 2:03:07 PM`` may be in March or in April. Only the time since the first row counts, and
a record lasts less than a fortnight: of the two orders that with the shorter time is right, as the
other changes the month where this changes the day.
"""

import re
from dataclasses import dataclass
from datetime import date
from typing import Final

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag, Severity

CLOCK: Final = "hh:mm:ss"  # in place of a unit: a column of times of day, with dates or without
DATE: Final = "yyyy-mm-dd"
DAY_S: Final = 86400.0
# Of a time of day that falls by more than this midnight has passed.
_MIDNIGHT_S: Final = DAY_S / 2.0

_YEAR_FIRST = r"(?P<year>\d{4})([-/.])(?P<month>\d\d?)\2(?P<day>\d\d?)"
_YEAR_LAST = r"(?P<a>\d\d?)(?P<sign_between>[-/.])(?P<b>\d\d?)(?P=sign_between)(?P<y>\d{4})"
_TIME = (
    r"(?P<hour>\d\d?):(?P<minute>[0-5]\d):(?P<second>[0-5]\d(?:[.,]\d*)?)"
    r"(?:\s*(?P<half>[AaPp])\.?[Mm]\.?)?"
)
_ZONE = r"(?P<zone>Z|(?P<sign>[+-])(?P<zone_hour>\d\d):?(?P<zone_minute>\d\d))?"
_STAMP = re.compile(rf"(?:(?:{_YEAR_FIRST}|{_YEAR_LAST})(?:[T ]\s*|$))?(?:{_TIME}\s*{_ZONE})?")


Days = tuple[int | None, int | None]
NO_DAY: Final[Days] = (None, None)


@dataclass(frozen=True)
class ClockStamp:
    """A date, a time of day, or both.

    Attributes
    ----------
    days
        Counted from the year 1, with the day before the month and with the month before the day;
        ``None`` where there is no such date. Both alike where the order is sure.
    second
        Of the day, less the zone's offset; ``None`` where there is a date alone.
    """

    days: Days
    second: float | None

    @property
    def unit(self) -> str:
        """What stands in place of a unit for a column of such stamps."""
        return DATE if self.second is None else CLOCK

    def seconds_since(self, first: Days) -> float:
        """Return the seconds since a day's midnight; of a time alone those since its own."""
        pairs = zip(self.days, first, strict=True)
        offsets = [
            stamp_day - day for stamp_day, day in pairs if stamp_day is not None and day is not None
        ]
        return DAY_S * min(offsets, key=abs, default=0) + (self.second or 0.0)


def read_stamp(cell: str) -> ClockStamp | None:
    """Read a cell as a date, a time of day or both; ``None`` where it is none, or no such date."""
    match = _STAMP.fullmatch(cell) if cell else None
    if match is None:
        return None
    days = NO_DAY
    if match["year"]:
        days = (_day(match["year"], match["month"], match["day"]),) * 2
    elif match["y"]:
        day_first = _day(match["y"], match["b"], match["a"])
        sure = match["sign_between"] == "."
        days = day_first, day_first if sure else _day(match["y"], match["a"], match["b"])
    if (match["year"] or match["y"]) and days == NO_DAY:
        return None
    if not match["hour"]:
        return ClockStamp(days, None)
    hour = match["hour"]
    if match["half"]:
        hour = str(int(hour) % 12 + 12 * (match["half"] in "pP"))
    second = _seconds(hour, match["minute"], match["second"])
    if match["sign"]:
        offset = _seconds(match["zone_hour"], match["zone_minute"], "0")
        second -= offset if match["sign"] == "+" else -offset
    return ClockStamp(days, second)


def _day(year: str, month: str, day: str) -> int | None:
    try:
        return date(int(year), int(month), int(day)).toordinal()
    except ValueError:
        return None


def _seconds(hours: str, minutes: str, seconds: str) -> float:
    return 3600.0 * int(hours) + 60.0 * int(minutes) + float(seconds.replace(",", "."))


def past_midnight(time_s: FloatArray) -> tuple[FloatArray, tuple[Flag, ...]]:
    """Let times of day run on over midnight, and say so."""
    passed = np.concatenate(([0], np.cumsum(np.diff(time_s) < -_MIDNIGHT_S)))
    if not passed[-1]:
        return time_s, ()
    message = (
        f"the time of day passes midnight {passed[-1]} time(s), first at data row "
        f"{int(np.argmax(passed > 0)) + 1}; it is counted on from the first day's"
    )
    return time_s + DAY_S * passed, (Flag("midnight", Severity.NOTE, message),)
