"""A motion that runs away, as sizes are tried, counts as a stalled shaft, and nothing overflows."""

import numpy as np
import pytest

from tests.sealed.closed_forms import HEAVE, RIG, still
from tests.sealed.generator.features import StalledError, features
from tests.sealed.generator.integrate import RUNAWAY
from tests.sealed.generator.mechanism import happen, set_run
from tests.sealed.generator.parameters import P
from tests.sealed.generator.sensing import sense

pytestmark = pytest.mark.slow  # the time loop takes 20 s to compile


@pytest.mark.parametrize("creep", [1.0, 1e6])
def test_a_belt_that_creeps_too_fast_stalls_without_an_overflow(creep: float) -> None:
    p = still()
    p[P.CREEP], p[P.CURVATURE] = creep, 1e-6
    truth = happen(p, HEAVE, RIG)
    moved = np.abs(truth.samples[1:5])
    last = int(np.argmax(np.isnan(moved).any(axis=0)))
    assert 0 < last < truth.before
    assert np.isnan(truth.samples[:, last:]).all()
    assert moved[:2, :last].max() < RUNAWAY
    # Warnings are errors here: squares of such forces would say so.
    record = sense(set_run(p, HEAVE), truth, HEAVE, RIG, None)
    with pytest.raises(StalledError, match="0 revolutions of 6"):
        features(record, HEAVE, RIG)
