"""What an effect does to the coefficients that a user reports."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.gap.forward.free_numbers import tolerated
from analysis.gap.search.joint import with_numbers
from hardware.description.arrays import FloatArray
from pmm.gap.examination import Examined
from pmm.gap.hull_report import HULL, Convention, ReportedCoefficient, reported_coefficients
from sim.rig import SimulatedRig

_TERMS: Final = {"a": "added_mass", "b": "damping", "c": "restoring"}
_BODY: Final = ("mass_kg", "inertia_kg_m2", "cg_x_m", "cg_z_m")
# Tolerances of what is not the same in all runs, or goes beyond coefficients and settings.
_CHANGING: Final = (
    "added_mass_per_octave", "damping_per_octave", "added_mass_per_speed", "damping_per_speed",
    "ripple_1_relative", "ripple_2_relative", "load_ripple_1_kg_m2", "warming_k_h", "warming_n_s",
)  # fmt: skip
UNITS: Final = {
    "a11": "kg", "a12": "kg m", "a21": "kg m", "a22": "kg m2",
    "b11": "N s/m", "b12": "N s", "b21": "N s", "b22": "N m s",
    "c11": "N/m", "c12": "N", "c21": "N", "c22": "N m",
    "mass_kg": "kg", "inertia_kg_m2": "kg m2", "cg_x_m": "m", "cg_z_m": "m",
}  # fmt: skip


@dataclass(frozen=True)
class CoefficientRow:
    """One coefficient of model and water: added mass and damping as they are reported.

    Attributes
    ----------
    stated
        What the campaign says.
    u_stated
        Standard uncertainty of that: what a memory of the water leaves of the table that it was
        fitted to; 0 without one.
    without, u_without
        Fitted to the campaign without an effect, and its standard uncertainty.
    with_effect, u_with
        Fitted with the effect that is named; NaN where none is, as nothing is known of a bias then.
    bias_u
        By how many of ``u_with`` it is off where that effect is not modelled; NaN likewise.
    speed_m_s, frequency_hz
        Where it holds; NaN where it is the same in all runs.
    """

    name: str
    unit: str
    stated: float
    u_stated: float
    without: float
    u_without: float
    with_effect: float
    u_with: float
    bias_u: float
    speed_m_s: float
    frequency_hz: float

    @property
    def compared(self) -> bool:
        """Whether it was fitted with an effect too."""
        return not math.isnan(self.with_effect)

    @property
    def reference(self) -> tuple[float, float]:
        """What the fit without an effect is held against, and the standard uncertainty of that.

        The fit with the effect that is named; where none is, what is stated.
        """
        if self.compared:
            return self.with_effect, self.u_with
        return self.stated, math.hypot(self.u_without, self.u_stated)

    @property
    def off_u(self) -> float:
        """By how many standard uncertainties the fit without an effect is off its reference."""
        value, u = self.reference
        return (self.without - value) / u

    @property
    def off(self) -> bool:
        """Whether that is more than the uncertainty."""
        return abs(self.off_u) > (1.0 if self.compared else 2.0)

    @property
    def is_told(self) -> bool:
        """Whether the reference is so far from 0 that a per cent of it says something."""
        value, u = self.reference
        return abs(value) > 2.0 * u

    @property
    def where(self) -> str:
        """Its name, and the frequency and speed that it holds at."""
        pairs = ((self.frequency_hz, "Hz"), (self.speed_m_s, "m/s"))
        conditions = [f"{value:g} {unit}" for value, unit in pairs if not math.isnan(value)]
        return f"{self.name} at {', '.join(conditions)}" if conditions else self.name


@dataclass(frozen=True, eq=False)
class _Fit:
    """By how much the free coefficients are off what the simulation begins with.

    Attributes
    ----------
    names
        Of the free coefficients, in the order of the arrays.
    off, covariance
        In their own units.
    """

    names: tuple[str, ...]
    off: FloatArray
    covariance: FloatArray

    def of(self, weights: Mapping[str, float]) -> tuple[float, float]:
        """Return a weighted sum of what they are off, and its standard uncertainty."""
        row = np.array([weights.get(name, 0.0) for name in self.names])
        return float(row @ self.off), math.sqrt(row @ self.covariance @ row)


def coefficient_rows(examined: Examined) -> tuple[Convention, tuple[CoefficientRow, ...]]:
    """Return every free coefficient of model and water, and how the derivatives are written.

    Where the answer names an effect, the rows say what that does to them.
    """
    simulator = examined.diagnosis.problem.simulator
    points = [run.set_point for run in simulator.stack.runs if run.turns]
    convention, derivatives = reported_coefficients(
        examined.ready.reporting, simulator.rig, points, examined.campaign.memory
    )
    plain, cured = _fit_pair(examined)
    numbers = [
        ReportedCoefficient(name, UNITS[name], {name: 1.0})
        for name in plain.names
        if name not in HULL
    ]
    coefficients = [
        coefficient
        for coefficient in (*derivatives, *numbers)
        if coefficient.weights.keys() & set(plain.names)
    ]
    return convention, tuple(
        _row(coefficient, examined, plain, cured) for coefficient in coefficients
    )


def _row(
    coefficient: ReportedCoefficient, examined: Examined, plain: _Fit, cured: _Fit | None
) -> CoefficientRow:
    moved, rig = examined.recentred.moved, examined.diagnosis.problem.simulator.rig
    simulated = coefficient.memory + sum(
        part * _stated(rig, name) for name, part in coefficient.weights.items()
    )
    stated = simulated - sum(
        part * moved.get(name, 0.0) for name, part in coefficient.weights.items()
    )
    off, u_without = plain.of(coefficient.weights)
    off_with, u_with = (math.nan, math.nan) if cured is None else cured.of(coefficient.weights)
    return CoefficientRow(
        coefficient.name,
        coefficient.unit,
        stated,
        coefficient.memory_u,
        simulated + off,
        u_without,
        simulated + off_with,
        u_with,
        (off - off_with) / u_with,
        coefficient.speed_m_s,
        coefficient.frequency_hz,
    )


def _fit_pair(examined: Examined) -> tuple[_Fit, _Fit | None]:
    """Return the fit without and with the effect that is named; ``None`` where none is.

    Of coefficients that are the same in all runs, on a rig that only its settings are off of: so
    they are what ``pmm coefficients`` finds. With an effect they do what they do where it acts.
    """
    problem, cause = examined.diagnosis.problem, examined.cause
    same = replace(examined.ready.case.tolerances, **dict.fromkeys(_CHANGING, 0.0))
    held = tolerated(problem.simulator, examined.free, same).columns
    plain = _fitted(examined, problem.residual, held)
    if cause is None:
        return plain, None
    joint, count = with_numbers(problem, examined.free, cause), len(examined.free)
    effect_columns, numbers = joint.columns[:, :-count], joint.columns[:, -count:]
    columns = np.hstack((numbers, held[:, count:], effect_columns))
    return plain, _fitted(examined, joint.linearised(problem.residual), columns)


def _fitted(examined: Examined, residual: FloatArray, columns: FloatArray) -> _Fit:
    """Return the most probable coefficients; each column is one deviation of its prior."""
    covariance = np.linalg.inv(np.eye(columns.shape[1]) + columns.T @ columns)
    mean = covariance @ (columns.T @ residual)
    places = [number for number, free in enumerate(examined.free) if free.is_coefficient]
    scale = np.array([examined.free[number].deviation for number in places])
    names = tuple(examined.free[number].name for number in places)
    spread = np.asarray(covariance[np.ix_(places, places)] * np.outer(scale, scale))
    return _Fit(names, mean[places] * scale, spread)


def _stated(rig: SimulatedRig, name: str) -> float:
    if name in _BODY:
        return float(getattr(rig.body, name))
    matrix = getattr(rig.water, _TERMS[name[0]])
    return float(matrix[int(name[1]) - 1][int(name[2]) - 1])
