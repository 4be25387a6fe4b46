"""Make ``decay.csv.gz`` and ``axes.toml``: a decay that a hand cuts down, axes that contradict.

The equation of motion is integrated by scipy. Run from the project's root:
``python -m tests.data.made.make``.
"""

import math
from pathlib import Path
from typing import Final

import numpy as np
from scipy.integrate import solve_ivp

from hardware.description.arrays import FloatArray

HERE = Path(__file__).parent
PERIOD_S: Final = 2.0
RATIO: Final = 0.012  # of critical damping
TOUCHED_S: Final = 60.3
LEFT: Final = 0.16  # of angle and rate
FIRST_RAD: Final = math.radians(9.0)
RATE_HZ: Final = 20.0
STOP_S: Final = 80.0
NOISE_RAD: Final = 2e-4
STIFFNESS: Final = 5.0  # N m/rad
INERTIA: Final = (1.83, 1.2, 0.2)  # kg m2: xx, zz, xz
ANGLES_DEG: Final = (0.0, 30.0, 31.2, 70.0, 120.0)
WRONG: Final = 1.23  # factor of the third axis's inertia


def swing() -> FloatArray:
    """Return seconds and angle of the decay."""
    omega, time_s = 2.0 * math.pi / PERIOD_S, np.arange(0.0, STOP_S, 1.0 / RATE_HZ)

    def rates(_: float, x: FloatArray) -> list[float]:
        return [x[1], -(omega**2) * x[0] - 2.0 * RATIO * omega * x[1]]

    angle, state, begun = np.zeros(time_s.size), np.array([FIRST_RAD, 0.0]), 0.0
    for end in (TOUCHED_S, STOP_S):
        done = solve_ivp(rates, (begun, end), state, "DOP853", rtol=1e-9, dense_output=True)
        inside = (time_s >= begun) & (time_s <= end)
        angle[inside] = done.sol(time_s[inside])[0]
        begun, state = end, LEFT * done.y[:, -1]
    noise = np.random.default_rng(28).normal(0.0, NOISE_RAD, time_s.size)
    return np.column_stack((time_s, angle + noise))


def axes() -> str:
    """Return the file of the axes."""
    rows = [f"[torsion]\nstiffness_n_m_rad = {STIFFNESS}\n"]
    for number, degrees in enumerate(ANGLES_DEG):
        s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
        about = float(np.dot((s * s, c * c, -2.0 * s * c), INERTIA)) * (
            WRONG if number == 2 else 1.0
        )
        period_s = 2.0 * math.pi * math.sqrt(about / STIFFNESS)
        rows.append(
            f"[[torsion.axes]]\nangle_deg = {degrees}\nu_angle_deg = 0.2\n"
            f"period_s = {period_s:.5f}\nu_period_s = 0.001\n"
        )
    return "gravity_m_s2 = 9.81\n\n" + "\n".join(rows)


def main() -> None:
    """Write both files."""
    np.savetxt(
        HERE / "decay.csv.gz", swing(), ("%.2f", "%.6f"),
        delimiter=",", header="time_s,angle [rad]", comments="",
    )  # fmt: skip
    (HERE / "axes.toml").write_text(axes())


if __name__ == "__main__":
    main()
