"""A heeled model of point masses on two struts, in the tank's frame.

Each mass is where the struts' line, the heel and its place on the model put it; its acceleration is
the derivative of that place (by complex step, and differences of it), and Newton's law of all of
them, with the polynomial of the water and a wall-sided hull's lever, tells what the struts bear. A
free model rolls as its moment asks, by ``solve_ivp``.
"""

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]
Path = Callable[[object], object]
GRAVITY_M_S2 = 9.80665
_STEP = 2e-3
_TINY = 1e-30


def first(path: Path, time: object) -> Array:
    """Return the derivative of an analytic path, by complex step."""
    return np.imag(np.asarray(path(time + 1j * _TINY))) / _TINY  # type: ignore[operator]


def second(path: Path, time: Array) -> Array:
    """Return the second derivative: fourth order differences of the first."""
    weights = ((-2, 1.0), (-1, -8.0), (1, 8.0), (2, -1.0))
    return np.asarray(sum(w * first(path, time + k * _STEP) for k, w in weights) / (12.0 * _STEP))


@dataclass(frozen=True, eq=False)
class HeeledModel:
    """The model: masses and their places ahead, to starboard and below the midpoint, upright."""

    masses: Array
    places: Array
    terms: Mapping[str, float]
    gm_m: float = 0.0
    bm_m: float = 0.0

    def integral(self, x: int, y: int, z: int) -> float:
        """Return the sum of m x^.. y^.. z^.."""
        return float((self.masses * (self.places ** np.array([x, y, z])).prod(axis=1)).sum())

    def righting(self, heel: object) -> object:
        """Return the moment that brings it upright."""
        weight = self.masses.sum() * GRAVITY_M_S2
        return weight * (self.gm_m + 0.5 * self.bm_m * np.tan(heel) ** 2) * np.sin(heel)


@dataclass(frozen=True, eq=False)
class HeeledRun:
    """A run: the struts' paths over time, the carriage, the turned rig and the heel."""

    model: HeeledModel
    aft: Path
    fore: Path
    half_spacing_m: float
    speed_m_s: float
    drift_rad: float = 0.0
    heel: Path = field(default=lambda time: 0.0 * np.asarray(time))

    def heading(self, time: object) -> object:
        """Return the model's angle in the tank, bow to starboard."""
        slope = (self.fore(time) - self.aft(time)) / (2.0 * self.half_spacing_m)  # type: ignore[operator]
        return np.arctan(slope) + self.drift_rad

    def reference(self, time: object) -> object:
        """Return the midpoint in the tank, along and to starboard, shape ``(2, ...)``."""
        half, drift, line = self.half_spacing_m, self.drift_rad, self.heading(time)
        way, across = self.speed_m_s * np.asarray(time), self.aft(time)
        x = way - half * np.cos(drift) - across * np.sin(drift) + half * np.cos(line)  # type: ignore[operator]
        y = -half * np.sin(drift) + across * np.cos(drift) + half * np.sin(line)  # type: ignore[operator]
        return np.stack((x, y))

    def _masses(self, time: object) -> object:
        """Return where the masses are, shape ``(3, masses, n)``."""
        heel, heading, at = self.heel(time), self.heading(time), self.reference(time)
        ahead, side, down = self.model.places.T[:, :, None]
        across = side * np.cos(heel) - down * np.sin(heel)
        below = side * np.sin(heel) + down * np.cos(heel)
        x = at[0] + ahead * np.cos(heading) - across * np.sin(heading)  # type: ignore[index]
        y = at[1] + ahead * np.sin(heading) + across * np.cos(heading)  # type: ignore[index]
        return np.stack((x, y, below + 0.0 * x))

    def motion(self, time: Array) -> dict[str, Array]:
        """Return the velocities through the water, their rates, the heel and its rates."""
        cosine, sine = np.cos(self.heading(time)), np.sin(self.heading(time))
        vx, vy = first(self.reference, time)
        ax, ay = second(self.reference, time)
        u, v, r = vx * cosine + vy * sine, vy * cosine - vx * sine, first(self.heading, time)
        return {
            "u": u, "v": v, "r": r,
            "vdot": ay * cosine - ax * sine - r * u,
            "rdot": second(self.heading, time),
            "phi": np.asarray(self.heel(time)) + 0.0 * u,
            "p": first(self.heel, time) + 0.0 * u,
            "pdot": second(self.heel, time) + 0.0 * u,
        }  # fmt: skip

    def struts(self, time: Array) -> Array:
        """Return X, Y, N and K of the struts on the model about the midpoint, shape ``(4, n)``."""
        heading, heel = self.heading(time), self.heel(time)
        cosine, sine = np.cos(heading), np.sin(heading)
        ax, ay, az = second(self._masses, time)
        ahead, aside = ax * cosine + ay * sine, ay * cosine - ax * sine
        x, side, down = self.model.places.T[:, :, None]
        y = side * np.cos(heel) - down * np.sin(heel)
        z = side * np.sin(heel) + down * np.cos(heel)
        rows = np.stack((ahead, aside, x * aside - y * ahead, y * az - z * aside))
        total = np.asarray(np.einsum("m,rmt->rt", self.model.masses, rows))
        total[3] += self.model.righting(heel)
        return total - water(self.model.terms, self.motion(time))

    def rolled(self, rest_rad: float, seconds: float, times: Array) -> Array:
        """Return the heel of the model free to roll from its heel at rest, at some times."""
        held = float(self.model.righting(rest_rad))  # type: ignore[arg-type]

        def rates(time: float, state: Array) -> list[float]:
            needed = [self._roll_moment(time, state, bend) for bend in (0.0, 1.0)]
            return [state[1], (held - needed[0]) / (needed[1] - needed[0])]

        found = solve_ivp(
            rates, (0.0, seconds), [rest_rad, 0.0], "DOP853", times, rtol=1e-6, atol=1e-8
        )
        return np.asarray(found.y[0])

    def _roll_moment(self, time: float, state: Array, bend: float) -> float:
        """Return K of the struts where the heel moves on from a state with one acceleration."""
        phi, p = float(state[0]), float(state[1])

        def path(at: object) -> object:
            later = np.asarray(at) - time
            return phi + p * later + 0.5 * bend * later**2

        run = HeeledRun(self.model, self.aft, self.fore, self.half_spacing_m, self.speed_m_s,
                        self.drift_rad, path)  # fmt: skip
        return float(run.struts(np.array([time]))[3, 0])


def water(terms: Mapping[str, float], motion: Mapping[str, Array]) -> Array:
    """Return X, Y, N and K of the water on the hull."""
    loads = np.zeros((4, len(motion["u"])))
    for name, value in terms.items():
        product = np.full(len(motion["u"]), value)
        for factor in re.findall(r"phi|[vrp]dot|[uvrp]", name[2:]):
            product = product * motion[factor]
        loads["XYNK".index(name[0])] += product
    return loads
