"""Motion across a clearance: free flight from one side to the other, and a plastic impact.

No effect itself. What is behind the clearance leaves its side when the force that holds it there
turns, flies under what it would have taken to keep it there, and stops where it meets the other
side. The flight takes about ``(6 L m / F')^(1/3)`` for the length L and the force's rate F', so
that the square wave of the describing functions, which changes sides at once, is a limit that comes
nearer with the cube root of the clearance only.
"""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from hardware.description.arrays import ComplexArray, FloatArray

POINTS = 2048  # of a turn, for quadrature
_TURNS = 3  # until the flights repeat


@dataclass(eq=False)
class Clearances:
    """Several clearances, each of one length, in front of one body.

    Attributes
    ----------
    length
        Of all of them; a place is 0 at the near side and -length at the far one.
    damping, stiffness
        Shape ``(n, n)``; against the flight.
    places, rates
        Shape ``(n,)``.
    """

    length: float
    damping: FloatArray
    stiffness: FloatArray
    places: FloatArray = field(init=False)
    rates: FloatArray = field(init=False)

    def __post_init__(self) -> None:
        self.places = np.zeros(len(self.damping))
        self.rates = np.zeros(len(self.damping))

    def step(self, pull: FloatArray, inertia: FloatArray, step_s: float) -> None:
        """Go on by a step under the pull that each side has to exert, positive off the near one."""
        load = pull + self.damping @ self.rates + self.stiffness @ self.places
        near, far = self.places >= 0.0, self.places <= -self.length
        held = (near & (load <= 0.0)) | (far & (load >= 0.0))
        flying = np.flatnonzero(~held)
        if not flying.size:
            return
        # The damping counts at the step's end: it may stop a light body in less than a step.
        among = np.ix_(flying, flying)
        heavy = inertia[among] + step_s * self.damping[among]
        self.rates[flying] -= step_s * np.linalg.solve(heavy, load[flying])
        self.places[flying] += step_s * self.rates[flying]
        for joint in flying:
            if not -self.length < self.places[joint] < 0.0:
                self._meet(int(joint), inertia, flying)

    def _meet(self, joint: int, inertia: FloatArray, flying: NDArray[np.intp]) -> None:
        """Stop one at its side; its impulse changes the rates of those that still fly."""
        movers = np.array([i for i in flying if i != joint and self.rates[i] != 0.0], dtype=int)
        if movers.size:
            block = inertia[np.ix_(movers, movers)]
            self.rates[movers] += np.linalg.solve(block, inertia[movers, joint] * self.rates[joint])
        self.places[joint] = min(max(self.places[joint], -self.length), 0.0)
        self.rates[joint] = 0.0


def flight_harmonics(
    clearances: Clearances, pull: FloatArray, inertia: FloatArray, step_s: float
) -> ComplexArray:
    """Return the harmonics of the places over a turn, ``x = Re sum X_n exp(i n th)``.

    The result has the shape ``(POINTS/2 + 1, n)``.

    Parameters
    ----------
    pull
        Over the points of a turn, shape ``(POINTS, n)``.
    inertia
        At each point, ``(POINTS, n, n)``.
    """
    places = np.empty_like(pull)
    for _ in range(_TURNS):
        for k in range(POINTS):
            places[k] = clearances.places
            clearances.step(pull[k], inertia[k], step_s)
    harmonics: ComplexArray = np.fft.rfft(places, axis=0) * (2.0 / POINTS)
    harmonics[0] /= 2.0
    return harmonics
