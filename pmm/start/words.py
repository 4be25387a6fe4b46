"""What the names of columns hint at, in the languages of several tanks. A hint, no more."""

import re
from collections.abc import Sequence
from typing import Final

_LONG: Final = 4  # letters of a word that may stand within a longer one: Strutkraft
_AS_IT_IS: Final = 2  # letters of a word that is only itself: fy, pc

FORCE: Final = (
    "force", "kraft", "kracht", "fuerza", "forza", "fuerz", "effort", "load", "gauge",
    "cell", "dms", "dyn", "f", "fy", "fz",
)  # fmt: skip
DISPLACEMENT: Final = (
    "disp", "stroke", "strut", "weg", "hub", "pos", "slag", "verplaats", "deplac", "déplac",
    "course", "spost", "desplaz", "heave", "sway", "tauch", "lvdt", "motion", "x", "y", "z",
)  # fmt: skip
ANGLE: Final = (
    "angle", "crank", "shaft", "winkel", "kurbel", "encoder", "hoek", "kruk", "manivelle",
    "vinkel", "phase", "phi", "theta", "drehgeber", "rotary",
)  # fmt: skip
SPEED: Final = (
    "speed", "carriage", "wagen", "velocity", "geschw", "snelheid", "vitesse", "chariot", "veloc",
    "schlepp", "tow", "hastighet", "u", "v",
)  # fmt: skip
PULSES: Final = (
    "photo", "foto", "licht", "pulse", "puls", "impuls", "mark", "trigger", "gate", "cellule", "pc",
)  # fmt: skip
ALONG: Final = (
    "fx", "surge", "drag", "resist", "widerst", "längskraft", "laengskraft", "weerstand", "trainée",
)  # fmt: skip
# What a drive was told to do, beside what was measured of it.
COMMAND: Final = (
    "command", "demand", "setpoint", "sollwert", "sollweg", "soll", "consigne", "kommando",
    "gewenst", "consigna",
)  # fmt: skip
RUDDER: Final = ("rudder", "ruder", "roer", "gouvernail", "safran", "timon", "timone")
THRUST: Final = ("thrust", "schub", "stuwkracht", "poussée", "poussee", "empuje", "spinta")
TORQUE: Final = ("torque", "drehmoment", "koppel", "couple")
REVOLUTIONS: Final = ("rpm", "rps", "revs", "revol", "drehzahl", "toerental", "propeller")
SINKAGE: Final = ("sink", "squat", "absenk", "einsink", "inzinking", "enfonce")
# A roll that is an angle may be that of any floating body; a moment called so is one of a gauge.
HEEL: Final = (
    "heel", "krängung", "kraengung", "helling", "gîte", "gite", "escora", "sbandamento",
)  # fmt: skip
ROLL_MOMENT: Final = ("roll", "mx", "rolkoppel", *HEEL)
# What moves or pulls at the same frequency and is no part of the oscillator.
OTHERS: Final = (
    "wave", "probe", "wp", "wg", "wellen", "golf", "houle", "onda", "bølge", "elevation", "tension",
    "mooring", "tether", "trosse", "rope", "cable", "seil", "leine", "roll", "temp", "accel",
    "beschl", "imu", "gyro", "spring", "mx", "my", "mz",
)  # fmt: skip
FORE: Final = (
    "fore", "fwd", "forward", "front", "vorn", "vorne", "bow", "bug", "avant", "av", "voor", "prua",
    "proa",
)  # fmt: skip
AFT: Final = (
    "aft", "hinten", "heck", "stern", "after", "rear", "arriere", "arrière", "ar", "achter",
    "poppa", "popa", "achtern",
)  # fmt: skip


def says(name: str, words: Sequence[str]) -> bool:
    """Tell whether a name has one of some words: short ones alone, long ones within others."""
    parts = [part.casefold() for part in re.findall(r"[^\W\d_]+", _spaced(name))]
    return any(_has_word(part, word) for part in parts for word in words)


def _spaced(name: str) -> str:
    """Put blanks where a name written together begins anew: ForceAft."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name)


def _has_word(part: str, word: str) -> bool:
    if len(word) <= _AS_IT_IS:
        return part == word
    return part.startswith(word) or (len(word) >= _LONG and word in part)


def natural(name: str) -> tuple[tuple[int, str], ...]:
    """Return what names are sorted by: letters as they are, numbers by their size."""
    parts = re.findall(r"\d+|\D+", name.casefold())
    return tuple((int(part), "") if part.isdigit() else (0, part) for part in parts)


def struts_in_order(names: Sequence[str]) -> list[str]:
    """Return names from aft to fore: by their words, else in the order of the names themselves."""
    return sorted(names, key=lambda name: (says(name, FORE) - says(name, AFT), natural(name)))


def axis_of(name: str) -> str:
    """Return the axis of a balance that a name says, as the z of ``Fz``; empty where none."""
    match = re.fullmatch(r"(?:f|force|kraft|kracht)[\s_]*([xyz])", name.strip().casefold())
    return match[1] if match else ""
