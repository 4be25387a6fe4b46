"""Budgets against the worked arithmetic, closed forms and GTC's own."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.uncertainty.budget import linear_budget
from analysis.uncertainty.estimate import Estimate, exactly, within
from analysis.uncertainty.monte_carlo import assess, monte_carlo
from hardware.description.errors import ConfigurationError, DataError

INPUTS = {
    "period_s": Estimate.of(7.2923, 0.0060, "s"),
    "mass_kg": Estimate.of(42.28, 0.02, "kg"),
    "cg_m": Estimate.of(0.0713, 0.0003, "m"),
}


def inertia(period_s: float, mass_kg: float, cg_m: float) -> float:
    return period_s**2 * mass_kg * 9.81 * cg_m / (4.0 * math.pi**2)


def test_worked_arithmetic() -> None:
    budget = linear_budget("I", inertia, INPUTS, unit="kg m2")
    assert budget.result.value == pytest.approx(39.8348, abs=5e-5)
    assert budget.result.uncertainty == pytest.approx(0.1810, abs=5e-5)
    shares = {line.name: 100.0 * line.share for line in budget.shares}
    assert shares == pytest.approx({"cg_m": 85.8, "period_s": 13.1, "mass_kg": 1.1}, abs=0.05)
    assert [line.name for line in budget.shares] == ["cg_m", "period_s", "mass_kg"]


def tied(value: float, uncertainty: float, r: float, unit: str = "1") -> Estimate:
    """Return an estimate that another of the same kind correlates with by the product of both r."""
    own = Estimate.of(value, uncertainty * math.sqrt(1.0 - r * r), unit)
    return own.widened(r * uncertainty, label="common")


def test_worked_arithmetic_with_a_correlation() -> None:
    root = math.sqrt(0.5)
    inputs = INPUTS | {
        "period_s": tied(7.2923, 0.0060, root, "s"),
        "cg_m": tied(0.0713, 0.0003, root, "m"),
    }
    budget = linear_budget("I", inertia, inputs)
    assert budget.result.uncertainty == pytest.approx(0.2091, abs=5e-5)
    assert sum(line.share for line in budget.shares) == pytest.approx(1.0)
    trial = monte_carlo("I", inertia, inputs, seed=1)
    assert trial.uncertainty == pytest.approx(0.2091, rel=0.01)


def test_worked_arithmetic_by_monte_carlo() -> None:
    found = assess("I", inertia, INPUTS, unit="kg m2", seed=4, trials=1_000_000)
    assert found.monte_carlo.mean == pytest.approx(39.8351, abs=6e-4)
    assert found.monte_carlo.low == pytest.approx(39.481, abs=2e-3)
    assert found.monte_carlo.high == pytest.approx(40.190, abs=2e-3)
    assert found.linear_good_enough


def test_a_bent_formula_is_caught() -> None:
    found = assess("square", lambda x: x * x, {"x": Estimate.of(0.1, 1.0)}, seed=2)
    assert not found.linear_good_enough
    assert found.interval[0] >= 0.0
    assert found.interval[1] == pytest.approx(5.0, rel=0.1)


@pytest.mark.parametrize(("off", "holds"), [(0.0003, True), (0.0007, False)])
def test_half_a_unit_of_the_second_digit_decides(off: float, holds: bool) -> None:
    """Of u = 0.0123 that is 0.0005 (Supplement 1 to the GUM, 7.9.2); a bend moves both ends."""
    size, end = 0.0123, 1.96
    bend = off / (end * size) ** 2
    found = assess(
        "bent", lambda x: x + bend * x * x, {"x": Estimate.of(0.0, size)}, seed=6, trials=1_000_000
    )
    assert found.linear_good_enough is holds


def test_ends_of_heavy_tails_are_as_uncertain_as_their_density_makes_them() -> None:
    """Student's t of one degree is Cauchy's: its density at the end is 1 / (pi (1 + 12.7 ** 2))."""
    inputs = {"x": Estimate.of(0.0, 0.3, "1", 1.0)}
    trials = 500_000
    found = monte_carlo("x", lambda x: x, inputs, seed=5, trials=trials)
    end = math.tan(math.pi * 0.475)
    expected = 0.3 * math.sqrt(0.025 * 0.975 / trials) * math.pi * (1.0 + end**2)
    assert found.end_uncertainty == pytest.approx(expected, rel=0.15)


def test_a_budget_is_not_good_enough_for_want_of_a_second_moment() -> None:
    """Two runs of a kind: the deviation of a hundred thousand trials is that of the largest."""
    inputs = {
        "a": Estimate.of(1.0, 0.02, "1", 1.0),
        "b": Estimate.of(2.0, 0.02, "1", 1.0),
        "c": Estimate.of(1.0, 0.03),
    }
    found = assess("a b + c", lambda a, b, c: a * b + c, inputs, seed=7)
    low, high = found.budget.result.interval()
    off = max(abs(low - found.monte_carlo.low), abs(high - found.monte_carlo.high))
    assert off > 0.2 * found.budget.result.half_width()
    assert found.monte_carlo.uncertainty > 1.0
    assert not found.linear_good_enough


def test_degrees_of_freedom_are_welchs() -> None:
    inputs = {"a": Estimate.of(1.0, 0.3, "1", 4.0), "b": Estimate.of(2.0, 0.4, "1", 9.0)}
    budget = linear_budget("sum", lambda a, b: a + b, inputs)
    assert budget.result.degrees_of_freedom == pytest.approx(
        0.25**2 / (0.09**2 / 4.0 + 0.16**2 / 9.0), rel=1e-6
    )


def test_finite_degrees_of_freedom_widen_the_monte_carlo() -> None:
    few = monte_carlo("x", lambda x: x, {"x": Estimate.of(0.0, 1.0, "1", 3.0)}, seed=3)
    assert few.high == pytest.approx(3.18, rel=0.05)
    even = monte_carlo("x", lambda x: x, {"x": within(0.0, 1.0)}, seed=3)
    assert even.high == pytest.approx(0.95, rel=0.01)


@given(
    u=st.lists(st.floats(0.01, 3.0), min_size=2, max_size=4),
    slopes=st.lists(st.floats(-5.0, 5.0), min_size=4, max_size=4),
    r=st.floats(-0.99, 0.99),
)
def test_linear_formulas_are_exact(u: list[float], slopes: list[float], r: float) -> None:
    inputs = {f"x{k}": Estimate.of(1.0 + k, spread) for k, spread in enumerate(u)}
    inputs["x0"] = tied(1.0, u[0], math.sqrt(abs(r)))
    inputs["x1"] = tied(2.0, u[1], math.copysign(math.sqrt(abs(r)), r))
    weights = np.array(slopes[: len(u)])

    def total(**given: float) -> float:
        return float(sum(w * given[f"x{k}"] for k, w in enumerate(weights)))

    matrix = np.eye(len(u))
    matrix[0, 1] = matrix[1, 0] = r
    part = weights * np.array(u)
    budget = linear_budget("sum", total, inputs)
    expected = math.sqrt(max(part @ matrix @ part, 0.0))
    assert budget.result.uncertainty == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_formulas_without_a_value_are_refused() -> None:
    with np.errstate(invalid="ignore"), pytest.raises(DataError, match="no finite value at x = -1"):
        linear_budget("root", lambda x: np.sqrt(x), {"x": exactly(-1.0)})
    with pytest.raises(DataError, match="of the trials have no value"):
        monte_carlo("root", lambda x: np.sqrt(x), {"x": Estimate.of(0.1, 1.0)}, seed=0)


def test_estimates_that_cannot_be_are_refused() -> None:
    with pytest.raises(ConfigurationError, match="must be finite"):
        Estimate.of(math.nan, 1.0)
    with pytest.raises(ConfigurationError, match="not negative"):
        Estimate.of(1.0, -1.0)
    with pytest.raises(ConfigurationError, match="degrees of freedom"):
        Estimate.of(1.0, 1.0, "m", 0.0)
