"""A recording that knows its gate is analysed in it; oracle: the same window given by hand."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.readers.dataset import from_dataset
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from hardware.description.dataset import GATE_OPENED, GATE_PERIODS
from hardware.description.setpoint import SetPoint
from sim.rig import vertical_rig
from sim.run import simulate


@pytest.fixture(scope="module")
def recording() -> Recording:
    """Return a run of ten periods."""
    return from_dataset(simulate(vertical_rig(), SetPoint(1.0, 0.02), periods=10, seed=3))


def _with_gate(recording: Recording, opened_s: str, periods: str) -> Recording:
    told = {**recording.provenance, GATE_OPENED: opened_s, GATE_PERIODS: periods}
    return replace(recording, provenance=told)


def test_the_gate_of_the_run_is_the_window(recording: Recording) -> None:
    opened_s = float(recording.photocell_edges_s[3])
    own = analyse(_with_gate(recording, repr(opened_s), "4")).readings[0]
    given = analyse(recording, settings=ResolverSettings(opens_s=opened_s, periods=4)).readings[0]
    assert own.periods == 4
    np.testing.assert_array_equal(own.coefficients, given.coefficients)


def test_what_the_user_asks_for_comes_first(recording: Recording) -> None:
    first, later = (float(recording.photocell_edges_s[at]) for at in (2, 5))
    asked = ResolverSettings(opens_s=later, periods=3)
    assert analyse(_with_gate(recording, repr(first), "4"), settings=asked).readings[0].periods == 3


@pytest.mark.parametrize(("opened_s", "periods"), [("soon", "4"), ("1e9", "4"), ("2.0", "0")])
def test_a_gate_that_cannot_be_is_none(recording: Recording, opened_s: str, periods: str) -> None:
    found = analyse(_with_gate(recording, opened_s, periods))
    assert found.stretch.period_count == analyse(recording).stretch.period_count
