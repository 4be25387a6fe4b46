"""The averaged cycle of a run: all harmonics of motion and loads together, mean included.

Non-linear terms are had from several harmonics at once, and these scatter together: one covariance
holds all of them. Phasors are named ``translation 0``, ``translation 1`` ...; order 0 is real.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from analysis.coefficients.phasors import FloatArray, Phasors
from analysis.coefficients.run import LOADS, MOTIONS, Run
from hardware.description.body import Body
from hardware.description.errors import DataError
from hardware.description.flags import Flag
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium

CHANNELS = (*MOTIONS, *LOADS)
SURGE_FORCE = "surge_force"


def at_order(name: str, order: int) -> str:
    """Return what a phasor of a cycle is called."""
    return f"{name} {order}"


def _nothing() -> FloatArray:
    return np.zeros((2, 2))


@dataclass(frozen=True, eq=False)
class Cycle:
    """Motion and loads of the model about the midpoint, at the harmonics 0 to ``orders``.

    Attributes
    ----------
    frequency_hz
        Of the fundamental; 0 for a static run, which has order 0 alone.
    speed_m_s
        Of the carriage.
    phasors
        By order: ``translation`` (m), ``rotation`` (rad), ``force`` (N), ``moment`` (N m) and,
        where there is a gauge for it, ``surge_force`` (N, of the strut on the model, ahead).
    mean_known
        Whether zero runs were taken off, so that the means are loads of the water.
    body, restoring, point_ahead_m, drift_rad
        As in :class:`analysis.coefficients.run.Run`.
    """

    name: str
    plane: Plane
    half_spacing_m: float
    frequency_hz: float
    speed_m_s: float
    phasors: Phasors
    orders: int
    medium: Medium = Medium.WATER
    body: Body | None = None
    restoring: FloatArray = field(default_factory=_nothing)
    point_ahead_m: float = 0.0
    drift_rad: float = 0.0
    mean_known: bool = False
    flags: tuple[Flag, ...] = ()

    @property
    def has_surge(self) -> bool:
        """Whether the surge force was measured."""
        return at_order(SURGE_FORCE, 0) in self.phasors.names

    @property
    def names(self) -> tuple[str, ...]:
        """The phasors' names in the order that fits work in: by order, then by channel."""
        channels = (*CHANNELS, SURGE_FORCE) if self.has_surge else CHANNELS
        return tuple(at_order(name, n) for n in range(self.orders + 1) for name in channels)

    def run(self, order: int = 1) -> Run:
        """Return one harmonic as a run of its own."""
        if not 0 <= order <= self.orders:
            raise DataError(
                f"{self.name} has harmonics 0 to {self.orders}, not {order}; resolve more of them"
            )
        chosen = self.phasors.select([at_order(name, order) for name in CHANNELS])
        return Run(
            self.name,
            self.plane,
            self.half_spacing_m,
            self.frequency_hz,
            self.speed_m_s,
            self.medium,
            replace(chosen, names=CHANNELS),
            order,
            self.body,
            self.restoring,
            self.point_ahead_m,
            self.flags,
            self.drift_rad,
        )

    def without(self, body: Body | None = None, restoring: FloatArray | None = None) -> "Cycle":
        """Return the cycle with what is to be taken off; see :meth:`Run.without`."""
        run = self.run(min(1, self.orders)).without(body, restoring)
        return replace(self, body=run.body, restoring=run.restoring)

    def without_dry(self, dry: "Cycle") -> "Cycle":
        """Return the cycle less the harmonics of a run in still air with the same motion.

        Each harmonic is turned by its own multiple of the angle between the two; the means stay,
        because zero runs are what they are taken from.

        Raises
        ------
        ConfigurationError
            As :meth:`Run.without_dry`.
        """
        first = self.run(1)
        flags = first.without_dry(dry.run(1)).flags
        lever = np.array([1.0, self.half_spacing_m])
        own, other = first.motion.values * lever, dry.run(1).motion.values * lever
        ratio = np.vdot(other, own) / np.vdot(other, other)
        scale = np.zeros((len(self.phasors.names), len(dry.phasors.names)), dtype=np.complex128)
        for n in range(1, min(self.orders, dry.orders) + 1):
            for name in LOADS:
                place = self.phasors.names.index(at_order(name, n))
                turn = abs(ratio) * np.exp(1j * n * np.angle(ratio))
                scale[place, dry.phasors.index(at_order(name, n))] = turn
        taken = dry.phasors.shared.mapped(scale, self.phasors.names, self.phasors.units)
        return replace(self, phasors=self.phasors.minus(taken), flags=flags)

    def about(self, ahead_m: float) -> "Cycle":
        """Return the cycle with its coefficients wanted about a point ahead of the midpoint."""
        return replace(self, point_ahead_m=ahead_m)
