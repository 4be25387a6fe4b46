"""An effect of the other sign is the same one seen in a mirror, and has it where nature does."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.a2_channel_skew import ChannelSkew
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect, Parameter
from sim.effects.k1_connecting_rod import ConnectingRod
from sim.effects.k6b_free_play import FreePlay
from sim.mechanism.linkage import Mechanism
from sim.rig import vertical_rig
from sim.run import steady_run
from tests.sim.effects.against_theory import small_angles
from tests.sim.effects.in_time import between, in_time

RIG = vertical_rig().ideal()
AIR = SetPoint(1.0, 0.02, 0.0, 0.0, Medium.AIR)
EVERY = [(kind, one) for kind in catalogue().values() for one in kind.parameters()]


@pytest.mark.parametrize(("kind", "one"), EVERY, ids=lambda it: getattr(it, "name", None))
def test_a_range_is_the_same_to_either_side_or_says_why_not(
    kind: type[Effect], one: Parameter
) -> None:
    assert kind.name
    assert (one.low == -one.high) != bool(one.one_sign)


@given(st.floats(0.05, 3.0), st.floats(-0.02, 0.02), st.floats(-7.0, 7.0))
def test_a_rod_to_the_other_side_mirrors_the_motion(
    rod_m: float, offset_m: float, angle: float
) -> None:
    """``y`` to the one side at an angle is ``-y`` to the other half a turn before the mirrored."""
    one, other = (Mechanism(0.02, rod_length_m=sign * rod_m) for sign in (1.0, -1.0))
    here = one.displacement(np.array([-angle]), offset_m)
    there = other.displacement(np.array([angle]), offset_m)
    assert there[0] == pytest.approx(-here[0], abs=1e-15)
    assert there[1] == pytest.approx(here[1], abs=1e-14)
    assert there[2] == pytest.approx(-here[2], abs=1e-13)


@pytest.mark.parametrize("rod_m", [0.09, -0.09, 0.0])
def test_no_rod_is_shorter_than_the_shortest(rod_m: float) -> None:
    with pytest.raises(ConfigurationError, match=r"-1e\+04 to -0\.1 or 0\.1 to 1e\+04"):
        ConnectingRod(rod_m)


def test_a_preload_to_the_other_side_mirrors_the_play() -> None:
    """Forces change their sign half a period later: odd orders stay, the mean and even ones turn.

    In air, without speed and at small angles nothing else tells up from down.
    """
    changes, level = [], small_angles(RIG)
    for preload_n in (5.0, -5.0):
        rig = FreePlay(2e-4, preload_n).change(level, AIR)
        played, nominal = (steady_run(one, AIR).spectra["force_aft"] for one in (rig, level))
        changes.append(played - nominal)
    up, down = changes
    mirrored = -down * (-1.0) ** np.arange(len(down))
    assert np.abs(up[2::2]).max() > 1e-3 * np.abs(up).max()
    np.testing.assert_allclose(mirrored[1:], up[1:], atol=1e-6 * np.abs(up[1:]).max())


@pytest.mark.parametrize("samples", [-1, 1])
def test_a_skew_in_time_is_the_force_some_samples_aside(samples: int) -> None:
    """Samples are counted from the pulse: those of the force alone come from another time."""
    per_period, set_point = 200, SetPoint(0.5, 0.02, 0.0, 1.0)
    delay_s = samples / (per_period * set_point.frequency_hz)
    runs = [RIG, ChannelSkew(delay_s, 0.0).change(RIG, set_point)]
    aft, fore = [], []
    for one in runs:
        run = in_time(one, set_point, 6, per_period)
        opened, closed = run.edges[3], run.edges[5]
        for name, found in (("recorded_force_aft", aft), ("recorded_force_fore", fore)):
            found.append(between(run, name, opened, closed, 2.0))
    turned = np.exp(-2j * np.pi * np.arange(5) * set_point.frequency_hz * delay_s)
    np.testing.assert_allclose(aft[1], turned * aft[0], atol=1e-6 * np.abs(aft[0]).max())
    np.testing.assert_allclose(fore[1], fore[0], atol=1e-6 * np.abs(fore[0]).max())
