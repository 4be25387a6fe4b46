"""Make ``roll.csv``: the roll decay of a body whose drag ``roll.toml`` says nothing of.

Run from the project's root: ``python -m examples.decay.make``.
"""

from pathlib import Path

import numpy as np

from hardware.description.arrays import FloatArray
from sim.pendulum.benches import decay_bench
from sim.pendulum.effects import make_effect
from sim.pendulum.floating import Floating
from sim.pendulum.record import record

HERE = Path(__file__).parent
BODY = Floating(inertia=100.0, added_inertia=20.0, restoring=800.0)
LOSS = 0.3  # of the amplitude a cycle over its square, 1/rad


def rows() -> FloatArray:
    """Return seconds and radians: 36 s at 25 Hz, noise of 0.1 mrad."""
    bench = decay_bench(BODY, release=0.2).with_effects([make_effect("quadratic_drag", loss=LOSS)])
    run = record(bench, duration_s=36.0, sample_rate_hz=25.0, seed=1).dataset
    noise = np.random.default_rng(7).normal(0.0, 1e-4, run.sizes["time"])
    return np.column_stack((run["time"].values, run["roll"].values + noise))


def main() -> None:
    """Write the record."""
    np.savetxt(
        HERE / "roll.csv", rows(), ("%.2f", "%.6f"), delimiter=",", header="time_s,roll",
        comments="",
    )  # fmt: skip


if __name__ == "__main__":
    main()
