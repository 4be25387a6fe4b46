"""A channel that is unsteady leaves the others their window; late waves have a late gate."""

import numpy as np
import pytest

from analysis.recording import Recording
from analysis.resolver.analysis import Analysis, analyse
from analysis.resolver.reference import PhaseReference, ReferenceSource
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from analysis.resolver.windows import analyse_windows
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError

RATE_HZ, OMEGA = 50.0, 2.0 * np.pi * 0.8
BY_STROKE = ReferenceChoice(channel="stroke")
TIME_S = np.arange(int(60.0 * RATE_HZ)) / RATE_HZ


def recorded(**channels: np.ndarray) -> Recording:
    rng = np.random.default_rng(6)
    rows = np.array(list(channels.values()))
    rows += 1e-3 * rng.standard_normal(rows.shape)
    units = [Channel(name, "m" if name == "stroke" else "N") for name in channels]
    return Recording("run", tuple(units), rows, RATE_HZ)


def windows(found: tuple[Analysis, ...]) -> dict[tuple[str, ...], tuple[float, float]]:
    return {
        one.recording.channel_names: (one.readings[0].opened_s, one.readings[-1].closed_s)
        for one in found
    }


def test_a_step_of_one_channel_costs_the_others_nothing() -> None:
    size = np.where(TIME_S < 30.0, 2.0, 3.0)
    record = recorded(
        stroke=np.sin(OMEGA * TIME_S),
        F1=5.0 * np.sin(OMEGA * TIME_S + 0.4),
        F2=size * np.sin(OMEGA * TIME_S - 0.7),
        F3=4.0 * np.cos(OMEGA * TIME_S),
    )
    joint = analyse(record, BY_STROKE)
    assert joint.readings[0].periods < 25
    found = analyse_windows(record, BY_STROKE)
    told = windows(found)
    assert list(told) == [("F1", "F3"), ("F2",)]
    assert np.ptp(told["F1", "F3"]) > 55.0
    assert told["F2",][1] < 30.0 + 1.3 or told["F2",][0] > 30.0 - 1.3
    own = [flag for flag in found[1].flags if flag.code == "own_window"]
    assert len(own) == 1
    assert f"all channels together are steady for {joint.readings[0].periods}" in own[0].message


def test_a_little_less_at_an_end_is_shared() -> None:
    size = np.where(TIME_S < 55.0, 2.0, 3.0)
    record = recorded(
        stroke=np.sin(OMEGA * TIME_S),
        F1=5.0 * np.sin(OMEGA * TIME_S),
        F2=size * np.sin(OMEGA * TIME_S),
    )
    assert [one.recording.channel_names for one in analyse_windows(record, BY_STROKE)] == [
        ("F1", "F2")
    ]


def waves(late_s: float) -> Recording:
    """A wave maker that runs from 5 to 37 s; the waves reach a model later, and fade behind."""

    def maker(time_s: np.ndarray) -> np.ndarray:
        inside = np.clip((time_s - 5.0) / 2.0, 0.0, 1.0) * np.clip((37.0 - time_s) / 4.0, 0.0, 1.0)
        return np.asarray(inside * np.sin(OMEGA * time_s))

    return recorded(
        stroke=maker(TIME_S), near=3.0 * maker(TIME_S), far=4.0 * maker(TIME_S - late_s)
    )


def test_a_delayed_gate_has_the_waves_of_the_reference_s_window() -> None:
    late_s = 11.3
    settings = ResolverSettings(opens_s=9.0, periods=18)  # to 31.5 s: before the ramp-down
    found = analyse_windows(waves(late_s), BY_STROKE, settings, {"far": late_s})
    told = windows(found)
    assert told["near",] == pytest.approx((9.0, 31.5), abs=0.01)
    assert told["far",] == pytest.approx((9.0 + late_s, 31.5 + late_s), abs=0.01)
    for one, size in zip(found, (3.0, 4.0), strict=True):
        assert one.readings[0].amplitude[0, 0] == pytest.approx(size, rel=1e-3)
        assert "reference_unsteady" not in [flag.code for flag in one.flags]
    # The phase is that of the reference carried on: waves so late lag by omega times the delay.
    phase = found[1].readings[0].phase_rad[0, 0]
    assert np.exp(1j * phase) == pytest.approx(np.exp(-1j * OMEGA * late_s), abs=0.002)


def test_a_delayed_gate_is_warned_of_the_ramp_that_its_waves_come_from() -> None:
    settings = ResolverSettings(opens_s=9.0, periods=20)  # to 34 s: into the ramp
    found = analyse_windows(waves(11.3), BY_STROKE, settings, {"far": 11.3})
    assert all("reference_unsteady" in [flag.code for flag in one.flags] for one in found)
    alone = ResolverSettings(channels=("far",), opens_s=20.0, periods=10)
    late = analyse_windows(waves(11.3), BY_STROKE, alone, {"far": 11.3})
    assert "reference_unsteady" not in [flag.code for flag in late[0].flags]


def test_a_delay_of_nothing_resolved_is_refused() -> None:
    with pytest.raises(ConfigurationError, match=r"delay of 'wind'.*resolved are near, far"):
        analyse_windows(waves(1.0), BY_STROKE, delays_s={"wind": 3.0})


def test_a_delayed_phase_is_carried_on_without_the_ramps_of_its_reference() -> None:
    """Three knots at either end are off by 1.4 degrees, as where an amplitude changes."""
    cycles = np.arange(41.0)
    off = 0.004 * (np.minimum(cycles, 3.0) - 3.0 + np.maximum(cycles, 37.0) - 37.0)
    told = PhaseReference(ReferenceSource.SIGNAL, (cycles - off) / 0.8, cycles)
    late = told.delayed(11.3)
    assert late.cycles - cycles == pytest.approx(0.8 * 11.3, abs=1e-6)
