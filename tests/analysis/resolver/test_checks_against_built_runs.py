"""Each flag appears where its cause was put, and nowhere else."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.resolver.analysis import analyse
from analysis.resolver.checks import gate_flags
from analysis.resolver.estimate import resolve
from analysis.resolver.photocell import from_photocell
from analysis.resolver.reference import from_frequency
from analysis.resolver.sums import PeriodSums, period_sums
from hardware.description.flags import Flag, Severity
from tests.analysis.resolver.signals import FloatArray, recording

RATE_HZ = 50.0
TIME = np.arange(3000) / RATE_HZ
MOTION = np.sin(2.0 * np.pi * TIME + 0.4)


def noise(size: float, seed: int = 0, channels: int = 1) -> FloatArray:
    return size * np.random.default_rng(seed).normal(size=(channels, TIME.size))


def flags(values: FloatArray, periods: int, edges_s: FloatArray | None = None) -> tuple[Flag, ...]:
    run = recording(values, RATE_HZ)
    reference = from_frequency(1.0, 0.0, run.end_s) if edges_s is None else from_photocell(edges_s)
    sums: PeriodSums = period_sums(run, reference)[3 : 3 + periods]
    return gate_flags(sums, resolve(run, sums))


def codes(values: FloatArray, periods: int, edges_s: FloatArray | None = None) -> list[str]:
    return [flag.code for flag in flags(values, periods, edges_s)]


@pytest.mark.parametrize("periods", [3, 5, 6, 10, 30])
@pytest.mark.parametrize("size", [0.0, 1e-3, 0.1])
def test_a_good_gate_has_no_flag(periods: int, size: float) -> None:
    assert codes(MOTION + noise(size), periods) == []


@pytest.mark.sample(2)
@pytest.mark.parametrize("periods", [3, 5, 6, 10, 30])
def test_channels_of_noise_or_of_nothing_have_no_flag(periods: int) -> None:
    """400 channels of noise beside a motion and two constants: as good as no false alarm."""
    constant = np.stack((np.zeros(TIME.size), np.full(TIME.size, 9.81)))
    values = np.concatenate((MOTION[None], constant, noise(1.0, 1, 400)))
    found = flags(values, periods)
    assert len(found) <= 3  # where 4 standard errors of few periods are no rarity
    assert not {"force_0", "force_1", "force_2"} & {flag.channel for flag in found}


@pytest.mark.parametrize("periods", [2, 3, 10])
def test_drift_is_noted_with_what_it_would_have_done(periods: int) -> None:
    drifting = np.stack((MOTION, MOTION + 0.5 * TIME))
    found = [flag for flag in flags(drifting, periods) if flag.code == "drift"]
    assert [flag.channel for flag in found] == ["force_1"]
    assert found[0].severity is Severity.NOTE
    assert "0.5 N/s" in found[0].message
    assert "0.159 N" in found[0].message  # 0.5 / pi


def test_a_small_drift_is_not_worth_a_word() -> None:
    assert codes(MOTION + 0.01 * TIME, 10) == []


def test_speed_change_is_flagged_above_half_a_percent() -> None:
    def edges(change: float) -> FloatArray:
        """Periods that grow by ``change`` over the ten of the gate."""
        return np.concatenate(([0.0], np.cumsum(1.0 + change * np.arange(40.0) / 9.0)))

    assert codes(np.ones(TIME.size), 10, edges(0.004)) == []
    found = flags(np.ones(TIME.size), 10, edges(0.01))
    assert [flag.code for flag in found] == ["speed_change"]
    assert "0.99 % within the gate (limit 0.5 %)" in found[0].message


@pytest.mark.parametrize("periods", [6, 10, 20])
@pytest.mark.parametrize("size", [0.0, 1e-3])
def test_a_transient_is_flagged_in_its_channel(periods: int, size: float) -> None:
    """A tenth of the amplitude dies away over the gate's length."""
    dying = 0.1 * np.exp(-TIME / periods)
    values = np.stack((MOTION, (1.0 + dying) * MOTION)) + noise(size, 2, 2)
    found = flags(values, periods)
    assert [(flag.code, flag.channel) for flag in found] == [("transient", "force_1")]


def test_a_trend_counts_beside_noise_as_if_it_were_no_slow_noise_itself() -> None:
    """One that goes through zero: for slow noise its own interval would hide it."""
    growing = (0.02 * (TIME - 23.0) + 0.12) * MOTION
    values = np.stack((MOTION, growing)) + noise(1e-3, 3, 2)
    assert [(flag.code, flag.channel) for flag in flags(values, 40)] == [("transient", "force_1")]


def test_a_transient_of_the_phase_is_flagged() -> None:
    turning = np.sin(2.0 * np.pi * TIME + 0.01 * TIME)
    assert codes(turning, 10) == ["transient"]


def test_a_single_period_has_no_interval() -> None:
    found = flags(MOTION, 1)
    assert [flag.code for flag in found] == ["no_interval"]
    assert "gate more periods" in found[0].message


def test_two_periods_are_few() -> None:
    found = flags(MOTION, 2)
    assert [flag.code for flag in found] == ["few_periods"]
    assert "rests on 2 periods; 3 or more" in found[0].message


def test_void_periods_are_counted() -> None:
    gap = MOTION.copy()
    gap[[int(5.5 * RATE_HZ), int(7.5 * RATE_HZ)]] = np.nan
    found = flags(gap, 10)
    assert [flag.code for flag in found] == ["void_periods"]
    assert found[0].severity is Severity.VOID
    assert found[0].message.startswith("2 of 10 periods")


@pytest.mark.parametrize(("every", "said"), [(1, False), (2, True)])
def test_pulses_of_every_second_turn_are_said(every: int, said: bool) -> None:
    values = np.concatenate((MOTION + noise(0.01), 3.0 * MOTION + 0.5 + noise(0.01, 1)))
    pulses = np.arange(0.0, 59.0)[::every]
    run = replace(recording(values, RATE_HZ), photocell_edges_s=pulses)
    assert ("half_frequency" in {flag.code for flag in analyse(run).flags}) == said


@pytest.mark.parametrize("channels", [1, 3])
@pytest.mark.parametrize(("marks", "said"), [(1, False), (2, True), (3, True)])
def test_several_pulses_a_turn_are_said(marks: int, said: bool, channels: int) -> None:
    """One of three channels moves twice a turn: with two marks as one ought to."""
    values = np.stack((3.0 * MOTION + 0.5, MOTION, np.sin(4.0 * np.pi * TIME)))[:channels]
    pulses = np.arange(0.2, 59.0, 1.0 / marks)
    run = recording(values + noise(0.01, 4, channels), RATE_HZ)
    found = [
        flag
        for flag in analyse(replace(run, photocell_edges_s=pulses)).flags
        if flag.code == "double_frequency"
    ]
    assert bool(found) == said
    if found:
        assert found[0].severity is Severity.VOID
        assert f"there are {marks} pulses a turn, and the motion has 1 Hz" in found[0].message


def test_a_channel_that_moves_twice_a_turn_is_no_lost_pulse() -> None:
    """A surge force of a model that sways is alike to either side."""
    twice = np.sin(4.0 * np.pi * TIME)
    values = np.stack((MOTION, twice, twice)) + noise(0.01, 2, 3)
    run = replace(recording(values, RATE_HZ), photocell_edges_s=np.arange(0.0, 59.0))
    assert "half_frequency" not in {flag.code for flag in analyse(run).flags}


@pytest.mark.parametrize("times", [1, 2, 3, 5])
def test_a_channel_that_is_read_more_slowly_is_said_with_its_lag(times: int) -> None:
    values = np.stack((MOTION, np.repeat(MOTION[::times], times)[: MOTION.size])) + 0.0
    run = replace(recording(values, RATE_HZ), photocell_edges_s=np.arange(0.0, 59.0))
    said = [flag for flag in analyse(run).flags if flag.code == "held"]
    assert [flag.channel for flag in said] == (["force_1"] if times > 1 else [])
    assert all(f"late by {500.0 * (times - 1) / RATE_HZ:.3g} ms" in flag.message for flag in said)


def test_a_rate_that_is_no_whole_part_is_seen_too() -> None:
    held = np.floor(np.arange(MOTION.size) / 3.3) * 3.3 / RATE_HZ
    values = np.stack((MOTION, np.sin(2.0 * np.pi * held)))
    run = replace(recording(values, RATE_HZ), photocell_edges_s=np.arange(0.0, 59.0))
    assert [flag.channel for flag in analyse(run).flags if flag.code == "held"] == ["force_1"]


@pytest.mark.parametrize("step", [0.02, 0.1, 0.5])
@pytest.mark.parametrize("size", [0.0, 0.02])
def test_coarse_steps_are_no_slow_sensor(step: float, size: float) -> None:
    values = step * np.round((np.stack((MOTION, 0.3 * MOTION)) + noise(size, 5, 2)) / step)
    run = replace(recording(values, RATE_HZ), photocell_edges_s=np.arange(0.0, 59.0))
    assert "held" not in {flag.code for flag in analyse(run).flags}


def held(values: FloatArray) -> bool:
    run = replace(recording(values, RATE_HZ), photocell_edges_s=np.arange(0.0, 59.0))
    return "held" in {flag.code for flag in analyse(run).flags}


def test_long_rests_are_no_slow_sensor() -> None:
    """A slack wire rests half of the time, and its values last 1.9 samples on average."""
    slack = np.maximum(MOTION, 0.0)
    loud = np.where(slack > 0.0, slack + noise(0.01)[0], 0.0)
    clipped = np.clip(MOTION, -0.8, 0.8)
    for values in (slack, loud, clipped):
        assert not held(values)


@pytest.mark.parametrize("samples_a_step", [1.7, 2.5, 5.0])
def test_a_straight_signal_in_coarse_steps_is_no_slow_sensor(samples_a_step: float) -> None:
    triangle = np.arcsin(MOTION) * RATE_HZ / (2.0 * np.pi)  # one step of 1 in a sample
    assert not held(np.round(triangle / samples_a_step))


def test_a_slow_sensor_in_coarse_steps_is_said() -> None:
    assert held(np.round(20.0 * np.repeat(MOTION[::5], 5)))


@pytest.mark.parametrize("amplitude", np.linspace(1.0, 9.0, 17))
def test_what_coarse_steps_may_do_is_said_and_never_exceeded(amplitude: float) -> None:
    """The error of a sine in whole steps, integrated with 100,000 samples a period."""
    angle = 2.0 * np.pi * (np.arange(100_000) + 0.5) / 100_000
    errors = []
    for offset in np.linspace(0.0, 1.0, 11):
        rounded = np.round(amplitude * np.sin(angle) + offset)
        errors.append(abs(2.0 * np.mean(rounded * np.sin(angle)) - amplitude))
    coarse = np.round(amplitude * MOTION + noise(0.01)[0])
    run = replace(recording(0.1 * coarse, RATE_HZ), photocell_edges_s=np.arange(0.0, 59.0))
    (flag,) = [flag for flag in analyse(run).flags if flag.code == "coarse_steps"]
    assert "steps of 0.1 N" in flag.message
    said = 10.0 * float(flag.message.split("off by ")[1].split(" N")[0])
    assert max(errors) <= said
    assert said < 0.8 / np.sqrt(amplitude)


@pytest.mark.parametrize(("amplitude", "size"), [(13.0, 0.0), (3.0, 0.6), (100.0, 0.0)])
def test_fine_steps_and_dithered_ones_are_not_worth_a_word(amplitude: float, size: float) -> None:
    values = np.round(amplitude * MOTION + noise(size)[0])
    run = replace(recording(values, RATE_HZ), photocell_edges_s=np.arange(0.0, 59.0))
    assert "coarse_steps" not in {flag.code for flag in analyse(run).flags}
