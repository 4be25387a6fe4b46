"""Campaigns with known truth: exact cycles from terms, their scatter, and what was stated wrong."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.random import Generator
from numpy.typing import NDArray

from analysis.coefficients.cycle import CHANNELS, SURGE_FORCE, Cycle, at_order
from analysis.coefficients.phasors import Phasors, Source, from_interleaved, interleaved
from analysis.coefficients.stated import Stated
from analysis.coefficients.terms import term_of, waves_of
from analysis.motion import mass_matrix, weight_matrix
from hardware.description.body import Body
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint

FloatArray = NDArray[np.float64]

HALF_M = 0.5
BODY = Body(mass_kg=70.0, inertia_kg_m2=27.5, cg_x_m=-0.02, cg_z_m=0.02)
RESTORING = np.array([[6900.0, 345.0], [345.0, 2400.0]])
VERTICAL = {
    "Z_wdot": -75.0, "Z_w": -190.0, "Z_qdot": -3.0, "Z_q": -12.0,
    "M_wdot": -3.0, "M_w": -12.0, "M_qdot": -22.0, "M_q": -55.0,
}  # fmt: skip
HORIZONTAL = {
    "Y_vdot": -62.0, "Y_v": -120.0, "Y_rdot": -2.0, "Y_r": 15.0,
    "N_vdot": -2.0, "N_v": -40.0, "N_rdot": -18.0, "N_r": -35.0,
}  # fmt: skip
CUBIC = {
    "Y_vvv": -900.0, "Y_vvr": 250.0, "Y_vrr": -180.0, "Y_rrr": 20.0,
    "N_vvv": 90.0, "N_vvr": -260.0, "N_vrr": 70.0, "N_rrr": -40.0,
}  # fmt: skip
SURGE_TRUTH = {"X_0": -12.0, "X_vv": -60.0, "X_vr": 45.0, "X_rr": -8.0}

_SAMPLES = 512


@dataclass(frozen=True)
class Made:
    """How a cycle is made.

    Attributes
    ----------
    truth, surge
        Coefficients by name, of force and moment and of X; no X gauge where ``None``.
    body, restoring
        What the model has in truth, and what is named to be taken off.
    """

    truth: Mapping[str, float]
    plane: Plane = Plane.HORIZONTAL
    drift_rad: float = 0.0
    orders: int = 3
    surge: Mapping[str, float] | None = None
    body: Body = BODY
    restoring: FloatArray | None = None


def made_up(point: SetPoint, made: Made, name: str) -> Cycle:
    """Return a run with exact loads, worked out sample by sample from the terms."""
    angle = 2.0 * math.pi * np.arange(_SAMPLES) / _SAMPLES
    position, pace, rate, through, through_rate = _motion(point, made, angle)
    known = np.zeros((2, 2)) if made.restoring is None else made.restoring
    loads = mass_matrix(made.body, made.plane) @ rate
    loads += (known + weight_matrix(made.body, made.plane)) @ position
    for key, value in made.truth.items():
        term = term_of(key, made.plane)
        loads[term.row] -= value * waves_of([term], through, through_rate)[0]
    rows = [*position, *loads]
    if made.surge is not None:
        side = 1.0 if made.plane is Plane.VERTICAL else -1.0
        force = -side * rate[0] * position[1] - made.body.cg_x_m * pace[1] ** 2
        force *= made.body.mass_kg
        for key, value in made.surge.items():
            force = force - value * waves_of([term_of(key, made.plane)], through, through_rate)[0]
        rows.append(force)
    cycle = Cycle(
        name,
        made.plane,
        HALF_M,
        point.frequency_hz,
        point.carriage_speed_m_s,
        _phasors(rows, angle, made.orders),
        made.orders,
        drift_rad=made.drift_rad,
        mean_known=True,
    )
    return cycle.without(BODY, known)


def _motion(
    point: SetPoint, made: Made, angle: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray, FloatArray]:
    """Position, velocity and acceleration, and the last two through the water, (2, samples)."""
    omega, speed = 2.0 * math.pi * point.frequency_hz, point.carriage_speed_m_s
    side = 1.0 if made.plane is Plane.VERTICAL else -1.0
    aft = point.eccentricity_m
    fore = aft * np.exp(1j * point.strut_phase_rad)
    moved = np.array([(fore + aft) / 2.0, -side * (fore - aft) / (2.0 * HALF_M)])
    turning = moved[:, None] * np.exp(1j * angle)
    position, pace, rate = (((1j * omega) ** n * turning).imag for n in range(3))
    through, through_rate = pace.copy(), rate.copy()
    ahead = math.cos(made.drift_rad)
    through[0] += side * speed * (math.sin(made.drift_rad) + ahead * position[1])
    through_rate[0] += side * speed * ahead * pace[1]
    return position, pace, rate, through, through_rate


def _phasors(rows: Sequence[FloatArray], angle: FloatArray, orders: int) -> Phasors:
    names = (*CHANNELS, SURGE_FORCE)[: len(rows)]
    values: list[complex] = []
    for n in range(orders + 1):  # y = Im(H exp(i n angle)): H = 2i mean(y exp(-i n angle))
        turn = np.exp(-1j * n * angle)
        values += [row.mean() if n == 0 else 2j * (row * turn).mean() for row in rows]
    return Phasors(
        tuple(at_order(one, n) for n in range(orders + 1) for one in names),
        ("m", "rad", "N", "N m", "N")[: len(rows)] * (orders + 1),
        np.array(values, dtype=np.complex128),
    )


def scattered(
    cycle: Cycle, generator: Generator, *, periods: int = 8, motion_m: float = 2e-5,
    force_n: float = 0.3, correlation: float = 0.5,
) -> Cycle:  # fmt: skip
    """Return the mean of noisy periods, all harmonics tied, with the scatter that they show."""
    count = len(cycle.phasors.names)
    spread = np.repeat([_noise(name, motion_m, force_n) for name in cycle.phasors.names], 2)
    spread[1 : 2 * count // (cycle.orders + 1) : 2] = 0.0  # a mean has no quadrature
    common = generator.standard_normal((periods, 1))
    own = generator.standard_normal((periods, 2 * count))
    draws = spread * (math.sqrt(correlation) * common + math.sqrt(1.0 - correlation) * own)
    values = from_interleaved(interleaved(cycle.phasors.values) + draws.mean(axis=0))
    source = Source(
        f"scatter of {cycle.name}", np.cov(draws, rowvar=False) / periods, periods - 1.0
    )
    return replace(cycle, phasors=replace(cycle.phasors, values=values, sources=(source,)))


def _noise(name: str, motion_m: float, force_n: float) -> float:
    kind = name.split()[0]
    if kind in ("translation", "rotation"):
        return motion_m * (1.0 if kind == "translation" else 1.0 / HALF_M)
    return force_n * (HALF_M if kind == "moment" else 1.0)


def wrong(cycle: Cycle, stated: Stated, errors: Mapping[str, float]) -> Cycle:
    """Return the cycle as a chain reads it that errs by so many stated standard uncertainties.

    Knows amplitude, lag and force gain; errors of the body belong to :class:`Made`.
    """
    size = len(cycle.phasors.names)
    factors = np.ones(size, dtype=np.complex128)
    omega = 2.0 * math.pi * cycle.frequency_hz
    lag = errors.get("lag_s", 0.0) * stated.lag_s
    gain = 1.0 + errors.get("force_gain_relative", 0.0) * stated.force_gain_relative
    longer = 1.0 + errors.get("amplitude_relative", 0.0) * stated.amplitude_relative
    for k, name in enumerate(cycle.phasors.names):
        kind, order = name.split()
        moves = kind in ("translation", "rotation")
        factors[k] = longer if moves else gain * np.exp(-1j * int(order) * omega * lag)
    return replace(cycle, phasors=cycle.phasors.mapped(np.diag(factors)))


def wrong_body(stated: Stated, errors: Mapping[str, float]) -> Body:
    """Return the body as it is, where :data:`BODY` is what is taken off."""
    names = ("mass_kg", "cg_x_m", "cg_z_m", "inertia_kg_m2")
    return replace(
        BODY,
        **{n: getattr(BODY, n) + errors.get(n, 0.0) * getattr(stated, n) for n in names},
    )


def without_incidence(frequency_hz: float, speed_m_s: float) -> float:
    """Return the strut phase of pure yaw or pitch: ``tan(phi/2) = omega l / U``."""
    return 2.0 * math.atan2(2.0 * math.pi * frequency_hz * HALF_M, speed_m_s)


def pure_pair(frequency_hz: float, eccentricity_m: float, speed_m_s: float) -> list[SetPoint]:
    """Return translation alone, and rotation without incidence."""
    phases = (0.0, without_incidence(frequency_hz, speed_m_s))
    return [SetPoint(frequency_hz, eccentricity_m, phase, speed_m_s) for phase in phases]


def amplitudes(speed_m_s: float = 1.2, frequency_hz: float = 0.3) -> list[tuple[str, SetPoint]]:
    """Return sway and pure yaw at three amplitudes, and a run between both."""
    turn = without_incidence(frequency_hz, speed_m_s)
    sizes = (0.06, 0.12, 0.2)
    points = [(f"sway {e:g}", SetPoint(frequency_hz, e, 0.0, speed_m_s)) for e in sizes]
    points += [(f"yaw {e:g}", SetPoint(frequency_hz, e, turn, speed_m_s)) for e in sizes]
    return [*points, ("mixed", SetPoint(frequency_hz, 0.15, 1.8, speed_m_s))]
