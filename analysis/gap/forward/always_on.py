"""What is always on in a good rig, as columns: ripple, a shaft that gives way, drift, hum.

Each is at the size of its tolerance; what is beyond it is named as out of tolerance.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Final

import numpy as np

from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.observe.bands import MAINS_HZ
from analysis.gap.observe.components import Component, GapRun, Part, Stack
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCES
from sim import signals
from sim.effects.d1_speed_ripple import SpeedRippleEffect
from sim.effects.effect import Effect
from sim.effects.m8_temperature import Temperature
from sim.effects.situation import STRUT_FORCES

_STEP: Final = 0.1  # of a tolerance
_PHASES: Final = {"sine": 0.0, "cosine": 0.5 * math.pi}
_LOAD: Final = "load ripple"

Named = Iterator[tuple[str, FloatArray]]


def is_of_drive(name: str) -> bool:
    """Tell whether a tolerance is one of how evenly the shaft turns."""
    return "ripple" in name


def always_on(simulator: Simulator, base: FloatArray, tolerances: Tolerances) -> Named:
    """Yield names, and what a tolerance of each changes, in sigma, shape ``(observations,)``.

    Parameters
    ----------
    base
        What repeats with the shaft without any of it, shape ``(observations,)``.
    """
    ripples = {1: tolerances.ripple_1_relative, 2: tolerances.ripple_2_relative}
    load = tolerances.load_ripple_1_kg_m2 if simulator.rig.drive.motor is None else 0.0
    of_one: dict[tuple[int, str], FloatArray] = {}
    for order, relative in ripples.items():
        for phase, angle_rad in _PHASES.items():
            if (wanted := relative or load) > 0.0:
                ripple = SpeedRippleEffect(_STEP * wanted, float(order), angle_rad)
                column = _change(simulator, base, ripple)
                of_one[order, phase] = column / wanted
                yield from [(f"ripple {order} {phase}", column)] if relative else ()
    if load > 0.0:
        yield _LOAD, load * _of_load(simulator, of_one)
    if tolerances.warming_k_h > 0.0:
        warming = Temperature(rate_k_h=_STEP * tolerances.warming_k_h)
        yield "warming", _change(simulator, base, warming)
    if tolerances.warming_n_s > 0.0:
        yield from _drifts(simulator.stack, tolerances.warming_n_s)
    if tolerances.hum_n > 0.0:
        yield from hum_columns(simulator.stack, tolerances.hum_n)


def _change(simulator: Simulator, base: FloatArray, effect: Effect) -> FloatArray:
    """Return what ten times an effect changes."""
    change = (simulator.steady((effect,)) - base) / _STEP / simulator.stack.uncertainty
    return np.asarray(change, np.float64)


def _of_load(simulator: Simulator, of_one: Mapping[tuple[int, str], FloatArray]) -> FloatArray:
    """Return what a shaft changes on whose inertia of 1 kg m2 the load acts, to first order.

    The load's torque T, n times a revolution, moves it by ``T/(J (n w)^2)``: a ripple of that order
    in each run. Once a revolution it lifts what the struts hold at rest.

    Parameters
    ----------
    of_one
        What a ripple of 1 changes, by its order and phase.
    """
    stack, total = simulator.stack, np.zeros(len(simulator.stack.components))
    orders = sorted({order for order, _ in of_one})
    ripples = np.array([_ripples(simulator, run, orders) for run in stack.runs])[stack.run]
    for order, ripple in zip(orders, ripples.T, strict=True):
        total += of_one[order, "sine"] * ripple.real + of_one[order, "cosine"] * ripple.imag
    return total


def _ripples(simulator: Simulator, run: GapRun, orders: Sequence[int]) -> list[complex]:
    """Return by order the ripple that a run's load gives a shaft of 1 kg m2: size and phase."""
    if not run.turns:
        return [0j] * len(orders)
    state = simulator.state(run, simulator.active_effects)
    period = state.period
    angle_rad = np.arange(period.points) * 2.0 * math.pi / period.points
    turn = np.exp(1j * np.outer(angle_rad, np.arange(period.orders + 1)))
    power = np.zeros(period.points)
    struts = zip(STRUT_FORCES, signals.STRUT_MOTIONS, simulator.lifted_n(run), strict=True)
    for force, motion, lifted_n in struts:
        pair = (state.spectra[force], state.spectra[motion[1].name])
        force_n, velocity = ((turn @ spectrum).real for spectrum in pair)
        power += (force_n + lifted_n) * velocity
    omega = 2.0 * math.pi * period.frequency_hz
    ripples = []
    for order in orders:
        torque = 2.0 * np.mean(power / omega * np.exp(-1j * order * angle_rad))
        ripples.append(complex(1j * torque / (order * omega**2)))
    return ripples


def _drifts(stack: Stack, drift_n_s: float) -> Named:
    """Yield what zeros change that drift alike in each record, a column for each force."""
    frequency_hz = np.array([run.set_point.frequency_hz for run in stack.runs])
    middle_s = [run.lead_s + 0.5 * run.periods / run.set_point.frequency_hz for run in stack.runs]
    times_s = {Part.MEAN: np.array(middle_s), Part.TREND: 1.0 / frequency_hz}
    for channel in FORCES:
        column = np.zeros(len(stack.components))
        for at, component in enumerate(stack.components):
            if component.channel == channel and component.part in times_s:
                column[at] = drift_n_s * times_s[component.part][stack.run[at]]
        yield f"drift {channel.removeprefix('force_')}", column / stack.uncertainty


def hum_columns(stack: Stack, hum_n: float) -> Named:
    """Yield what hum of a size changes, a column for each force and frequency of the mains."""
    for channel, mains_hz in product(FORCES, MAINS_HZ):
        line, side = Component(channel, Part.MAINS, mains_hz), channel.removeprefix("force_")
        rows = np.array([component == line for component in stack.components])
        yield f"hum {side} {mains_hz} Hz", hum_n * rows / stack.uncertainty
