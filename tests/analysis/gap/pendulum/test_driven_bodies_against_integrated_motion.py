"""What a body under a known force has, put into its equation of motion, against a linear body."""

import pytest

from analysis.gap.pendulum.causes import causes_for
from analysis.gap.pendulum.search import weigh
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


@pytest.mark.parametrize("name", PUT_IN)
def test_what_is_put_in_is_named_with_its_size(name: str) -> None:
    made, size = PUT_IN[name]
    problem = driven(made, RUNS, 3, KNOWN)
    tried = [one for one in causes_for(problem.trials) if one.name in TRIED]
    weighed = weigh(problem, tried, most=1)
    assert judge(weighed).said == CAUSE
    assert weighed.answers.best == name
    best = weighed.sets[name]
    (axis,) = best.axes
    assert axis.value(float(best.units[0])) == pytest.approx(size, rel=0.02)


def test_nothing_put_in_is_none() -> None:
    problem = driven(Made(), RUNS, 5, KNOWN)
    tried = [one for one in causes_for(problem.trials) if one.name in TRIED]
    assert weigh(problem, tried, most=1).answers.by_answer["none"] > 0.5
