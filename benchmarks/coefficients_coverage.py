"""How often intervals hold the truth: campaigns with scatter and with what was stated wrong."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.random import Generator

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import fit_cycles
from analysis.coefficients.cycle_trials import cycle_trials
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from benchmarks.coefficients_campaigns import (
    CUBIC,
    HORIZONTAL,
    RESTORING,
    VERTICAL,
    Made,
    Scatter,
    amplitudes,
    made_struts,
    made_up,
    pure_pair,
    scattered,
    taken,
    wrong,
    wrong_body,
)
from benchmarks.outcome import Report, Row
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint

STATED = StatedUncertainties(
    mass_kg=0.05,
    inertia_kg_m2=0.1,
    cg_x_m=5e-4,
    cg_z_m=5e-4,
    lag_s=2e-4,
    force_gain_relative=1e-3,
    amplitude_relative=5e-4,
)
_MANY = Scatter(periods=200)
"""Student's t of few periods has a larger deviation than the budget's by its nature."""
MADE_UP = {**HORIZONTAL, **CUBIC}
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
        fit = linear_fit(_campaign(case, generator), Form.MANOEUVRING, STATED).fit
        half = fit.uncertain.half_width()
        for name, value, width in zip(fit.names, fit.values, half, strict=True):
            hits[name] += abs(value - case.truth[name]) <= width
    return {name: count / campaigns for name, count in hits.items()}


def _campaign(case: Case, generator: Generator) -> list[BodyCycle]:
    """Both motions, with one error of everything stated for all runs."""
    errors = {name: float(generator.standard_normal()) for name in ACTING}
    restoring = RESTORING if case.plane is Plane.VERTICAL else None
    body = wrong_body(STATED, errors)
    made = Made(case.truth, case.plane, orders=3, body=body, restoring=restoring)
    points = pure_pair(case.frequency_hz, case.eccentricity_m, case.speed_m_s)
    return [
        _read(point, made, name, errors, generator)
        for name, point in zip("ab", points, strict=True)
    ]


def _read(
    point: SetPoint, made: Made, name: str, errors: Mapping[str, float], generator: Generator
) -> BodyCycle:
    struts = wrong(made_struts(point, made, name), STATED, errors)
    return taken(scattered(struts, generator), made)


def cubic_rates(
    campaigns: int, report: Report, truth: Mapping[str, float] = MADE_UP
) -> dict[str, float]:
    """Return the same for sway, yaw and drift with cubic terms, all harmonics together."""
    points = [(name, point, 0.0) for name, point in amplitudes()]
    points += [(f"drift {k}", points[3 + k][1], angle) for k, angle in enumerate((0.1, -0.2))]
    hits = dict.fromkeys(truth, 0)
    for k in range(campaigns):
        if k % 50 == 0:
            report(f"campaign {k} of {campaigns} with cubic terms")
        generator = np.random.default_rng(np.random.SeedSequence(2026, spawn_key=(k,)))
        errors = {name: float(generator.standard_normal()) for name in ACTING}
        body = wrong_body(STATED, errors)
        read = [
            _read(point, Made(truth, drift_rad=drift, body=body), name, errors, generator)
            for name, point, drift in points
        ]
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
        points = pure_pair(case.frequency_hz, case.eccentricity_m, case.speed_m_s)
        cycles = [
            made_up(point, _exact(case), name, generator, _MANY)
            for name, point in zip("ab", points, strict=True)
        ]
        fit = linear_fit(cycles, Form.MANOEUVRING, STATED).fit
        drawn = cycle_trials(fit, trials, seed=1)
        ratio = drawn.standard_uncertainty / fit.uncertain.standard_uncertainty
        worst = float(ratio[np.argmax(np.abs(np.log(ratio)))])
        rows.append({"case": case.name, "ratio farthest from 1": worst})
        farthest = max(farthest, math.exp(abs(math.log(worst))))
    return farthest, rows


def _exact(case: Case) -> Made:
    restoring = RESTORING if case.plane is Plane.VERTICAL else None
    return Made(case.truth, case.plane, orders=3, restoring=restoring)
