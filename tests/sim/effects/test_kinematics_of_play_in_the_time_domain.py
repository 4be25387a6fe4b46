"""Play in the joints, sample by sample: against its closed form, and blocks against whole runs."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.description.setpoint import SetPoint
from sim.effects.k6_joint_play import JointPlay
from sim.effects.situation import Situation
from sim.mechanism.play import JointMotion, follow_with_play
from sim.rig import vertical_rig
from tests.sim.effects.against_theory import small_angles

RATE_HZ, PERIODS = 200.0, 4


# The jump's impulse comes when it should; what is left is the interval's square, most of it where
# the clearance is taken up within a few samples from the turn.
@pytest.mark.parametrize(("rate_hz", "tolerance"), [(200.0, 1e-2), (2000.0, 5e-5)])
@pytest.mark.parametrize("frequency_hz", [0.4, 0.8])
@pytest.mark.parametrize("half_play_m", [5e-5, 1e-3])
def test_samples_against_closed_form(
    frequency_hz: float, half_play_m: float, rate_hz: float, tolerance: float
) -> None:
    set_point, effect = SetPoint(frequency_hz, 0.02, 1.0), JointPlay(half_play_m)
    rig = small_angles(vertical_rig().ideal())
    period = round(rate_hz / frequency_hz)
    spectra = []
    for one in (rig, effect.change(rig, set_point)):
        chain = one.chain(set_point)
        _, run = chain.run(chain.start(rate_hz, 0), PERIODS * period)
        last = run["force_aft"][-period:]
        spectra.append(np.fft.rfft(last)[:6] * 2.0 / period)
    change = 1j * (spectra[1] - spectra[0]) * (-1.0) ** np.arange(6)  # the shaft starts at -pi
    theory = effect.signature(Situation.of(rig, set_point))
    stated = np.array([theory.get(("force_aft", n), 0.0) for n in range(1, 6)])
    assert np.linalg.norm(change[1:] - stated) < tolerance * np.linalg.norm(stated)


def test_impulse_of_each_jump_is_whole() -> None:
    time = np.arange(2000) / RATE_HZ
    omega = 2.0 * np.pi * 0.731
    motion = np.array([np.sin(omega * time), omega * np.cos(omega * time), 0.0 * time])
    motion[2] = -(omega**2) * motion[0]
    d, v, a = 0.02 * motion
    _, behind = follow_with_play(None, JointMotion(d, v, a), 1e-3, 1.0 / RATE_HZ)
    gained = np.cumsum(behind.acceleration) / RATE_HZ
    moving = np.abs(behind.velocity - v) < 1e-12
    # Away from the jumps velocity is what all accelerations before it add up to, half a sample on.
    shifted = v + a / (2.0 * RATE_HZ)
    assert (
        np.abs(gained - gained[moving][-1] - (shifted - shifted[moving][-1]))[moving].max() < 1e-4
    )
    assert np.abs(behind.position - d).max() == pytest.approx(1e-3, rel=1e-9)


@settings(max_examples=25, deadline=None)
@given(st.lists(st.integers(1, 200), min_size=1, max_size=8))
def test_blocks_against_the_whole_run(counts: list[int]) -> None:
    set_point = SetPoint(0.8, 0.02, 1.0)
    chain = JointPlay(1e-3).change(vertical_rig().ideal(), set_point).chain(set_point)
    total = sum(counts)
    _, whole = chain.run(chain.start(RATE_HZ, 0), total)
    state, parts = chain.start(RATE_HZ, 0), []
    for count in counts:
        state, part = chain.run(state, count)
        parts.append(part["force_fore"])
    assert np.allclose(np.concatenate(parts), whole["force_fore"], rtol=1e-12, atol=1e-12)
