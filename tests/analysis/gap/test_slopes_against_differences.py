"""The columns that a fit is linear in are the simulator's own derivatives."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.forward.candidate import candidates
from analysis.gap.forward.free_numbers import Free, free_numbers
from analysis.gap.forward.problem import built
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.inference.gaussian import misfit
from analysis.gap.observe.components import STEADY_PARTS, GapRun
from analysis.gap.search.fit import linearised_at
from sim.effects.catalogue import find
from sim.model.water.radiation import constant
from sim.rig import SimulatedRig
from tests.analysis.gap.small import POINTS, USUAL, problem_of, record


@pytest.mark.slow
@pytest.mark.parametrize("name", ["coulomb-friction", "quadratic-damping", "amplifier-lag"])
def test_of_an_effect(name: str, rig: SimulatedRig, clean: tuple[GapRun, ...]) -> None:
    problem = problem_of(rig, clean)
    chosen = (next(iter(candidates(find(name), [0.5, 1.0]))),)
    fit = linearised_at(problem, chosen, chosen[0].start)
    step = 1e-3
    for axis in range(len(fit.units)):
        sides = []
        for sign in (1.0, -1.0):
            moved = fit.units.copy()
            moved[axis] += sign * step
            sides.append(problem.simulator.steady(built(chosen, moved)))
        slope = problem.whitened(sides[0] - sides[1]) / (2.0 * step)
        parts = problem.simulator.stack.components
        steady = np.array([one.part in STEADY_PARTS for one in parts])
        off = np.linalg.norm((fit.columns[:, axis] - slope)[steady])
        assert off < 0.1 * np.linalg.norm(slope[steady])


def test_of_the_free_numbers(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> None:
    problem = problem_of(rig, clean)
    free: tuple[Free, ...] = free_numbers(rig, Tolerances())
    base = problem.simulator.steady(())
    for at_, one in enumerate(free):
        sides = [one.steady(problem.simulator, units) for units in (0.02, -0.02)]
        slope = problem.whitened(sides[0] - sides[1]) / 0.04
        off = np.linalg.norm(problem.nuisances.columns[:, at_] - slope)
        assert off <= 0.02 * np.linalg.norm(slope) + 1e-6, one.name
    assert np.isfinite(base).all()


def test_water_that_a_table_states_has_coefficients_to_be_free(rig: SimulatedRig) -> None:
    """A table leaves to the constants what it lacks: a coupling alone tells no size."""
    lent = replace(rig.water, added_mass=((0.0, 0.3), (0.3, 0.0)))
    found = {
        one.name: one.deviation for one in free_numbers(replace(rig, water=lent), Tolerances())
    }
    assert found["a11"] == pytest.approx(Tolerances().added_mass_relative * rig.body.mass_kg)
    assert found["a22"] == pytest.approx(Tolerances().added_mass_relative * rig.body.inertia_kg_m2)
    assert found["b11"] == pytest.approx(Tolerances().damping_relative * rig.water.damping[0][0])


def test_a_memory_counts_as_what_is_believed(rig: SimulatedRig) -> None:
    """Whether added mass stands in the hull or in its memory, a tolerance of it is the same."""
    added = rig.water.added_mass
    lent = replace(
        rig,
        water=replace(rig.water, added_mass=((0.0, 0.0), (0.0, 0.0))),
        radiation=constant(added),
    )
    stated, found = (
        {one.name: one.deviation for one in free_numbers(each, Tolerances())}
        for each in (rig, lent)
    )
    assert found == pytest.approx(stated)


@pytest.mark.slow
def test_water_is_other_where_the_carriage_stands(rig: SimulatedRig) -> None:
    """Damping a tenth higher in the runs at rest alone is one tolerance of it."""
    still = tuple(replace(one, carriage_speed_m_s=0.0) for one in POINTS[:2])
    moving = tuple(replace(one, carriage_speed_m_s=1.0) for one in POINTS[:2])
    damping = tuple(tuple(1.1 * one for one in row) for row in rig.water.damping)
    other = replace(rig, water=replace(rig.water, damping=damping))

    def left(at_rest: SimulatedRig, tolerances: Tolerances) -> float:
        runs = (*record(at_rest, (), 5, still), *record(rig, (), 6, moving))
        problem = problem_of(rig, runs, tolerances=tolerances)
        return misfit(problem.residual, problem.nuisances)

    usual = left(rig, USUAL)
    assert left(other, USUAL) < usual + 5.0
    assert left(other, replace(USUAL, damping_per_speed=0.0)) > usual + 100.0
