"""A leading cause that a rig shows very well is found as it was put in, whatever it began from."""

import numpy as np
import pytest

from analysis.gap.forward.candidate import Candidate, candidates
from analysis.gap.forward.free_numbers import free_numbers, with_coefficients
from analysis.gap.forward.problem import Problem
from analysis.gap.inference.gaussian import misfit
from analysis.gap.observe.components import Part
from analysis.gap.search.fit import Fit, linearised_at
from analysis.gap.search.joint import fit_jointly
from analysis.gap.search.linear_hypothesis import in_form, with_forms
from analysis.gap.search.refinement import refine
from hardware.description.arrays import FloatArray
from sim.effects.a8_hum import Hum
from sim.effects.catalogue import build, find
from sim.effects.k1_connecting_rod import ConnectingRod
from sim.effects.s3_coulomb_friction import CoulombFriction
from sim.rig import SimulatedRig
from tests.analysis.gap.small import USUAL, problem_of, record


def _begun(*names: str) -> tuple[tuple[Candidate, ...], FloatArray]:
    parts = tuple(next(iter(candidates(find(name), [0.5, 1.0]))) for name in names)
    return parts, np.concatenate([one.start for one in parts])


def _chi_square(problem: Problem, fit: Fit) -> float:
    """Return that of what repeats and the tolerances leave, over its observations."""
    steady = problem.simulator.stack.steady
    left = (problem.residual - fit.signature)[steady]
    return misfit(left, problem.nuisances.among(steady)) / len(left)


@pytest.mark.slow
def test_a_rod_and_friction_are_found_on_a_rig_whose_coupling_is_far_off(
    rig: SimulatedRig,
) -> None:
    """What a long rod makes of a wrong coupling is as large as the friction, and no part of it."""
    runs = record(rig, [build("connecting-rod:rod_length_m=1.5"), build("coulomb-friction")], 71)
    free = free_numbers(rig, USUAL)
    off = [-6.0 if one.name == "a21" else 0.0 for one in free]
    problem = problem_of(with_coefficients(rig, free, off), runs)
    parts, units = _begun("connecting-rod", "coulomb-friction")
    alone = refine(problem, linearised_at(problem, parts, units))
    found = fit_jointly(problem, free, alone)
    assert _chi_square(problem, alone) > 10.0
    assert _chi_square(problem, found) < 1.3
    rod, friction = found.effects
    assert isinstance(rod, ConnectingRod)
    assert isinstance(friction, CoulombFriction)
    assert rod.rod_length_m == pytest.approx(1.5, rel=0.01)
    assert friction.friction_n == pytest.approx(0.3, rel=0.03)


@pytest.mark.slow
def test_friction_is_found_in_the_form_that_it_has(rig: SimulatedRig) -> None:
    """It turns over 0.1 mm; as the form that is held it would be taken for Stribeck's."""
    runs = record(rig, [build("coulomb-friction:friction_n=4,presliding_m=1e-4")], 72)
    problem = problem_of(rig, runs)
    formed = {}
    for name in ("coulomb-friction", "stribeck-friction"):
        parts, units = _begun(name)
        held = with_forms(problem, refine(problem, linearised_at(problem, parts, units)))
        formed[name] = (held, in_form(problem, held))
    held, found = formed["coulomb-friction"]
    assert found.log_evidence > max(held.log_evidence, formed["stribeck-friction"][1].log_evidence)
    (friction,) = found.effects
    assert isinstance(friction, CoulombFriction)
    assert friction.presliding_m == pytest.approx(1e-4, rel=0.1)
    assert friction.friction_n == pytest.approx(4.0, rel=0.01)
    # What was fitted is no other form any more.
    assert found.forms.shape[1] == held.forms.shape[1] - 1
    assert not any(one.any() for one, axis in zip(found.sizes[0], found.axes, strict=True)
                   if axis.is_form)  # fmt: skip


def test_a_form_that_hardly_shows_is_left_as_it_is_held(rig: SimulatedRig) -> None:
    problem = problem_of(rig, record(rig, [build("coulomb-friction:friction_n=0.05")], 73))
    parts, units = _begun("coulomb-friction")
    held = with_forms(problem, refine(problem, linearised_at(problem, parts, units)))
    assert in_form(problem, held) is held


def test_what_a_digitiser_rounds_tells_nothing_of_hum(rig: SimulatedRig) -> None:
    """Its lines are known to a fifth; what rounding changes by chance tells less than they do."""
    problem = problem_of(rig, record(rig, [build("hum:amplitude_n=0.3,frequency_hz=50")], 74))
    parts, units = _begun("hum")
    found = refine(problem, linearised_at(problem, parts, units))
    told = found.columns[:, 0] * problem.nuisances.whiten(found.columns)[:, 0]
    lines = [one.part is Part.MAINS for one in problem.simulator.stack.components]
    assert np.sum(told[np.logical_not(lines)]) < np.sum(told[lines])
    (hum,) = found.effects
    assert isinstance(hum, Hum)
    assert hum.amplitude_n == pytest.approx(0.3, rel=0.1)
