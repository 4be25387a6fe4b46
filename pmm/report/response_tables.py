"""Tables of frequency responses and of the distortions beside them."""

from collections.abc import Iterator
from typing import Final

from pmm.document.content import Column, Content, Table, number, word
from pmm.document.notation import rounded, written
from pmm.harmonics.response_rows import DistortionRow, ResponseRow, ResponseRows

_THREE: Final = written(".3g")
_LINES: Final[tuple[Column[ResponseRow], ...]] = (
    Column("output", lambda row: row.output, once=True),
    number("line", "line"),
    number("frequency", "frequency_hz", written(".5g"), "Hz"),
    Column("gain", lambda row: rounded(row.gain, row.gain_half_width), number=True),
    word("unit", "unit"),
    Column("phase", lambda row: rounded(row.phase_deg, row.phase_half_width_deg),
           unit="deg", number=True),
    number("coherence", "coherence", written(".4f")),
)  # fmt: skip
_DISTORTIONS: Final[tuple[Column[DistortionRow], ...]] = (
    Column("output", lambda row: row.output, once=True),
    word("distortion", "degree"),
    Column("lines", lambda row: ", ".join(map(str, row.lines))),
    Column("level", lambda row: rounded(row.level, row.half_width), number=True),
    number("noise", "noise", _THREE),
    word("unit", "unit"),
    number("of the lines", "relative", lambda part: f"{100.0 * part:.2g}", "%"),
    number("chance of noise", "chance", _THREE),
    Column("told", lambda row: "more than noise" if row.told else "noise"),
)
_READING: Final = (
    "Gain and phase are those of the output over the input. Coherence is the part of the output's "
    "power in one period that goes with the input.",
    "Distortions stand at harmonics that were not excited: those of odd degree (friction, cubic "
    "damping) at odd ones, those of even degree (play, one-sided forces) at even ones, as long as "
    "all excited lines are odd. About as much of odd ones lies on the excited lines themselves.",
)


def response_tables(rows: ResponseRows | None) -> Iterator[Content]:
    """Yield the tables of a gate's responses; none where none was asked for."""
    if rows is None:
        return
    yield Table(f"Response to {rows.lines[0].input}" if rows.lines else "Response", _LINES,
                rows.lines, titled=True, notes=_READING[:1])  # fmt: skip
    yield Table("Distortions", _DISTORTIONS, rows.distortions, titled=True, notes=_READING[1:],
                grade=lambda row: "" if row.told else "faint")  # fmt: skip
