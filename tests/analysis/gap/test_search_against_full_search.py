"""What the search leaves out or reuses to be quick changes no number that it should not."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.forward.candidate import Candidate, candidates
from analysis.gap.forward.free_numbers import free_numbers, tolerated, with_coefficients
from analysis.gap.forward.noise import pooled
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.simulator import Simulator
from analysis.gap.forward.stages import Solved
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.inference.gaussian import left_over, null_evidence
from analysis.gap.judge.withheld import Predicted, shrinkage
from analysis.gap.locate.traces import deviating_traces, worth_a_look
from analysis.gap.observe.components import GapRun, Part, Stack
from analysis.gap.observe.regimes import Regime
from analysis.gap.search.first_look import look, smaller_units
from analysis.gap.search.fit import linearised_at
from analysis.gap.search.joint import fit_jointly
from analysis.gap.search.refinement import refine
from hardware.description.errors import ConfigurationError
from sim.effects.catalogue import build, find
from sim.effects.d2_speed_droop import SpeedDroop
from sim.effects.effect import DeviationTrace, Effect
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig
from sim.run import steady_run
from sim.solve.period import Period
from tests.analysis.gap.small import POINTS, problem_of, record

USUAL = Tolerances()


@pytest.mark.parametrize("said", ["coulomb-friction", "amplifier-lag", "speed-ripple", "cable"])
def test_stages_solved_once_give_the_whole_chain(said: str, rig: SimulatedRig) -> None:
    solved = Solved()
    for effects in ((), (build(said),), (), (build(said),)):
        for point in POINTS:
            changed, really = switch_on(effects, rig, point)
            period = Period(really.frequency_hz, 8, 64)
            whole = steady_run(changed, really, orders=8, points=64).spectra
            found = solved.steady_state(changed.stages(really), period).spectra
            assert found.keys() == whole.keys()
            for name, harmonics in whole.items():
                np.testing.assert_array_equal(found[name], harmonics)


@pytest.mark.slow
def test_nothing_costly_is_looked_at_where_nothing_shows(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    seen = deviating_traces(_scattering(rig, clean))
    assert DeviationTrace.BESIDE not in seen
    assert not worth_a_look(find("hum"), seen)
    assert not worth_a_look(find("load-ripple"), seen)
    assert worth_a_look(find("coulomb-friction"), seen)


@pytest.mark.slow
def test_hum_is_looked_at_where_lines_show(rig: SimulatedRig) -> None:
    runs = record(rig, [build("hum:amplitude_n=1,frequency_hz=7.3")], 31)
    seen = deviating_traces(_scattering(rig, runs))
    assert DeviationTrace.BESIDE in seen
    assert worth_a_look(find("hum"), seen)


@pytest.mark.slow
def test_a_drive_is_looked_at_where_the_struts_deviate(rig: SimulatedRig) -> None:
    seen = deviating_traces(_scattering(rig, record(rig, [build("speed-ripple")], 33)))
    assert worth_a_look(find("load-ripple"), seen)


@pytest.mark.slow
@pytest.mark.parametrize(("said", "shows"), [("speed-ripple", True), ("connecting-rod", False)])
def test_backlash_is_looked_at_where_the_shaft_turns_unevenly(
    said: str, shows: bool, rig: SimulatedRig
) -> None:
    seen = deviating_traces(_scattering(rig, record(rig, [build(said)], 34)))
    assert worth_a_look(find("gear-backlash"), seen) is shows
    assert worth_a_look(find("load-ripple"), seen)  # the struts tell of either


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", ["load-ripple", "coulomb-friction", "quadratic-damping", "joint-play", "speed-ripple"]
)
def test_a_tenth_of_an_effect_is_found_by_the_power_of_its_size(
    name: str, rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    """Inertia by its inverse, drag in proportion, play by less than its size."""
    problem = problem_of(rig, clean)
    chosen = (next(iter(candidates(find(name), [0.5, 1.0]))),)
    whole = linearised_at(problem, chosen, chosen[0].start)
    tenth = linearised_at(problem, chosen, smaller_units(problem, whole, 0.1))
    sizes = [left_over(one.signature, problem.nuisances) for one in (whole, tenth)]
    assert 0.05 < sizes[1] / sizes[0] < 0.2


@pytest.mark.slow
def test_a_slight_droop_is_not_taken_for_a_large_flywheel(rig: SimulatedRig) -> None:
    """From 0.02 rad/(s N m), and not by way of a flywheel on which no droop shows."""
    off = build("speed-droop:droop_rad_s_n_m=5e-4,inertia_kg_m2=100")
    problem = problem_of(rig, record(rig, [off], 34))
    fit = look(problem, find("speed-droop")).fit
    assert fit is not None
    asked = left_over(problem.residual, problem.nuisances)
    assert left_over(fit.signature, problem.nuisances) < 4.0 * asked
    (found,) = refine(problem, fit).effects
    assert isinstance(found, SpeedDroop)
    assert 2e-4 < found.droop_rad_s_n_m < 2e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("said", "share"),
    [
        ("zero-drift:aft_n_s=-0.01", 0.95),
        ("zero-drift:aft_n_s=-0.2,fore_n_s=0.1", 0.95),
        ("speed-droop:droop_rad_s_n_m=1e-4,inertia_kg_m2=5", 0.9),
        ("load-ripple:inertia_kg_m2=400", 0.6),
    ],
)
def test_a_look_promises_most_of_what_a_full_fit_finds(
    said: str, share: float, rig: SimulatedRig
) -> None:
    """Else nothing is fitted: a drift was passed over for what it does to lines when it is slight.

    By a look that is linear they promise 0.77, 0.63, 0.85 and 0.23 of it.
    """
    problem = problem_of(rig, record(rig, [build(said)], 37))
    seen = look(problem, find(said.split(":")[0]))
    assert seen.fit is not None
    none = null_evidence(problem.residual, problem.nuisances)
    gained = refine(problem, seen.fit).log_evidence - none
    assert gained > 10.0
    assert seen.expected - none > share * gained


def test_a_clearance_is_looked_at_between_teeth_that_the_load_hardly_bends() -> None:
    (one,) = candidates(find("gear-backlash"), [0.5, 1.0])
    assert [axis.parameter.name for axis in one.axes] == ["backlash_rad"]
    assert one.axes[0].value(float(one.start[0])) < 1e-3
    assert one.fixed_values["stiffness_n_m_rad"] > 1e6


@pytest.mark.slow
@pytest.mark.parametrize("name", ["coulomb-friction", "viscous-guides", "strut-phase-error"])
def test_a_rough_slope_is_near_the_slope(
    name: str, rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    problem = problem_of(rig, clean)
    chosen = (next(iter(candidates(find(name), [0.5, 1.0]))),)
    exact = linearised_at(problem, chosen, chosen[0].start).columns
    rough = linearised_at(problem, chosen, chosen[0].start, roughly=True).columns
    assert np.linalg.norm(rough - exact) < 0.05 * np.linalg.norm(exact)


@pytest.mark.slow
def test_an_effect_acts_on_the_rig_as_its_coefficients_are(rig: SimulatedRig) -> None:
    """A photocell turned by 0.03 rad turns what 20 % more added mass changes as well."""
    free = free_numbers(rig, Tolerances())
    off = with_coefficients(rig, free, [1.0 if one.name == "a11" else 0.0 for one in free])
    flat = Tolerances(added_mass_per_octave=0.0, damping_per_octave=0.0)
    runs = record(off, [build("photocell-angle:late_rad=0.03")], 32)
    problem = _scattering(rig, runs, flat)
    fit = look(problem, find("photocell-angle")).fit
    assert fit is not None
    alone = linearised_at(problem, fit.candidates, np.array([_units(fit.candidates[0], 0.03)]))
    moved = fit_jointly(problem, free, alone)
    assert moved.log_evidence > alone.log_evidence + 10.0
    assert moved.cost < 1.3 * len(problem.residual)


@pytest.mark.slow
def test_pulses_quieter_than_believed_are_no_gap(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    problem = _scattering(rig, clean)
    stack = problem.simulator.stack
    pulses = np.array([one.part is Part.PERIOD_SCATTER for one in stack.components])
    for change, zero in ((-3.0, True), (3.0, False)):
        values = stack.values + np.where(pulses, change, 0.0)
        simulator = replace(problem.simulator, stack=replace(stack, values=values))
        residual = Problem(simulator, problem.nuisances).residual
        assert (not residual[pulses].any()) is zero


@pytest.mark.slow
def test_what_cannot_be_simulated_here_ends_no_diagnosis(
    rig: SimulatedRig, clean: tuple[GapRun, ...], monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = problem_of(rig, clean)
    parts = [next(iter(candidates(find(name), []))) for name in ("coulomb-friction", "cable")]
    both = linearised_at(problem, tuple(parts), np.concatenate([one.start for one in parts]))

    def fails(simulator: Simulator, effects: Sequence[Effect]) -> np.ndarray:
        raise ConfigurationError("the teeth strike too hard")

    assert problem.simulator.nominal.any()
    monkeypatch.setattr(Simulator, "predict", fails)
    assert refine(problem, both).units == pytest.approx(both.units)


def test_a_gap_of_nothing_is_nothing_within_its_noise() -> None:
    generator = np.random.default_rng(7)
    rows = np.ones(200, dtype=bool)
    pairs = [
        [
            Predicted(Regime("chosen", str(run), (run,)), rows, size * noise)
            for size, noise in ((5.0, drawn), (0.9, drawn))
        ]
        for run in range(4)
        for drawn in [generator.standard_normal(200)]
    ]
    found = shrinkage([one[0] for one in pairs], [one[1] for one in pairs])
    assert found.share == 1.0
    assert found.after == 0.0
    noisy = [replace(one[1], remainder=one[1].remainder / 0.9) for one in pairs]
    found = shrinkage([one[0] for one in pairs], noisy)
    assert found.low < 1.0 - 0.5 * math.sqrt(math.sqrt(2.0 / 800)) / found.before


def _scattering(
    rig: SimulatedRig, runs: tuple[GapRun, ...], tolerances: Tolerances = USUAL
) -> Problem:
    """Return the problem of a rig whose pulses scatter as the campaign's do."""
    on = (build(f"trigger-jitter:jitter_rad={tolerances.pulse_scatter_rad}"),)
    simulator = Simulator(rig, Stack.of(pooled(runs, rig, tolerances)), on)
    free = free_numbers(rig, tolerances)
    nuisances = tolerated(simulator, free, tolerances)
    return Problem(simulator, nuisances)


def _units(candidate: Candidate, value: float) -> float:
    axis = candidate.axes[0]
    return float(axis.unit(value))
