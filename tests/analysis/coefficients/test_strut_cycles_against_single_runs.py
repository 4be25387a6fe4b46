"""All harmonics at once against each harmonic by itself: values, scatter and every correction."""

import math
from collections.abc import Callable
from dataclasses import replace

import control
import numpy as np
import pytest

from analysis.coefficients.corrections import (
    AmplifierFilter,
    Delay,
    response_at,
    zero_reading,
)
from analysis.coefficients.dry_run import without_dry
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.strut_cycle import StrutCycle, measured_cycle, static_cycle
from analysis.coefficients.strut_phasors import reading_phasors
from analysis.readers.dataset import from_dataset
from analysis.recording import Recording
from analysis.resolver.analysis import Analysis, analyse
from analysis.resolver.settings import ResolverSettings
from hardware.description.channels import Channel
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.h4_cubic_damping import CubicDamping
from sim.rig import SimulatedRig, vertical_rig
from sim.run import simulate
from tests.analysis.coefficients.cycles import CHANNEL_NAMES

POINT = SetPoint(0.8, 0.03, 0.4, 0.8)
RIG = CubicDamping().change(vertical_rig(), POINT)
MATRIX = np.array([[1.02, 0.03], [-0.01, 0.97]])


def read(
    point: SetPoint = POINT, rig: SimulatedRig = RIG, channels: tuple[str, ...] = CHANNEL_NAMES
) -> Analysis:
    record = simulate(rig, point, periods=8, sample_rate_hz=100.0, seed=3, name="run")
    return analyse(from_dataset(record), settings=ResolverSettings(channels=channels, harmonics=3))


@pytest.fixture(scope="module")
def analysis() -> Analysis:
    return read()


def alone(analysis: Analysis, order: int) -> Phasors:
    """What the resolver says of one harmonic, with the covariance of its channels."""
    found = reading_phasors(analysis.readings[0], CHANNEL_NAMES, order)
    return found.select([f"{name} {order}" for name in CHANNEL_NAMES])


def same(
    cycle: StrutCycle,
    analysis: Analysis,
    gauges: Callable[[int], np.ndarray] = lambda order: np.eye(2),
) -> None:
    """Every order of the cycle is the reading's own, its gauges changed, scatter included."""
    for order in (1, 2, 3):
        own = cycle.phasors.select([f"{name} {order}" for name in CHANNEL_NAMES])
        change = np.eye(4, dtype=complex)
        change[2:, 2:] = gauges(order)
        expected = alone(analysis, order).mapped(change)
        np.testing.assert_allclose(own.values, expected.values, rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(
            own.real.covariance(), expected.real.covariance(), rtol=1e-9, atol=1e-18
        )


def test_as_read(analysis: Analysis) -> None:
    same(measured_cycle(analysis, RIG.oscillator), analysis)


def test_orders_scatter_together(analysis: Analysis) -> None:
    covariance = measured_cycle(analysis, RIG.oscillator).phasors.real.covariance()
    first, third = slice(8, 16), slice(24, 32)
    assert np.abs(covariance[first, third]).max() > 0.0
    np.testing.assert_allclose(covariance, covariance.T, atol=1e-18)


def test_cross_talk(analysis: Analysis) -> None:
    cycle = measured_cycle(analysis, RIG.oscillator).calibrated(MATRIX)
    same(cycle, analysis, lambda _: MATRIX)
    with pytest.raises(ConfigurationError, match="not singular"):
        cycle.calibrated(np.ones((2, 2)))


@pytest.mark.parametrize(
    "response",
    [Delay(2e-3, 0.98), AmplifierFilter(20.0, 2, "bessel"), control.tf([1.0], [0.004, 1.0]),
     control.ss([[-250.0]], [[250.0]], [[1.0]], [[0.0]])],
    ids=["skew", "filter", "transfer function", "state space"],
)  # fmt: skip
def test_lag_by_transfer_function(analysis: Analysis, response) -> None:  # type: ignore[no-untyped-def]
    responses = {"force_aft": response, "force_fore": Delay(1e-3)}
    cycle = measured_cycle(analysis, RIG.oscillator).without_response(responses)

    def undone(order: int) -> np.ndarray:
        omega = 2.0 * math.pi * 0.8 * order
        return np.diag([1.0 / response_at(one, omega) for one in responses.values()])

    assert cycle.frequency_hz == pytest.approx(0.8, rel=1e-4)
    same(cycle, analysis, undone)


def test_a_filter_that_lets_no_third_harmonic_through_is_refused(analysis: Analysis) -> None:
    with pytest.raises(DataError, match="of harmonic 3 at"):
        measured_cycle(analysis, RIG.oscillator).without_response(
            {"force_aft": AmplifierFilter(1.2, 4)}
        )


def still(value: float, name: str) -> Recording:
    noise = np.random.default_rng(0).normal(0.0, 0.01, (2, 400))
    channels = (Channel("force_aft", "N"), Channel("force_fore", "N"))
    return Recording(name, channels, np.array([[value], [2.0 * value]]) + noise, 100.0)


def test_zero_runs_come_off_the_means_alone(analysis: Analysis) -> None:
    zero = zero_reading(still(1.5, "zero"))
    before = measured_cycle(analysis, RIG.oscillator)
    after = before.without_zero(zero)
    assert after.mean_known
    assert not before.mean_known
    for name in ("force_aft", "force_fore"):
        assert after.phasors[f"{name} 0"] == pytest.approx(
            alone(analysis, 0)[f"{name} 0"] - zero[name]
        )
        assert after.phasors[f"{name} 1"] == before.phasors[f"{name} 1"]
    same(after, analysis)


def test_a_dry_run_leaves_the_waters_loads() -> None:
    wet = measured_cycle(read(), RIG.oscillator).model()
    air = measured_cycle(read(replace(POINT, medium=Medium.AIR)), RIG.oscillator).model()
    left = without_dry(wet, air)
    taken = wet.without(RIG.body)
    assert [flag.code for flag in left.flags].count("dry_run_taken_off") == 1
    first, third = ((f"force {n}", f"moment {n}") for n in (1, 3))
    own, expected = (one.hull.phasors.select(first).values for one in (left, taken))
    np.testing.assert_allclose(own, expected, rtol=2e-3)
    own, expected = (one.phasors.select(third).values for one in (left, wet))
    np.testing.assert_allclose(own, expected, atol=0.1)
    with pytest.raises(ConfigurationError, match="a dry run was taken off"):
        left.without(RIG.body)


def test_set_points_stand_in_for_displacements() -> None:
    forces = ("force_aft", "force_fore")
    cycle = measured_cycle(read(rig=RIG.ideal(), channels=forces), RIG.oscillator)
    assert "motion_from_set_point" in [flag.code for flag in cycle.flags]
    measured = measured_cycle(read(rig=RIG.ideal()), RIG.oscillator)
    for name in ("displacement_aft 1", "displacement_fore 1"):
        assert cycle.phasors[name] == pytest.approx(measured.phasors[name], rel=1e-6)


def test_a_run_that_stands_still() -> None:
    reading = zero_reading(still(6.0, "drift"))
    zero = zero_reading(still(1.0, "zero"))
    point = SetPoint(0.0, 0.0, 0.0, 1.2, drift_rad=0.1)
    cycle = static_cycle("drift", reading, HORIZONTAL_1963, point).without_zero(zero).model()
    assert cycle.frequency_hz == 0.0
    assert cycle.mean_known
    assert cycle.phasors["force 0"].real == pytest.approx(15.0, abs=0.01)
    assert cycle.phasors["moment 0"].real == pytest.approx(5.0 * 0.5, abs=0.01)
    assert math.isclose(cycle.drift_rad, 0.1)
    assert len(cycle.phasors.real.contributions) == 2
