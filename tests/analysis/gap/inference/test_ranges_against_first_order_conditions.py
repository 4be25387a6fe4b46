"""The most probable parameters within their ranges, by the conditions that only these meet."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.inference.gaussian import Posterior
from analysis.gap.inference.hypothesis import bounded_mode


@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 6), spread=st.sampled_from([0.1, 3.0]))
def test_what_is_inside_is_level_and_what_is_held_is_held_back(
    seed: int, count: int, spread: float
) -> None:
    rng = np.random.default_rng(seed)
    root = rng.standard_normal((count, count + 1)) * 10.0 ** rng.uniform(-1.0, 1.0, (count, 1))
    precision = np.eye(count) + root @ root.T
    mean = spread * rng.standard_normal(count)
    low, high = -rng.uniform(0.01, 1.0, count), rng.uniform(0.01, 1.0, count)
    found = bounded_mode(Posterior(mean, precision), np.array((low, high)))
    assert ((low <= found) & (found <= high)).all()
    falls = precision @ (mean - found)  # where the density rises to
    near = 1e-6 * (1.0 + np.abs(precision).max() * np.abs(mean).max())
    assert (falls[found > low] > -near).all()
    assert (falls[found < high] < near).all()
