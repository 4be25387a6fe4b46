"""Oracle: the same run in one call, with every part of the rig that remembers something."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.description.motor import Cogging, Guides, ShuntMotor
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint
from sim.acquisition.amplifier import BridgeCarrier, FilterKind, LowPass
from sim.acquisition.channels import Acquisition, Digitiser
from sim.acquisition.photocell import PhotocellStage
from sim.drive.carriage import CarriageSettings, Fluctuation
from sim.drive.prescribed_drive import DriveSettings, SpeedRipple
from sim.gauges.dynamometer import Dynamometer, Dynamometers
from sim.model.friction import Coulomb, LoadFriction
from sim.model.law_point import Acting, Point
from sim.model.laws import Cubic, Quadratic, Tone
from sim.model.mounting import Mounting
from sim.model.water.radiation import Radiation
from sim.model.water.tank import Tank, with_walls
from sim.rig import SimulatedRig, vertical_rig
from tests.sim.blocks import join

MEMORY = Radiation(
    np.array([[40.0, 3.0], [3.0, 12.0]]),
    np.array([[-4.0, 9.0], [-9.0, -4.0]]),
    np.array([[10.0, 1.0], [0.0, 4.0]]),
    np.array([[10.0, 0.0], [1.0, 4.0]]),
)


def everything() -> SimulatedRig:
    channel = Digitiser(
        noise_rms=0.1,
        drift_per_s=0.1,
        full_scale=400.0,
        walk_per_sqrt_s=0.2,
        offset=0.3,
        gain=1.01,
        low_pass=LowPass(15.0, FilterKind.BUTTERWORTH, 4),
        carrier=BridgeCarrier(phase_error_rad=0.1),
        delay_s=0.013,
        hum=0.5,
    )
    gauge = Dynamometer(1.01, 0.5, 500.0, 1e-5, 1e-5, 0.01, -300.0, 300.0)
    return replace(
        vertical_rig(),
        drive=DriveSettings(start_ramp_s=1.1, ripple=(SpeedRipple(2, 0.01),), speed_error=0.01),
        carriage=CarriageSettings(0.01, (Fluctuation(0.02, 0.7),)),
        radiation=with_walls(MEMORY, Tank(2.0, 1.0), Plane.VERTICAL, np.eye(2), onset_s=0.434),
        mounting=Mounting(2e5, 300.0, 1e6, 4000.0),
        forces=(
            Acting(Quadratic(100.0)),
            Acting(Cubic(200.0), Point.ROTATION),
            Acting(Coulomb(1.0, 0.2), Point.AFT),
            Acting(LoadFriction(0.01), Point.FORE),
            Acting(Tone(2.0, 1.7), Point.THROUGH_WATER),
        ),
        dynamometers=Dynamometers(gauge, gauge, 0.01, -0.01),
        acquisition=Acquisition(channel, channel, channel, channel, channel, channel),
        photocell=PhotocellStage(0.1, 1e-3, 1e-3, missed_every=3, extra_every=2),
    )


MOTOR = ShuntMotor(cogging=(Cogging(3, 0.5),), guides=Guides(1.0, 2.0))
RIGS = {
    "told": everything(),
    "loaded": replace(
        everything(), drive=DriveSettings(start_ramp_s=1.1, motor=MOTOR), mounting=Mounting()
    ),
    "loaded on springs": replace(everything(), drive=DriveSettings(start_ramp_s=1.1, motor=MOTOR)),
}


@pytest.mark.sample(1)
@pytest.mark.parametrize("rig", RIGS.values(), ids=RIGS.keys())
@settings(deadline=None, max_examples=8)
@given(sizes=st.lists(st.integers(0, 90), min_size=1, max_size=8), seed=st.integers(0, 2**40))
def test_any_mix_of_blocks(rig: SimulatedRig, sizes: list[int], seed: int) -> None:
    chain = rig.chain(SetPoint(1.1, 0.05, 0.8, carriage_speed_m_s=1.0))
    end, whole = chain.run(chain.start(100.0, seed), sum(sizes))
    state, parts = chain.start(100.0, seed), []
    for size in sizes:
        before = hash(state.stages)
        after, part = chain.run(state, size)
        assert hash(state.stages) == before
        state = after
        parts.append(part)
    joined = join(parts)
    for name, values in whole.items():
        scale = np.abs(values).max(initial=0.0)
        np.testing.assert_allclose(
            joined[name], values, rtol=1e-12, atol=1e-12 * scale, err_msg=name
        )
    assert state.next_sample == end.next_sample
