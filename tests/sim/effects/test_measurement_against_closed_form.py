"""Effects of the measurement against closed forms, over frequency, amplitude, phase, medium."""

from dataclasses import MISSING, fields, replace

import numpy as np
import pytest

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.campaign import in_order
from sim.effects.effect import Effect
from sim.effects.h3_quadratic_damping import QuadraticDamping
from sim.effects.m1_gain_error import GainError
from sim.effects.m2_cross_talk import CrossTalk
from sim.effects.m3_quadratic_gauge import QuadraticGauge
from sim.effects.m4_gauge_hysteresis import GaugeHysteresis
from sim.effects.m5_zero_offset import ZeroOffset
from sim.effects.m6_zero_drift import ZeroDrift
from sim.effects.m6b_campaign_drift import CampaignDrift
from sim.effects.m7_saturation import Saturation
from sim.effects.m8_temperature import Temperature
from sim.effects.situation import RECORDED_FORCES, Situation
from sim.effects.switching import switch_on
from sim.model.force_law import ForceLaw, LawInput
from sim.model.friction import Coulomb
from sim.model.law_point import Acting, Point
from sim.model.laws import LAWS
from sim.model.water.force_laws import CrossFlow
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from sim.run import steady_run
from tests.sim.effects.against_theory import at_small_angles
from tests.sim.effects.in_time import by_cycles, in_time

VERTICAL = vertical_rig().ideal()
CRANK = horizontal_rig(rod_length_m=1.5).ideal()
# With a mean force at the aft strut, so that products of mean and first order are there.
LOADED = replace(VERTICAL, forces=(Acting(Coulomb(0.0, 4.0), Point.AFT),))
SET_POINTS = [
    SetPoint(frequency, amplitude, phase, speed, medium)
    for frequency in (0.4, 0.9)
    for amplitude in (0.01, 0.03)
    for phase in (0.0, np.pi / 2.0, np.pi)
    for speed, medium in ((0.0, Medium.WATER), (1.2, Medium.WATER), (0.0, Medium.AIR))
]


@pytest.mark.parametrize(
    ("effect", "rig", "tolerance"),
    [
        (GainError(0.005, -0.02), VERTICAL, 1e-9),
        (GainError(0.005, -0.02), CRANK, 1e-9),
        (CrossTalk(0.01, -0.03, 0.05), VERTICAL, 1e-9),
        (CrossTalk(0.01, -0.03), CRANK, 1e-9),
        (QuadraticGauge(1e-5), VERTICAL, 1e-9),
        (QuadraticGauge(1e-5), CRANK, 1e-9),
        (GainError(0.005, -0.02), LOADED, 1e-9),
        (QuadraticGauge(1e-5), LOADED, 1e-9),
        (GaugeHysteresis(1e-5), LOADED, 1e-3),
        # The points of the period miss the turn of the force by up to half a step: (pi/128)^2.
        (GaugeHysteresis(1e-5), VERTICAL, 1e-3),
        (ZeroOffset(0.3, -0.1), VERTICAL, 1e-9),
        (Temperature(), VERTICAL, 1e-9),
        (Temperature(hours=8.0, rate_k_h=-1.0), CRANK, 1e-9),
    ],
)
def test_signature(effect: Effect, rig: SimulatedRig, tolerance: float) -> None:
    assert at_small_angles(effect, rig, SET_POINTS) < tolerance


@pytest.mark.sample(13)
@pytest.mark.parametrize("limits", [(0.9, 0.9), (0.5, 0.5), (0.8, 5.0), (5.0, 0.6)])
@pytest.mark.parametrize("set_point", SET_POINTS[::4])
@pytest.mark.parametrize("rig", [VERTICAL, LOADED])
def test_saturation(rig: SimulatedRig, limits: tuple[float, float], set_point: SetPoint) -> None:
    """Limits as parts of the force, so that all set-points reach them.

    The corners have harmonics with 1/n^2, of which the period's points fold some back: 1e-3.
    """
    peak = float(np.abs(Situation.of(rig, set_point).force()).max())
    effect = Saturation(limits[0] * peak, limits[1] * peak)
    assert at_small_angles(effect, rig, [set_point], points=1024) < 1e-3


def test_saturation_at_nine_tenths() -> None:
    """A symmetric limit at 0.9 of the force leaves 3.2 % at the third order."""
    situation = Situation.of(VERTICAL, SetPoint(0.9, 0.03))
    force = situation.force()[0]
    effect = Saturation(0.9 * abs(force), 0.9 * abs(force))
    third = effect.signature(situation)[RECORDED_FORCES[0], 3]
    assert abs(third / force) == pytest.approx(0.032, abs=5e-4)


@pytest.mark.parametrize("periods", [1, 7])
@pytest.mark.parametrize("set_point", SET_POINTS[::7])
def test_drift_in_the_time_domain(set_point: SetPoint, periods: int) -> None:
    """Whole periods from the pulse, by the trapezoid rule: (2 pi n/512)^2/12 of it at order n."""
    effect = ZeroDrift(2e-3, -1e-3)
    theory = effect.signature(Situation.of(VERTICAL, set_point))
    nominal = in_time(VERTICAL, set_point, periods, 512)
    changed = in_time(effect.change(VERTICAL, set_point), set_point, periods, 512)
    gap = [
        by_cycles(changed, name, periods)[order] - by_cycles(nominal, name, periods)[order] - value
        for (name, order), value in theory.items()
    ]
    assert np.linalg.norm(gap) < 1e-3 * np.linalg.norm(list(theory.values()))


@pytest.mark.parametrize("set_point", SET_POINTS[::11])
def test_drift_over_a_campaign_in_the_time_domain(set_point: SetPoint) -> None:
    """The orders as those of the drift within a run; the mean when the run begins, and its growth.

    The window of whole periods from the first pulse, half a period in, is centred half a period
    and half its length after the run's beginning.
    """
    effect, periods = CampaignDrift(2e-3, -1e-3, 600.0), 7
    theory = effect.signature(Situation.of(VERTICAL, set_point))
    nominal = in_time(VERTICAL, set_point, periods, 512)
    changed = in_time(effect.change(VERTICAL, set_point), set_point, periods, 512)
    middle_s = 0.5 * (1 + periods) / set_point.frequency_hz
    grown = dict(zip(RECORDED_FORCES, (2e-3 * middle_s, -1e-3 * middle_s), strict=True))
    for name in RECORDED_FORCES:
        both = [by_cycles(one, name, periods) for one in (changed, nominal)]
        found = both[0] - both[1]
        assert found[0] == pytest.approx(theory[name, 0] + grown[name], rel=1e-9)
        stated = np.array([theory[name, order] for order in (1, 2, 3)])
        assert np.linalg.norm(found[1:4] - stated) < 1e-3 * np.linalg.norm(stated)


def test_drift_over_a_campaign_in_its_records_at_rest() -> None:
    """Two zero runs an hour apart read drift times that hour more, to the zero's millisecond."""
    at_rest = SetPoint(0.5, 0.0)
    runs = in_order([at_rest] * 4, duration_s=900.0, waiting_s=300.0)
    effect = CampaignDrift(2e-4, -1e-4)
    means = []
    for place in (runs[0], runs[-1]):
        rig, set_point = switch_on([effect], VERTICAL, at_rest, place)
        record = in_time(rig, set_point, 5, 128)
        means.append([record.signals[name].mean() for name in RECORDED_FORCES])
    np.testing.assert_allclose(np.diff(means, axis=0)[0], [0.72, -0.36], rtol=1e-6)
    # A zero that is taken before each of them shows none of it.
    changed = [switch_on([ZeroDrift(2e-4, -1e-4)], VERTICAL, at_rest, run)[0] for run in runs]
    assert changed[0] == changed[-1]


def test_temperature_follows_the_order_of_the_runs() -> None:
    """The same set-point, first and last: its zero has moved by rate times time."""
    effect = Temperature(rate_k_h=0.5, zero_n_k=0.05)
    set_points = [SET_POINTS[0], *SET_POINTS[:3], SET_POINTS[0]]
    runs = in_order(set_points, duration_s=600.0, waiting_s=1200.0)
    situation = Situation.of(VERTICAL, SET_POINTS[0])
    first, last = (effect.at_run(runs[i]).signature(situation) for i in (0, -1))
    assert first[RECORDED_FORCES[0], 0] == 0.0
    assert last[RECORDED_FORCES[0], 0] == pytest.approx(0.5 * 2.0 * 0.05, rel=1e-12)
    at_last = effect.at_run(runs[-1])
    assert at_small_angles(at_last, VERTICAL, [SET_POINTS[0]]) < 1e-9


@pytest.mark.parametrize("first", [True, False])
def test_temperature_scales_what_other_effects_ask_of_the_water(first: bool) -> None:
    """8/(3 pi) B w^2 a^2 of quadratic damping goes with the density, whatever the order."""
    set_point = SetPoint(0.5, 0.03, 0.0)
    warm = Temperature(1.0, 10.0, gain_1_k=0.0, zero_n_k=0.0, damping_1_k=0.0, density_1_k=-4e-4)
    drag = QuadraticDamping(1000.0, 0.0)
    both = (warm, drag) if first else (drag, warm)

    def force(*effects: Effect) -> complex:
        spectra = steady_run(*switch_on(effects, VERTICAL, set_point)).spectra
        return complex(spectra["force_aft"][1] + spectra["force_fore"][1])

    cold, hot = force(drag) - force(), force(*both) - force(warm)
    assert abs(hot / cold - (1.0 - 4e-3)) < 1e-9
    closed = 8.0 / (3.0 * np.pi) * 1000.0 * (np.pi * 0.03) ** 2
    assert cold.real == pytest.approx(closed, rel=1e-5)


def test_temperature_scales_coupled_loads_and_leaves_what_is_not_of_the_water() -> None:
    flow = CrossFlow(((2.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 3.0)), None)
    dry = Acting(Coulomb(0.3), Point.AFT)
    warm = Temperature(1.0, 10.0, density_1_k=-2e-4)
    changed = warm.change(replace(VERTICAL, cross_flow=flow, forces=(dry,)), SET_POINTS[0])
    assert changed.forces == (dry,)
    assert changed.cross_flow is not None
    np.testing.assert_allclose(changed.cross_flow.cubic, np.array(flow.cubic) * 0.998, rtol=1e-15)


@pytest.mark.parametrize("law", LAWS)
def test_a_scaled_law_asks_for_more(law: type[ForceLaw]) -> None:
    needed = [one.name for one in fields(law) if one.default is MISSING]  # type: ignore[arg-type]
    needed = needed or ["stiffness_n_m", "stiffness_n_m2", "stiffness_n_m3", "preload_n"]
    one = law(**dict(zip(needed, (0.3, 0.7, 0.2, 0.1), strict=False)))
    t = np.linspace(0.0, 1.0, 9)
    motion = LawInput(0.01 * t, np.cos(4.0 * t), np.sin(t), 5.0 + t, t, 0.01, np.ones_like(t))
    assert np.abs(one.force(motion)).max() > 0.0
    np.testing.assert_allclose(one.scaled(1.5).force(motion), 1.5 * one.force(motion), rtol=1e-12)


def test_a_law_that_does_not_say_what_it_grows_with_is_not_scaled() -> None:
    class Own(ForceLaw):
        def force(self, motion: LawInput) -> FloatArray:
            return motion.position

    with pytest.raises(ConfigurationError, match="Own cannot be scaled: name in its"):
        Own().scaled(2.0)


@pytest.mark.parametrize("saturates", [1e-300, 1e-9, 1e-5])
def test_a_loop_that_hardly_any_force_widens_further_is_rayleighs(saturates: float) -> None:
    slight = GaugeHysteresis(1e-5, saturates=saturates).change(VERTICAL, SetPoint(0.5, 0.02))
    assert slight == GaugeHysteresis(1e-5).change(VERTICAL, SetPoint(0.5, 0.02))
