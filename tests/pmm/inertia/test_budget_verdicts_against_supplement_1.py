"""Whether a budget is good enough: Supplement 1 to the GUM by draws and formulas of our own."""

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from analysis.inertia.bifilar import yaw_from_period
from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.monte_carlo import Assessment
from hardware.description.arrays import FloatArray
from pmm.inertia import bifilar, swing

EXAMPLES = Path(__file__).parents[3] / "examples" / "inertia"
TRIALS = 1_000_000


def yaw(half_spacing_m: FloatArray, line_m: FloatArray, period_s: FloatArray,
        gravity_m_s2: FloatArray) -> FloatArray:  # fmt: skip
    return half_spacing_m * period_s / (2.0 * np.pi) * np.sqrt(gravity_m_s2 / line_m)


def about_pivot(moment_kg_m: FloatArray, period_s: FloatArray, gravity_m_s2: FloatArray,
                **_: FloatArray) -> FloatArray:  # fmt: skip
    return moment_kg_m * gravity_m_s2 * (period_s / (2.0 * np.pi)) ** 2


def apart(found: Assessment, formula: Callable[..., FloatArray]) -> float:
    """Return how far the linear interval's ends are off the trials', in tolerances (8.1.3)."""
    rng = np.random.default_rng(5)
    inputs = {line.name: line.input for line in found.budget.shares}
    drawn = {
        name: one.value + one.uncertainty * _standard(one.degrees_of_freedom, rng)
        for name, one in inputs.items()
    }
    ends = np.quantile(formula(**drawn), [0.025, 0.975])
    size = found.budget.result.uncertainty
    tolerance = 0.5 * 10.0 ** (math.floor(math.log10(size)) - 1)  # two digits are meant
    return float(np.abs(np.array(found.budget.result.interval()) - ends).max() / tolerance)


def _standard(freedom: float, rng: np.random.Generator) -> FloatArray:
    if math.isinf(freedom):
        return rng.standard_normal(TRIALS)
    return np.asarray(stats.t.rvs(freedom, size=TRIALS, random_state=rng))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("job", "file", "name", "formula", "least"),
    [
        (bifilar, "hull.toml", "k_yaw_by_period_m", yaw, 20.0),
        (swing, "swing.toml", "tare_i_pivot_kg_m2", about_pivot, 10.0),
    ],
)
def test_three_releases_are_refused_rightly(
    job: object, file: str, name: str, formula: Callable[..., FloatArray], least: float
) -> None:
    outcome = job.run(str(EXAMPLES / file))  # type: ignore[attr-defined]
    found = next(one.assessment for one in outcome.findings if one.name == name)
    assert apart(found, formula) > least
    assert not found.linear_good_enough


@pytest.mark.parametrize(("freedom", "good"), [(2.0, False), (5.0, False), (math.inf, True)])
def test_the_verdict_follows_the_freedom_of_the_period(freedom: float, good: bool) -> None:
    period = Estimate.of(4.3889, 0.0007, "s", freedom)
    known = (Estimate.of(0.9, 0.0005, "m"), Estimate.of(3.477, 0.002, "m"))
    found = yaw_from_period(period, *known, Estimate.of(9.81, 0.0005, "m/s2"))
    off = apart(found, yaw)
    assert (off < 1.0) == good
    assert found.linear_good_enough == good
