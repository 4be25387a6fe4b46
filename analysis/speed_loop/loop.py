"""A speed loop's margins, bandwidth and ripple, from the motor's data.

A motor's plant gives the speed as P u + P_d T, of the command u and the load torque T; the
controller is C = k_p + k_i / s on what the speed is short of. With the dead time d of the drive's
own sampling,

    L = C P exp(-s d),   speed per set-point L / (1 + L),   speed per load P_d / (1 + L).
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.motor import Servo, ShuntMotor, SpeedLoop

if TYPE_CHECKING:
    from control import StateSpace  # type: ignore[import-untyped]

_PADE_ORDER: Final = 4  # of the dead time: 1e-4 rad off at w d = 2, beyond any crossover here

_OMEGA: Final = np.logspace(-3.0, 6.0, 3000)  # rad/s, at which margins are looked for
_SETTLED: Final = 5.0  # time constants: to 1 %
_SHORTEST_S, _LONGEST_S = 3.0, 30.0
_HALF_POWER: Final = math.sqrt(0.5)
_UNBOUNDED: Final = 1e6  # a gain margin beyond it is rounding


@dataclass(frozen=True)
class Margins:
    """How far a loop is from instability.

    Attributes
    ----------
    gain
        By which factor the loop's gain may grow; infinite where no gain makes it unstable.
    phase_rad
        By how much its phase may fall behind at the crossover.
    sensitivity
        Largest ``|1 / (1 + L)|``: by how much the loop makes a disturbance larger at worst.
    crossover_hz
        Where ``|L| = 1``; NaN where it never is.
    """

    gain: float
    phase_rad: float
    sensitivity: float
    crossover_hz: float


@dataclass(frozen=True)
class ShaftLoop:
    """A motor's speed loop with what the model adds to the shaft.

    Attributes
    ----------
    controller
        Its gains, in the motor's units.
    added_inertia_kg_m2
        Mean inertia of the model at the shaft.
    delay_s
        Dead time in the loop.
    """

    motor: Servo | ShuntMotor
    controller: SpeedLoop
    added_inertia_kg_m2: float = 0.0
    delay_s: float = 0.0

    @property
    def closed(self) -> bool:
        """Whether there is a controller at all."""
        return bool(self.controller.proportional or self.controller.integral)

    @cached_property
    def margins(self) -> Margins:
        """Its margins."""
        import control

        if not self.closed:
            return Margins(math.inf, math.inf, 1.0, math.nan)
        response = self.open_response(_OMEGA)
        degrees = np.degrees(np.unwrap(np.angle(response)))
        stated_margins = control.stability_margins((np.abs(response), degrees, _OMEGA))
        gain, phase, distance, _, crossover, _ = map(float, stated_margins)
        if gain > _UNBOUNDED:
            gain = math.inf
        return Margins(gain, math.radians(phase), 1.0 / distance, crossover / (2.0 * math.pi))

    @cached_property
    def stable(self) -> bool:
        """Whether all poles of the closed loop lie in the left half plane."""
        return bool(np.all(self.speed_per_setpoint.poles().real < 0.0))

    @property
    def bandwidth_hz(self) -> float:
        """Up to where the speed follows its set-point, -3 dB; NaN without a controller."""
        if not self.closed:
            return math.nan
        response = self.open_response(_OMEGA)
        follows = np.abs(response / (1.0 + response))
        last = int(np.argmax(follows < _HALF_POWER))
        return float(np.interp(-_HALF_POWER, -follows[last - 1 : last + 1],
                               _OMEGA[last - 1 : last + 1])) / (2.0 * math.pi)  # fmt: skip

    @cached_property
    def settling_s(self) -> float:
        """How long its slowest motion takes to die out to 1 %, 3 to 30 s."""
        rates = -self.speed_per_load.poles().real
        slowest = float(rates[rates > _SETTLED / _LONGEST_S].min(initial=math.inf))
        return min(max(_SETTLED / slowest, _SHORTEST_S), _LONGEST_S)

    @cached_property
    def speed_per_setpoint(self) -> "StateSpace":
        """From the speed's set-point to the speed."""
        import control

        return control.feedback(self._open, 1)

    @cached_property
    def speed_per_load(self) -> "StateSpace":
        """From the load torque (N m) to the speed (rad/s), the set-point held."""
        import control

        A, B = self.motor.plant(self.added_inertia_kg_m2)
        speed = [[1.0, 0.0], [1.0, 0.0]]
        plant = control.ss(A, B[:, ::-1], speed, np.zeros((2, 2)))
        return plant.lft(-self._controller)

    def open_response(self, omega_rad_s: FloatArray) -> ComplexArray:
        """Return L at circular frequencies; the dead time is exact."""
        s = 1j * np.asarray(omega_rad_s, dtype=float)
        gains = self.controller.proportional + self.controller.integral / s
        return np.asarray(gains * self._motor_response(s)[:, 0] * np.exp(-s * self.delay_s))

    def load_response(self, omega_rad_s: FloatArray) -> ComplexArray:
        """Return the speed per load torque at circular frequencies, rad/s per N m."""
        motor = self._motor_response(1j * np.asarray(omega_rad_s, dtype=float))[:, 1]
        return np.asarray(motor / (1.0 + self.open_response(omega_rad_s)))

    def ripple(self, torques_n_m: ComplexArray, omega_rad_s: float) -> ComplexArray:
        """Return how the speed varies over a turn, relative to its mean.

        Parameters
        ----------
        torques_n_m
            Phasors of the load over a turn, order 1 first.
        omega_rad_s
            Speed of the shaft.
        """
        orders = np.arange(1.0, len(torques_n_m) + 1.0)
        return self.load_response(orders * omega_rad_s) * torques_n_m / omega_rad_s

    def _motor_response(self, s: ComplexArray) -> ComplexArray:
        """Return the speed per command and per load torque, shape ``(n, 2)``."""
        A, B = self.motor.plant(self.added_inertia_kg_m2)
        rates = s[:, np.newaxis, np.newaxis] * np.eye(2) - A
        return np.asarray(np.linalg.solve(rates, B)[:, 0], dtype=complex)

    @cached_property
    def _plant(self) -> "StateSpace":
        import control

        A, B = self.motor.plant(self.added_inertia_kg_m2)
        return control.ss(A, B, [[1.0, 0.0]], [[0.0, 0.0]])

    @cached_property
    def _controller(self) -> "StateSpace":
        import control

        gains = self.controller
        controller = control.ss([[0.0]], [[1.0]], [[gains.integral]], [[gains.proportional]])
        return control.series(controller, _dead_time(self.delay_s))

    @cached_property
    def _open(self) -> "StateSpace":
        import control

        return control.series(self._controller, self._plant[0, 0])


def _dead_time(delay_s: float) -> Any:
    import control

    if delay_s == 0.0:
        return control.ss([], [], [], [[1.0]])
    return control.ss(control.tf(*control.pade(delay_s, _PADE_ORDER)))
