"""What a run was told to do against what it did; a given frequency against the motion's own."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.channels import Channel
from hardware.description.flags import Flag
from hardware.description.setpoint import SetPoint

TIME_S = np.arange(4000) / 100.0
QUARTER = np.pi / 2.0  # the fore strut's cosine, ahead of the aft one's sine
NAMES = ("displacement_aft", "displacement_fore", "force_aft")


def run(set_point: SetPoint | None, frequency_hz: float = 0.83) -> Recording:
    theta = 2.0 * np.pi * frequency_hz * TIME_S
    values = np.stack((0.02 * np.sin(theta), 0.02 * np.cos(theta), 7.0 * np.sin(theta + 0.3)))
    channels = tuple(Channel(name, unit) for name, unit in zip(NAMES, "mmN", strict=True))
    return Recording("run", channels, values, 100.0, set_point=set_point)


def found(recording: Recording, code: str, **choice: float) -> list[Flag]:
    flags = analyse(recording, ReferenceChoice(**choice)).flags  # type: ignore[arg-type]
    return [flag for flag in flags if flag.code == code]


def test_a_run_that_did_what_it_was_told_is_not_flagged() -> None:
    assert not found(run(SetPoint(0.83, 0.02, QUARTER)), "set_point_differs")
    assert not found(run(SetPoint(0.825, 0.0205, QUARTER)), "set_point_differs")
    assert not found(run(None), "set_point_differs")


def test_another_frequency_is_named_with_both_values() -> None:
    (flag,) = found(run(SetPoint(0.8, 0.02, QUARTER)), "set_point_differs")
    assert "frequency is 0.8 Hz, found are 0.83 Hz, +3.8 % (limit 1 %)" in flag.message
    assert (flag.severity, flag.channel) == ("warning", None)


def test_another_eccentricity_is_named_for_each_strut_reference_or_not() -> None:
    flags = found(run(SetPoint(0.83, 0.03, QUARTER)), "set_point_differs")
    assert [flag.channel for flag in flags] == ["displacement_aft", "displacement_fore"]
    assert all("is 30 mm, found are 20 mm, -33.3 % (limit 5 %)" in flag.message for flag in flags)


@pytest.mark.parametrize("told_rad", [0.0, -QUARTER, np.pi, QUARTER + 0.06])
def test_another_strut_phase_is_named(told_rad: float) -> None:
    (flag,) = found(run(SetPoint(0.83, 0.02, told_rad)), "set_point_differs")
    told, seen = flag.message.split("phase is ")[1].split(" deg, found are ")
    assert float(told) == pytest.approx(np.degrees(told_rad), abs=0.1)
    off = float(seen.split(" deg")[0]) - 90.0
    assert (off + 180.0) % 360.0 - 180.0 == pytest.approx(0.0, abs=0.1)


def test_a_strut_phase_as_set_is_not_flagged_whatever_full_turns() -> None:
    for told_rad in (QUARTER - 0.04, QUARTER + 2.0 * np.pi, QUARTER - 2.0 * np.pi):
        assert not found(run(SetPoint(0.83, 0.02, told_rad)), "set_point_differs")


def test_a_displacement_of_unknown_unit_is_not_compared() -> None:
    recording = run(SetPoint(0.83, 0.03, QUARTER))
    plain = tuple(Channel(name) for name in NAMES)
    assert not found(replace(recording, channels=plain), "set_point_differs")


def test_a_displacement_that_is_not_resolved_is_compared_all_the_same() -> None:
    chosen = ResolverSettings(channels=("force_aft",))
    flags = analyse(run(SetPoint(0.83, 0.03, QUARTER)), settings=chosen).flags
    assert sum(flag.code == "set_point_differs" for flag in flags) == 2


def test_a_frequency_that_does_not_fit_is_named_with_the_one_that_does() -> None:
    (flag,) = found(run(None), "frequency_differs", frequency_hz=0.8)
    assert "against the given 0.8 Hz: 0.83" in flag.message
    assert not found(run(None), "frequency_differs", frequency_hz=0.83)
    assert not found(run(None), "frequency_differs")


@pytest.mark.parametrize(("set_hz", "said"), [(0.8, True), (0.83, False)])
def test_a_set_point_that_tells_the_phase_is_held_against_the_motion(
    set_hz: float, said: bool
) -> None:
    force = np.sin(2.0 * np.pi * 0.83 * np.arange(4000) / 100.0)
    recording = Recording("run", (Channel("force", "N"),), force[None], 100.0)
    flags = found(replace(recording, set_point=SetPoint(set_hz, 0.02, 0.0)), "frequency_differs")
    assert bool(flags) == said
    if said:
        fits_hz = flags[0].message.split("against the set-point's 0.8 Hz: ")[1].split(" Hz")[0]
        assert float(fits_hz) == pytest.approx(0.83, rel=1e-4)


@given(st.floats(0.7, 1.3), st.floats(0.9, 1.1))
def test_any_frequency_near_by_is_found(frequency_hz: float, ratio: float) -> None:
    given_hz = frequency_hz * ratio
    turned = abs(frequency_hz - given_hz) * 40.0
    flags = found(run(None, frequency_hz), "frequency_differs", frequency_hz=given_hz)
    if turned > 0.2:
        told = float(flags[0].message.split("Hz: ")[1].split(" Hz")[0])
        assert told == pytest.approx(frequency_hz, rel=3e-3)
    elif turned < 0.04:
        assert not flags


def test_noise_does_not_turn() -> None:
    noise = np.random.default_rng(3).normal(size=(1, 4000))
    recording = Recording("run", (Channel("force", "N"),), noise, 100.0)
    assert not found(recording, "frequency_differs", frequency_hz=0.8)
