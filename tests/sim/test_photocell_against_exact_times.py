"""Oracle: the exact times at which a shaft passes the mark."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from sim.acquisition.photocell import PhotocellStage
from sim.chain import Chain
from sim.drive.prescribed_drive import ConstantSpeedDrive, DriveSettings
from sim.signals import SHAFT_ACCELERATION, SHAFT_ANGLE, SHAFT_SPEED
from tests.sim.blocks import join

TURN = 2.0 * math.pi


def edges(
    drive: ConstantSpeedDrive, photocell: PhotocellStage, count: int, rate: float
) -> FloatArray:
    chain = Chain((drive, photocell))
    return chain.run(chain.start(rate, seed=5), count)[1]["photocell_edge_time"]


@pytest.mark.slow
@given(
    frequency=st.floats(0.01, 2.0),
    angle=st.floats(-10.0, 10.0),
    mark=st.floats(-3.0, 3.0),
    rate=st.floats(20.0, 1000.0),
)
def test_steady_shaft(frequency: float, angle: float, mark: float, rate: float) -> None:
    drive = ConstantSpeedDrive(frequency, DriveSettings(initial_angle_rad=angle))
    found = edges(drive, PhotocellStage(mark_angle_rad=mark), 2000, rate)
    turns = np.round((angle - mark) / TURN + found * frequency)
    exact = (turns + (mark - angle) / TURN) / frequency
    np.testing.assert_allclose(found, exact, rtol=1e-13, atol=1e-14 / frequency)
    assert np.all(np.diff(turns) == 1.0)
    last = 1999 / rate
    assert found.size == pytest.approx(last * frequency, abs=1.0 + 1e-9)


@pytest.mark.parametrize(("frequency", "rate"), [(1.0, 200.0), (1.0 / 3.0, 20.0), (0.1, 30.0)])
def test_marks_that_fall_on_samples(frequency: float, rate: float) -> None:
    """Rounding decides between which two samples the mark lies; the time must not notice."""
    drive = ConstantSpeedDrive(frequency, DriveSettings(initial_angle_rad=0.0))
    found = edges(drive, PhotocellStage(), 100_000, rate)
    np.testing.assert_allclose(found, (1 + np.arange(found.size)) / frequency, rtol=1e-14)


def test_during_the_start_ramp() -> None:
    """The ramp's angle w T (2.5 u^4 - 3 u^5 + u^6), solved for each turn in extended precision."""
    ramp, frequency, offset = 6.0, 1.3, -1.0
    drive = ConstantSpeedDrive(frequency, DriveSettings(offset, start_ramp_s=ramp))
    found = edges(drive, PhotocellStage(), 3000, 200.0)
    inside = found[found < ramp]
    assert inside.size == 4
    for k, time in enumerate(found):
        target = (k * TURN - offset) / (TURN * frequency)  # seconds at full speed
        if time < ramp:
            roots = np.roots([1.0, -3.0, 2.5, 0.0, 0.0, 0.0, -target / ramp])
            real = roots[(np.abs(roots.imag) < 1e-9) & (roots.real > 0) & (roots.real < 1)].real
            exact = ramp * real[0]
        else:
            exact = target + ramp / 2.0
        assert time == pytest.approx(exact, abs=2e-13)


def test_ramp_that_ends_between_two_samples() -> None:
    """Across the ramp's end the polynomial is not the motion; what is left is far below 1 ns."""
    ramp = 1.0
    for initial in np.linspace(-3.2, -2.9, 7):
        drive = ConstantSpeedDrive(1.0, DriveSettings(float(initial), start_ramp_s=ramp))
        found = edges(drive, PhotocellStage(), 300, 170.3)
        u_or_after = -initial / TURN
        if u_or_after >= ramp / 2.0:
            assert found[0] == pytest.approx(u_or_after + ramp / 2.0, abs=1e-10)
        else:
            u = found[0] / ramp
            turned = ramp * (2.5 * u**4 - 3.0 * u**5 + u**6)
            assert turned == pytest.approx(u_or_after, abs=1e-10)


@given(sizes=st.lists(st.integers(0, 7), min_size=1, max_size=80))
def test_marks_between_blocks_are_found(sizes: list[int]) -> None:
    drive = ConstantSpeedDrive(3.0, DriveSettings(initial_angle_rad=0.3))
    chain = Chain((drive, PhotocellStage(latency_s=0.02, jitter_rms_s=1e-3)))
    whole = chain.run(chain.start(13.0, seed=2), sum(sizes))[1]
    state, parts = chain.start(13.0, seed=2), []
    for size in sizes:
        state, part = chain.run(state, size)
        parts.append(part)
    np.testing.assert_allclose(
        join(parts)["photocell_edge_time"], whole["photocell_edge_time"], rtol=1e-12
    )


def test_latency_and_jitter() -> None:
    drive = ConstantSpeedDrive(1.0)
    delayed = edges(drive, PhotocellStage(latency_s=0.004, jitter_rms_s=0.001), 400_000, 20.0)
    delay = delayed - edges(drive, PhotocellStage(), 400_000, 20.0)
    count = delay.size
    assert count == 20_000
    assert delay.mean() == pytest.approx(0.004, abs=4 * 0.001 / math.sqrt(count))
    assert delay.std() == pytest.approx(0.001, rel=4 / math.sqrt(2 * count))


def test_shaft_that_turns_back_passes_the_same_mark_twice() -> None:
    chain = Chain((PhotocellStage(),), inputs=(SHAFT_ANGLE, SHAFT_SPEED, SHAFT_ACCELERATION))
    t = np.arange(40) / 10.0
    swing = {
        "shaft_angle": t * (3.5 - t) - 1.0,
        "shaft_speed": 3.5 - 2.0 * t,
        "shaft_acceleration": np.full_like(t, -2.0),
    }
    found = chain.run(chain.start(10.0, seed=0), t.size, swing)[1]["photocell_edge_time"]
    root = math.sqrt(3.5**2 - 4.0)
    np.testing.assert_allclose(found, [(3.5 - root) / 2, (3.5 + root) / 2], rtol=1e-14)


def test_an_angle_that_contradicts_its_speed_still_gives_a_time_between_the_samples() -> None:
    chain = Chain((PhotocellStage(),), inputs=(SHAFT_ANGLE, SHAFT_SPEED, SHAFT_ACCELERATION))
    given_shaft = {
        "shaft_angle": np.array([-0.2, 0.1]),
        "shaft_speed": np.array([-90.0, -80.0]),
        "shaft_acceleration": np.array([500.0, -700.0]),
    }
    found = chain.run(chain.start(10.0, seed=0), 2, given_shaft)[1]["photocell_edge_time"]
    assert found.size == 1
    assert 0.0 < found[0] < 0.1


def test_too_few_samples_a_turn_are_refused() -> None:
    with pytest.raises(ConfigurationError, match=r"more than once .* at 1 Hz"):
        edges(ConstantSpeedDrive(2.0, DriveSettings(0.1)), PhotocellStage(), 10, 1.0)
