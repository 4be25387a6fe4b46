"""Runs with non-linear loads through the simulator, beside those made up for the benchmarks."""

from dataclasses import replace

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.strut_cycle import measured_cycle
from analysis.readers.dataset import from_dataset
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from hardware.description.setpoint import SetPoint
from sim.rig import SimulatedRig
from sim.run import simulate

CHANNEL_NAMES = ("displacement_aft", "displacement_fore", "force_aft", "force_fore")


def simulated(
    rig: SimulatedRig, point: SetPoint, *, name: str, seed: int = 1, periods: int = 8,
    rate_hz: float = 100.0, harmonics: int = 3, channels: tuple[str, ...] = CHANNEL_NAMES,
) -> BodyCycle:  # fmt: skip
    """A run through rig, recorder and resolver."""
    record = simulate(rig, point, periods=periods, sample_rate_hz=rate_hz, seed=seed, name=name)
    settings = ResolverSettings(channels=channels, harmonics=harmonics)
    cycle = measured_cycle(analyse(from_dataset(record), settings=settings), rig.oscillator).model()
    return cycle.without(rig.body, np.array(rig.water.restoring))


def zeroed(cycle: BodyCycle) -> BodyCycle:
    """As after zero runs that found no offset."""
    return replace(cycle, mean_known=True)
