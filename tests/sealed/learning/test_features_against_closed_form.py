"""Features of a hand-made campaign, each of which can be worked out on paper."""

import math

import numpy as np
import pytest

from tests.sealed.learning.features import SETTINGS, as_matrix, moments, of_components

CELL = "force_aft|in phase|1"
POINTS = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0))  # log frequency, carriage speed


def _settings(times: int = 1) -> list[list[float]]:
    return [[fast, -3.0, 1.0, speed, 1.0] for fast, speed in POINTS * times]


def _campaign(times: int = 1) -> dict[str, object]:
    """Return runs whose one cell is off by 2 + 3 log f - 4 U, in sigma."""
    settings = _settings(times)
    off = [2.0 + 3.0 * row[0] - 4.0 * row[3] for row in settings]
    return {"cell": [CELL] * len(off), "run": range(len(off)), "off": off, "settings": settings}


def test_a_plane_over_set_points_is_its_mean_and_slopes() -> None:
    """Off by 2, 5, -2, 1: mean 1.5, rms sqrt(34 / 4), slopes 3 and -4, none over what is fixed."""
    found = moments(np.array([2.0, 5.0, -2.0, 1.0]), np.array(_settings()))
    assert found["mean"] == pytest.approx(1.5)
    assert found["rms"] == pytest.approx(math.sqrt(8.5))
    slopes = [found[name] for name in SETTINGS]
    assert slopes == pytest.approx([3.0, 0.0, 0.0, -4.0, 0.0], abs=1e-6)


def test_the_number_of_runs_changes_no_feature() -> None:
    """Each run made thrice is the same campaign."""
    once, thrice = of_components(_campaign()), of_components(_campaign(3))
    assert once.keys() == thrice.keys()
    assert [thrice[name] for name in once] == pytest.approx(list(once.values()), abs=1e-6)
    assert once[f"{CELL}|mean"] == pytest.approx(math.asinh(1.5))
    assert once["runs|spread speed"] == pytest.approx(0.5)


def test_a_cell_that_no_run_has_is_not_a_number() -> None:
    """Trees take that for what it is: not seen."""
    row = as_matrix([of_components(_campaign())], [f"{CELL}|mean", "force_fore|mean|0|mean"])
    assert np.isfinite(row[0, 0])
    assert np.isnan(row[0, 1])
