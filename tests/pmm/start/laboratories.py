"""Recordings of laboratories that never were: closed forms, names of many tanks, any order.

Nothing of the product is in here: the truth is what the numbers were made of.
"""

import gzip
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

NAMES: Mapping[str, Mapping[str, str]] = {
    "english": {
        "time": "Time", "displacement_aft": "Strut aft", "displacement_fore": "Strut fore",
        "force_aft": "Load cell aft", "force_fore": "Load cell fore", "shaft_angle": "Crank angle",
        "carriage_speed": "Carriage speed", "photocell": "Photocell",
    },
    "german": {
        "time": "Zeit", "displacement_aft": "Weg hinten", "displacement_fore": "Weg vorn",
        "force_aft": "Kraft hinten", "force_fore": "Kraft vorn", "shaft_angle": "Kurbelwinkel",
        "carriage_speed": "Wagengeschwindigkeit", "photocell": "Lichtschranke",
    },
    "dutch": {
        "time": "Tijd", "displacement_aft": "Verplaatsing achter",
        "displacement_fore": "Verplaatsing voor", "force_aft": "Kracht achter",
        "force_fore": "Kracht voor", "shaft_angle": "Krukhoek", "carriage_speed": "Snelheid",
        "photocell": "Fotocel",
    },
    "french": {
        "time": "Temps", "displacement_aft": "Course arrière", "displacement_fore": "Course avant",
        "force_aft": "Effort arrière", "force_fore": "Effort avant",
        "shaft_angle": "Angle manivelle", "carriage_speed": "Vitesse chariot",
        "photocell": "Cellule photo",
    },
    "letters": {
        "time": "t", "displacement_aft": "z1", "displacement_fore": "z2", "force_aft": "F1",
        "force_fore": "F2", "shaft_angle": "phi", "carriage_speed": "U", "photocell": "PC",
    },
    "numbers": {
        "time": "t", "displacement_aft": "ch03", "displacement_fore": "ch04", "force_aft": "ch01",
        "force_fore": "ch02", "shaft_angle": "ch07", "carriage_speed": "ch06", "photocell": "ch09",
    },
}  # fmt: skip
UNITS: Mapping[str, Mapping[str, float]] = {
    "s": {"s": 1.0, "ms": 1e-3},
    "m": {"m": 1.0, "mm": 1e-3, "cm": 1e-2},
    "N": {"N": 1.0, "kN": 1e3, "kgf": 9.80665},
    "rad": {"rad": 1.0, "deg": np.pi / 180.0, "rev": 2.0 * np.pi},
    "m/s": {"m/s": 1.0, "mm/s": 1e-3, "km/h": 1.0 / 3.6},
}
STYLES: tuple[Callable[[str, str], str], ...] = (
    lambda name, unit: f"{name} [{unit}]",
    lambda name, unit: f"{name} ({unit})",
    lambda name, unit: f"{name} {unit}",
    lambda name, unit: f"{name} / {unit}",
    lambda name, unit: f"{name}_{unit}",
    lambda name, unit: f"{name} in {unit}",
)


@dataclass
class Laboratory:
    """One recording: its columns in SI with their units, and what they are.

    ``truth`` has the column's name by channel; ``bare`` says that no header has a unit.
    """

    frequency_hz: float
    eccentricity_m: float
    strut_phase_deg: float
    speed_m_s: float
    rate_hz: float
    columns: dict[str, tuple[FloatArray, str]] = field(default_factory=dict)
    truth: dict[str, str] = field(default_factory=dict)


def laboratory(
    rng: np.random.Generator,
    language: str = "english",
    sensors: tuple[str, ...] = ("displacement_aft", "displacement_fore", "force_aft", "force_fore"),
    besides: tuple[str, ...] = (),
    *,
    running: bool = True,
) -> Laboratory:
    """Return a laboratory of random frequency, amplitude, noise and forces."""
    frequency_hz = float(np.exp(rng.uniform(np.log(0.12), np.log(1.9))))
    made = Laboratory(
        frequency_hz,
        float(rng.uniform(0.008, 0.055)),
        float(rng.choice([0.0, 180.0, 90.0])),
        float(rng.choice([0.0, 0.8, 1.5])),
        float(rng.choice([50.0, 100.0, 128.0, 200.0])),
    )
    count = int(made.rate_hz * rng.uniform(9.0, 25.0) / frequency_hz)
    time_s = np.arange(count) / made.rate_hz
    turns = frequency_hz * time_s + rng.uniform(0.0, 1.0)
    names = NAMES[language]
    made.columns[names["time"]] = (time_s + float(rng.choice([0.0, 12.0])), "s")
    for channel in sensors:
        values, unit = _sensor(channel, made, turns, rng, moving=running)
        made.columns[names[channel]] = (values, unit)
        made.truth[channel] = names[channel]
    for name in besides:
        made.columns[name] = _beside(name, made, turns, rng)
    return made


def _wave(turns: FloatArray, *amplitudes: complex) -> FloatArray:
    parts = [(a * np.exp(2j * np.pi * n * turns)).imag for n, a in enumerate(amplitudes, 1)]
    return np.asarray(np.sum(parts, axis=0), dtype=np.float64)


def _complex(rng: np.random.Generator) -> complex:
    return complex(np.exp(2j * np.pi * rng.uniform()))


def _sensor(
    channel: str, made: Laboratory, turns: FloatArray, rng: np.random.Generator, *, moving: bool
) -> tuple[FloatArray, str]:
    noise = rng.standard_normal(turns.size)
    on = 1.0 if moving else 0.0
    if channel.startswith("displacement"):
        ahead = np.deg2rad(made.strut_phase_deg) if channel.endswith("fore") else 0.0
        swing = made.eccentricity_m * np.exp(1j * ahead) * (1.0 + 0.01 * rng.uniform(-1.0, 1.0))
        ramp = rng.uniform(-1e-3, 1e-3)
        return on * _wave(turns, swing, 2e-3 * swing) + ramp + 2e-5 * noise, "m"
    if channel.startswith("force"):
        size = 10.0 ** rng.uniform(0.3, 2.2)
        own = [size * share * _complex(rng) for share in (1.0, 0.06, 0.04)]
        level = float(rng.uniform(-20.0, 20.0))
        return level + on * _wave(turns, *own) + size * rng.uniform(0.002, 0.2) * noise, "N"
    if channel == "shaft_angle":
        angle = 2.0 * np.pi * turns * float(rng.choice([-1.0, 1.0])) * on
        wrapped = np.mod(angle, 2.0 * np.pi) if rng.uniform() < 0.7 else angle
        return wrapped + 1e-4 * noise, "rad"
    if channel == "photocell":
        return 5.0 * (np.mod(turns, 1.0) < 0.08) * on + 0.02 * noise, ""
    return made.speed_m_s * (1.0 + 2e-3 * noise), "m/s"


def _beside(
    name: str, made: Laboratory, turns: FloatArray, rng: np.random.Generator
) -> tuple[FloatArray, str]:
    noise = rng.standard_normal(turns.size)
    slow = np.cumsum(noise) / np.sqrt(turns.size)
    rough = 0.2 * noise + 0.2 * _wave(turns * rng.uniform(1.3, 1.7), _complex(rng))
    swing = _wave(turns, _complex(rng)) + rough
    known = {
        "Roll": (0.1 * swing, "rad"),
        "Tension": (30.0 + 5.0 * swing, "N"),
        "WP_1": (0.02 * swing, "m"),
        "WP_2": (0.02 * swing, "m"),
        "Temperature": (15.0 + 0.1 * slow, "degC"),
        "Acceleration": (0.3 * swing, "m/s2"),
        "Spare": (np.zeros_like(turns), ""),
        "Reserve": (np.full_like(turns, np.nan), "N"),
        "Moment": (2.0 * swing, "N m"),
        "Position": (5.0 + made.speed_m_s * turns / made.frequency_hz, "m"),
        "Counter": (np.arange(turns.size, dtype=np.float64), ""),
        "Hum": (_wave(turns * 0.0 + np.arange(turns.size) * 16.7 / made.rate_hz, 1.0), "V"),
    }
    return known[name]


def write(
    made: Laboratory,
    path: Path,
    rng: np.random.Generator,
    *,
    bare: tuple[str, ...] = (),
    style: int = 0,
    missing: float = 0.0,
    comma: bool = False,
) -> Path:
    """Write a recording as a CSV with shuffled columns, each in one of its units.

    Parameters
    ----------
    bare
        Columns whose header has no unit; they keep SI.
    missing
        Share of cells that are empty.
    """
    titles, texts = [], []
    for at in rng.permutation(len(made.columns)):
        name, (values, unit) = list(made.columns.items())[at]
        title = name
        if unit and name not in bare:
            chosen = str(rng.choice(list(UNITS.get(unit, {unit: 1.0}))))
            title = STYLES[style](name, chosen)
            values = values / UNITS.get(unit, {unit: 1.0})[chosen]
        column = [f"{value:.9g}" for value in values]
        if missing and unit != "s":
            for gone in np.flatnonzero(rng.uniform(size=values.size) < missing):
                column[gone] = ""
        titles.append(title)
        texts.append(["" if text == "nan" else text for text in column])
    separator = ";" if comma else ","
    rows = [separator.join(titles), *(separator.join(row) for row in zip(*texts, strict=True))]
    text = "\n".join(rows) + "\n"
    text = text.replace(".", ",") if comma else text
    data = text.encode("utf-8")
    path.write_bytes(gzip.compress(data, 1) if path.suffix == ".gz" else data)
    return path
