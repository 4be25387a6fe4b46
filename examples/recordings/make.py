"""Write ``heave.csv.gz``: a forced heave run as another system might have recorded it.

Two struts heave a model by 20 mm at 0.83 Hz. The displacement of the aft strut and the forces of
both struts are sampled at 200 Hz for 40 s. The gauge of the fore strut is mounted the other way
round, so its column has the wrong sign; ``heave.toml`` sets that right.

Every signal is ``sum(a_n sin(n w t + p_n)) + drift + noise``; the numbers are below.
"""

import gzip
from pathlib import Path

import numpy as np

SEED = 1963
SAMPLE_RATE_HZ = 200.0
DURATION_S = 40.0
FREQUENCY_HZ = 0.83

AMPLITUDE_MM = 20.0
# Of each force: amplitude in newtons and phase in radians of harmonics 1 to 3.
FORCE_AFT = ((24.0, 2.80), (1.20, 0.70), (0.40, -1.10))
FORCE_FORE = ((26.5, 2.65), (0.90, 0.40), (0.35, 2.00))
NOISE_N = 0.30
DRIFT_N = (0.8, -0.5)  # from the first sample to the last, aft and fore
NOISE_MM = 0.005

HEADER = "Time [s],Strut A [mm],F1 [N],F2 [N]"


def harmonics(time_s: np.ndarray, parts: tuple[tuple[float, float], ...]) -> np.ndarray:
    """Sum harmonics 1, 2 ... of the given amplitudes and phases."""
    angle = 2.0 * np.pi * FREQUENCY_HZ * time_s
    waves = [a * np.sin(n * angle + p) for n, (a, p) in enumerate(parts, 1)]
    return np.asarray(np.sum(waves, axis=0))


def columns() -> np.ndarray:
    """Return time, displacement, aft force and (turned round) fore force, shape ``(rows, 4)``."""
    rng = np.random.default_rng(SEED)
    time_s = np.arange(round(DURATION_S * SAMPLE_RATE_HZ)) / SAMPLE_RATE_HZ
    ramp = np.linspace(0.0, 1.0, time_s.size)
    strut = harmonics(time_s, ((AMPLITUDE_MM, 0.0),)) + NOISE_MM * rng.standard_normal(time_s.size)
    forces = [
        harmonics(time_s, parts) + drift * ramp + NOISE_N * rng.standard_normal(time_s.size)
        for parts, drift in zip((FORCE_AFT, FORCE_FORE), DRIFT_N, strict=True)
    ]
    return np.column_stack([time_s, strut, forces[0], -forces[1]])


def write(path: Path) -> None:
    """Write the recording, the same bytes every time."""
    rows = columns().tolist()
    lines = [HEADER, *(f"{t:.3f},{d:.4f},{aft:.3f},{fore:.3f}" for t, d, aft, fore in rows)]
    text = "\n".join(lines) + "\n"
    path.write_bytes(gzip.compress(text.encode(), mtime=0))


if __name__ == "__main__":
    write(Path(__file__).with_name("heave.csv.gz"))
