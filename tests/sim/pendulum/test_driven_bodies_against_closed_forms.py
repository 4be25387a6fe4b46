"""Oracle: Den Hartog's dry friction under a sine (1931), and what a period takes in and gives."""

import math

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from sim.pendulum.benches import decay_bench
from sim.pendulum.coordinates import HEAVE
from sim.pendulum.driven import DrivenBody, PeriodicForce, settled
from sim.pendulum.effects import make_effect
from sim.pendulum.record import record
from sim.pendulum.resistance import Resistance

MASS, STIFFNESS, FORCE = 70.0, 1000.0, 30.0
OMEGA = math.sqrt(STIFFNESS / MASS)
ORDERS = 23


def body(ratio: float, resistance: Resistance) -> DrivenBody:
    """Return a body under a cosine at a share of its natural frequency."""
    force = PeriodicForce(ratio * OMEGA, (FORCE,))
    return DrivenBody(50.0, 20.0, STIFFNESS, resistance, HEAVE, force)


@pytest.mark.parametrize("ratio", [0.7, 1.3, 1.6])
@pytest.mark.parametrize("share", [0.1, 0.3])
def test_dry_friction_leaves_the_largest_displacement_of_den_hartog(
    ratio: float, share: float
) -> None:
    found = settled(body(ratio, Resistance(coulomb=share * FORCE)), ORDERS)
    turns = np.linspace(0.0, 2.0 * math.pi, 2000)
    moved = np.real(found @ np.exp(1j * np.outer(np.arange(1, ORDERS + 1), turns)))
    magnified = 1.0 / (1.0 - ratio**2)
    lost = math.sin(math.pi / ratio) / (ratio * (1.0 + math.cos(math.pi / ratio)))
    expected = FORCE / STIFFNESS * math.sqrt(magnified**2 - (share * lost) ** 2)
    assert moved.max() == pytest.approx(expected, rel=2e-4)


@pytest.mark.parametrize("ratio", [0.6, 1.0, 1.5])
def test_force_and_drag_do_the_same_work_over_a_period(ratio: float) -> None:
    quadratic = 40.0
    found = settled(body(ratio, Resistance(viscous=10.0, quadratic=quadratic)), ORDERS)
    turns = 2.0 * math.pi * np.arange(4096) / 4096
    speeds = 1j * ratio * OMEGA * np.arange(1, ORDERS + 1) * found
    v = np.real(speeds @ np.exp(1j * np.outer(np.arange(1, ORDERS + 1), turns)))
    given = np.mean(FORCE * np.cos(turns) * v)
    assert given == pytest.approx(np.mean(10.0 * v**2 + quadratic * np.abs(v) ** 3), rel=1e-5)


def test_harmonics_of_a_linear_body_are_those_of_its_impedance() -> None:
    force = PeriodicForce(3.0, (FORCE, 0.0, 5j))
    found = settled(DrivenBody(50.0, 20.0, STIFFNESS, Resistance(viscous=60.0), HEAVE, force), 4)
    for order, push in ((1, FORCE), (3, 5j)):
        w = 3.0 * order
        assert found[order - 1] == pytest.approx(push / (STIFFNESS - w**2 * MASS + 60j * w))
    assert found[1] == found[3] == 0.0


def test_record_from_rest_on_comes_to_the_impedances_motion_late_by_the_clock() -> None:
    force, delay_s = PeriodicForce(3.0, (FORCE * 1j, 0.0, 5.0)), 0.04
    driven = DrivenBody(50.0, 20.0, STIFFNESS, Resistance(viscous=60.0), HEAVE, force)
    late = make_effect("sensor_delay", delay_s=delay_s)(decay_bench(driven, release=0.0))
    run = record(late, duration_s=50.0, sample_rate_hz=20.0, seed=1).dataset
    true_s = run["time"].values - delay_s
    expected = np.zeros(true_s.size)
    for order, push in ((1, FORCE * 1j), (3, 5.0)):
        w = 3.0 * order
        reached = push / (STIFFNESS - w**2 * MASS + 60j * w)
        expected += np.real(reached * np.exp(1j * w * true_s))
    np.testing.assert_allclose(run["heave"].values[-200:], expected[-200:], atol=1e-8)


def test_friction_that_holds_the_body_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="holds the body against its force"):
        settled(body(0.5, Resistance(coulomb=1.1 * FORCE)), 3)
