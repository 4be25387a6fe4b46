"""How often intervals hold the truth: campaigns with scatter and with what was stated wrong."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from analysis.coefficients.cycle_fit import fit_cycles
from analysis.coefficients.names import Form
from analysis.coefficients.solve import problem_of, solve
from analysis.coefficients.stated import Stated
from analysis.coefficients.uncertainty import monte_carlo
from benchmarks.coefficients_campaigns import (
    CUBIC,
    HORIZONTAL,
    RESTORING,
    VERTICAL,
    Made,
    amplitudes,
    made_up,
    pure_pair,
    scattered,
    wrong,
    wrong_body,
)
from benchmarks.outcome import Report, Row
from hardware.description.oscillator import Plane

FloatArray = NDArray[np.float64]

STATED = Stated(
    mass_kg=0.05,
    inertia_kg_m2=0.1,
    cg_x_m=5e-4,
    cg_z_m=5e-4,
    lag_s=2e-4,
    force_gain_relative=1e-3,
    amplitude_relative=5e-4,
)
ACTING = tuple(name for name in STATED.__dataclass_fields__ if getattr(STATED, name) > 0.0)


@dataclass(frozen=True)
class Case:
    """One kind of campaign."""

    name: str
    plane: Plane
    frequency_hz: float
    eccentricity_m: float
    speed_m_s: float

    @property
    def truth(self) -> Mapping[str, float]:
        """Its linear coefficients."""
        return VERTICAL if self.plane is Plane.VERTICAL else HORIZONTAL


CASES = (
    Case("vertical", Plane.VERTICAL, 0.8, 0.02, 0.0),
    Case("vertical_speed", Plane.VERTICAL, 0.8, 0.02, 1.2),
    Case("vertical_slow", Plane.VERTICAL, 0.15, 0.04, 0.0),
    Case("horizontal", Plane.HORIZONTAL, 0.4, 0.05, 0.0),
    Case("horizontal_speed", Plane.HORIZONTAL, 0.3, 0.1, 1.2),
    Case("horizontal_slow", Plane.HORIZONTAL, 0.05, 0.25, 1.2),
)


def linear_rates(case: Case, campaigns: int) -> dict[str, float]:
    """Return the part of intervals that hold each coefficient, over seeded campaigns."""
    hits = dict.fromkeys(case.truth, 0)
    for k in range(campaigns):
        generator = np.random.default_rng(np.random.SeedSequence(1963, spawn_key=(k,)))
        result = solve(_campaign(case, generator), Form.MANOEUVRING, stated=STATED)
        half = result.half_width()
        for name, value, width in zip(result.names, result.values, half, strict=True):
            hits[name] += abs(value - case.truth[name]) <= width
    return {name: count / campaigns for name, count in hits.items()}


def _campaign(case: Case, generator: Generator):  # type: ignore[no-untyped-def]
    """Both motions, with one error of everything stated for all runs."""
    errors = {name: float(generator.standard_normal()) for name in ACTING}
    restoring = RESTORING if case.plane is Plane.VERTICAL else None
    body = wrong_body(STATED, errors)
    made = Made(case.truth, case.plane, orders=1, body=body, restoring=restoring)
    points = pure_pair(case.frequency_hz, case.eccentricity_m, case.speed_m_s)
    cycles = [made_up(point, made, name) for name, point in zip("ab", points, strict=True)]
    return [scattered(wrong(one, STATED, errors), generator).run() for one in cycles]


def cubic_rates(campaigns: int, report: Report) -> dict[str, float]:
    """Return the same for sway, yaw and drift with cubic terms, all harmonics together."""
    truth = {**HORIZONTAL, **CUBIC}
    points = [(name, point, 0.0) for name, point in amplitudes()]
    points += [(f"drift {k}", points[3 + k][1], angle) for k, angle in enumerate((0.1, -0.2))]
    hits = dict.fromkeys(truth, 0)
    for k in range(campaigns):
        if k % 50 == 0:
            report(f"campaign {k} of {campaigns} with cubic terms")
        generator = np.random.default_rng(np.random.SeedSequence(2026, spawn_key=(k,)))
        errors = {name: float(generator.standard_normal()) for name in ACTING}
        body = wrong_body(STATED, errors)
        cycles = [
            made_up(point, Made(truth, drift_rad=drift, body=body), name)
            for name, point, drift in points
        ]
        read = [scattered(wrong(one, STATED, errors), generator) for one in cycles]
        fit = fit_cycles(read, tuple(truth), stated=STATED)
        half = fit.uncertain.half_width()
        for name, value, width in zip(fit.names, fit.values, half, strict=True):
            hits[name] += abs(value - truth[name]) <= width
    return {name: count / campaigns for name, count in hits.items()}


def monte_carlo_ratio(trials: int) -> tuple[float, list[Row]]:
    """Return the ratio of standard uncertainties that is farthest from 1, and all of them."""
    rows: list[Row] = []
    farthest = 1.0
    for case in CASES:
        generator = np.random.default_rng(7)
        # many periods: Student's t of few has a larger deviation than the budget's by its nature
        runs = [
            scattered(made_up(point, _exact(case), name), generator, periods=200).run()
            for name, point in zip(
                "ab", pure_pair(case.frequency_hz, case.eccentricity_m, case.speed_m_s), strict=True
            )
        ]
        linear = solve(runs, Form.MANOEUVRING, stated=STATED).standard_uncertainty
        drawn = monte_carlo(problem_of(runs, Form.MANOEUVRING), STATED, trials=trials, seed=1)
        ratio = drawn.standard_uncertainty / linear
        worst = float(ratio[np.argmax(np.abs(np.log(ratio)))])
        rows.append({"case": case.name, "ratio farthest from 1": worst})
        farthest = max(farthest, math.exp(abs(math.log(worst))))
    return farthest, rows


def _exact(case: Case) -> Made:
    restoring = RESTORING if case.plane is Plane.VERTICAL else None
    return Made(case.truth, case.plane, orders=1, restoring=restoring)
