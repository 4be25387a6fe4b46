"""Write the example records of a swing and of a bifilar suspension, from closed forms.

``swing-1.csv.gz`` to ``swing-3.csv.gz``: an inclinometer on the empty swing, three releases,
degrees at 32 Hz. ``stern-1.csv.gz`` to ``stern-3.csv.gz``: an ultrasonic range finder at the stern
of a hull on two lines, yaw with sway, millimetres at 20 Hz. Headers name quantity and unit.
``gate-1.csv`` to ``gate-3.csv``: a light gate at the rest position of a rudder that swings freely,
its edges in seconds.
"""

import gzip
import math
from pathlib import Path

import numpy as np
from numpy.random import Generator

from hardware.description.arrays import FloatArray

SEED = 2014
SWING_PERIOD_S = 7.2923
RELEASE_SCATTER = 1e-3  # of the period, from one release to the next
GATE_PERIOD_S = 1.5252
HALF_SPACING_M, LINE_M, GYRADIUS_M = 0.900, 3.477, 1.056
GRAVITY_M_S2 = 9.81


def damped(t: FloatArray, period_s: float, tau_s: float, phase: float) -> FloatArray:
    """Damped cosine of unit amplitude."""
    return np.asarray(np.exp(-t / tau_s) * np.cos(2.0 * np.pi * t / period_s + phase))


def swing(generator: Generator) -> str:
    """One release of the swing: seconds and degrees."""
    t = np.arange(0.0, 160.0, 1.0 / 32.0)
    period = SWING_PERIOD_S * (1.0 + RELEASE_SCATTER * generator.standard_normal())
    angle = 1.1 * damped(t, period, 1.0 / 0.0048, 0.3) + 0.0012
    angle += 5e-4 * generator.standard_normal(t.size)
    rows = [f"{a:.5f},{b:.5f}" for a, b in zip(t, angle, strict=True)]
    return "\n".join(["Time [s],Tilt [deg]", *rows]) + "\n"


def stern(generator: Generator) -> str:
    """One release of the hull: seconds and millimetres."""
    t = np.arange(0.0, 160.0, 0.05)
    sway = 2.0 * math.pi * math.sqrt(LINE_M / GRAVITY_M_S2)
    yaw = sway * GYRADIUS_M / HALF_SPACING_M * (1.0 + 2e-4 * generator.standard_normal())
    y = 200.0 * damped(t, yaw, 640.0, 0.3) + 150.0 * damped(t, sway, 124.0, 1.2) + 812.0
    y += 0.1 * generator.standard_normal(t.size)
    rows = [f"{a:.2f},{b:.2f}" for a, b in zip(t, y, strict=True)]
    return "\n".join(["Time [s],Range [mm]", *rows]) + "\n"


def gate(generator: Generator) -> str:
    """One release of the rudder past a gate: dark for 20 mm at each passage, 60 swings."""
    passage = (np.arange(120) + 0.5) * GATE_PERIOD_S / 2.0
    passage += 2e-5 * generator.standard_normal(passage.size)
    speed = 0.4 * np.exp(-passage / 300.0)  # m/s at the gate
    half = 0.01 / speed
    edges = np.column_stack([passage - half, passage + half]).ravel()
    rows = [f"{at:.6f},{(k + 1) % 2}" for k, at in enumerate(edges)]
    return "\n".join(["Time,State", *rows]) + "\n"


def main(folder: Path = Path(__file__).parent) -> None:
    """Write all of them."""
    for number in (1, 2, 3):
        generator = np.random.default_rng((SEED, number))
        for name, text in (("swing", swing(generator)), ("stern", stern(generator))):
            packed = gzip.compress(text.encode(), mtime=0)
            (folder / f"{name}-{number}.csv.gz").write_bytes(packed)
        (folder / f"gate-{number}.csv").write_text(gate(generator), encoding="utf-8")


if __name__ == "__main__":
    main()
