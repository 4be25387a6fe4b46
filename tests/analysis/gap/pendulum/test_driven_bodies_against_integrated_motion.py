"""What a body under a known force has, put into its equation of motion, against a linear body."""

from functools import cache

import numpy as np
import pytest

from analysis.gap.pendulum.causes import causes_for
from analysis.gap.pendulum.laws import damping_laws
from analysis.gap.pendulum.problem import PendulumProblem
from analysis.gap.pendulum.search import Weighed, weigh
from analysis.gap.pendulum.verdict import CAUSE, judge
from tests.analysis.gap.pendulum.driven_bodies import MASS_KG, STIFFNESS, Made, driven

RUNS = ((0.4, 30.0), (0.6, 30.0), (0.6, 10.0), (0.9, 30.0))
KNOWN = {"restoring": 2e-3, "damping": 0.02, "force": 2e-3}
TRIED = (
    "bearing_friction",
    "quadratic_drag",
    "cubic_damping",
    "nonlinear_restoring",
    "restoring",
    "damping",
    "sensor_delay",
    "sensor_gain",
    "wrong_clock",
)
# what is put in, and the catalogue's number for it
PUT_IN = {
    "bearing_friction": (Made(friction_n=2.0), 2.0 / STIFFNESS),
    "quadratic_drag": (Made(quadratic=60.0), 60.0 / (0.375 * MASS_KG)),
    "nonlinear_restoring": (Made(hardening=2000.0), 2.0),
    "sensor_delay": (Made(delay_s=-0.03), -0.03),
    "wrong_clock": (Made(clock=2e-3), 2e-3),
}


# what is left out of the catalogue: all that would explain it
WITHHELD = {
    "bearing_friction": ("bearing_friction",),
    "quadratic_drag": ("quadratic_drag", "cubic_damping"),
    "nonlinear_restoring": ("nonlinear_restoring",),
}


@cache
def problem_with(name: str) -> PendulumProblem:
    return driven(PUT_IN[name][0], RUNS, 3, KNOWN)


def weighed_without(problem: PendulumProblem, names: tuple[str, ...] = ()) -> Weighed:
    left = [name for name in TRIED if name not in names]
    return weigh(problem, [one for one in causes_for(problem.trials) if one.name in left], most=1)


@pytest.mark.slow
@pytest.mark.parametrize("name", PUT_IN)
def test_what_is_put_in_is_named_with_its_size(name: str) -> None:
    weighed = weighed_without(problem_with(name))
    assert judge(weighed).outcome == CAUSE
    assert weighed.answers.best == name
    best = next(fit for fit in weighed.ranked if fit.answer == name)
    (axis,) = best.axes
    assert axis.value(float(best.units[0])) == pytest.approx(PUT_IN[name][1], rel=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("name", WITHHELD)
def test_what_the_catalogue_does_not_have_is_called_nothing_else(name: str) -> None:
    weighed = weighed_without(problem_with(name), WITHHELD[name])
    shares = weighed.answers.by_answer
    assert shares["unknown"] > max(share for one, share in shares.items() if one != "unknown")
    assert judge(weighed).outcome in ("unknown", "untold")


@pytest.mark.slow
def test_a_law_beside_less_linear_damping_than_stated_is_the_best() -> None:
    problem = driven(Made(damping=45.0, quadratic=60.0), RUNS, 3, KNOWN)
    tried = ("damping", "viscous_damping", "quadratic_drag", "cubic_damping")
    causes = [one for one in causes_for(problem.trials) if one.name in tried]
    weighed = weigh(problem, causes, most=2)
    first, *others = damping_laws(weighed, judge(weighed).best, causes)
    assert first.name == "linear and quadratic"
    share, loss = (
        axis.value(float(unit))
        for axis, unit in zip(first.hypothesis.axes, first.hypothesis.units, strict=True)
    )
    assert share == pytest.approx(-0.25, abs=0.02)
    assert loss == pytest.approx(60.0 / (0.375 * MASS_KG), rel=0.02)
    assert all(one.told_apart for one in others)


@pytest.mark.slow
def test_a_drag_far_above_its_typical_size_is_found_as_any_power() -> None:
    problem = driven(Made(power=150.0), RUNS[:3], 3, KNOWN)
    tried = ("damping", "quadratic_drag", "power_drag")
    causes = [one for one in causes_for(problem.trials) if one.name in tried]
    weighed = weigh(problem, causes, most=1)
    best = judge(weighed).best
    assert best.names == ("power_drag",)
    assert best.axes[0].value(float(best.units[0])) == pytest.approx(0.4, abs=0.03)
    assert damping_laws(weighed, best, causes)[0].name == "any power"


@pytest.mark.slow
def test_nothing_put_in_is_none() -> None:
    assert weighed_without(driven(Made(), RUNS, 5, KNOWN)).answers.by_answer["none"] > 0.5


def test_a_third_harmonic_is_what_a_force_of_that_order_makes() -> None:
    time_s = np.append(0.0, np.arange(40.0, 50.0, 0.005))
    for trial, (frequency_hz, force_n) in zip(
        driven(Made(), RUNS[:2], 5, {}).trials, RUNS, strict=False
    ):
        first, third = (
            np.std(Made().motion(order * frequency_hz, force_n, time_s)[1:]) for order in (1, 3)
        )
        assert trial.third_harmonic == pytest.approx(third / first / 3.0, rel=1e-3)
