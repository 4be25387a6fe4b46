"""Gain, lag, clock rate and dead band of motions that are exact at exactly warped times."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.comparison import fit
from analysis.comparison.compare import compare
from analysis.comparison.result import ChannelComparison
from analysis.comparison.settings import ComparisonSettings
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError, DataError
from tests.analysis.comparison.motions import (
    Motion,
    Truth,
    harmonic,
    irregular,
    pair,
    recorded,
    uneven,
)

RATE = 3e-4


def truth(order: int = 0) -> Truth:
    return Truth(gain=1.3, lag_s=0.12, rate=RATE, mid_s=29.5, order=order)


def compared(
    motion: Motion,
    what: Truth,
    seed: int = 0,
    settings: ComparisonSettings | None = None,
    *,
    noise: float | tuple[float, float] = 0.01,
) -> ChannelComparison:
    rng = np.random.default_rng(seed)
    first, second = pair(motion, what, rng, noise=noise)
    asked = settings or ComparisonSettings(order=what.order)
    return compare(first, "x", second, "x", asked)


def misses(found: ChannelComparison, what: Truth) -> list[float]:
    """Errors of gain, lag and clock rate in half-widths."""
    lag_s = found.lag_s.value - what.lag_s - what.rate * (found.mid_s - what.mid_s)
    if found.modulo_s is not None:
        lag_s -= found.modulo_s * round(lag_s / found.modulo_s)
    errors = (found.gain.value - what.gain, lag_s, found.clock_rate.value - what.rate)
    halves = (found.gain, found.lag_s, found.clock_rate)
    return [abs(error) / of.half_width() for error, of in zip(errors, halves, strict=True)]


@pytest.mark.parametrize("order", [-2, -1, 0, 1, 2])
def test_without_noise_nothing_is_off(order: int) -> None:
    what = truth(order)
    found = compared(irregular(np.random.default_rng(1)), what, noise=0.0)
    lag_s = what.lag_s + what.rate * (found.mid_s - what.mid_s)
    assert found.gain.value == pytest.approx(what.gain, rel=1e-5)
    assert found.lag_s.value == pytest.approx(lag_s, abs=1e-6)
    assert found.clock_rate.value == pytest.approx(what.rate, abs=1e-7)
    assert found.modulo_s is None


@pytest.mark.slow
@pytest.mark.parametrize("order", [-1, 0, 2])
def test_intervals_hold_in_irregular_motion(order: int) -> None:
    what, missed = truth(order), []
    for seed in range(20):
        motion = irregular(np.random.default_rng(100 + seed))
        missed.append(misses(compared(motion, what, seed), what))
    assert np.mean(np.array(missed) < 1.0) > 0.85
    assert np.max(missed) < 2.5


def test_one_frequency_tells_the_lag_but_for_whole_periods() -> None:
    rng = np.random.default_rng(3)
    motion = harmonic(rng)
    what = replace(truth(), lag_s=7.0)
    found = compared(motion, what, 3)
    assert found.modulo_s == pytest.approx(1.0 / motion.frequencies_hz[0], rel=1e-4)
    assert abs(found.lag_s.value) <= found.modulo_s / 2.0
    assert max(misses(found, what)) < 1.5
    assert [flag.code for flag in found.flags] == ["lag_modulo"]


def test_harmonics_repeat_with_their_fundamental() -> None:
    rng = np.random.default_rng(4)
    motion = harmonic(rng, 0.3, 0.1)
    found = compared(motion, truth(), 4)
    assert found.modulo_s == pytest.approx(1.0 / motion.frequencies_hz[0], rel=1e-4)
    assert max(misses(found, truth())) < 1.5


def test_a_clock_that_is_off_by_a_hundredth_is_followed() -> None:
    what = replace(truth(), rate=0.008)
    found = compared(irregular(np.random.default_rng(5)), what, 5)
    assert max(misses(found, what)) < 1.5
    assert found.lag_at(found.to_s).value - found.lag_at(found.from_s).value > 0.4


def test_a_turned_sensor_has_a_negative_gain() -> None:
    what = replace(truth(), gain=-0.7)
    found = compared(irregular(np.random.default_rng(6)), what, 6)
    assert max(misses(found, what)) < 1.5


@pytest.mark.parametrize("width", [0.05, 0.3])
@pytest.mark.parametrize("irregularly", [False, True])
def test_a_dead_band_is_found_and_not_taken_for_a_lag(width: float, irregularly: bool) -> None:
    rng = np.random.default_rng(7)
    motion = irregular(rng) if irregularly else harmonic(rng)
    fine_s = np.arange(-2.0, 62.0, 1e-3)
    leader = motion.at(fine_s)
    scale = leader.std()
    follower, at = [], float(leader[0] / scale)
    for value in (leader / scale).tolist():  # the definition, sample by sample
        at = max(min(at, value + width / 2.0), value - width / 2.0)
        follower.append(at)
    first_s, second_s = np.arange(0.0, 60.0, 0.01), np.arange(0.0, 60.0, 0.005)
    shown = 1.2 * np.interp(second_s - 0.05, fine_s, follower)
    first = motion.at(first_s) / scale + 0.002 * rng.standard_normal(first_s.size)
    second = shown + 0.002 * rng.standard_normal(second_s.size)
    found = compare(
        recorded("demand", first, 100.0, 0.0, "m"),
        "x",
        recorded("axis", second, 200.0, 0.0, "m"),
        "x",
    )
    assert found.dead_band_found
    assert found.dead_band is not None
    assert abs(found.dead_band.value - width) < found.dead_band.half_width()
    lag_s = found.lag_s.value - 0.05
    assert abs(lag_s) < 5e-4
    assert found.gain.value == pytest.approx(1.2, rel=2e-3)


@pytest.mark.slow
def test_without_a_dead_band_none_is_found() -> None:
    for seed in range(10):
        motion = irregular(np.random.default_rng(200 + seed))
        assert not compared(motion, truth(), seed, noise=0.05).dead_band_found


@pytest.mark.slow
@pytest.mark.parametrize("noise", [(0.5, 0.0), (1.0, 0.0), (0.0, 1.0), (0.7, 0.7)])
def test_strong_noise_is_no_dead_band_and_leaves_the_intervals_right(
    noise: tuple[float, float],
) -> None:
    missed = []
    for seed in range(6):
        rng = np.random.default_rng(300 + seed)
        motion = irregular(rng) if seed % 2 else harmonic(rng, 0.2, 0.05)
        found = compared(motion, truth(), seed, noise=noise)
        assert not found.dead_band_found
        assert found.dead_band is not None
        assert found.dead_band.value <= found.dead_band.half_width()
        missed.append(misses(found, truth()))
    assert np.median(missed) < 0.7
    assert np.max(missed) < 2.0


def test_a_wide_dead_band_of_a_wide_spectrum_is_found_whatever_leads_to_it() -> None:
    rng = np.random.default_rng(5)
    frequencies_hz = rng.uniform(0.1, 3.0, 80)
    sizes = rng.rayleigh(size=80) / (1.0 + (frequencies_hz / 0.5) ** 2)
    motion = Motion(frequencies_hz, sizes, rng.uniform(0.0, 2.0 * np.pi, 80))
    fine_s, time_s = np.arange(-2.0, 62.0, 1e-3), np.arange(0.0, 60.0, 0.01)
    leader = motion.at(fine_s)
    width = 0.3 * float(leader.std())
    follower, at = [], float(leader[0])
    for value in leader.tolist():
        at = max(min(at, value + width / 2.0), value - width / 2.0)
        follower.append(at)
    first = motion.at(time_s) + 0.02 * leader.std() * rng.standard_normal(time_s.size)
    second = np.interp(time_s - 0.25, fine_s, follower)
    records = [recorded("a", one, 100.0, 0.0, "m") for one in (first, second)]
    found = compare(records[0], "x", records[1], "x")
    assert found.dead_band_found
    assert found.dead_band is not None
    assert abs(found.dead_band.value - width) < found.dead_band.half_width() < 0.5 * width
    assert abs(found.lag_s.value - 0.25) < 1.5 * found.lag_s.half_width()


def test_a_lever_is_found() -> None:
    rng = np.random.default_rng(8)
    heave, pitch = irregular(rng), irregular(rng, 0.9)
    first_s, second_s = np.arange(6000) / 100.0, np.arange(6000) / 100.0
    what = replace(truth(), gain=1.0)
    on_first = what.on_first(second_s)
    rows = np.array([heave.at(first_s), pitch.at(first_s)])
    rows += 1e-3 * rng.standard_normal(rows.shape)
    camera = Recording("camera", (Channel("z", "m"), Channel("pitch", "rad")), rows, 100.0)
    bow = heave.at(on_first) - 0.65 * pitch.at(on_first)
    wire = recorded("wire", bow + 1e-3 * rng.standard_normal(bow.size), 100.0, 0.0, "m")
    found = compare(camera, "z", wire, "x", ComparisonSettings(levers=("pitch",)))
    arm = found.levers["pitch"]
    assert abs(arm.value + 0.65) < 1.5 * arm.half_width() < 0.01
    assert arm.unit == "m per rad"
    assert max(misses(found, what)) < 1.5


def test_a_lag_that_jumps_is_said_and_widens() -> None:
    rng = np.random.default_rng(9)
    motion = irregular(rng)
    time_s = np.arange(6000) / 100.0
    late = np.where(time_s < 30.0, 0.1, 0.14)
    values = motion.at(time_s - late) + 0.02 * rng.standard_normal(time_s.size)
    steady = compared(motion, replace(truth(), rate=0.0), 9)
    found = compare(
        recorded("a", motion.at(time_s), 100.0, 0.0, "m"),
        "x",
        recorded("b", values, 100.0, 0.0, "m"),
        "x",
    )
    assert "lag_unsteady" in {flag.code for flag in found.flags}
    assert found.lag_s.half_width() > 5.0 * steady.lag_s.half_width()


def test_the_wrong_derivative_is_said() -> None:
    found = compared(irregular(np.random.default_rng(10)), truth(2), settings=ComparisonSettings())
    (flag,) = (flag for flag in found.flags if flag.code == "explained_in_part")
    assert "as derivative +2" in flag.message


def test_channels_that_have_nothing_in_common_are_refused() -> None:
    rng = np.random.default_rng(11)
    first, _ = pair(irregular(rng), truth(), rng)
    _, second = pair(irregular(rng), truth(), rng)
    with pytest.raises(DataError, match="does not follow"):
        compare(first, "x", second, "x")
    with pytest.raises(DataError, match="after its end"):
        compare(first, "x", replace(second, start_s=500.0), "x")
    still = recorded("still", np.ones(1000), 100.0, 0.0, "m")
    with pytest.raises(DataError, match="does not move"):
        compare(first, "x", still, "x")


def test_missing_samples_leave_the_longest_stretch() -> None:
    rng = np.random.default_rng(12)
    first, second = pair(irregular(rng), truth(), rng)
    values = second.values("x").copy()
    values[1000:1010] = np.nan
    found = compare(first, "x", replace(second, samples=values[None, :]), "x")
    assert max(misses(found, truth())) < 1.5
    assert "longest_stretch" in {flag.code for flag in found.flags}
    assert found.from_s > 3.6


@pytest.mark.slow
@pytest.mark.parametrize("order", [0, 1])
def test_uneven_stamps_leave_the_intervals_right(order: int) -> None:
    what, missed = truth(order), []
    for seed in range(12):
        rng = np.random.default_rng(400 + seed)
        motion = irregular(rng) if seed % 2 else harmonic(rng, 0.2)
        first, second = uneven(motion, what, rng)
        found = compare(first, "x", second, "x", ComparisonSettings(order=order))
        missed.append(misses(found, what))
    assert np.mean(np.array(missed) < 1.0) > 0.85
    assert np.max(missed) < 2.5


def test_uneven_stamps_without_noise_are_off_by_nothing() -> None:
    rng = np.random.default_rng(1)
    first, second = uneven(irregular(rng), truth(), rng, noise=0.0)
    found = compare(first, "x", second, "x")
    assert found.gain.value == pytest.approx(1.3, rel=1e-5)
    assert found.lag_s.value == pytest.approx(0.12 + RATE * (found.mid_s - 29.5), abs=2e-6)
    assert found.to_s - found.from_s > 50.0


def test_where_uneven_stamps_are_missing_for_long_the_longest_stretch_is_left() -> None:
    rng = np.random.default_rng(2)
    first, second = uneven(irregular(rng), truth(), rng)
    assert second.stamps_s is not None
    kept = np.abs(second.stamps_s - 15.0) > 2.0
    stamps_s, values = second.stamps_s[kept], second.values("x")[kept]
    found = compare(first, "x", replace(second, samples=values[None], stamps_s=stamps_s), "x")
    assert max(misses(found, truth())) < 1.5
    assert "longest_stretch" in {flag.code for flag in found.flags}
    assert found.from_s > 16.9


@pytest.mark.parametrize(
    "settings",
    [
        ComparisonSettings(order=4),
        ComparisonSettings(order=-1, levers=("x",)),
        ComparisonSettings(band_hz=(2.0, 1.0)),
        ComparisonSettings(most_lag_s=0.0),
        ComparisonSettings(from_s=2.0, to_s=1.0),
    ],
)
def test_settings_that_cannot_be_are_refused(settings: ComparisonSettings) -> None:
    with pytest.raises(ConfigurationError):
        compared(irregular(np.random.default_rng(13)), truth(), settings=settings)


def test_a_dead_band_that_is_not_there_is_looked_for_in_few_steps(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    tried = []
    linearised = fit.linearised
    monkeypatch.setattr(
        fit, "linearised", lambda *given: (tried.append(given[1].half), linearised(*given))[1]
    )
    found = compared(irregular(np.random.default_rng(13)), truth(), 13)
    assert found.dead_band is not None
    assert 2 <= sum(half is not None for half in tried) <= 20  # of two fits: no better after ten


@pytest.mark.parametrize("lag_s", [0.6, 1.0, 3.0, -1.4])
@pytest.mark.parametrize("noise_m", [1e-5, 1e-3])
def test_a_start_and_a_stop_tell_the_lag_itself(lag_s: float, noise_m: float) -> None:
    """A sine with ramps at both ends, 12 s to 48 s: the lag put in, and no period beside it."""
    rng = np.random.default_rng(5)
    time_s = np.arange(0.0, 60.0, 0.01)

    def motion_m(at_s: FloatArray) -> FloatArray:
        share = np.clip((at_s - 12.0) / 2.0, 0.0, 1.0) * np.clip((48.0 - at_s) / 2.0, 0.0, 1.0)
        return np.asarray(0.02 * share * np.sin(2.0 * np.pi * 0.8 * at_s))

    first, second = (
        recorded(name, values + noise_m * rng.standard_normal(time_s.size), 100.0, 0.0, "m")
        for name, values in (("a", motion_m(time_s)), ("b", 1.05 * motion_m(time_s - lag_s)))
    )
    found = compare(first, "x", second, "x")
    assert found.modulo_s is None
    assert abs(found.lag_s.value - lag_s) < 2.0 * found.lag_s.half_width() < 4e-3
    assert abs(found.gain.value - 1.05) < 2.0 * found.gain.half_width()
