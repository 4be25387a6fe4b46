"""Bodies that are let go, their equation of motion integrated by scipy."""

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

FloatArray = NDArray[np.float64]

PERIOD_S, INERTIA, DAMPING_RATIO = 1.8, 12.5, 0.03
OMEGA = 2.0 * math.pi / PERIOD_S
RESTORING, VISCOUS = INERTIA * OMEGA**2, 2.0 * DAMPING_RATIO * INERTIA * OMEGA
TABLE = f"""[floating]
inertia = 10.0
added_inertia = 2.5
restoring = {RESTORING:.9f}
resistance = {{ viscous = {VISCOUS:.9f} }}
"""


@dataclass(frozen=True)
class Released:
    """A body and how it is let go and recorded; the stated one where nothing is said.

    Attributes
    ----------
    inertia, restoring, damping
        Shares of what is stated.
    dead_zone
        Displacement in which dry friction holds the body, in rad.
    loss, cubic_loss
        Of the amplitude a cycle, over its square and its cube.
    softening
        Restoring is C q (1 - softening q^2).
    memory, tau_s
        A moment, over the restoring, of the rate that is forgotten over this time.
    hand_s
        Over which the hand lets go.
    offset, drift_per_s
        Of the reading, in rad and rad/s.
    """

    inertia: float = 1.0
    restoring: float = 1.0
    damping: float = 1.0
    dead_zone: float = 0.0
    loss: float = 0.0
    cubic_loss: float = 0.0
    softening: float = 0.0
    memory: float = 0.0
    tau_s: float = 1.0
    hand_s: float = 0.0
    offset: float = 0.0
    drift_per_s: float = 0.0
    held: float = math.radians(10.0)

    def record(self, swings: float = 20.0, rate_hz: float = 50.0) -> tuple[FloatArray, FloatArray]:
        """Return times in s and readings in rad, without noise."""
        inertia, restoring = INERTIA * self.inertia, RESTORING * self.restoring
        omega = math.sqrt(restoring / inertia)
        cubic = 4.0 / (3.0 * math.pi) * self.cubic_loss * inertia / omega

        def slope(t: float, y: FloatArray) -> list[float]:
            hand = max(1.0 - t / self.hand_s, 0.0) if self.hand_s else 0.0
            moment = (
                VISCOUS * self.damping * y[1]
                + 0.375 * self.loss * inertia * abs(y[1]) * y[1]
                + cubic * y[1] ** 3
                + restoring * self.dead_zone * math.tanh(y[1] / 1e-4)
                + restoring * (y[0] - self.softening * y[0] ** 3)
                + RESTORING * self.memory * y[2]
                - restoring * self.held * hand
            )
            return [y[1], -moment / inertia, y[1] - y[2] / self.tau_s]

        time_s = np.arange(round(swings * PERIOD_S * rate_hz) + 1) / rate_hz
        method = "LSODA" if self.dead_zone else "DOP853"
        found = solve_ivp(
            slope, (0.0, float(time_s[-1])), [self.held, 0.0, 0.0], method=method,
            rtol=1e-9, atol=1e-11, t_eval=time_s, max_step=0.1,
        )  # fmt: skip
        return time_s, found.y[0] + self.offset + self.drift_per_s * time_s


def written(
    folder: Path, time_s: FloatArray, values: FloatArray, tolerances: dict[str, float],
    *, table: str = TABLE, noise: float = 1e-4, seed: int = 7,
) -> Path:  # fmt: skip
    """Write a record with noise, and the file that tells of it; return that."""
    noisy = values + np.random.default_rng(seed).normal(0.0, noise, time_s.size)
    rows = np.column_stack((time_s, noisy))
    np.savetxt(folder / "decay.csv", rows, "%.8f", ",", header="time_s,roll", comments="")
    known = "".join(f"{name} = {value}\n" for name, value in tolerances.items())
    record = '[measured]\nrecord = "decay.csv"\nchannel = "roll"\n'
    file = folder / "decay.toml"
    file.write_text(f'name = "decay"\n{record}{table}[tolerances]\n{known}')
    return file
