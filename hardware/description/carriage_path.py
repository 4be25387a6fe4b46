"""The carriage's speed over the turn of a master angle, with which a model's own speed is steady.

With ``psi`` the angle of the struts' line in the rig, ahead towards across, ``u`` the speed along
the model, none across it, and ``l`` half the spacing, the reference point moves ahead at

    U - p l sin(psi) psi' = u cos(psi)

of the strut at the pivot, ``p`` = 1 aft and -1 fore: ``U = u cos(psi) + p l sin(psi) psi'``.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from hardware.description.arrangement import Joint, Pivot
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.lines import struts_over_turn
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import SetPoint

INSTANTS: Final = 720  # of a turn
_TURN: Final = 2.0 * math.pi
_LEAST: Final = 1e-9
"""Of the speed, below which a harmonic is left out: less than any carriage holds by a thousand.
Half or twice as much moves no digit that is set."""


@dataclass(frozen=True, eq=False)
class CarriagePath:
    """A speed over the master angle: ``U = Re sum of parts[n] exp(i n theta)``, in m/s.

    Attributes
    ----------
    parts
        By harmonic of the master angle, from 0 on.
    omega_rad_s
        Of the master angle.
    """

    parts: ComplexArray
    omega_rad_s: float

    @classmethod
    def of(cls, oscillator: Oscillator, set_point: SetPoint) -> "CarriagePath | None":
        """Return that of a run; ``None`` where the carriage's speed is steady."""
        if not set_point.steady_ahead:
            return None
        omega, half = _TURN * set_point.frequency_hz, oscillator.half_spacing_m
        moved = set_point.eccentricity_m * struts_over_turn(set_point.every_line, least=INSTANTS)
        lever = (moved[1] - moved[0]) / (2.0 * half)
        on_model = oscillator.joint is Joint.SLIDES_ON_MODEL
        heading = np.arctan(lever) if on_model else np.arcsin(lever)
        points = len(heading)
        order = np.arange(points // 2 + 1)
        turning = np.fft.irfft(1j * omega * order * np.fft.rfft(heading), points)
        reach = half if oscillator.pivot is Pivot.AFT else -half
        speed = set_point.carriage_speed_m_s * np.cos(heading) + reach * np.sin(heading) * turning
        parts = 2.0 * np.fft.rfft(speed) / points
        parts[0] /= 2.0
        orders = np.flatnonzero(np.abs(parts) > _LEAST * np.abs(speed).max())
        return cls(parts[: orders.max(initial=0) + 1], omega)

    @property
    def mean_m_s(self) -> float:
        """Mean speed over a turn."""
        return float(self.parts[0].real)

    def at(self, angle_rad: float) -> float:
        """Return the speed at a master angle, in m/s."""
        return float((self.parts @ np.exp(1j * np.arange(len(self.parts)) * angle_rad)).real)

    def over_turn(self, times: int = 0, instants: int = INSTANTS) -> FloatArray:
        """Return the speed at instants of a turn, differentiated by time so often."""
        order = np.arange(len(self.parts))
        angle = _TURN * np.arange(instants) / instants
        rates = self.parts * (1j * order * self.omega_rad_s) ** times
        return np.asarray((rates @ np.exp(1j * np.outer(order, angle))).real)

    def harmonics(self, orders: int) -> ComplexArray:
        """Return a real mean, and ``H[n]`` of ``sum of Im(H[n] exp(i n theta))`` up to an order."""
        harmonics = np.zeros(orders + 1, dtype=np.complex128)
        count = min(orders + 1, len(self.parts))
        harmonics[:count] = 1j * self.parts[:count]
        harmonics[0] = self.parts[0].real
        return harmonics
