"""Oracle: pulses drawn about a shaft's angle; the scatter that was put in, as often as chi-squared
says."""

import numpy as np
import pytest
from scipy.stats import chi2

from analysis.gap.observe.pulses import scatter_of_pulses

PERIOD_S, JITTER_S = 1.7, 1e-3


@pytest.mark.parametrize("turns", [2, 3, 6, 12, 40])
def test_scatter_is_what_was_put_in(turns: int) -> None:
    rng, freedom = np.random.default_rng(turns), turns + 1 - min(3, turns - 1) - 1
    even_s = PERIOD_S * np.arange(turns + 1)
    found = [
        scatter_of_pulses(even_s + JITTER_S * rng.standard_normal(turns + 1)) for _ in range(1500)
    ]
    logs, stated = np.array(found).T
    expected = np.log(np.sqrt(2.0) * JITTER_S / PERIOD_S)
    drawn = 0.5 * np.log(chi2.rvs(freedom, size=1500, random_state=1) / freedom)
    assert np.mean(logs) - expected == pytest.approx(np.mean(drawn), abs=0.15)
    assert np.std(logs) == pytest.approx(stated[0], rel=0.1)


def test_a_shaft_that_comes_to_its_speed_does_not_scatter() -> None:
    """Half a thousandth too slow at first, and back with a time constant of two turns."""
    rng, number = np.random.default_rng(5), np.arange(7)
    settling_s = 5e-4 * 2.0 * PERIOD_S * np.exp(-number / 2.0)
    jitter_s = 1e-4 * rng.standard_normal((200, 7))
    both = [
        (scatter_of_pulses(PERIOD_S * number + settling_s + each)[0],
         scatter_of_pulses(PERIOD_S * number + each)[0])
        for each in jitter_s
    ]  # fmt: skip
    assert abs(np.diff(np.mean(both, axis=0))[0]) < 0.1
    spread = np.std(np.diff(PERIOD_S * number + settling_s), ddof=1) / PERIOD_S
    assert np.log(spread) > np.mean(both) + 0.5  # of intervals about their mean it would


def test_a_turn_that_is_missing_is_no_scatter() -> None:
    pulses_s = PERIOD_S * np.delete(np.arange(9.0), 4)
    assert scatter_of_pulses(pulses_s)[0] < np.log(1e-6)
