"""Oracle: transfer functions of the sensors, exact passage times, clocks, statistics."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.readers.dataset import from_dataset
from hardware.description.errors import ConfigurationError, DataError
from sim.pendulum.benches import (
    KEELBOAT_2014,
    KVLCC2_ROLL,
    MODEL_HULL_2014,
    SWING_2021,
    SWING_MODEL_2021,
    bifilar_bench,
    compound_bench,
    decay_bench,
)
from sim.pendulum.effects import make_effect
from sim.pendulum.pivot import Pendulum
from sim.pendulum.record import record
from sim.pendulum.sensors import inclinometer
from sim.pendulum.simulation import (
    simulate_bifilar,
    simulate_decay,
    simulate_stopwatch,
    simulate_swing,
    simulate_swing_static,
)

G = 9.80665


@pytest.mark.parametrize(("upper", "expected"), [(False, 0.93), (True, -0.05)])
def test_the_inclinometer_reads_as_the_tangential_acceleration_lets_it(
    upper: bool, expected: float
) -> None:
    found = simulate_swing(upper_pivot=upper, seed=1, release_rad=0.01, duration_s=60.0).dataset
    true = found.angle.values
    read = found.inclinometer_angle.values
    factor, _ = np.polyfit(true, read, 1)
    rise = 1.2 if upper else 0.0
    pivot = 39.526 + 42.28 * (0.0719 + rise) ** 2
    square = 42.28 * G * (0.0719 + rise) / pivot
    exact = 1.0 - square * (0.92 + rise) / G
    # the bow of 0.05 % of the range is in the slope as well
    assert factor == pytest.approx(exact, abs=6e-3)
    assert factor == pytest.approx(expected, abs=0.01)


def test_the_inclinometer_stops_at_three_degrees_and_says_so() -> None:
    found = simulate_swing(seed=1, release_rad=math.radians(4.0), duration_s=10.0).dataset
    assert np.abs(found.inclinometer_angle.values).max() == pytest.approx(math.radians(3.0))
    (flag,) = json.loads(found.attrs["flags"])
    assert flag["code"] == "saturated"
    assert flag["channel"] == "inclinometer_angle"


def test_the_bow_is_the_stated_share_of_the_range() -> None:
    bench = compound_bench(Pendulum((SWING_2021,), linear=True), release_rad=math.radians(2.999))
    bent = replace(inclinometer(0.0), non_repeatability=0.0)
    bench = replace(
        bench, sensors=(*bench.sensors, bent), digitisers=(*bench.digitisers, *bench.digitisers[:1])
    )
    found = record(bench, duration_s=8.0, sample_rate_hz=256.0, seed=0).dataset
    off = np.abs(found.inclinometer_angle.values - found.angle.values)
    assert off.max() == pytest.approx(5e-4 * math.radians(6.0), rel=1e-4)


def test_a_lag_has_the_transfer_function_of_its_discrete_step_and_nearly_the_continuous() -> None:
    body = replace(KVLCC2_ROLL, restoring=134.1 * (2.0 * math.pi) ** 2)
    lag = make_effect("sensor_lag", lag_s=0.1)
    found = (
        simulate_decay(body, release=0.1, effects=[lag], seed=0, duration_s=20.0)
        .dataset["roll"]
        .values
    )
    t, w, h, tau = np.arange(2001) / 100.0, 2.0 * np.pi, 0.01, 0.1
    z, pole = np.exp(1j * w * h), math.exp(-h / tau)
    # the input is straight between samples: weights of the old and the new one
    new = 1.0 - tau / h * (1.0 - pole)
    discrete = ((1.0 - pole - new) + new * z) / (z - pole)
    late = t > 5.0
    np.testing.assert_allclose(
        found[late], (0.1 * discrete * np.exp(1j * w * t)).real[late], atol=1e-10
    )
    assert abs(discrete * (1.0 + 1j * w * tau) - 1.0) < 5e-4


def test_offset_gain_noise_and_drift_do_what_they_say() -> None:
    effects = [
        make_effect("sensor_offset", offset=0.01),
        make_effect("sensor_gain", gain_error=0.05),
        make_effect("sensor_noise", noise_rms=1e-3),
        make_effect("sensor_drift", drift_per_s=1e-4),
    ]
    plain = simulate_decay(KVLCC2_ROLL, release=0.1, seed=5, duration_s=200.0).dataset
    noisy = simulate_decay(
        KVLCC2_ROLL, release=0.1, seed=5, duration_s=200.0, effects=effects
    ).dataset
    t = plain.time.values
    rest = noisy["roll"].values - 1.05 * plain["roll"].values - 0.01 - 1e-4 * t
    assert abs(rest.mean()) < 4e-3 / math.sqrt(t.size)
    assert rest.std() == pytest.approx(1e-3, rel=0.03)
    again = simulate_decay(KVLCC2_ROLL, release=0.1, seed=5, duration_s=200.0, effects=effects)
    np.testing.assert_array_equal(again.dataset["roll"].values, noisy["roll"].values)


def test_a_fast_clock_makes_every_period_longer() -> None:
    clock = make_effect("wrong_clock", clock_error=0.01)
    found = simulate_decay(
        KVLCC2_ROLL, release=0.1, effects=[clock], seed=0, duration_s=50.0
    ).dataset
    w = math.sqrt(821.0 / 134.1)
    expected = 0.1 * np.cos(w * found.time.values / 1.01)
    np.testing.assert_allclose(found["roll"].values, expected, atol=1e-10)
    bench = clock(decay_bench(KVLCC2_ROLL, release=0.1))
    took = simulate_stopwatch(bench, swings=10, readings=3, reaction_s=0.0, seed=0)
    np.testing.assert_allclose(took, 1.01 * 20.0 * math.pi / w, rtol=1e-9)


def test_a_stopwatch_reading_misses_by_the_persons_reaction() -> None:
    bench = decay_bench(KVLCC2_ROLL, release=0.1)
    w = math.sqrt(821.0 / 134.1)
    took = simulate_stopwatch(bench, swings=3, readings=200, reaction_s=0.1, seed=2)
    off = took - 6.0 * math.pi / w
    assert off.std() == pytest.approx(0.1, rel=0.15)
    damped = make_effect("bearing_friction", dead_zone=0.01)(bench)
    with pytest.raises(DataError, match="come to rest"):
        simulate_stopwatch(damped, swings=10, readings=5, seed=0, longest_s=300.0)


def test_gate_edges_are_where_the_flag_enters_and_leaves() -> None:
    body = replace(KEELBOAT_2014, linear=True)
    found = simulate_bifilar(
        body, yaw_rad=0.1, stern_lever_m=1.0, flag_width_m=0.02, seed=0, duration_s=60.0
    )
    w = math.sqrt(body.stiffness[2, 2] / body.mass[2, 2])
    for gate in found.gates:
        # |0.1 cos(w t)| = 0.01 about every odd quarter
        centre = (np.arange(gate.time_s.size // 2) + 0.5) * math.pi / w
        half = math.asin(0.1) / w
        np.testing.assert_allclose(gate.time_s[0::2], centre - half, atol=1e-9)
        np.testing.assert_allclose(gate.time_s[1::2], centre + half, atol=1e-9)
        assert np.all(gate.blocked == (np.arange(gate.time_s.size) % 2 == 0))
    np.testing.assert_array_equal(found.dataset.photocell_edge_time.values, found.gates[0].time_s)


def test_missed_passages_are_missed_whole_and_as_often_as_stated() -> None:
    missed = make_effect("missed_passages", missed_share=0.2)
    body = replace(MODEL_HULL_2014, linear=True)
    every = simulate_bifilar(body, seed=4, duration_s=900.0)
    seen = simulate_bifilar(body, seed=4, duration_s=900.0, effects=[missed])
    for all_edges, some in zip(every.gates, seen.gates, strict=True):
        passages = all_edges.time_s.size // 2
        share = 1.0 - (some.time_s.size // 2) / passages
        assert share == pytest.approx(0.2, abs=4.0 * math.sqrt(0.16 / passages))
        assert np.all(some.blocked[:-1] != some.blocked[1:])
        assert np.all(np.isin(some.time_s, all_edges.time_s))


def test_a_beam_beside_rest_makes_half_swings_alternate() -> None:
    body = replace(KEELBOAT_2014, linear=True)
    beside = make_effect("gate_offset", beam_offset_m=0.02)
    found = simulate_bifilar(body, yaw_rad=0.1, seed=0, duration_s=60.0, effects=[beside])
    passages = 0.5 * (found.gates[0].time_s[0::2] + found.gates[0].time_s[1::2])
    halves = np.diff(passages)
    w = math.sqrt(body.stiffness[2, 2] / body.mass[2, 2])
    ends = [math.asin(0.2 + off) for off in (-0.05, 0.05)]
    swing = 2.0 * sum(ends) / w  # longer less shorter half, each off by twice the mean angle
    np.testing.assert_allclose(np.abs(np.diff(halves)), swing, atol=1e-8)


def test_gate_files_hold_every_edge_with_both_states(tmp_path: Path) -> None:
    found = simulate_bifilar(MODEL_HULL_2014, seed=0, duration_s=20.0, sway_m=0.02)
    path = found.write_gates(tmp_path / "gates.csv")
    lines = path.read_text().splitlines()
    assert lines[0] == "Time,State at A,State at B"
    rows = np.loadtxt(lines[2:], delimiter=",")
    assert rows.shape[0] == sum(gate.time_s.size for gate in found.gates)
    for column, gate in zip((1, 2), found.gates, strict=True):
        changed = np.flatnonzero(np.diff(np.concatenate([[0.0], rows[:, column]])))
        np.testing.assert_allclose(rows[changed, 0], gate.time_s, atol=1e-9)
    with pytest.raises(DataError, match="there already"):
        found.write_gates(path)


@pytest.mark.sample(1)
@pytest.mark.parametrize("model", [None, SWING_MODEL_2021])
def test_static_series_have_the_angles_of_equation_2(model) -> None:  # type: ignore[no-untyped-def]
    weights = (0.0, 0.2, 0.5)
    series = simulate_swing_static(weights, 0.2, seed=3, model=model, residual_rad=0.0)
    moment = 42.28 * 0.0719 + (11.27 * 0.8367 if model else 0.0)
    for mass, found in zip(weights, series, strict=True):
        angle = found.dataset.angle.values
        np.testing.assert_allclose(np.tan(angle), mass * 0.2 / moment, atol=1e-12)
    (first, *_) = simulate_swing_static(weights, 0.2, seed=3, residual_rad=1e-3)
    assert 0.0 < np.abs(first.dataset.angle.values).max() < 5e-3


def test_the_record_follows_the_schema_and_tells_the_truth() -> None:
    found = simulate_swing(seed=0, model=SWING_MODEL_2021, duration_s=5.0)
    recording = from_dataset(found.dataset)
    assert recording.channel_names == ("inclinometer_angle", "angle")
    assert recording.sample_count == 5 * 256 + 1
    truth = json.loads(recording.provenance["truth"])
    assert truth == found.truth
    assert truth["last_part_inertia_kg_m2"] == 0.45
    assert truth["mass_kg"] == pytest.approx(42.28 + 11.27)
    gated = simulate_bifilar(MODEL_HULL_2014, seed=0, duration_s=5.0)
    assert from_dataset(gated.dataset).photocell_edges_s is not None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"duration_s": 0.0}, "duration_s = 0"),
        ({"sample_rate_hz": math.nan}, "sample_rate_hz = nan"),
        ({"seed": -1}, "seed = -1"),
    ],
)
def test_what_cannot_be_run_is_refused_in_words(arguments, message: str) -> None:  # type: ignore[no-untyped-def]
    usual = {"duration_s": 1.0, "sample_rate_hz": 50.0, "seed": 0}
    with pytest.raises(ConfigurationError, match=message):
        record(bifilar_bench(MODEL_HULL_2014), **{**usual, **arguments})


def test_a_body_that_does_not_swing_back_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="does not swing back"):
        Pendulum((replace(SWING_2021, lever_m=-0.1),))
    with pytest.raises(ConfigurationError, match="depth_m = 0"):
        replace(MODEL_HULL_2014, depth_m=0.0)
