"""What ``pmm coefficients`` reports of a campaign, as sums over the simulated hull's matrices."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.coefficients.campaign_systems import common_name
from analysis.coefficients.hull_coefficients import as_reported
from analysis.coefficients.names import place_of
from analysis.coefficients.normalisation import DIMENSIONAL, Normalisation
from hardware.description.arrays import FloatArray
from hardware.description.setpoint import Medium, SetPoint
from pmm.coefficients.settings import CoefficientSettings, System
from pmm.coefficients.systems import BY_GRAVITY, system_of
from sim.model.water.fitted_memory import FittedMemory
from sim.rig import SimulatedRig

# Added mass and damping by rows, about the midpoint between the struts.
HULL: Final = tuple(f"{term}{row}{column}" for term in "ab" for row in "12" for column in "12")
_UNITS: Final = np.eye(len(HULL)).reshape(len(HULL), 2, 2, 2)  # of each: added mass, damping

State = tuple[float, float]
"""The carriage's speed, m/s, and the frequency, Hz."""


@dataclass(frozen=True)
class Convention:
    """How derivatives are written: as ``pmm coefficients`` does for the same campaign.

    Attributes
    ----------
    form
        ``"manoeuvring"`` or ``"seakeeping"``.
    normalisation
        ``"dimensional"``, or the system's name.
    point_ahead_m
        What they refer to, ahead of the midpoint between the struts.
    """

    form: str
    plane: str
    normalisation: str
    point_ahead_m: float

    def __str__(self) -> str:
        """Return what the head of a table says."""
        ahead = self.point_ahead_m
        side = "ahead of" if ahead > 0.0 else "behind"
        point = f"{abs(ahead):g} m {side} the midpoint" if ahead else "about the midpoint"
        return f"{self.form} form, {point}, {self.normalisation}"


@dataclass(frozen=True)
class ReportedCoefficient:
    """One coefficient.

    Attributes
    ----------
    weights
        Of the hull's numbers that it is the sum of.
    memory
        What the water's memory adds to that sum.
    memory_u
        Standard uncertainty of that: what the memory leaves of the table that it was fitted to.
    speed_m_s, frequency_hz
        Where it holds; NaN where it is the same at all.
    """

    name: str
    unit: str
    weights: Mapping[str, float]
    memory: float = 0.0
    memory_u: float = 0.0
    speed_m_s: float = math.nan
    frequency_hz: float = math.nan


def reported_coefficients(
    settings: CoefficientSettings,
    rig: SimulatedRig,
    set_points: Sequence[SetPoint],
    memory: FittedMemory | None = None,
) -> tuple[Convention, tuple[ReportedCoefficient, ...]]:
    """Return the coefficients that a campaign's runs report, and how they are written.

    Runs in air count only where there are no others. A system that divides by the speed leaves out
    runs at rest; where all are, it is not used.

    Parameters
    ----------
    set_points
        Of the runs that oscillate, one or more.
    memory
        What the rig's memory of the water was fitted to, and how well.

    Raises
    ------
    ConfigurationError
        If a dimension of the model is missing.
    """
    wet = [point for point in set_points if point.medium is Medium.WATER] or set_points
    states = sorted({(point.carriage_speed_m_s, point.frequency_hz) for point in wet})
    systems: dict[State, Normalisation] = {}
    if settings.system is not System.DIMENSIONAL:
        by_speed = system_of(settings.system, settings.ship, rig.body)
        by_gravity = settings.system in BY_GRAVITY
        systems = {state: by_speed(state[0]) for state in states if by_gravity or state[0] > 0.0}
    name = common_name(tuple(systems.values())) if systems else DIMENSIONAL
    coefficients = {
        state: list(_of_state(settings, rig, state, systems.get(state), memory))
        for state in systems or states
    }
    plane = str(rig.oscillator.plane)
    convention = Convention(str(settings.form), plane, name, settings.point_ahead_m)
    return convention, tuple(_merged(coefficients))


def _of_state(
    settings: CoefficientSettings,
    rig: SimulatedRig,
    state: State,
    system: Normalisation | None,
    fitted: FittedMemory | None,
) -> Iterator[ReportedCoefficient]:
    """Yield each coefficient at one speed and frequency."""
    form, plane, (speed, frequency) = settings.form, rig.oscillator.plane, state
    added_mass, damping = _memory(rig, frequency)
    uncertainties = np.zeros((2, 2, 2))
    if fitted is not None:
        uncertainties = np.array(fitted.standard_uncertainties(2.0 * math.pi * frequency))
    columns = as_reported(
        np.stack((*_UNITS[:, 0], added_mass)),
        np.stack((*_UNITS[:, 1], damping)),
        plane,
        form,
        point_ahead_m=settings.point_ahead_m,
        speed_m_s=speed,
        frequency_hz=frequency,
    )
    for name, column in columns.items():
        place = place_of(name, plane, form)
        factor = 1.0 if system is None else system.place_factor(place)
        *parts, memory = (column / factor).tolist()
        weights = {hull_name: part for hull_name, part in zip(HULL, parts, strict=True) if part}
        unit = place.unit if system is None else "1"
        memory_u = float(np.linalg.norm(parts * uncertainties.ravel()))
        yield ReportedCoefficient(name, unit, weights, memory, memory_u, speed, frequency)


def _memory(rig: SimulatedRig, frequency_hz: float) -> tuple[FloatArray, FloatArray]:
    """Return added mass and damping that the water's memory has at a frequency."""
    if rig.radiation is None:
        return np.zeros((2, 2)), np.zeros((2, 2))
    omega = 2.0 * math.pi * frequency_hz
    return rig.radiation.added_mass(omega), rig.radiation.damping(omega)


def _merged(
    coefficients: Mapping[State, Sequence[ReportedCoefficient]],
) -> Iterator[ReportedCoefficient]:
    """Yield each coefficient once where it is the same at all states, with what it depends on."""
    for several in zip(*coefficients.values(), strict=True):
        kinds: dict[object, list[ReportedCoefficient]] = {}
        for coefficient in several:
            kinds.setdefault((coefficient.memory, *coefficient.weights.items()), []).append(
                coefficient
            )
        for alike in kinds.values():
            speed, frequency = (
                _its_own(
                    *(
                        [getattr(coefficient, key) for coefficient in part]
                        for part in (alike, several)
                    )
                )
                for key in ("speed_m_s", "frequency_hz")
            )
            yield replace(alike[0], speed_m_s=speed, frequency_hz=frequency)


def _its_own(values: Sequence[float], all_values: Sequence[float]) -> float:
    """Return what tells some states from the others; NaN where nothing does."""
    return values[0] if len(set(values)) == 1 < len(set(all_values)) else math.nan
