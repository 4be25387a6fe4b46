"""Oracle: the same run in one call. And: a state is a value."""

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.setpoint import SetPoint
from sim.acquisition.channels import Acquisition, Digitiser
from sim.acquisition.photocell import PhotocellStage
from sim.chain import Chain
from sim.drive.prescribed_drive import DriveSettings
from sim.mechanism.linkage import Mechanism
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.signals import FORCE_AFT, SHAFT_ANGLE, Signal, Signals
from sim.stage import Block
from tests.sim.blocks import join


@dataclass(frozen=True)
class Lag:
    """A stage with a memory, as a later filter has: first-order low-pass of the aft force."""

    time_constant_s: float

    name: ClassVar[str] = "lag"
    reads: ClassVar[tuple[Signal, ...]] = (FORCE_AFT,)
    writes: ClassVar[tuple[Signal, ...]] = (Signal("lagged", "N"),)

    def start(self, sample_rate_hz: float, seed: int) -> float:
        return 0.0

    def run(self, state: float, block: Block, inputs: Signals) -> tuple[float, Signals]:
        pole = np.exp(-1.0 / (self.time_constant_s * block.sample_rate_hz))
        out = np.empty(block.count)
        for i, value in enumerate(inputs[FORCE_AFT.name]):
            state = float(pole * state + (1.0 - pole) * value)
            out[i] = state
        return state, {"lagged": out}


def busy_rig() -> SimulatedRig:
    """A rig in which every stage has something to remember or to draw."""
    noisy = Digitiser(noise_rms=0.3, drift_per_s=0.1, full_scale=450.0)
    return replace(
        horizontal_rig(rod_length_m=1.0),
        drive=DriveSettings(initial_angle_rad=0.2, start_ramp_s=1.7),
        photocell=PhotocellStage(mark_angle_rad=0.1, latency_s=1e-3, jitter_rms_s=1e-3),
        acquisition=Acquisition(noisy, noisy, noisy, noisy, noisy, noisy),
    )


def busy_chain() -> Chain:
    chain = busy_rig().chain(SetPoint(1.1, 0.05, 0.8, carriage_speed_m_s=1.0))
    return replace(chain, stages=(*chain.stages, Lag(0.3)))


@given(sizes=st.lists(st.integers(0, 120), min_size=1, max_size=12), seed=st.integers(0, 2**40))
def test_any_mix_of_block_sizes_gives_the_samples_of_the_whole_run(
    sizes: list[int], seed: int
) -> None:
    chain = busy_chain()
    end, whole = chain.run(chain.start(50.0, seed), sum(sizes))
    state, parts = chain.start(50.0, seed), []
    for size in sizes:
        state, part = chain.run(state, size)
        parts.append(part)
    joined = join(parts)
    assert joined.keys() == whole.keys() == {signal.name for signal in chain.signals}
    for name, values in whole.items():
        scale = np.abs(values).max(initial=0.0)
        np.testing.assert_allclose(joined[name], values, rtol=1e-12, atol=1e-12 * scale)
    assert state.next_sample == end.next_sample == sum(sizes)
    assert hash(state.stages[5]) == hash(end.stages[5])  # the noise stands at the same place


def test_one_state_gives_the_same_samples_twice() -> None:
    chain = busy_chain()
    state, _ = chain.run(chain.start(100.0, seed=3), 333)
    before = hash(state)
    first_state, first = chain.run(state, 150)
    chain.run(first_state, 77)
    second_state, second = chain.run(state, 150)
    assert first_state == second_state
    assert hash(state) == before
    for name, values in first.items():
        np.testing.assert_array_equal(values, second[name])


def test_computing_ahead_can_be_taken_back_when_a_command_changes() -> None:
    """Run on at the old eccentricity, then take the state back and run at the new one."""
    chain = vertical_rig().ideal().chain(SetPoint(1.0, 0.03))
    state, _ = chain.run(chain.start(200.0, seed=0), 100)
    _, ahead = chain.run(state, 50)
    smaller = chain.change("mechanism", lambda _: Mechanism(eccentricity_m=0.015))
    _, again = smaller.run(state, 50)
    np.testing.assert_allclose(again["force_aft"], ahead["force_aft"] / 2.0, atol=1e-12)


def test_seed_decides_the_noise_and_nothing_else() -> None:
    chain = busy_chain()
    _, one = chain.run(chain.start(100.0, seed=1), 200)
    _, two = chain.run(chain.start(100.0, seed=2), 200)
    np.testing.assert_array_equal(one["force_aft"], two["force_aft"])
    np.testing.assert_array_equal(one[SHAFT_ANGLE.name], two[SHAFT_ANGLE.name])
    assert np.abs(one["recorded_force_aft"] - two["recorded_force_aft"]).max() > 0.1
    assert np.abs(one["photocell_edge_time"] - two["photocell_edge_time"]).max() > 1e-6
