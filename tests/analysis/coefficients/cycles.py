"""Cycles of runs with non-linear loads: through the simulator, or made up with given scatter."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from analysis.coefficients.cycle import CHANNELS, SURGE_FORCE, Cycle, at_order, measured_cycle
from analysis.coefficients.phasors import Phasors, Source, from_interleaved, interleaved
from analysis.coefficients.terms import term_of, waves_of
from analysis.motion import mass_matrix, weight_matrix
from analysis.readers.dataset import from_dataset
from analysis.resolver.analyse import Settings, analyse
from hardware.description.body import Body
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Plane
from hardware.description.setpoint import SetPoint
from sim.rig import SimulatedRig
from sim.run import simulate

HALF_M = 0.5
BODY = Body(mass_kg=70.0, inertia_kg_m2=27.5, cg_x_m=-0.02, cg_z_m=0.02)
TRUTH = {
    "Y_vdot": -62.0, "Y_v": -120.0, "Y_rdot": -2.0, "Y_r": 15.0,
    "N_vdot": -2.0, "N_v": -40.0, "N_rdot": -18.0, "N_r": -35.0,
    "Y_vvv": -900.0, "Y_vvr": 250.0, "Y_vrr": -180.0, "Y_rrr": 20.0,
    "N_vvv": 90.0, "N_vvr": -260.0, "N_vrr": 70.0, "N_rrr": -40.0,
}  # fmt: skip
SURGE_TRUTH = {"X_0": -12.0, "X_vv": -60.0, "X_vr": 45.0, "X_rr": -8.0}
CHANNEL_NAMES = ("displacement_aft", "displacement_fore", "force_aft", "force_fore")


def simulated(
    rig: SimulatedRig, point: SetPoint, *, name: str, seed: int = 1, periods: int = 8,
    rate_hz: float = 100.0, harmonics: int = 3,
) -> Cycle:  # fmt: skip
    """A run through rig, recorder and resolver."""
    record = simulate(rig, point, periods=periods, sample_rate_hz=rate_hz, seed=seed, name=name)
    settings = Settings(channels=CHANNEL_NAMES, harmonics=harmonics)
    cycle = measured_cycle(analyse(from_dataset(record), settings=settings), rig.oscillator).model()
    return cycle.without(rig.body, np.array(rig.water.restoring))


def struts(point: SetPoint, plane: Plane = Plane.HORIZONTAL) -> np.ndarray:
    """Translation and rotation of the fundamental, shape (2,)."""
    aft = point.eccentricity_m
    fore = aft * np.exp(1j * point.strut_phase_rad)
    side = 1.0 if plane is Plane.HORIZONTAL else -1.0
    return np.array([(fore + aft) / 2.0, side * (fore - aft) / (2.0 * HALF_M)])


def made_up(
    point: SetPoint, truth: dict[str, float], *, name: str, plane: Plane = Plane.HORIZONTAL,
    drift_rad: float = 0.0, orders: int = 3, surge: dict[str, float] | None = None,
    restoring: np.ndarray | None = None,
) -> Cycle:  # fmt: skip
    """A run with exact loads, worked out sample by sample from the terms."""
    omega, speed = 2.0 * math.pi * point.frequency_hz, point.carriage_speed_m_s
    angle = 2.0 * math.pi * np.arange(512) / 512
    wave = np.exp(1j * angle)
    moved = struts(point, plane)
    side = -1.0 if plane is Plane.HORIZONTAL else 1.0
    position = (moved[:, None] * wave).imag
    pace = (1j * omega * moved[:, None] * wave).imag
    rate = (-(omega**2) * moved[:, None] * wave).imag
    through = pace.copy()
    through[0] += side * speed * (math.sin(drift_rad) + math.cos(drift_rad) * position[1])
    through_rate = rate.copy()
    through_rate[0] += side * speed * math.cos(drift_rad) * pace[1]
    known = np.zeros((2, 2)) if restoring is None else restoring
    loads = mass_matrix(BODY, plane) @ rate + (known + weight_matrix(BODY, plane)) @ position
    for key, value in truth.items():
        term = term_of(key, plane)
        loads[term.row] -= value * waves_of([term], through, through_rate)[0]
    rows = [*position, *loads]
    if surge is not None:
        force = -BODY.mass_kg * (through[0] * pace[1] + BODY.cg_x_m * pace[1] ** 2)
        for key, value in surge.items():
            force = force - value * waves_of([term_of(key, plane)], through, through_rate)[0]
        rows.append(force)
    names = (*CHANNELS, SURGE_FORCE)[: len(rows)]
    values, units = [], ("m", "rad", "N", "N m", "N")[: len(rows)]
    for n in range(orders + 1):
        turn = np.exp(-1j * n * angle)
        # y = Im(H exp(i n angle)): H = 2i mean(y exp(-i n angle))
        values += [row.mean() if n == 0 else 2j * (row * turn).mean() for row in rows]
    phasors = Phasors(
        tuple(at_order(one, n) for n in range(orders + 1) for one in names),
        units * (orders + 1),
        np.array(values, dtype=complex),
    )
    cycle = Cycle(
        name, plane, HALF_M, point.frequency_hz, speed, phasors, orders,
        drift_rad=drift_rad, mean_known=True,
    )  # fmt: skip
    return cycle.without(BODY, known)


def oscillator(plane: Plane):  # type: ignore[no-untyped-def]
    return VERTICAL_1963 if plane is Plane.VERTICAL else HORIZONTAL_1963


def scattered(
    cycle: Cycle, generator: np.random.Generator, *, periods: int = 8, motion_m: float = 2e-5,
    force_n: float = 0.3, correlation: float = 0.5,
) -> Cycle:  # fmt: skip
    """The mean of so many noisy periods, all harmonics tied, with the scatter that they show."""
    count = len(cycle.phasors.names)
    sizes = [_size(name, motion_m, force_n) for name in cycle.phasors.names]
    spread = np.repeat(sizes, 2)
    spread[1 : 2 * count // (cycle.orders + 1) : 2] = 0.0  # a mean has no quadrature
    common = generator.standard_normal((periods, 1))
    own = generator.standard_normal((periods, 2 * count))
    draws = spread * (math.sqrt(correlation) * common + math.sqrt(1.0 - correlation) * own)
    values = from_interleaved(interleaved(cycle.phasors.values) + draws.mean(axis=0))
    source = Source(
        f"scatter of {cycle.name}", np.cov(draws, rowvar=False) / periods, periods - 1.0
    )
    return replace(cycle, phasors=replace(cycle.phasors, values=values, sources=(source,)))


def _size(name: str, motion_m: float, force_n: float) -> float:
    kind = name.split()[0]
    if kind in ("translation", "rotation"):
        return motion_m * (1.0 if kind == "translation" else 1.0 / HALF_M)
    return force_n * (HALF_M if kind == "moment" else 1.0)


def campaign(speed_m_s: float = 1.2, frequency_hz: float = 0.3) -> Sequence[tuple[str, SetPoint]]:
    """Sway and yaw at three amplitudes, and one in between."""
    turn = 2.0 * math.atan2(2.0 * math.pi * frequency_hz * HALF_M, speed_m_s)
    points = [(f"sway {e:g}", SetPoint(frequency_hz, e, 0.0, speed_m_s)) for e in (0.06, 0.12, 0.2)]
    points += [
        (f"yaw {e:g}", SetPoint(frequency_hz, e, turn, speed_m_s)) for e in (0.06, 0.12, 0.2)
    ]
    return [*points, ("mixed", SetPoint(frequency_hz, 0.15, 1.8, speed_m_s))]
