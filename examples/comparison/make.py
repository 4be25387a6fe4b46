"""A heave in irregular waves, seen by a camera and felt by an accelerometer with its own clock.

``python examples/comparison/make.py`` writes both files. The truth: the accelerometer reads 2 % too
much, comes 45 ms late at 30 s by the file's own clocks, and its clock is fast by 350 ppm.
"""

import gzip
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
GAIN, LAG_S, RATE, MIDDLE_S = 1.02, 0.045, 350e-6, 30.0


def write(folder: Path) -> None:
    """Write ``camera.csv.gz`` and ``imu.csv.gz``."""
    rng = np.random.default_rng(28)
    turn = 2.0 * np.pi * rng.uniform(0.4, 1.2, 30)
    size = 0.012 * np.exp(-(((turn / 2.0 / np.pi - 0.75) / 0.2) ** 2)) * rng.rayleigh(size=30)
    phase = rng.uniform(0.0, 2.0 * np.pi, 30)
    camera_s = np.arange(60 * 25) / 25.0
    heave_mm = 1e3 * np.sin(np.outer(camera_s, turn) + phase) @ size
    heave_mm += rng.normal(0.0, 0.2, heave_mm.size)
    imu_s = np.arange(60 * 100) / 100.0
    moved_s = imu_s - LAG_S - RATE * (imu_s - MIDDLE_S)
    lift_m_s2 = -GAIN * np.sin(np.outer(moved_s, turn) + phase) @ (size * turn**2)
    lift_m_s2 += rng.normal(0.0, 0.02, lift_m_s2.size)
    _write(folder / "camera.csv.gz", "time [s],heave [mm]", camera_s, heave_mm, "%.2f,%.2f")
    _write(folder / "imu.csv.gz", "time [s],az [m/s2]", imu_s, lift_m_s2, "%.2f,%.3f")


def _write(path: Path, header: str, time_s: np.ndarray, values: np.ndarray, form: str) -> None:
    rows = "\n".join(form % row for row in zip(time_s, values, strict=True))
    text = f"{header}\n{rows}\n".encode()
    path.write_bytes(gzip.compress(text, mtime=0))


if __name__ == "__main__":
    write(HERE)
