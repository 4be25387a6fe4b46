"""Effects of the linkage against Fourier series, over frequency, amplitude, phase and medium."""

from dataclasses import replace

import numpy as np
import pytest

from hardware.description.arrangement import DriftBy, Gauges, Joint, Pivot
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.agreement import simulated_signature
from sim.effects.effect import Effect
from sim.effects.k1_connecting_rod import ConnectingRod
from sim.effects.k2_slot_tilt import SlotTilt
from sim.effects.k3_eccentricity_error import EccentricityError
from sim.effects.k4_strut_phase_error import StrutPhaseError
from sim.effects.k5_foreshortening import Foreshortening
from sim.effects.k6_joint_play import JointPlay
from sim.effects.k7_drift_arrangement import DriftArrangement
from sim.effects.m9_gauges_turned import GaugesTurned
from sim.effects.situation import Situation
from sim.model.water.force_laws import SurgeForces
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from tests.sim.effects.against_theory import at_small_angles, mismatch

PHASES = (0.0, np.pi / 3.0, np.pi)
IN_WATER = [SetPoint(f, a, p) for f in (0.4, 0.9) for a in (0.01, 0.03) for p in PHASES]
AHEAD = [SetPoint(0.7, a, p, 1.2) for a in (0.01, 0.03) for p in PHASES]
IN_AIR = [SetPoint(0.7, a, p, 0.0, Medium.AIR) for a in (0.01, 0.03) for p in PHASES]
SET_POINTS = IN_WATER + AHEAD + IN_AIR
SMALL = [SetPoint(f, 0.01, p) for f in (0.4, 0.9) for p in PHASES]

FORCES = ("force_aft", "force_fore", "force_x")

CASES = [
    (ConnectingRod(), 1e-6),  # the series ends at (e/L)^5
    (ConnectingRod(-1.5), 1e-6),
    (ConnectingRod(-0.5, rod_offset_m=0.002), 1e-3),
    # The series ends at the first power of the offset, whose square is (o/L)^2 of the second order.
    (ConnectingRod(0.5, rod_offset_m=0.002), 1e-3),
    (SlotTilt(), 1e-10),
    (SlotTilt(-0.01, 0.02), 1e-10),
    (EccentricityError(), 1e-10),
    (EccentricityError(-5e-4, 3e-4), 1e-10),
    (StrutPhaseError(), 1e-10),
]


@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig()], ids=["vertical", "horizontal"])
@pytest.mark.parametrize(("effect", "tolerance"), CASES)
def test_signature(effect: Effect, tolerance: float, rig: SimulatedRig) -> None:
    assert mismatch(effect, rig.ideal(), SET_POINTS) < tolerance


@pytest.mark.parametrize("effect", [SlotTilt(), EccentricityError(), StrutPhaseError()])
def test_signature_on_cranks_with_rods(effect: Effect) -> None:
    # The rod's series ends at (e/L)^5.
    assert mismatch(effect, horizontal_rig(1.5).ideal(), SET_POINTS) < 1e-6


@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig()], ids=["vertical", "horizontal"])
@pytest.mark.parametrize("joint", [Joint.SLIDES_ON_MODEL, Joint.SLIDES_ON_RIG])
@pytest.mark.parametrize("pivot", Pivot)
def test_foreshortening(rig: SimulatedRig, joint: Joint, pivot: Pivot) -> None:
    # The leading term leaves out (e/l)^2 of itself, 4e-4 here, times the numbers of the next one.
    given = replace(rig.ideal(), oscillator=replace(rig.oscillator, joint=joint, pivot=pivot))
    assert mismatch(Foreshortening(), given, SMALL) < 2e-3


@pytest.mark.sample(7)
@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig()], ids=["vertical", "horizontal"])
@pytest.mark.parametrize("joint", [Joint.SLIDES_ON_MODEL, Joint.SLIDES_ON_RIG])
@pytest.mark.parametrize("pivot", Pivot)
@pytest.mark.parametrize("gauges", Gauges)
def test_gauges_that_turn_otherwise(
    rig: SimulatedRig, joint: Joint, pivot: Pivot, gauges: Gauges
) -> None:
    named = replace(rig.oscillator, joint=joint, pivot=pivot, gauges=gauges)
    given = replace(rig.ideal(), oscillator=named, surge=SurgeForces(x_uu=-6.0, x_vr=9.0))
    assert mismatch(GaugesTurned(), given, [*SMALL, *AHEAD]) < 1e-6


DRIFTING = [SetPoint(0.9, 1e-4, p, 1.2, drift_rad=1e-7) for p in PHASES]
DRIFTING += [SetPoint(0.7, 1e-4, p, 0.0, Medium.AIR, -1e-7) for p in PHASES]


@pytest.mark.sample(11)
@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig()], ids=["vertical", "horizontal"])
@pytest.mark.parametrize("joint", [Joint.SLIDES_ON_MODEL, Joint.SLIDES_ON_RIG])
@pytest.mark.parametrize("pivot", Pivot)
@pytest.mark.parametrize("gauges", Gauges)
@pytest.mark.parametrize("drift_by", DriftBy)
@pytest.mark.parametrize("way", [1.0, 2.0])
def test_drift_set_in_another_way(
    rig: SimulatedRig, joint: Joint, pivot: Pivot, gauges: Gauges, drift_by: DriftBy, way: float
) -> None:
    arrangement = {"joint": joint, "pivot": pivot, "gauges": gauges, "drift_by": drift_by}
    named = replace(rig.oscillator, **arrangement)
    given = replace(rig.ideal(), oscillator=named, surge=SurgeForces(-2.0, -6.0, x_vr=9.0))
    effect = DriftArrangement(way)
    for set_point in DRIFTING:
        situation = Situation.of(given, set_point)
        theory = effect.signature(situation)
        keys = [(name, order) for name in FORCES for order in range(3)]
        found = simulated_signature(effect, given, set_point, keys)
        gap = np.linalg.norm([found[key] - theory.get(key, 0.0) for key in keys])
        # Angles are 2e-4, times the numbers of the next term; where there is nothing, rounding.
        rounding = abs(set_point.drift_rad) * np.linalg.norm(situation.force())
        assert gap < 5e-3 * np.linalg.norm(list(theory.values())) + 2e-5 * rounding


def test_drift_set_in_another_way_is_nothing_without_a_drift() -> None:
    straight = SetPoint(0.9, 0.02, 1.0, 1.2)
    rig = replace(horizontal_rig().ideal(), surge=SurgeForces(-2.0, -6.0))
    effect, keys = DriftArrangement(2.0), [(name, 1) for name in FORCES]
    assert not effect.signature(Situation.of(rig, straight))
    assert not any(simulated_signature(effect, rig, straight, keys).values())


@pytest.mark.parametrize("half_play_m", [5e-5, 5e-4])
def test_joint_play(half_play_m: float) -> None:
    # Where contact begins the motion has a kink; its error falls with the square of the points.
    effect = JointPlay(half_play_m)
    # Its harmonics fall with the order squared: those that are left out are not in the products.
    assert at_small_angles(effect, vertical_rig().ideal(), SET_POINTS, points=512) < 1e-3
