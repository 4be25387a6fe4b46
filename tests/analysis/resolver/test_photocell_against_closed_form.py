"""Photocell pulses of a shaft whose angle is known: missed, too many, late, at changing speed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.resolver.estimate import resolve
from analysis.resolver.photocell import from_photocell
from analysis.resolver.reference import PhaseReference, ReferenceSource
from analysis.resolver.sums import period_sums
from hardware.description.errors import DataError
from tests.analysis.resolver.signals import recording

PULSES = np.arange(12.0) + 0.37
VIBRATION = 1e-3 * np.sin(np.arange(12.0) * 2.3)  # of the speed, from revolution to revolution


def codes(reference: PhaseReference) -> set[str]:
    return {flag.code for flag in reference.flags}


def test_phase_is_straight_within_each_revolution() -> None:
    edges = PULSES + VIBRATION
    reference = from_photocell(edges)
    middle = (edges[1:] + edges[:-1]) / 2.0
    assert reference.cycles_at(middle) == pytest.approx(np.arange(11.0) + 0.5, abs=1e-12)
    assert reference.times_at(np.arange(12.0)) == pytest.approx(edges, abs=1e-12)
    assert not reference.flags


def test_phase_goes_on_beyond_the_first_and_the_last_pulse() -> None:
    reference = from_photocell(PULSES)
    assert reference.cycles_at(np.array([0.07, 11.87])) == pytest.approx([-0.3, 11.5], abs=1e-12)


@pytest.mark.parametrize("harmonic", [1, 2, 3])
def test_latency_turns_harmonic_n_by_n_times_its_angle(harmonic: int) -> None:
    """1 ms at 1 Hz is 0.36 degrees, and 0.63 % of the in-phase part in the quadrature."""
    time = np.arange(1200) / 100.0
    run = recording(np.sin(2.0 * np.pi * harmonic * (time - 0.37)))
    late = PULSES[:11] + 1e-3
    turned = resolve(run, period_sums(run, from_photocell(late))).phase_rad[0, harmonic - 1]
    assert np.degrees(turned) == pytest.approx(0.36 * harmonic, rel=1e-9)
    calibrated = resolve(run, period_sums(run, from_photocell(late, latency_s=1e-3)))
    assert abs(calibrated.phase_rad[0, harmonic - 1]) < 1e-12
    quadrature = resolve(run, period_sums(run, from_photocell(late))).quadrature
    assert quadrature[0, harmonic - 1] == pytest.approx(6.3e-3 * harmonic, rel=0.01)


@pytest.mark.parametrize("harmonic", [1, 2, 3])
def test_angle_offset_is_the_shaft_angle_at_the_mark(harmonic: int) -> None:
    offset_rad = 0.4
    time = np.arange(1200) / 100.0
    theta = 2.0 * np.pi * (time - 0.37) + offset_rad
    run = recording(np.sin(harmonic * theta + 0.2))
    reference = from_photocell(PULSES[:11], angle_offset_rad=offset_rad)
    result = resolve(run, period_sums(run, reference))
    assert result.phase_rad[0, harmonic - 1] == pytest.approx(0.2, abs=1e-12)


@pytest.mark.parametrize("missed", [[4], [3, 7], [4, 5, 6], [1], [10], [2, 3, 8, 9]])
def test_missed_pulses_are_bridged_and_flagged(missed: list[int]) -> None:
    reference = from_photocell(np.delete(PULSES, missed))
    assert reference.cycles_at(PULSES) == pytest.approx(np.arange(12.0), abs=1e-12)
    assert codes(reference) == {"missed_pulse"}
    assert f"{len(missed)} photocell pulses missed" in reference.flags[0].message


@pytest.mark.parametrize("missed", [[0], [11], [0, 11], [0, 1]])
def test_missed_pulses_at_the_ends_only_shorten_the_reference(missed: list[int]) -> None:
    reference = from_photocell(np.delete(PULSES, missed))
    first = missed.count(0) + missed.count(1)
    assert reference.cycles_at(PULSES) == pytest.approx(np.arange(12.0) - first, abs=1e-12)
    assert not reference.flags


@pytest.mark.parametrize("apart", [0.01, 0.1, 0.2, 0.3, 0.33, 0.36, 0.4, 0.45, 0.6, 0.9])
@pytest.mark.parametrize("opens_on", [0, 1])
def test_of_two_marks_one_tells_the_phase(apart: float, opens_on: int) -> None:
    """The nearer of the two that follow a mark is the second of its pair."""
    first, second = PULSES, PULSES + apart
    edges = np.sort(np.concatenate((first, second)))[opens_on:]
    reference = from_photocell(edges)
    told = reference.cycles_at(first if apart < 0.5 else second)
    assert np.ptp(told - np.arange(12.0)) < 1e-12
    assert told[0] == pytest.approx(np.rint(told[0]), abs=1e-12)
    assert codes(reference) == {"paired_pulses"}
    degrees = 360.0 * min(apart, 1.0 - apart)
    assert f"{degrees:.3g} degrees of the shaft apart" in reference.flags[0].message


def test_pulses_that_are_lost_in_turn_are_no_pairs() -> None:
    turns = np.array([1.0, 4.0, 1.0, 3.0, 1.0, 4.0, 1.0])  # as a mark shorter than a sample
    edges = np.concatenate(([0.0], np.cumsum(turns)))
    reference = from_photocell(edges)
    assert reference.cycles_at(edges) == pytest.approx(edges, abs=1e-12)
    assert codes(reference) == {"missed_pulse"}


def test_pulses_lost_of_pairs_do_not_shift_the_others() -> None:
    """Alone, the second of a pair is out of time, and the first passes for a second one."""
    edges = np.sort(np.concatenate((np.arange(40.0), np.arange(40.0) + 0.3)))
    reference = from_photocell(np.delete(edges, [24, 51]))  # a first one, and a second one
    assert reference.cycles_at(np.arange(40.0)) == pytest.approx(np.arange(40.0), abs=1e-12)
    assert codes(reference) == {"paired_pulses", "missed_pulse", "extra_pulse"}


@given(st.integers(0, 10), st.floats(0.005, 0.995))
def test_an_extra_pulse_is_dropped_and_no_other(revolution: int, fraction: float) -> None:
    extra = PULSES[revolution] + fraction
    reference = from_photocell(np.sort(np.append(PULSES, extra)))
    assert reference.times_s == pytest.approx(PULSES, abs=1e-12)
    assert codes(reference) == {"extra_pulse"}
    assert f"{extra:.3f} s" in reference.flags[0].message


@pytest.mark.parametrize("before_first", [True, False])
@pytest.mark.parametrize("distance", [0.01, 0.1, 0.3, 0.6])
def test_an_extra_pulse_outside_the_first_or_last_is_dropped(
    before_first: bool, distance: float
) -> None:
    extra = PULSES[0] - distance if before_first else PULSES[-1] + distance
    reference = from_photocell(np.sort(np.append(PULSES, extra)))
    assert reference.times_s == pytest.approx(PULSES, abs=1e-12)


@pytest.mark.parametrize("extras", [(5.05, 5.3), (5.3, 5.7), (2.02, 8.9), (2.1, 6.9, 9.5)])
def test_several_extra_pulses_are_dropped(extras: tuple[float, ...]) -> None:
    edges = np.sort(np.concatenate((PULSES, 0.37 + np.array(extras))))
    reference = from_photocell(edges)
    assert reference.times_s == pytest.approx(PULSES, abs=1e-12)


@given(st.sampled_from([2, 3, 8, 9]), st.floats(0.03, 0.97))
def test_extra_and_missed_pulses_in_one_run(missed: int, fraction: float) -> None:
    edges = np.delete(PULSES, missed)
    reference = from_photocell(np.sort(np.append(edges, PULSES[5] + fraction)))
    assert reference.cycles_at(PULSES) == pytest.approx(np.arange(12.0), abs=1e-12)
    assert codes(reference) == {"missed_pulse", "extra_pulse"}


@pytest.mark.parametrize("fraction", [0.04, 0.2, 0.3, 0.7, 0.8, 0.96])
def test_a_pulse_missed_and_another_too_many_beside_it(fraction: float) -> None:
    """A stray pulse within a gap; half-way in a revolution it could be either, so not there."""
    edges = np.append(np.delete(PULSES, 6), PULSES[4] + fraction)
    reference = from_photocell(np.sort(edges))
    assert reference.cycles_at(PULSES) == pytest.approx(np.arange(12.0), abs=1e-12)


def test_a_run_that_changes_speed_little_by_little_loses_no_pulse() -> None:
    """From 1 to 3 Hz over 60 revolutions: no interval is odd among its neighbours."""
    cycles = np.arange(60.0)
    edges = np.cumsum(1.0 / np.linspace(1.0, 3.0, 60))
    reference = from_photocell(edges)
    assert reference.cycles_at(edges) == pytest.approx(cycles, abs=1e-12)
    assert not reference.flags


def test_speed_change_is_followed_per_revolution() -> None:
    """1 % over ten periods: 6e-8 of the amplitude, where one line through all edges loses 3e-4."""
    count, change = 10, 0.01
    slope = change / count  # of the frequency, per second at about 1 Hz
    edges = (np.sqrt(1.0 + 2.0 * slope * np.arange(count + 1.0)) - 1.0) / slope
    time = np.arange(1050) / 100.0
    run = recording(np.sin(2.0 * np.pi * (time + slope * time**2 / 2.0)))
    per_revolution = resolve(run, period_sums(run, from_photocell(edges)), take_out_drift=False)
    assert abs(per_revolution.amplitude[0, 0] - 1.0) < 1e-7
    ends = PhaseReference(ReferenceSource.PHOTOCELL, edges[[0, -1]], np.array([0.0, float(count)]))
    straight = resolve(run, period_sums(run, ends), take_out_drift=False)
    assert straight.amplitude[0, 0] - 1.0 == pytest.approx(-2.8e-4, rel=0.1)


@pytest.mark.parametrize("edges", [[], [1.0]])
def test_fewer_than_two_pulses_are_no_reference(edges: list[float]) -> None:
    with pytest.raises(DataError, match=rf"^{len(edges)} photocell pulses"):
        from_photocell(np.array(edges))


@pytest.mark.parametrize(
    ("edges", "message"),
    [
        ([0.0, 2.0, 1.0, 3.0], r"pulse 2 at 1\.000000 s does not come after"),
        ([0.0, 1.0, 1.0, 2.0], r"pulse 2 at 1\.000000 s does not come after"),
        ([0.0, 1.0, np.nan, 2.0], "photocell pulse 2"),
    ],
)
def test_edges_in_disorder_are_refused(edges: list[float], message: str) -> None:
    with pytest.raises(DataError, match=message):
        from_photocell(np.array(edges))


def test_many_pulses_take_no_time() -> None:
    """Work grows with the pulses, not with their square: an hour at 10 Hz, with pulses odd."""
    edges = np.delete(np.arange(36_000.0), [100, 30_000])
    reference = from_photocell(np.sort(np.append(edges, [77.3, 20_000.9])))
    assert len(reference.times_s) == 35_998
