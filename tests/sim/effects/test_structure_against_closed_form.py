"""Structural effects against describing functions, over frequency, amplitude, phase and medium."""

import numpy as np
import pytest

from hardware.description.setpoint import Medium, SetPoint
from sim.effects.effect import Effect
from sim.effects.s1_gauge_compliance import GaugeCompliance
from sim.effects.s2_frame_compliance import FrameCompliance
from sim.effects.s3_coulomb_friction import CoulombFriction
from sim.effects.s4_stribeck_friction import StribeckFriction
from sim.effects.s5_load_friction import LoadDependentFriction
from sim.effects.s6_viscous_guides import ViscousGuides
from sim.effects.s7_cable import Cable
from sim.effects.s8_mass_error import MassError
from sim.effects.s9_inertia_error import InertiaError
from sim.effects.s10_entrained_water import EntrainedWater
from sim.effects.s11_strut_tare import StrutTare
from sim.rig import SimulatedRig, horizontal_rig, vertical_rig
from tests.sim.effects.against_theory import at_small_angles

PHASES = (0.0, np.pi / 2.0, np.pi)
IN_WATER = [SetPoint(f, a, p) for f in (0.4, 0.9) for a in (0.01, 0.03) for p in PHASES]
AHEAD = [SetPoint(0.7, 0.02, p, 1.2) for p in PHASES]
IN_AIR = [SetPoint(0.7, 0.02, p, 0.0, Medium.AIR) for p in PHASES]
SET_POINTS = IN_WATER + AHEAD + IN_AIR

CASES = [
    (GaugeCompliance(), 1e-9),
    (FrameCompliance(), 1e-9),
    (CoulombFriction(), 1e-3),
    (ViscousGuides(), 1e-9),
    (Cable(), 1e-3),
    (Cable(at_struts=0.6), 1e-3),
    (Cable(sliding_n=0.3), 2e-2),
    (Cable(sliding_n=3.0, slip_m=4e-3, at_struts=1.0), 1e-4),
    (Cable(preload_n=-3.0, stiffness_n_m2=200.0, stiffness_n_m3=4e3, rubbing_n_m=0.0), 1e-9),
    (MassError(), 1e-8),  # in air the weight's part along a pitching model, and so g theta^2
    (InertiaError(), 1e-9),
    # Where the model only turns no water sloshes: rounding over the least that counts.
    (EntrainedWater(), 1e-7),
    (EntrainedWater(5.0, 0.6, 0.1), 1e-7),
    (EntrainedWater(5.0, 0.6, 0.1, 0.7), 1e-7),
    (StrutTare(), 1e-3),
]

# Friction that changes fast about its jump: a finer period, the error falls with its points squared
# (Stribeck, whose peak is a tenth of the speed wide, is off by 1.5 % at 128 points).
SHARP = [
    (StribeckFriction(), 1e-3),
    (StribeckFriction(1.0, 0.2), 1e-4),
    (LoadDependentFriction(), 1e-4),
    (LoadDependentFriction(0.1, 500.0), 1e-4),
    (LoadDependentFriction(0.1, 30.0), 1e-4),
]


@pytest.mark.parametrize("rig", [vertical_rig(), horizontal_rig()], ids=["vertical", "horizontal"])
@pytest.mark.parametrize(("effect", "tolerance"), CASES)
def test_signature(effect: Effect, tolerance: float, rig: SimulatedRig) -> None:
    assert at_small_angles(effect, rig.ideal(), SET_POINTS) < tolerance


@pytest.mark.parametrize(("effect", "tolerance"), SHARP)
def test_signature_of_sharp_friction(effect: Effect, tolerance: float) -> None:
    assert at_small_angles(effect, vertical_rig().ideal(), SET_POINTS, points=512) < tolerance
