"""Each cause of a pendulum test is told as of the part of the test that it is about."""

import pytest

from analysis.gap.pendulum.causes import cause
from sim.pendulum.effects import by_name

# What somebody would take apart, turn or weigh to find it.
PARTS = {
    "bearing_friction": "damping",
    "quadratic_drag": "damping",
    "inertia": "inertia and restoring",
    "finite_amplitude": "inertia and restoring",
    "line_stretch": "lines",
    "off_level": "lines",
}


@pytest.mark.parametrize(("name", "part"), PARTS.items())
def test_a_cause_is_of_its_part(name: str, part: str) -> None:
    assert cause(by_name()[name]).stage == part
