"""Records at rest beside runs: they show what has no motion to act on, and leave all else alone."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import ClassVar, TypeVar

import numpy as np
import pytest

from analysis.coefficients.corrections import ZERO_BLOCKS
from analysis.gap.design.forecast import planned
from analysis.gap.forward.simulator import Simulator
from analysis.gap.judge.diagnosis import Diagnosis, Settings, diagnose
from analysis.gap.observe.at_rest import run_at_rest
from analysis.gap.observe.components import GapRun, Part, Stack
from analysis.gap.observe.regimes import regimes
from analysis.gap.search.fit import expected_evidence
from analysis.readers.dataset import from_dataset
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.setpoint import Medium, SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.catalogue import catalogue
from sim.effects.effect import Effect, Signature, StageName, parameter
from sim.effects.h8_surface_suction import SurfaceSuction
from sim.effects.m5_zero_offset import ZeroOffset
from sim.effects.m6_zero_drift import ZeroDrift
from sim.effects.m6b_campaign_drift import CampaignDrift
from sim.effects.s3_coulomb_friction import CoulombFriction
from sim.effects.situation import RECORDED_FORCES, Situation, at_struts
from sim.effects.switching import switch_on
from sim.model.force_law import ForceLaw, LawInput
from sim.model.law_point import Acting, Point
from sim.rest import rig_at_rest
from sim.rig import SimulatedRig
from sim.run import simulate
from tests.analysis.gap.small import problem_of, record

E = TypeVar("E", bound=Effect)

STANDS = SetPoint(1.0, 0.0)
LENGTH_S = 30.0
RATE_HZ = 64.0
BETWEEN_S = 800.0  # from one record at rest to the next


@dataclass(frozen=True)
class Uneven(ForceLaw):
    """Friction that is larger one way than the other; nothing where nothing moves."""

    uneven_n: float

    strengths: ClassVar[tuple[str, ...]] = ("uneven_n",)

    def force(self, motion: LawInput) -> FloatArray:
        return -self.uneven_n * np.expm1(-((motion.velocity / 0.02) ** 2))


@dataclass(frozen=True)
class UnevenFriction(Effect):
    """A mean of the aft force, as a zero offset has it, while the model moves."""

    code: ClassVar[str] = "X1"
    name: ClassVar[str] = "uneven-friction"
    title: ClassVar[str] = "Friction that differs from one direction to the other"
    stage: ClassVar[StageName] = StageName.STRUCTURE

    uneven_n: float = parameter(0.3, -5.0, 5.0, "N", "half of what it differs by")

    def change(self, rig: SimulatedRig, set_point: SetPoint) -> SimulatedRig:
        return replace(rig, forces=(*rig.forces, Acting(Uneven(self.uneven_n), Point.AFT)))

    def signature(self, situation: Situation) -> Signature:
        return at_struts(np.array([self.uneven_n, 0.0]), 0, RECORDED_FORCES)


MOVING = (UnevenFriction, CoulombFriction, SurfaceSuction)  # what has no part in a record at rest


def at_rest(
    rig: SimulatedRig, effects: Sequence[Effect], seed: int, count: int = 4
) -> tuple[GapRun, ...]:
    """Simulate and observe records at rest through the campaign."""
    point = SetPoint(ZERO_BLOCKS / LENGTH_S, 0.0)
    found = []
    for number in range(count):
        place = CampaignRun(number, BETWEEN_S * number, 300.0, None)
        changed, really = switch_on(effects, rig, point, place)
        dataset = simulate(
            rig_at_rest(changed),
            really,
            periods=ZERO_BLOCKS - 1,
            settling_periods=0,
            sample_rate_hz=RATE_HZ,
            seed=7000 * seed + number,
            name=f"zero-{number}",
        )
        found.append(run_at_rest(from_dataset(dataset), place, really))
    return tuple(found)


@pytest.fixture(scope="module")
def still(rig: SimulatedRig) -> tuple[GapRun, ...]:
    """Records at rest without any effect."""
    return at_rest(rig, (), seed=1)


def diagnosed(
    rig: SimulatedRig, runs: Sequence[GapRun], kinds: Sequence[type[Effect]]
) -> Diagnosis:
    return diagnose(rig, runs, Settings({kind.name: kind for kind in kinds}))


def both(rig: SimulatedRig, effect: Effect, seed: int) -> tuple[GapRun, ...]:
    """Record runs and zeros with an effect on."""
    return (*record(rig, (effect,), seed), *at_rest(rig, (effect,), seed))


def named(found: Diagnosis, kind: type[E]) -> E:
    """Return the effect that is named, alone, with three quarters of the probability."""
    assert found.answers.by_answer[kind.name] > 0.75
    assert found.best is not None
    (effect,) = found.best.effects
    assert isinstance(effect, kind)
    return effect


@pytest.mark.slow
def test_a_zero_offset_stays_at_rest(rig: SimulatedRig) -> None:
    runs = both(rig, ZeroOffset(0.4, -0.2), seed=3)
    effect = named(diagnosed(rig, runs, (ZeroOffset, *MOVING)), ZeroOffset)
    assert effect.aft_n == pytest.approx(0.4, abs=3e-3)
    assert effect.fore_n == pytest.approx(-0.2, abs=3e-3)


@pytest.mark.slow
def test_uneven_friction_does_not_and_the_odds_say_so(rig: SimulatedRig) -> None:
    """The mean of the runs alone leaves its size to the free zero; the rest record does not."""
    runs = both(rig, UnevenFriction(0.4), seed=3)
    turning = tuple(one for one in runs if one.turns)
    with_rest, without = (diagnosed(rig, one, (ZeroOffset, *MOVING)) for one in (runs, turning))
    effect = named(with_rest, UnevenFriction)
    assert effect.uneven_n == pytest.approx(0.4, rel=0.05)
    assert advantage(with_rest) > advantage(without) + 20.0
    (rest,) = [one for one in with_rest.after if str(one.regime) == "medium rest"]
    assert np.abs(rest.remainder).max() < 4.0


def advantage(found: Diagnosis) -> float:
    """Return the log odds of uneven friction over a zero offset."""
    fits = {one.name: one.fit for one in found.weighed.first_looks}
    fits |= {one.names[0]: one for one in found.weighed.singles}
    friction, zero = fits["uneven-friction"], fits["zero-offset"]
    assert friction is not None
    assert zero is not None
    expected = [expected_evidence(found.problem, one) for one in (friction, zero)]
    return expected[0] - expected[1]


@pytest.mark.slow
def test_a_drift_over_the_campaign_has_the_slope_of_its_zeros(rig: SimulatedRig) -> None:
    runs = both(rig, CampaignDrift(2e-4, 0.0), seed=3)
    effect = named(diagnosed(rig, runs, (CampaignDrift, ZeroOffset)), CampaignDrift)
    zeros = [one.observed.value("force_aft", Part.MEAN) for one in runs if not one.turns]
    slope = np.polyfit(BETWEEN_S * np.arange(len(zeros)), zeros, 1)[0]
    assert effect.aft_n_s == pytest.approx(slope, rel=0.01)
    assert effect.aft_n_s == pytest.approx(2e-4, rel=0.01)
    assert abs(effect.fore_n_s) < 4e-6


@pytest.mark.slow
def test_no_gap_stays_no_gap(
    rig: SimulatedRig, clean: tuple[GapRun, ...], still: tuple[GapRun, ...]
) -> None:
    found = diagnosed(rig, (*clean, *still), (ZeroOffset, CampaignDrift, *MOVING))
    assert found.answers.best == "none"


def test_what_acts_on_motion_predicts_nothing(rig: SimulatedRig, still: tuple[GapRun, ...]) -> None:
    simulator = Simulator(rig, Stack.of([replace(one, stands_at_m=(0.0, 0.0)) for one in still]))
    moved = {
        kind.name
        for kind in (*catalogue().values(), UnevenFriction)
        if kind.repeats and np.abs(simulator.predict((kind(),)) - simulator.nominal).max() > 1e-9
    }
    assert moved == {"zero-offset", "temperature", "quadratic-drift"}


@pytest.mark.slow
def test_runs_are_predicted_as_without_records_at_rest(
    rig: SimulatedRig, clean: tuple[GapRun, ...], still: tuple[GapRun, ...]
) -> None:
    alone = problem_of(rig, clean)
    beside = problem_of(rig, (*clean, *still))
    rows = beside.simulator.stack.run < len(clean)
    for effects in ((), (CoulombFriction(),), (ZeroDrift(),)):
        assert np.array_equal(
            beside.simulator.predict(effects)[rows], alone.simulator.predict(effects)
        )
    count = len(alone.free)
    own = beside.simulator.stack.uncertainty[rows, None] * beside.nuisances.columns[rows, :count]
    old = alone.simulator.stack.uncertainty[:, None] * alone.nuisances.columns[:, :count]
    np.testing.assert_allclose(own, old, rtol=1e-12, atol=1e-15)


def test_struts_that_stand_off_their_middle_carry_the_restoring_force(rig: SimulatedRig) -> None:
    (run,) = at_rest(rig, (), seed=2, count=1)
    moved = replace(run, stands_at_m=(1e-3, 1e-3))
    force = Simulator(rig, Stack.of((moved,))).nominal - Simulator(rig, Stack.of((run,))).nominal
    assert run.stands_at_m == pytest.approx((0.0, 0.0), abs=1e-6)
    assert force.sum() == pytest.approx(1e-3 * rig.water.restoring[0][0], rel=1e-3)


def test_they_are_a_medium_of_their_own(
    clean: tuple[GapRun, ...], still: tuple[GapRun, ...]
) -> None:
    mixed = (still[0], *clean, *still[1:])
    resting = {at for at, one in enumerate(mixed) if not one.turns}
    found = {str(one): {*one.runs} for one in regimes(mixed)}
    assert found.pop("medium rest") == resting
    assert all(not resting & runs for runs in found.values())
    assert list(found) == [str(one) for one in regimes(clean)]


def test_what_is_proposed_has_the_noise_of_a_run(
    rig: SimulatedRig, clean: tuple[GapRun, ...], still: tuple[GapRun, ...]
) -> None:
    slow = SetPoint(ZERO_BLOCKS / LENGTH_S, 0.02)
    run = planned(problem_of(rig, (*clean, *still)), slow, 0)
    assert run.turns
    assert len(run.observed.components) > len(still[0].observed.components)


@pytest.mark.parametrize(
    ("samples", "missing", "said"),
    [(19, 0, "needs 20 samples or more"), (60, 2, "2 of them missing")],
)
def test_records_that_are_too_short_or_have_gaps_are_refused(
    rig: SimulatedRig, samples: int, missing: int, said: str
) -> None:
    dataset = simulate(rig_at_rest(rig), STANDS, periods=2, seed=1, settling_periods=0)
    short = dataset.isel(time=slice(samples)).load()
    short["force_aft"].values[:missing] = np.nan
    with pytest.raises(DataError, match=said):
        run_at_rest(from_dataset(short), CampaignRun(), STANDS)


def test_a_record_without_force_is_refused(rig: SimulatedRig) -> None:
    dataset = simulate(rig_at_rest(rig), STANDS, periods=2, seed=1, settling_periods=0)
    with pytest.raises(DataError, match="no channel force_aft or force_fore"):
        run_at_rest(from_dataset(dataset).select(["displacement_aft"]), CampaignRun(), STANDS)


def test_one_in_air_has_no_restoring_force(rig: SimulatedRig) -> None:
    dataset = simulate(rig_at_rest(rig), STANDS, periods=2, seed=1, settling_periods=0)
    run = run_at_rest(from_dataset(dataset), CampaignRun(), replace(STANDS, medium=Medium.AIR))
    moved = replace(run, stands_at_m=(1e-3, 1e-3))
    assert Simulator(rig, Stack.of((moved,))).nominal == pytest.approx(np.zeros(2), abs=1e-9)
