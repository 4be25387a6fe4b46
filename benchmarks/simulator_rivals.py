"""The model on its gauges, with memory and quadratic drag, through scipy's integrators.

The equations are written down anew, as a user would: heave and pitch, in NumPy.
"""

from dataclasses import dataclass
from typing import Any, Final, Literal

import numpy as np

from hardware.description.arrays import FloatArray

Method = Literal["RK45", "DOP853", "LSODA"]
METHODS: Final[tuple[Method, ...]] = ("RK45", "DOP853", "LSODA")


@dataclass(frozen=True, eq=False)
class ModelOnGauges:
    """``M q'' + mu + B q' + C q + drag = T^T (k (y - h) + d (y' - h'))``, ``h = T^-1 q``.

    q is heave and pitch, h the model at the struts (aft, fore), y the motion of the struts. The
    memory is ``mu = gain xi_2`` of ``xi_1' = xi_2``, ``xi_2' = q' - 2 zeta w xi_2 - w^2 xi_1``, the
    drag ``B_q |z'| z'`` acts in heave.

    Attributes
    ----------
    mass, damping, stiffness, memory_gain
        Shape ``(2, 2)``.
    to_struts
        ``T^-1``, shape ``(2, 2)``.
    """

    frequency_hz: float
    eccentricity_m: float
    strut_phase_rad: float
    ramp_s: float
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    memory_gain: FloatArray
    memory_rad_s: float
    memory_ratio: float
    quadratic_n_s2_m2: float
    gauge_n_m: float
    gauge_n_s_m: float
    to_struts: FloatArray

    def struts(self, t: Any) -> tuple[FloatArray, FloatArray]:
        """Return displacement and velocity of the struts, shape ``(2, ...)``, with the ramp."""
        u = np.minimum(t / self.ramp_s, 1.0)
        omega = 2.0 * np.pi * self.frequency_hz
        turned = self.ramp_s * u**4 * (2.5 + u * (u - 3.0)) + np.maximum(t - self.ramp_s, 0.0)
        angle = -np.pi + omega * turned
        angles = np.array([angle, angle + self.strut_phase_rad])
        speed = omega * u**3 * (10.0 + u * (6.0 * u - 15.0))
        return self.eccentricity_m * np.sin(angles), self.eccentricity_m * np.cos(angles) * speed

    def gauge_forces(self, t: Any, x: FloatArray) -> FloatArray:
        """Return the force of each gauge, shape ``(2, ...)``."""
        y, v = self.struts(t)
        stretch, rate = y - self.to_struts @ x[:2], v - self.to_struts @ x[2:4]
        return self.gauge_n_m * stretch + self.gauge_n_s_m * rate

    def rates(self, t: float, x: FloatArray) -> FloatArray:
        """Return the derivatives of (q, q', xi_1, xi_2)."""
        q, v, first, second = x.reshape(4, 2)
        water = self.damping @ v + self.stiffness @ q + self.memory_gain @ second
        water[0] += self.quadratic_n_s2_m2 * abs(v[0]) * v[0]
        turn = np.linalg.solve(self.mass, self.to_struts.T @ self.gauge_forces(t, x) - water)
        w = self.memory_rad_s
        return np.concatenate(
            [v, turn, second, v - 2.0 * self.memory_ratio * w * second - w**2 * first]
        )

    def forces(self, time_s: FloatArray, method: Method, tolerance: float) -> FloatArray:
        """Return the force of each strut by ``solve_ivp``, shape ``(2, times)``."""
        from scipy.integrate import solve_ivp

        # At rest, where the restoring forces bend the gauges.
        gauges = self.gauge_n_m * self.to_struts.T
        at_rest = np.linalg.solve(
            self.stiffness + gauges @ self.to_struts, gauges @ self.struts(0.0)[0]
        )
        start = np.concatenate([at_rest, np.zeros(6)])
        solved = solve_ivp(
            self.rates,
            (0.0, float(time_s[-1])),
            start,
            method,
            time_s,
            rtol=tolerance,
            atol=1e-3 * tolerance,
        )
        return self.gauge_forces(time_s, solved.y)
