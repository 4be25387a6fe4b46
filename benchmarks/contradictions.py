"""Data that contradict each other, and decays that are touched: how often it is seen, and falsely.

Torsion axes: inertias about 4 to 6 axes of a plane, one of them off by five standard uncertainties
of what all others predict it to. Decays: friction, linear and quadratic damping, cut down by a hand
at a moment.
"""

import math
from typing import Final

import numpy as np
from numpy.random import Generator

from analysis.inertia.plane_inertia import plane_inertia
from analysis.inertia.regime import change_of_regime
from analysis.inertia.series import Series, usable_part
from analysis.uncertainty.estimate import Estimate
from benchmarks.outcome import Benchmark, Outcome, Report, Row
from hardware.description.arrays import FloatArray

_SETS: Final = 1000
_DECAYS: Final = 200
_U_ANGLE_RAD: Final = math.radians(0.2)
_U_RELATIVE: Final = 1e-3  # of an inertia by its period
_RATE_HZ: Final = 50.0


def _flagged(generator: Generator, shifted: float) -> bool:
    """Return whether the redundancy of a drawn set of axes has a flag."""
    count = int(generator.integers(4, 7))
    angle = math.pi / count * (np.arange(count) + generator.uniform(-0.3, 0.3, count))
    xx, zz = generator.uniform(1.5, 3.0, 2)
    s, c = np.sin(angle), np.cos(angle)
    rows = np.column_stack([s * s, c * c, -2.0 * s * c])
    about = rows @ np.array([xx, zz, 0.2])
    slope = 2.0 * s * c * (xx - zz) - 0.4 * np.cos(2.0 * angle)
    sigma = np.hypot(_U_RELATIVE * about, slope * _U_ANGLE_RAD)
    off = int(generator.integers(count))
    rest = np.arange(count) != off
    normal = rows[rest].T @ (rows[rest] / sigma[rest, None] ** 2)
    predicted = math.sqrt(sigma[off] ** 2 + rows[off] @ np.linalg.inv(normal) @ rows[off])
    about[off] += shifted * predicted * generator.choice([-1.0, 1.0])
    seen = about * (1.0 + _U_RELATIVE * generator.standard_normal(count))
    read = angle + _U_ANGLE_RAD * generator.standard_normal(count)
    found = plane_inertia(
        [Estimate.of(float(v), float(_U_RELATIVE * abs(v)), "kg m2") for v in seen],
        [Estimate.of(float(v), _U_ANGLE_RAD, "rad") for v in read],
    )
    return bool(found.redundancy.flags())


def _decay(generator: Generator, *, touched: bool) -> tuple[Series, float, float]:
    """Return a record, the moment of the touch, and the period."""
    period_s, swings = generator.uniform(1.0, 3.0), generator.uniform(30.0, 80.0)
    friction = generator.uniform(0.0, 0.6) / swings
    linear, quadratic = generator.uniform(0.002, 0.02), generator.uniform(0.0, 0.08)
    at_s = generator.uniform(0.3, 0.7) * swings * period_s
    kept = generator.uniform(0.1, 0.7) if touched else 1.0
    count = int(swings * period_s * _RATE_HZ)
    step, amplitude = 1.0 / (period_s * _RATE_HZ), np.ones(count)
    for k in range(1, count):
        a = amplitude[k - 1]
        a = max(a - step * (friction + linear * a + quadratic * a * a), 0.0)
        amplitude[k] = a * (kept if k == round(at_s * _RATE_HZ) else 1.0)
    return _recorded(amplitude, period_s, generator), at_s, period_s


def _recorded(amplitude: FloatArray, period_s: float, generator: Generator) -> Series:
    time_s = np.arange(amplitude.size) / _RATE_HZ
    noise = 10.0 ** generator.uniform(-3.5, -2.3) * generator.standard_normal(time_s.size)
    angle = 2.0 * np.pi * time_s / period_s + generator.uniform(0.0, 6.0)
    values = 0.1 * (amplitude * np.cos(angle) + 0.02 + noise)
    return Series("decay", "roll", "rad", _RATE_HZ, 0.0, values)


def _near(generator: Generator) -> bool:
    series, at_s, period_s = _decay(generator, touched=True)
    found = change_of_regime(series, usable_part(series))
    return found is not None and abs(found.time_s - at_s) <= period_s


def _false(generator: Generator) -> bool:
    series, _, _ = _decay(generator, touched=False)
    return change_of_regime(series, usable_part(series)) is not None


def run(quick: bool, report: Report) -> Outcome:
    """Draw sets of axes and decays."""
    generator = np.random.default_rng(28)
    sets, decays = (20, 5) if quick else (_SETS, _DECAYS)
    report("torsion axes")
    wrong = np.mean([_flagged(generator, 5.0) for _ in range(sets)])
    clean = np.mean([_flagged(generator, 0.0) for _ in range(sets)])
    report("decays")
    near = np.mean([_near(generator) for _ in range(decays)])
    false = np.mean([_false(generator) for _ in range(decays)])
    rows: list[Row] = [
        {"what": "torsion axes, one off by 5", "drawn": sets, "seen": float(wrong)},
        {"what": "torsion axes, all right", "drawn": sets, "seen": float(clean)},
        {"what": "decays touched, within one period", "drawn": decays, "seen": float(near)},
        {"what": "decays left alone", "drawn": decays, "seen": float(false)},
    ]
    measured = {
        "axes": float(wrong),
        "axes_not": 1.0 - float(clean),
        "regime": float(near),
        "regime_not": 1.0 - float(false),
    }
    notes = (
        "Axes evenly over the half turn, each turned by up to 0.3 of the distance; u of an angle "
        "0.2 degrees, of an inertia 0.1 %; five standard uncertainties are those of the datum and "
        "of what the others predict it to. Decays of 30 to 80 swings, noise of 0.03 to 0.5 % of "
        "the first amplitude, cut down to 10 to 70 % at 30 to 70 % of the record.",
    )
    return Outcome({"Seen, as a part of all": rows}, measured, notes)


BENCHMARK = Benchmark("contradictions", "Contradictions and touched decays", run)
