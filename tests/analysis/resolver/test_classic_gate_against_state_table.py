"""The gating circuit against its state table: pulse, pulse, hold, reset."""

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.recording import Recording
from analysis.resolver.classic_gate import GatedIntegrator
from analysis.resolver.classic_gate_state import GatingState, IntegratorState
from analysis.resolver.classic_recording import gated_readings
from analysis.resolver.reference import from_frequency
from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Severity

RATE_HZ = 50.0
REFERENCE = from_frequency(1.0, 0.0, 100.0)


def sine(start: int, stop: int) -> FloatArray:
    return np.asarray(3.0 * np.sin(2.0 * np.pi * np.arange(start, stop) / RATE_HZ)[None])


def machine(periods: int = 1) -> GatedIntegrator:
    return GatedIntegrator(("force",), RATE_HZ, periods)


def fed(
    mode: GatedIntegrator, state: IntegratorState, seconds: float, pulses: list[float]
) -> IntegratorState:
    values = sine(state.sample_count, state.sample_count + round(seconds * RATE_HZ))
    return mode.advance(state, values, np.array(pulses), REFERENCE.cycles_at)


def test_pulses_open_count_close_and_are_then_ignored_until_the_reset() -> None:
    mode = machine(2)
    state = fed(mode, IntegratorState(0.0), 0.5, [])
    assert state.gate is GatingState.ARMED
    state = fed(mode, state, 1.0, [1.003])
    assert (state.gate, state.opened_s) == (GatingState.OPEN, 1.003)
    state = fed(mode, state, 1.0, [2.003])
    assert state.gate is GatingState.OPEN
    assert state.reading is None
    state = fed(mode, state, 1.0, [3.003])
    assert state.gate is GatingState.HOLD
    held = state.reading
    assert held is not None
    assert (held.opened_s, held.closed_s, held.periods) == (1.003, 3.003, 2)
    assert held.in_phase[0, 0] == pytest.approx(3.0, abs=1e-3)
    state = fed(mode, state, 3.0, [4.003, 5.003, 6.003])
    assert state.gate is GatingState.HOLD
    assert state.reading is held
    state = mode.reset(state)
    assert state.gate is GatingState.ARMED
    assert state.reading is None
    state = fed(mode, state, 3.0, [7.003, 8.003, 9.003])
    assert state.reading is not None
    assert state.reading.opened_s == 7.003
    assert state.reading.in_phase == pytest.approx(held.in_phase, abs=1e-9)


def test_a_reset_while_open_starts_over() -> None:
    mode = machine()
    state = mode.reset(fed(mode, IntegratorState(0.0), 1.5, [1.0]))
    state = fed(mode, state, 2.0, [2.0, 3.0])
    assert state.reading is not None
    assert state.reading.opened_s == 2.0


def test_one_block_may_hold_opening_and_closing() -> None:
    state = fed(machine(3), IntegratorState(0.0), 6.0, [1.51, 2.51, 3.51, 4.51])
    assert state.reading is not None
    assert state.reading.closed_s - state.reading.opened_s == pytest.approx(3.0)


def test_the_start_state_is_not_changed() -> None:
    start = IntegratorState(0.0)
    fed(machine(), start, 3.0, [1.0, 2.0])
    assert start.gate is GatingState.ARMED
    assert start.sample_count == 0


def test_pulses_before_the_first_sample_find_nothing_on() -> None:
    values = sine(100, 250)
    state = machine().advance(
        IntegratorState(2.0), values, np.array([1.0, 3.0, 4.0]), REFERENCE.cycles_at
    )
    assert state.reading is not None
    assert state.reading.opened_s == 3.0


@given(
    st.lists(st.integers(0, 60), max_size=10),
    st.floats(0.0, 0.99),
    st.integers(1, 4),
    st.booleans(),
)
def test_the_reading_does_not_depend_on_blocks(
    lengths: list[int], opening: float, periods: int, ahead: bool
) -> None:
    values = np.random.default_rng(periods).standard_normal((1, 300))
    pulses = opening + np.arange(6.0)
    mode = machine(periods)
    whole = mode.advance(IntegratorState(0.0), values, pulses, REFERENCE.cycles_at)
    state, sent, at = IntegratorState(0.0), 0, REFERENCE.cycles_at
    cuts = np.minimum(np.cumsum([0, *lengths, 300]), 300)
    for start, stop in pairwise(cuts):
        known = 6 if ahead else int(np.searchsorted(pulses, (stop - 1) / RATE_HZ, side="right"))
        known = max(known, sent)
        state = mode.advance(state, values[:, start:stop], pulses[sent:known], at)
        sent = known
    assert whole.reading is not None
    assert state.reading is not None
    assert np.array_equal(state.reading.in_phase, whole.reading.in_phase)
    assert np.array_equal(state.reading.quadrature, whole.reading.quadrature)
    assert state.reading.closed_s == whole.reading.closed_s == pulses[periods]


def test_a_missing_sample_voids_the_reading_and_says_so() -> None:
    values = sine(0, 200)
    values[0, 75] = np.nan
    state = machine().advance(
        IntegratorState(0.0), values, np.array([1.0, 2.0]), REFERENCE.cycles_at
    )
    assert state.reading is not None
    assert np.isnan(state.reading.in_phase).all()
    (flag,) = state.reading.flags
    assert (flag.code, flag.severity, flag.channel) == ("missing_samples", Severity.VOID, "force")


def test_a_missing_sample_outside_the_gate_does_no_harm() -> None:
    values = sine(0, 200)
    values[0, [30, 120]] = np.nan
    state = machine().advance(
        IntegratorState(0.0), values, np.array([1.0, 2.0]), REFERENCE.cycles_at
    )
    assert state.reading is not None
    assert np.isfinite(state.reading.in_phase).all()


def test_a_missed_pulse_is_flagged_with_the_revolutions() -> None:
    state = fed(machine(), IntegratorState(0.0), 4.0, [1.0, 3.0])
    assert state.reading is not None
    (flag,) = state.reading.flags
    assert flag.code == "gate_not_whole"
    assert "2.000 revolutions" in flag.message


def test_late_and_disordered_pulses_are_refused() -> None:
    state = fed(machine(), IntegratorState(0.0), 2.0, [])
    with pytest.raises(DataError, match=r"1\.500000 s came after samples up to 1\.980000 s"):
        fed(machine(), state, 1.0, [1.5])
    with pytest.raises(DataError, match=r"2\.500000 s does not come after"):
        fed(machine(), state, 1.0, [2.6, 2.5])


def test_too_few_samples_a_period_are_refused() -> None:
    with pytest.raises(DataError, match=r"5\.0 samples a period cannot carry harmonic 3"):
        fed(machine(), IntegratorState(0.0), 2.0, [1.0, 1.1])


def test_settings_below_their_limits_are_refused() -> None:
    with pytest.raises(ConfigurationError, match="periods = 0"):
        GatedIntegrator(("force",), RATE_HZ, 0)
    with pytest.raises(ConfigurationError, match="harmonics = 0"):
        GatedIntegrator(("force",), RATE_HZ, 1, 0)


def recording(count: int, pulses: FloatArray | None) -> Recording:
    return Recording(
        "run", (Channel("force", "N"),), sine(0, count), RATE_HZ, photocell_edges_s=pulses
    )


@pytest.mark.parametrize("periods", [1, 2])
def test_a_recording_gives_a_reading_in_each_m_plus_one_intervals(periods: int) -> None:
    pulses = 0.013 + np.arange(12.0)
    readings = gated_readings(recording(600, pulses), REFERENCE, periods=periods)
    opened = [reading.opened_s for reading in readings]
    assert opened == list(pulses[: 12 - periods : periods + 1])
    assert all(reading.in_phase[0, 0] == pytest.approx(3.0, abs=1e-3) for reading in readings)


def test_a_gate_may_close_on_the_very_last_sample() -> None:
    (reading,) = gated_readings(recording(101, None), REFERENCE, periods=2)
    assert (reading.opened_s, reading.closed_s) == (0.0, 2.0)
    assert reading.in_phase[0, 0] == pytest.approx(3.0, abs=1e-12)


def test_a_recording_with_too_few_pulses_says_how_many() -> None:
    with pytest.raises(DataError, match=r"2 pulses between .* a gate of 2 periods needs 3"):
        gated_readings(recording(200, np.array([1.0, 2.0])), REFERENCE, periods=2)
