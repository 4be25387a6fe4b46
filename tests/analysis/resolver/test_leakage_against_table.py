"""What the estimators let through of a vibration at x times the fundamental: table and sinc."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.recording import Recording
from analysis.resolver.estimate import resolve
from analysis.resolver.hann import resolve_hann
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.leakage import boxcar_leakage, measured_leakage
from analysis.resolver.reference import from_frequency
from analysis.resolver.sums import period_sums
from tests.analysis.resolver.signals import FloatArray, recording

ORDERS = np.array([0.37, 1.37, 5.37])
# Each figure, and one unit of the last digit that the table gives.
BOXCAR = {
    1: ((0.68, 0.01), (0.91, 0.01), (0.11, 0.01)),
    3: ((0.083, 0.001), (0.11, 0.01), (0.014, 0.001)),
    10: ((0.060, 0.001), (0.080, 0.001), (1e-2, 1e-3)),
    30: ((8e-3, 1e-3), (0.010, 0.001), (1e-3, 1e-3)),
}
HANN = {
    10: ((1e-3, 1e-3), (5e-3, 1e-3), (4e-6, 1e-6)),
    30: ((2e-5, 1e-5), (7e-5, 1e-5), (6e-8, 1e-8)),
}


def leakage(
    periods: int, orders: FloatArray, *, hann: bool = False, harmonics: int = 1
) -> FloatArray:
    """Of the real estimator, at 100 samples a period, for each order and harmonic."""
    blank = recording(np.zeros(100 * (periods + 2)))
    reference = from_frequency(1.0, 0.0, blank.end_s)
    edges = 1.0 + np.arange(periods + 1.0)

    def estimator(run: Recording) -> Harmonics:
        if hann:
            return resolve_hann(run, reference, edges, harmonics, take_out_drift=False)
        sums = period_sums(run, reference, harmonics, edges_cycles=edges)
        return resolve(run, sums, take_out_drift=False)

    return measured_leakage(blank, estimator, orders)


@pytest.mark.parametrize("periods", BOXCAR)
def test_whole_periods_leak_as_the_table_says(periods: int) -> None:
    figures, digit = np.array(BOXCAR[periods]).T
    assert np.all(np.abs(leakage(periods, ORDERS)[:, 0] - figures) < digit)


@pytest.mark.parametrize("periods", HANN)
def test_hann_taper_leaks_as_the_table_says(periods: int) -> None:
    figures, digit = np.array(HANN[periods]).T
    assert np.all(np.abs(leakage(periods, ORDERS, hann=True)[:, 0] - figures) < digit)


@pytest.mark.parametrize("periods", BOXCAR)
def test_the_closed_form_is_the_worst_phase(periods: int) -> None:
    """The estimator leaks as much as two sincs together, and no more."""
    orders = np.linspace(0.21, 6.3, 60)
    bound = boxcar_leakage(orders, periods, 3)
    assert leakage(periods, orders, harmonics=3) == pytest.approx(bound, rel=1e-4, abs=1e-6)


@given(st.integers(1, 40), st.integers(1, 200), st.integers(1, 3))
def test_closed_form_is_zero_where_whole_periods_of_the_vibration_fit(
    periods: int, turns: int, harmonic: int
) -> None:
    order = turns / periods
    through = boxcar_leakage(np.array([order]), periods, harmonic)[0, -1]
    assert through == pytest.approx(1.0 if turns == harmonic * periods else 0.0, abs=1e-12)


@pytest.mark.parametrize("order", [1.5, 2.5, 4.0, 0.5])
def test_a_vibration_of_whole_turns_in_the_gate_does_not_come_through(order: float) -> None:
    assert leakage(4, np.array([order]), harmonics=1).max() < 1e-6


def test_a_harmonic_comes_through_whole_and_in_its_place() -> None:
    through = leakage(5, np.array([1.0, 2.0, 3.0]), harmonics=3)
    assert through == pytest.approx(np.eye(3), abs=1e-9)


def test_many_frequencies_are_tried_in_order() -> None:
    """More than are tried together."""
    orders = np.linspace(0.3, 4.0, 37)
    together = leakage(3, orders)
    alone = [leakage(3, orders[[k]])[0, 0] for k in (0, 15, 16, 36)]
    assert together[[0, 15, 16, 36], 0] == pytest.approx(alone, rel=1e-9)
