"""How a shaft gives way to its load: the closed loop of a motor and its speed controller."""

from functools import lru_cache

import numpy as np

from hardware.description.motor import Motor, SpeedLoop
from sim.solve.linear_system import LinearSystem, Rows, as_rows


def closed_loop(motor: Motor, added_inertia_kg_m2: float) -> LinearSystem:
    """Return the closed loop from load torque to the shaft's deviation, by python-control.

    Input: load torque (N m). Outputs: angle (rad), speed (rad/s), acceleration (rad/s2).
    """
    return _closed_loop(as_rows(np.hstack(motor.plant(added_inertia_kg_m2))), motor.loop)


@lru_cache(maxsize=256)
def _closed_loop(plant: Rows, loop: SpeedLoop) -> LinearSystem:
    """Return the loop of a plant, A and B side by side, and its controller."""
    import control  # type: ignore[import-untyped]

    motor = np.array(plant)
    n = len(motor)
    # States: angle, speed, current. Inputs: load, command. Outputs: three, then two to control by.
    rates = np.zeros((n + 1, n + 1))
    rates[0, 1], rates[1:, 1:] = 1.0, motor[:, :n]
    inputs = np.zeros((n + 1, 2))
    inputs[1:] = motor[:, : n - 1 : -1]
    states = np.eye(n + 1)
    outputs = np.array([states[0], states[1], rates[1], states[1], states[0]])
    through = np.zeros((5, 2))
    through[2] = inputs[1]
    controller = control.ss([], [], [], [[-loop.proportional, -loop.integral]])
    closed_loop = control.ss(rates, inputs, outputs, through).lft(controller)
    return LinearSystem(*(np.array(matrix, dtype=float) for matrix in control.ssdata(closed_loop)))


@lru_cache(maxsize=128)
def droop(motor: Motor) -> float:
    """Return the steady speed that a steady load takes, rad/s per N m; 0 with an integral part."""
    if motor.loop.integral:
        return 0.0
    A, B = motor.plant(0.0)
    closed = A - motor.loop.proportional * np.outer(B[:, 0], [1.0, 0.0])
    return -float(np.linalg.solve(closed, B[:, 1])[0])
