"""Records in: series, gates, stopwatch, and everything that can be wrong with them."""

import math
from pathlib import Path

import numpy as np
import pytest

from analysis.inertia.amplitude import fit_power_decay
from analysis.inertia.checks import (
    check_amplitude_effect,
    check_record,
    check_sway_axis,
    check_yaw_axis,
    strongest_axis,
)
from analysis.inertia.gates import GateEvents, gate_events, passages, read_gate_events
from analysis.inertia.lengthening import pendulum_lengthening
from analysis.inertia.local_periods import LocalPeriods
from analysis.inertia.passage_fit import fit_passages
from analysis.inertia.record import analyse_record
from analysis.inertia.repeats import KnownScatter, combine_runs
from analysis.inertia.series import Series, rough_period, series_from_recording, usable_part
from analysis.inertia.stopwatch import StopwatchReading, stopwatch_period
from analysis.recording import Recording
from analysis.uncertainty.estimate import Estimate
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from tests.analysis.inertia.records import FloatArray, damped


def record(values: FloatArray, rate: float = 20.0, unit: str = "rad") -> Series:
    return Series("swing", "angle", unit, rate, 0.0, values)


def noisy(t: FloatArray, period: float, decay: float, size: float) -> FloatArray:
    return damped(t, period, decay, size) + 1e-3 * size * np.random.default_rng(1).standard_normal(
        t.size
    )


T = np.arange(0.0, 120.0, 0.05)


def test_a_channel_of_a_recording() -> None:
    values = np.stack([noisy(T, 3.0, 0.01, 0.05), 7.0 * np.ones(T.size)])
    channels = (Channel("roll", "rad"), Channel("load", "N"))
    recording = Recording("run", channels, values, 20.0, start_s=5.0)
    series = series_from_recording(recording, "roll")
    assert series.time_s[0] == 5.0
    assert check_record(usable_part(series)) == ()
    with pytest.raises(DataError, match=r"load.*is in N"):
        series_from_recording(recording, "load")
    with pytest.raises(DataError, match="no channel 'rol'"):
        series_from_recording(recording, "rol")
    lost = Recording("run", channels, np.full((2, 10), np.nan), 20.0)
    with pytest.raises(DataError, match="no finite sample"):
        series_from_recording(lost, "roll")


def test_the_end_is_where_it_dies_out() -> None:
    part = usable_part(record(noisy(T, 2.0, 0.1, 0.05)))
    assert part.series.time_s[-1] == pytest.approx(math.log(1.0 / 0.03) / 0.1, rel=0.1)
    assert part.last_amplitude < 0.05 * part.first_amplitude
    assert "falls below the limit" in part.reason


def test_gaps_are_flagged_by_their_length() -> None:
    values = noisy(T, 3.0, 0.01, 0.05)
    values[500:505] = np.nan
    assert [flag.severity for flag in usable_part(record(values)).series.flags] == ["note"]
    values[900:960] = np.nan
    flags = usable_part(record(values)).series.flags
    assert [flag.code for flag in flags] == ["gaps"]
    assert flags[0].severity == "warning"


def test_too_few_swings() -> None:
    few = record(noisy(T[:100], 2.5, 0.0, 0.05))
    with pytest.raises(DataError, match="too few swings"):
        check_record(usable_part(few))
    some = record(noisy(T[:400], 3.0, 0.0, 0.05))
    assert [flag.code for flag in check_record(usable_part(some))] == ["few_swings"]


def test_swings_too_few_to_follow_the_amplitude_are_counted_out() -> None:
    with pytest.raises(DataError, match=r"swing, angle: too few swings: 4\.\d+ of 3 s .* least 6"):
        analyse_record(record(noisy(T[:260], 3.0, 0.0, 0.05)))


@pytest.mark.parametrize("seed", range(5))
def test_noise_beside_a_fast_decay_is_no_aliasing(seed: int) -> None:
    """The broad line of five swings stands little above noise of a fiftieth."""
    time_s = np.arange(0.0, 60.0, 0.02)
    swing = np.exp(-0.25 * time_s) * np.sin(2.0 * math.pi * time_s)
    noise = 0.02 * np.random.default_rng(seed).standard_normal(time_s.size)
    assert rough_period("a decay", swing + noise, 50.0) == pytest.approx(1.0, rel=0.05)


def test_aliasing() -> None:
    slow = np.arange(0.0, 300.0, 0.8)
    with pytest.raises(DataError, match="aliasing"):
        check_record(usable_part(record(noisy(slow, 2.846, 0.001, 0.05), 1.25)))


def test_degrees_given_as_radians() -> None:
    with pytest.raises(DataError, match="degrees given as radians"):
        check_record(usable_part(record(noisy(T, 3.0, 0.01, 4.3))))


def test_small_degrees_betray_themselves_by_their_period() -> None:
    amplitude = np.linspace(0.5, 0.1, 8)

    def codes(amplitude: np.ndarray, period_s: np.ndarray) -> list[str]:
        known = 2.0 * math.pi / period_s**2 * 1e-4  # of the frequency, for 0.1 ms of the period
        covariance = np.zeros((8, 2, 2))
        covariance[:, 1, 1] = known**2
        nothing = np.zeros(8)
        local = LocalPeriods(nothing, amplitude, nothing, period_s, covariance, nothing.astype(int))
        flags = check_amplitude_effect("swing", local, pendulum_lengthening(3.0))
        return [flag.code for flag in flags]

    steady = np.full(8, 3.0)
    assert codes(amplitude, steady) == ["angle_scale"]
    assert codes(amplitude, 3.0 * (1.0 + amplitude**2 / 16.0)) == []
    assert codes(0.05 * amplitude, steady) == []


def test_wrong_axis() -> None:
    check_sway_axis("bow", 2.0 * math.pi * math.sqrt(3.477 / 9.81), 3.477)
    with pytest.raises(DataError, match="yaw for sway"):
        check_sway_axis("bow", 4.391, 3.477)
    assert check_yaw_axis("bow", 4.391, 3.477) == ()
    sway = 2.0 * math.pi * math.sqrt(3.477 / 9.80665)
    assert check_yaw_axis("bow", sway, 3.477)[0].code == "period_is_sway"
    weak = Series("phone", "rate_x", "rad/s", 20.0, 0.0, 0.1 * np.cos(T))
    strong = Series("phone", "rate_z", "rad/s", 20.0, 0.0, np.cos(T))
    assert "rate_z swings 10 times" in strongest_axis(weak, (strong,))[0].message
    assert strongest_axis(strong, (weak,)) == ()


def test_nothing_swings() -> None:
    with pytest.raises(DataError, match="nothing swings"):
        usable_part(record(np.ones(2000)))
    still = np.random.default_rng(0).standard_normal(2000)
    with pytest.raises(DataError, match="nothing swings"):
        usable_part(record(still))


HALF = 1.2


def timer(
    count: int = 120, *, sway_s: float = 0.0, softening: float = 0.0, asymmetry_s: float = 0.0
) -> GateEvents:
    """Two gates at either end: sway shifts their passages oppositely."""
    number = np.arange(count)
    size = np.exp(-0.01 * number)
    centre = 1.0 + np.concatenate(([0.0], np.cumsum(HALF * (1.0 + softening * size[1:] ** 2))))
    centre = centre + asymmetry_s * (-1.0) ** number
    events = []
    for gate, sign in ((0, 1.0), (1, -1.0)):
        shift = sign * sway_s * np.sin(1.9 * number)
        width = 0.03 / size
        events += [(t, gate, 1) for t in centre + shift - width / 2.0]
        events += [(t, gate, 0) for t in centre + shift + width / 2.0]
    events.sort()
    state, rows = [0.0, 0.0], []
    for time, gate, blocked in events:
        state[gate] = float(blocked)
        rows.append((time, *state))
    table = np.array(rows)
    return gate_events("timer", table[:, 0], table[:, 1:].T, ("A", "B"))


def test_two_gates_cancel_sway() -> None:
    fit = fit_passages(passages(timer(sway_s=0.05)))
    assert fit.period.value == pytest.approx(2.0 * HALF, rel=1e-6)


def test_period_at_no_amplitude_and_a_gate_off_centre() -> None:
    fit = fit_passages(passages(timer(softening=2e-3, asymmetry_s=0.01)))
    assert fit.period.value == pytest.approx(2.0 * HALF, rel=1e-4)
    assert abs(fit.period.value - 2.0 * HALF) < 3.0 * fit.period.uncertainty
    assert fit.mean_period_s > 2.0 * HALF * (1.0 + 3e-4)
    assert abs(fit.asymmetry_s) == pytest.approx(0.01, rel=0.01)


def test_bounces_and_lost_edges_do_not_shift_the_count() -> None:
    events = timer(sway_s=0.004)
    time, states = list(events.time_s), [list(row) for row in events.blocked.astype(float)]
    for place in (101, 205, 309):  # a bounce: off and on again within a hundredth of the width
        for row, gate in zip(states, (0, 1), strict=True):
            row[place:place] = (
                [row[place - 1]] * 2 if gate else [1.0 - row[place - 1], row[place - 1]]
            )
        time[place:place] = [time[place - 1] + 1e-7, time[place - 1] + 2e-7]
    for place in (250, 150):  # an edge the timer lost
        del time[place]
        for row in states:
            del row[place]
    damaged = gate_events("timer", np.array(time), np.array(states), ("A", "B"))
    found = passages(damaged)
    assert found.number[-1] == 119
    assert "gate_repaired" in {flag.code for flag in found.flags}
    assert fit_passages(found).period.value == pytest.approx(2.0 * HALF, rel=1e-4)


def test_single_gate() -> None:
    two = timer()
    one = gate_events("timer", two.time_s, two.blocked[:1].astype(float))
    assert fit_passages(passages(one)).period.value == pytest.approx(2.0 * HALF, rel=1e-6)


def test_timer_files(tmp_path: Path) -> None:
    path = tmp_path / "gates.csv"
    events = timer(40)
    rows = [
        f"{t:.7f},{int(a)},{int(b)},"
        for t, a, b in zip(events.time_s, *events.blocked, strict=True)
    ]
    head = ["Time,State at A,State at B,Comment", "s,State,State,", ""]
    path.write_text("\n".join(head + rows) + "\n")
    assert passages(read_gate_events(path)).time_s.size == 40
    with pytest.raises(DataError, match="no column 'Gate 1'"):
        read_gate_events(path, gates=("Gate 1",))
    with pytest.raises(DataError, match="no such file"):
        read_gate_events(tmp_path / "none.csv")
    path.write_text("\n".join(head + rows[:4]) + "\n")
    with pytest.raises(DataError, match="at least 8"):
        read_gate_events(path)
    path.write_text("\n".join(head + [row.replace(",1,", ",7,") for row in rows]) + "\n")
    with pytest.raises(DataError, match="neither 0 nor 1"):
        read_gate_events(path)
    path.write_text("\n".join(head + rows[20:] + rows[:20]) + "\n")
    with pytest.raises(DataError, match="runs backwards"):
        read_gate_events(path)
    still = gate_events("timer", np.arange(10.0), np.zeros((1, 10)))
    with pytest.raises(DataError, match="has seen no swings"):
        passages(still)


def test_few_passages_cannot_be_extrapolated() -> None:
    with pytest.raises(DataError, match="at least 24"):
        fit_passages(passages(timer(16)))


TIMES = (56.9, 57.0, 56.95, 56.97, 56.92, 57.9)


def test_stopwatch() -> None:
    single = stopwatch_period((StopwatchReading(20, 56.92),)).estimate
    assert single.value == pytest.approx(2.846)
    assert single.uncertainty == pytest.approx(0.005)
    assert [flag.code for flag in stopwatch_period((StopwatchReading(20, 56.92),)).flags] == [
        "single_run"
    ]
    several = stopwatch_period(tuple(StopwatchReading(20, s) for s in (56.9, 57.6, 56.4, 57.3)))
    assert several.estimate.degrees_of_freedom == pytest.approx(3.0)
    (agreement,) = several.redundancy
    # each reading is of 0.1 s
    assert agreement.chi_squared == pytest.approx(100.0 * np.var([56.9, 57.6, 56.4, 57.3]) * 4.0)
    assert agreement.stands_out == ()
    wild = stopwatch_period(tuple(StopwatchReading(20, s) for s in TIMES))
    assert wild.redundancy[0].stands_out == ("reading 6",)
    with pytest.raises(DataError, match="too few swings"):
        stopwatch_period((StopwatchReading(2, 5.0),))
    with pytest.raises(DataError, match="miscounted"):
        stopwatch_period(tuple(StopwatchReading(20, s) for s in (56.9, 56.8, 59.8)))


def test_stopwatch_with_a_scatter_known_from_earlier() -> None:
    known = KnownScatter(0.03, 8.0)
    single = stopwatch_period((StopwatchReading(20, 56.92),), known_scatter=known)
    assert single.estimate.uncertainty == pytest.approx(0.03)
    assert "single_run" not in {flag.code for flag in single.flags}
    times = (56.9, 57.6, 56.4, 57.3)
    several = stopwatch_period(
        tuple(StopwatchReading(20, s) for s in times), known_scatter=known
    ).estimate
    pooled = math.sqrt((3.0 * float(np.var(times, ddof=1)) / 400.0 + 8.0 * 0.03**2) / 11.0)
    assert several.uncertainty == pytest.approx(pooled / 2.0)
    assert several.degrees_of_freedom == pytest.approx(11.0)


def test_decay_needs_amplitudes() -> None:
    with pytest.raises(DataError, match="at least 4 above 0"):
        fit_power_decay(np.arange(3.0), np.ones(3))


def test_a_fits_own_error_alone_never_leaves() -> None:
    """The paper's three P1 runs: 0.0082 s of the mean, though each fit claims a hundredth of it."""
    runs = [Estimate.of(value, 1e-4, "s") for value in (7.3083, 7.2809, 7.2878)]
    found = combine_runs(runs)
    assert found.estimate.value == pytest.approx(7.2923, abs=1e-4)
    assert found.estimate.uncertainty == pytest.approx(0.0082, abs=1e-4)
    assert found.estimate.degrees_of_freedom == pytest.approx(2.0)
    assert found.flags[0].code == "scatter_exceeds_fit"
    (agreement,) = found.redundancy
    assert agreement.widening == pytest.approx(142.0, rel=0.01)
    assert agreement.without[0] == pytest.approx([7.28435])
    with pytest.raises(DataError, match="a fit's own error alone is no uncertainty"):
        combine_runs(runs[:1])
    known = combine_runs(runs[:1], known_scatter=KnownScatter(0.0142, 6.0))
    assert known.estimate.uncertainty == pytest.approx(0.0142)
    assert known.estimate.degrees_of_freedom == pytest.approx(6.0)
    pooled = combine_runs(runs, known_scatter=KnownScatter(0.0142, 6.0))
    assert pooled.estimate.degrees_of_freedom == pytest.approx(8.0)


@pytest.mark.parametrize(("unit", "flagged"), [("rad/s", True), ("", False), ("1", False)])
def test_only_what_has_one_unit_is_compared(unit: str, flagged: bool) -> None:
    """Metres of travel beside degrees of roll, both without a unit, say nothing of each other."""
    time = np.arange(500) / 50.0
    roll = Series("run", "roll", unit, 50.0, 0.0, np.sin(time))
    travel = Series("run", "travel", unit, 50.0, 0.0, 7.0 * time)
    assert bool(strongest_axis(roll, (travel,))) is flagged
