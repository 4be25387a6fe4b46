"""Simulated runs for the tests of this folder: a rig, set-points, and the way to a Run."""

import math
from dataclasses import replace

import numpy as np

from analysis.coefficients.measured import measured_run
from analysis.coefficients.run import Run, from_struts
from analysis.readers.dataset import from_dataset
from analysis.resolver.analyse import Settings, analyse
from hardware.description.setpoint import Medium, SetPoint
from sim.rig import SimulatedRig
from sim.run import simulate

CHANNELS = ("displacement_aft", "displacement_fore", "force_aft", "force_fore")


def strut_run(  # type: ignore[no-untyped-def]
    rig: SimulatedRig, set_point: SetPoint, *, name: str, seed: int = 0, periods: int = 8,
    rate_hz: float = 200.0, channels: tuple[str, ...] = CHANNELS,
):  # fmt: skip
    record = simulate(rig, set_point, periods=periods, sample_rate_hz=rate_hz, seed=seed, name=name)
    settings = Settings(channels=channels, harmonics=3)
    analysis = analyse(from_dataset(record), settings=settings)
    return measured_run(analysis, rig.oscillator)


def loaded(rig: SimulatedRig, set_point: SetPoint, *, dry: bool = False, **options: object) -> Run:
    """A run with the body's inertia and the water's restoring named."""
    run = from_struts(strut_run(rig, set_point, **options))  # type: ignore[arg-type]
    if dry or set_point.medium is Medium.AIR:
        return run
    return run.without(rig.body, np.array(rig.water.restoring))


def pure(
    frequency_hz: float, eccentricity_m: float, speed_m_s: float = 0.0
) -> tuple[SetPoint, ...]:
    """Both motions: strut phases 0 and pi."""
    first = SetPoint(frequency_hz, eccentricity_m, 0.0, speed_m_s)
    return first, replace(first, strut_phase_rad=math.pi)
