"""What the eye sees of the samples: nothing invented, no spike lost, holes where samples are."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from pmm.console.traces import TraceBuffer, points_a_second


def test_up_to_a_hundred_samples_a_second_are_all_shown() -> None:
    traces = TraceBuffer(2, 100.0)
    values = np.arange(20.0).reshape(2, 10)
    traces.add(1, values[:, :4])
    traces.add(5, values[:, 4:])
    trace = traces.take()
    assert (trace.first, trace.start_s) == (1, 0.01)
    np.testing.assert_array_equal(trace.values, values)


def test_a_gap_is_shown_as_a_gap() -> None:
    traces = TraceBuffer(1, 100.0)
    traces.add(1, np.ones((1, 2)))
    traces.add(5, np.ones((1, 1)))
    np.testing.assert_array_equal(traces.take().values, [[1, 1, np.nan, np.nan, 1]])


def test_what_was_shown_is_not_shown_again() -> None:
    traces = TraceBuffer(1, 100.0)
    traces.add(1, np.array([[1.0, 2.0, 3.0]]))
    traces.add(3, np.array([[9.0, 4.0]]))
    np.testing.assert_array_equal(traces.take().values, [[1, 2, 3, 4]])


@given(st.integers(0, 999), st.integers(1, 40))
def test_a_spike_of_one_sample_survives_thinning(place: int, block: int) -> None:
    each, rate_hz = points_a_second(1000.0)
    assert (each, rate_hz) == (10, 100.0)
    samples = np.sin(np.arange(1000.0))[None, :]
    samples[0, place] = 50.0
    traces = TraceBuffer(1, 1000.0)
    for start in range(0, 1000, block):
        traces.add(start, samples[:, start : start + block])
    shown = traces.take().values
    assert shown.shape == (1, 100)
    assert shown.max() == 50.0
    assert set(shown[0]) <= set(samples[0])
