"""Oracle: closed forms of what the other forms of an effect do."""

import math
from dataclasses import replace

import numpy as np
import pytest

from hardware.description.arrays import ComplexArray
from hardware.description.setpoint import SetPoint
from sim.effects import typical
from sim.effects.campaign import CampaignRun
from sim.effects.d1b_torque_cogging import TorqueCogging
from sim.effects.d5_guide_friction import GuideFriction
from sim.effects.effect import Effect
from sim.effects.h6_memory import Memory
from sim.effects.h7_tank_walls import TankWalls
from sim.effects.h11_carriage_speed import CarriageSpeedError
from sim.effects.h15_dynamic_trim import DynamicTrim
from sim.effects.k6_joint_play import JointPlay
from sim.effects.k6b_free_play import FreePlay
from sim.effects.m6_zero_drift import ZeroDrift
from sim.effects.m6b_campaign_drift import CampaignDrift
from sim.effects.m8_temperature import Temperature
from sim.effects.s1_gauge_compliance import GaugeCompliance
from sim.effects.s8_mass_error import MassError
from sim.effects.situation import Situation
from sim.effects.switching import switch_on
from sim.model.force_law import LawInput
from sim.model.laws import Spring, Stiffening
from sim.rig import SimulatedRig, vertical_rig
from sim.run import steady_run
from sim.stage import Block

RIG = vertical_rig().ideal()
SET_POINT = SetPoint(0.7, 0.02, 0.6, 1.2)
OMEGA = 2.0 * math.pi * SET_POINT.frequency_hz
PHASE = 2.0 * math.pi * (np.arange(20_000) + 0.5) / 20_000


def on(effect: Effect, set_point: SetPoint = SET_POINT, rig: SimulatedRig = RIG) -> SimulatedRig:
    return switch_on([effect], rig, set_point)[0]


@pytest.mark.parametrize("exponent", [0.0, 0.1, 1.0, 1.5, 2.0, 3.0, 4.0])
def test_shares_of_powers(exponent: float) -> None:
    """First harmonic of |cos|^n sgn(cos), second of |cos|^n, as sums."""
    size = np.abs(np.cos(PHASE)) ** exponent
    odd = 2.0 * np.mean(size * np.sign(np.cos(PHASE)) * np.cos(PHASE))
    assert typical.power_share(exponent) == pytest.approx(odd, rel=1e-4)
    if exponent >= 1.0:
        even = 2.0 * np.mean(size * np.cos(2.0 * PHASE))
        assert typical.even_share(exponent) == pytest.approx(even, rel=1e-6)


@pytest.mark.parametrize(("even", "order"), [(True, 2), (False, 1)])
def test_stiffening(even: bool, order: int) -> None:
    x = 0.03 * np.cos(PHASE)
    nothing = np.zeros_like(x)
    law = Stiffening(2.0, 0.02, 2.5, even)
    force = law.force(LawInput(x, nothing, nothing, nothing, nothing, 0.0, nothing))
    share = typical.even_share(2.5) if even else typical.power_share(2.5)
    found = 2.0 * np.mean(force * np.cos(order * PHASE))
    assert found == pytest.approx(2.0 * 1.5**2.5 * share, rel=1e-6)
    assert law.scaled(3.0).stiffening_n == 6.0


@pytest.mark.parametrize("form", Memory().forms())
def test_memory_of_several_rates(form: Memory) -> None:
    """The sum of K_i/(beta_i + s), as large as the one of one rate at the typical frequency."""
    radiation = on(form).radiation
    assert radiation is not None
    rest = 1.0 - form.slow
    shares = {5.0: rest * (1.0 - form.quick), 1.25: form.slow, 20.0: rest * form.quick}
    at = np.array([0.5, 1.0, 3.0]) * typical.omega_rad_s(RIG)
    wanted = np.array([sum(k / (rate + 1j * w) for rate, k in shares.items()) for w in at])
    wanted *= 200.0 / abs(wanted[1]) / abs(5.0 + 1j * at[1])
    found = radiation.damping(at)[:, 0, 0] + 1j * at * (radiation.added_mass(at)[:, 0, 0])
    np.testing.assert_allclose(found, wanted, rtol=1e-9)


def test_walls_that_take_more_of_short_waves() -> None:
    """Each mode's peak is as strong as the power of its frequency says."""
    plain, falling = (on(TankWalls(falls=falls)).radiation for falls in (0.0, 1.0))
    assert plain is not None
    assert falling is not None
    modes = np.array([3.82, 5.42])  # w of whole waves in 4.2 m
    ratio = falling.damping(modes)[:, 0, 0] / plain.damping(modes)[:, 0, 0]
    np.testing.assert_allclose(ratio, typical.omega_rad_s(RIG) / modes, rtol=0.02)


def test_gauges_that_are_unlike() -> None:
    """(1 + Z G)^-1 Z y with G of each gauge."""
    effect = GaugeCompliance(5e4, 300.0, unlike=0.3)
    situation = Situation.of(RIG, SET_POINT)
    s = 1j * situation.omega
    give = np.diag([1.0 / (5e4 / share + s * 300.0) for share in (1.3, 0.7)])
    stiff = situation.impedance(1)
    wanted = np.linalg.solve(np.eye(2) + stiff @ give, stiff @ situation.displacement())
    steady = steady_run(on(effect), SET_POINT)
    found = np.array([1j * steady.referred(f"recorded_force_{end}")[1] for end in ("aft", "fore")])
    assert np.linalg.norm(found - wanted) < 5e-3 * np.linalg.norm(wanted)  # small angles
    alike = on(replace(effect, unlike=0.0))
    assert on(effect, rig=alike).mounting.gauge_unlike == pytest.approx(0.15)


def test_play_that_is_unlike() -> None:
    rig = on(JointPlay(1e-4, unlike=0.3))
    assert rig.linkage_aft.half_play_m == pytest.approx(1.3e-4)
    assert rig.linkage_fore.half_play_m == pytest.approx(0.7e-4)


def test_free_play_that_is_unlike_is_its_mirror_image() -> None:
    """On a rig that is alike fore and aft, in heave: the other sign is the other strut."""
    symmetric = replace(RIG, body=replace(RIG.body, cg_x_m=0.0))
    diagonal = replace(
        symmetric.water,
        **{
            name: ((matrix[0][0], 0.0), (0.0, matrix[1][1]))
            for name in ("added_mass", "damping", "restoring")
            for matrix in (getattr(symmetric.water, name),)
        },
    )
    rig, heave = replace(symmetric, water=diagonal), SetPoint(1.0, 0.02)

    def forces(unlike: float) -> ComplexArray:
        spectra = steady_run(on(FreePlay(unlike=unlike), heave, rig), heave).spectra
        return np.array([spectra["force_aft"][:4], spectra["force_fore"][:4]])

    one, other = forces(0.3), forces(-0.3)
    assert np.abs(one - other[::-1]).max() < 1e-6 * np.abs(one).max()
    assert np.abs(one[0] - one[1]).max() > 1e-4 * np.abs(one).max()


def test_a_tachometers_zero() -> None:
    """As large at 1 m/s, half of it at 2, nothing at rest."""
    effect = CarriageSpeedError(0.01, steady=1.0)
    for speed, error in ((1.0, 0.01), (2.0, 0.005), (0.0, 0.0)):
        rig = on(effect, SetPoint(0.7, 0.02, 0.0, speed))
        assert rig.carriage.speed_error == pytest.approx(error)


def test_trim_of_another_power() -> None:
    """As large at 1 m/s; 1.5 times as large at 1.5 m/s."""
    stiff = []
    for speed in (1.0, 1.5):
        set_point = SetPoint(0.7, 0.02, 0.0, speed)
        laws = [on(one, set_point).forces[0].law for one in (DynamicTrim(power=3.0), DynamicTrim())]
        sizes = [law.stiffness_n_m for law in laws if isinstance(law, Spring)]
        stiff.append(sizes[0] / sizes[1])
    assert stiff == pytest.approx([1.0, 1.5])


def test_a_lump_that_lies_ahead() -> None:
    """Moments of the mass about the midpoint: of the model as weighed, and of 0.7 kg there."""
    body, real = RIG.body, on(MassError(0.01, ahead=0.5)).body
    at_m = body.cg_x_m + 0.25
    assert real.mass_kg == pytest.approx(70.7)
    moment = 70.0 * body.cg_x_m + 0.7 * at_m
    assert real.mass_kg * real.cg_x_m == pytest.approx(moment)
    more = 0.7 * (at_m**2 - body.cg_x_m**2)
    assert real.inertia_kg_m2 == pytest.approx(body.inertia_kg_m2 + more)


def test_oil_loses_as_much() -> None:
    """4 F/pi of friction against b V, at the typical speed."""
    guides = on(GuideFriction(5.0, oil=0.5)).drive.guides
    viscous = guides.viscous_n_s_m * typical.speed_m_s(RIG)
    assert guides.coulomb_n == 2.5
    assert viscous == pytest.approx(2.5 * 4.0 / math.pi)


def test_cogging_with_its_double() -> None:
    """T/(J k^2 w^2) of each, as ripples of the speed k times as large."""
    ripple = on(TorqueCogging(0.5, 2.0, 0.3, 5.0, double=0.4, double_phase_rad=1.0)).drive.ripple
    sizes = {one.order: one.relative for one in ripple}
    expected = {2: 0.5 / (5.0 * 2.0 * OMEGA**2), 4: 0.2 / (5.0 * 4.0 * OMEGA**2)}
    assert sizes == pytest.approx(expected)


def test_zeros_that_settle() -> None:
    """As far after half a minute; the zero is taken as the record begins."""
    force = np.zeros(2)
    for form in (ZeroDrift(1e-3, 0.0), *ZeroDrift(1e-3, 0.0).forms()):
        gauge = on(form).dynamometers.aft
        later = Block(60, 2, 2.0)  # 30 and 30.5 s
        reading = gauge.drifting_from(0.0).read(None, later, force)[1]
        assert reading[0] == pytest.approx(0.03, rel=1e-12)
        begun = gauge.drifting_from(5.0).read(None, Block(10, 1, 2.0), force[:1])[1]
        assert begun[0] == pytest.approx(0.0, abs=1e-15)
        assert gauge.without_drift().read(None, later, force)[1][0] == 0.0


def at(since_start_s: float) -> CampaignRun:
    return CampaignRun(index=3, since_start_s=since_start_s, waited_s=100.0, before=None)


@pytest.mark.parametrize("form", CampaignDrift().forms())
def test_campaigns_that_settle(form: CampaignDrift) -> None:
    """As far after half an hour, and the drift within a run is the slope of that way."""
    zeros = [
        on(form.at_run(at(since))).dynamometers.aft.zero_drifted_n
        for since in (1800.0, 3600.0, 3610.0)
    ]
    assert zeros[0] == pytest.approx(2e-4 * 1800.0)
    assert zeros[1] < 2.0 * zeros[0]
    slope = on(form.at_run(at(3605.0))).dynamometers.aft.zero_drift_n_s
    assert (zeros[2] - zeros[1]) / 10.0 == pytest.approx(slope, rel=1e-4)


def test_a_hall_that_settles() -> None:
    (form,) = Temperature().forms()
    assert isinstance(form, Temperature)
    rises = [form.at_run(at(3600.0 * hours)).rise_k for hours in (0.0, 4.0, 100.0)]
    assert rises == pytest.approx([0.0, 2.0, 2.0 / (1.0 - math.exp(-2.0))])
