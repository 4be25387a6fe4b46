"""A water with a memory of known poles, and campaigns of harmonics that a hull in it would show."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from analysis.coefficients.body_axes import labels
from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.response.multisine import multisine
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.setpoint import SetPoint
from sim.model.parameters import HullCoefficients
from sim.model.water.radiation import Radiation
from sim.rig import SimulatedRig, horizontal_rig
from sim.run import steady_run

# K(s) = k s / (s^2 + a s + b): poles -a/2 +- i sqrt(b - a^2/4), kernel a damped cosine.
SWAY, YAW = (4.0, 25.0), (5.0, 36.0)
STRENGTH = {(0, 0): (260.0, SWAY), (0, 1): (20.0, SWAY), (1, 1): (40.0, YAW)}
INFINITE = {(0, 0): 60.0, (0, 1): 2.0, (1, 1): 17.0}
STEADY = {(0, 0): 20.0, (0, 1): 3.0, (1, 1): 8.0}
SKEW = 6.0  # of the steady damping: 12 is above, 21 below; does no work
ELEMENTS = ((0, 0), (0, 1), (1, 1))
ORDERS = (3, 5, 7, 9, 11, 13, 15, 17)
BASE_HZ = 0.1
SCATTER = (2e-7, 2e-7, 5e-3, 5e-3)  # of phasors of both struts, m, and both gauges, N


def memory(element: tuple[int, int], omega: ArrayLike) -> ComplexArray:
    """K of one element, closed form."""
    k, (a, b) = STRENGTH[element]
    s = 1j * np.asarray(omega, dtype=np.float64)
    return np.asarray(k * s / (s * s + a * s + b))


def kernel(element: tuple[int, int], time_s: FloatArray) -> FloatArray:
    """The impulse response of K: k exp(-a t/2) (cos q t - a/(2 q) sin q t)."""
    k, (a, b) = STRENGTH[element]
    q = math.sqrt(b - a * a / 4.0)
    fading = k * np.exp(-a * time_s / 2.0)
    return np.asarray(fading * (np.cos(q * time_s) - a / (2.0 * q) * np.sin(q * time_s)))


def curves(omega: FloatArray) -> FloatArray:
    """A and B of each element, shape (3, 2, k)."""
    return np.array([
        [INFINITE[one] + memory(one, omega).imag / omega, STEADY[one] + memory(one, omega).real]
        for one in ELEMENTS
    ])  # fmt: skip


def water() -> Radiation:
    """The same as the simulator takes it: two states for each mode of each motion."""
    state, inputs = np.zeros((6, 6)), np.zeros((6, 2))
    outputs = np.zeros((2, 6))
    for n, (moves, feels, k, (a, b)) in enumerate(
        ((0, 0, *STRENGTH[0, 0]), (1, 1, *STRENGTH[1, 1]), (0, 1, *STRENGTH[0, 1]))
    ):
        state[2 * n : 2 * n + 2, 2 * n : 2 * n + 2] = [[0.0, 1.0], [-b, -a]]
        inputs[2 * n + 1, moves] = 1.0
        outputs[feels, 2 * n + 1] += k
    # The coupling of the other way: the same mode driven by yaw, felt in sway.
    both = Radiation(_matrix(INFINITE), state, inputs, outputs)
    k, (a, b) = STRENGTH[0, 1]
    return both.joined([[0.0, 1.0], [-b, -a]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, k], [0.0, 0.0]])


def _matrix(elements: dict[tuple[int, int], float]) -> FloatArray:
    return np.array([[elements[0, 0], elements[0, 1]], [elements[0, 1], elements[1, 1]]])


@cache
def rig(remembers: bool = True) -> SimulatedRig:
    damping = (_matrix(STEADY) + np.array([[0.0, SKEW], [-SKEW, 0.0]])).tolist()
    hull = HullCoefficients(damping=tuple(map(tuple, damping)))
    if not remembers:
        added = tuple(map(tuple, _matrix(INFINITE).tolist()))
        return replace(horizontal_rig().ideal(), water=replace(hull, added_mass=added))
    return replace(horizontal_rig().ideal(), water=hull, radiation=water())


@cache
def steady(own: SimulatedRig, point: SetPoint) -> ComplexArray:
    """Phasors of struts and gauges in the periodic steady state, (4, orders + 1)."""
    orders = 2 * max(line.order for line in point.every_line) if point.lines else 7
    found = steady_run(own, point, orders=max(12, orders))
    channels = (*DISPLACEMENTS, *FORCES)
    values = np.stack([1j * found.referred(f"recorded_{one}")[: orders + 1] for one in channels])
    values[:, 0] = values[:, 0].imag  # H[0] = i A0
    return values


def cycle(name: str, point: SetPoint, seed: int, *, remembers: bool = True) -> BodyCycle:
    """A run of the campaign with scatter drawn into its harmonics."""
    own, values = rig(remembers), steady(rig(remembers), point)
    orders = values.shape[1] - 1
    size = np.tile(np.repeat(SCATTER, 2), orders + 1)
    exact = Phasors.of(
        labels((*DISPLACEMENTS, *FORCES), orders), ("m", "m", "N", "N") * (orders + 1),
        values.T.ravel(),
    )  # fmt: skip
    drawn = exact.real.values + size * np.random.default_rng(seed).standard_normal(size.size)
    source = Contribution(f"scatter: {name}", 40.0, np.arange(size.size), np.diag(size))
    known = replace(exact, real=UncertainValues(drawn, (source,)))
    struts = StrutCycle(name, own.oscillator, point, point.frequency_hz, known, orders, True)
    return struts.model().without(own.body)


def many_lines(seed: int, *, remembers: bool = True) -> list[BodyCycle]:
    """A run of eight lines in sway and one in yaw."""
    runs = []
    for k, (kind, phase) in enumerate((("sway", 0.0), ("yaw", math.pi))):
        point = SetPoint(BASE_HZ, 0.06, lines=multisine(ORDERS, 1.0 / np.array(ORDERS), (phase,)))
        runs.append(cycle(kind, point, 100 * seed + k, remembers=remembers))
    return runs


def single_sines(seed: int, *, remembers: bool = True) -> list[BodyCycle]:
    """Sway and yaw at each of the same frequencies, a run each."""
    return [
        cycle(f"{kind}-{order}", SetPoint(BASE_HZ * order, 0.06 * 3.0 / order, phase),
              100 * seed + 10 * order + k, remembers=remembers)
        for order in ORDERS
        for k, (kind, phase) in enumerate((("sway", 0.0), ("yaw", math.pi)))
    ]  # fmt: skip
