"""The push test names the gauge and the sign that a record was built with, or says why not."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.channels import FORCE_AFT, FORCE_FORE, FORCE_X, Channel
from pmm.devices.push_test import NoPushError, PushError, faults, judge

RATE_HZ, NOISE_N, FULL_N = 100, 0.05, 490.0
CHANNELS = tuple(Channel(one.name, "N", FULL_N) for one in (FORCE_AFT, FORCE_FORE, FORCE_X))
OFFSETS = (3.0, -40.0, 0.4)


def records(seed: int, *pushes: float) -> tuple[dict, dict]:
    """Offsets and noise at rest; the same and a half sine of half a second when pushed."""
    random = np.random.default_rng(seed)
    shape = np.zeros(2 * RATE_HZ)
    shape[RATE_HZ : RATE_HZ + 50] = np.sin(np.linspace(0.0, np.pi, 50))
    rest, pushed = {}, {}
    for one, offset, push in zip(CHANNELS, OFFSETS, (*pushes, 0.0, 0.0, 0.0), strict=False):
        rest[one.name] = offset + NOISE_N * random.standard_normal(RATE_HZ)
        noise = NOISE_N * random.standard_normal(shape.size)
        pushed[one.name] = offset + push * shape + noise
    return rest, pushed


@given(
    st.integers(0, 2),
    st.sampled_from([-1, 1]),
    st.floats(3.5, 480.0),
    st.floats(-0.4, 0.4),
    st.integers(0, 2**16),
)
def test_gauge_and_sign_are_found_in_noise_and_cross_talk(at, sign, force, cross, seed) -> None:
    pushes = [cross * force] * 3
    pushes[at] = sign * force
    found = judge(CHANNELS, *records(seed, *pushes))
    assert (found.channel, found.sign) == (CHANNELS[at].name, sign)
    # The half sine's top, less what five smoothed samples take off it, and their noise.
    assert found.change == pytest.approx(sign * force, rel=0.01, abs=4 * NOISE_N)
    assert set(found.others) == {one.name for one in CHANNELS} - {found.channel}
    assert faults(found, found.channel, sign) == ()


@given(st.integers(0, 2**16))
def test_noise_alone_is_no_push(seed: int) -> None:
    with pytest.raises(NoPushError, match=r"a push is more than 2\.45 N; push harder"):
        judge(CHANNELS, *records(seed))


def test_the_threshold_is_eight_times_the_noise_where_that_is_more() -> None:
    random = np.random.default_rng(1)
    rest = {"force_aft": random.standard_normal(10_000)}
    only = (Channel("force_aft", "N"),)
    below = {"force_aft": np.full(100, 7.5)}
    above = {"force_aft": np.full(100, 8.5)}
    with pytest.raises(NoPushError):
        judge(only, rest, below)
    found = judge(only, rest, above)
    assert found.threshold == pytest.approx(8.0, rel=0.03)
    assert judge(only, rest, below, noise_times=6.0).channel == "force_aft"


def test_a_single_wild_sample_is_no_push() -> None:
    rest, pushed = records(2)
    pushed["force_aft"][120] += 10.0
    with pytest.raises(NoPushError):
        judge(CHANNELS, rest, pushed)


def test_two_gauges_that_move_alike_leave_it_open() -> None:
    with pytest.raises(
        PushError, match=r"force_aft \(\+.* and force_fore \(.*push one gauge alone"
    ):
        judge(CHANNELS, *records(3, 50.0, 40.0))


@pytest.mark.parametrize("which", ["at rest", "while pushed"])
def test_an_invalid_or_short_record_is_refused(which: str) -> None:
    rest, pushed = records(4, 50.0)
    record = rest if which == "at rest" else pushed
    record["force_fore"] = record["force_fore"].copy()
    record["force_fore"][10] = np.nan
    with pytest.raises(PushError, match=f"force_fore: not valid {which}; check the gauge"):
        judge(CHANNELS, rest, pushed)
    record["force_fore"] = np.zeros(3)
    with pytest.raises(PushError, match=f"force_fore: 3 samples {which}"):
        judge(CHANNELS, rest, pushed)


def test_a_gauge_without_noise_and_full_scale_is_judged_too() -> None:
    only = (Channel("force_aft", "N"),)
    flat = {"force_aft": np.zeros(20)}
    with pytest.raises(NoPushError):
        judge(only, flat, flat)
    assert judge(only, flat, {"force_aft": np.full(20, -1e-6)}).sign == -1


def test_swapped_cables_and_a_wrong_sign_are_named_with_their_fix() -> None:
    found = judge(CHANNELS, *records(5, 0.0, -30.0))
    swapped, turned = faults(found, "force_aft")
    assert "the push on force_aft came in on force_fore: their cables are swapped" in swapped
    assert "exchange the plugs of force_aft and force_fore" in swapped
    assert "force_fore went to -" in turned
    assert "turn the sign of its `scale`" in turned
    assert faults(found, "force_fore", -1) == ()
    assert faults(found, "force_fore") == (turned,)
