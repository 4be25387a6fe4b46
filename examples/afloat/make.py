"""Make ``run-N.csv.gz``: a body on springs under a known force, whose guide rubs.

``heave.toml`` says nothing of the friction. Run from the project's root:
``python -m examples.afloat.make``.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.signal import resample_poly

from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from sim.acquisition.channels import Digitiser
from sim.pendulum.bench import PendulumBench
from sim.pendulum.benches import decay_bench
from sim.pendulum.coordinates import HEAVE
from sim.pendulum.driven import DrivenBody, PeriodicForce
from sim.pendulum.record import record
from sim.pendulum.resistance import Resistance
from sim.pendulum.sensors import Sensor

HERE = Path(__file__).parent
FREQUENCIES_HZ = (0.4, 0.5, 0.6, 0.7, 0.9)
FORCE_N = 30.0
FRICTION_N = 3.0
STOP_S, RATE_HZ = 50.0, 50.0
FINER = 10  # simulated; an accelerometer is filtered before it is sampled
NOISE = (0.02, 2e-5, 1e-3)  # N, m, m/s2


def bench(frequency_hz: float) -> PendulumBench:
    """Return a body of 50 kg that moves 20 kg of water, on springs of 1 kN/m."""
    force = PeriodicForce(2.0 * math.pi * frequency_hz, (FORCE_N,))
    resistance = Resistance(viscous=60.0, coulomb=FRICTION_N)
    body = DrivenBody(50.0, 20.0, 1000.0, resistance, HEAVE, force)
    accelerometer = Sensor(Channel("acceleration", "m/s2"), ((HEAVE.acceleration, 1.0),))
    seen = decay_bench(body, release=0.0)
    return replace(
        seen, sensors=(*seen.sensors, accelerometer), digitisers=(Digitiser(), Digitiser())
    )


def rows(number: int) -> FloatArray:
    """Return seconds, force, heave and acceleration of a run, with noise."""
    one, stop_s = bench(FREQUENCIES_HZ[number]), STOP_S + 1.0  # the filter's end is cut off
    run = record(one, duration_s=stop_s, sample_rate_hz=FINER * RATE_HZ, seed=number).dataset
    force = FORCE_N * np.cos(2.0 * math.pi * FREQUENCIES_HZ[number] * run["time"].values)
    columns = np.column_stack((force, run["heave"].values, run["acceleration"].values))
    count = round(STOP_S * RATE_HZ)
    kept = resample_poly(columns, 1, FINER, window=("kaiser", 9.0))[:count]
    noise = np.random.default_rng(20 + number).normal(0.0, NOISE, kept.shape)
    return np.column_stack((np.arange(count) / RATE_HZ, kept + noise))


def main() -> None:
    """Write the records."""
    for number in range(len(FREQUENCIES_HZ)):
        np.savetxt(
            HERE / f"run-{number + 1}.csv.gz", rows(number), ("%.2f", "%.3f", "%.6f", "%.4f"),
            delimiter=",", header="time_s,force [N],heave [m],acceleration [m/s2]", comments="",
        )  # fmt: skip


if __name__ == "__main__":
    main()
