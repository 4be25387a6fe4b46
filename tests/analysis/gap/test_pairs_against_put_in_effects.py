"""Two effects at once: each is found beside the other, however far its usual size is off."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.gap.forward.candidate import candidates
from analysis.gap.inference.gaussian import null_evidence
from analysis.gap.judge.diagnosis import Settings, diagnose
from analysis.gap.search.engine import Engine, fit_pairs
from analysis.gap.search.first_look import look
from analysis.gap.search.fit import weighed_at
from analysis.gap.search.refinement import refine
from sim.effects.catalogue import build, catalogue, find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of, record

KNOWN = (
    "connecting-rod",
    "entrained-water",
    "coulomb-friction",
    "slot-tilt",
    "carriage-fluctuation",
    "carriage-speed",
)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("said", "seed"),
    [
        (("connecting-rod:rod_length_m=10", "coulomb-friction:friction_n=0.3"), 81),
        (("carriage-fluctuation:relative=0.001", "slot-tilt:tilt_aft_rad=0.005"), 82),
    ],
)
def test_both_are_named(rig: SimulatedRig, said: tuple[str, str], seed: int) -> None:
    """The rod's bow is six times less than a usual one makes, the swell a third."""
    runs = record(rig, [build(one) for one in said], seed)
    found = diagnose(rig, runs, Settings({name: find(name) for name in KNOWN}))
    assert found.answers.best == "+".join(sorted(one.split(":")[0] for one in said))


@pytest.mark.slow
def test_neither_need_be_among_the_likeliest_alone(rig: SimulatedRig) -> None:
    """Friction and quadratic damping make a cubic one, a lag and a skew the best single answers."""
    said = ("coulomb-friction:friction_n=0.5", "quadratic-damping:translation_n_s2_m2=300")
    runs = record(rig, [build(one) for one in said], 84)
    names = ("coulomb-friction", "quadratic-damping", "cubic-damping", "amplifier-lag",
             "channel-skew", "viscous-guides", "strut-tare", "memory", "cable")  # fmt: skip
    found = diagnose(rig, runs, Settings({name: find(name) for name in names}))
    assert found.answers.best == "coulomb-friction+quadratic-damping"
    assert found.rival is not None
    assert not {*found.best.names} & set(found.rival.names)


@pytest.mark.slow
@pytest.mark.parametrize("is_first", [True, False])
def test_a_pair_is_fitted_from_the_nearer_of_two_ways(rig: SimulatedRig, is_first: bool) -> None:
    """Beside pulses that are missing a fit has few steps, too few to find a ripple anew."""
    said = ("missed-pulse:every=5", "speed-ripple:relative=0.005,phase_rad=-2.9")
    problem = problem_of(rig, record(rig, [build(one) for one in said], 85))
    missed, ripple = (look(problem, find(one.split(":")[0])) for one in said)
    assert missed.fit is not None
    assert ripple.fit is not None
    near = refine(problem, ripple.fit)
    astray = near.units + np.array([0.0, 1.2])  # where its slopes lead, which are wrong
    started = 1.5 * astray
    signature = near.signature + near.columns @ (started - astray)
    far = weighed_at(problem, near.candidates, started, near.columns, signature)
    ways = [near, far] if is_first else [far, near]
    seen = replace(ripple, fits=tuple(ways))
    none = null_evidence(problem.residual, problem.nuisances)
    (pair,) = fit_pairs(problem, [missed.fit], [seen], none, Engine())
    assert pair.units == pytest.approx(near.units, abs=0.05)


def test_every_start_is_within_its_range() -> None:
    for kind in catalogue().values():
        for one in candidates(kind, [0.5, 1.0]):
            low, high = one.bounds
            assert np.all((low <= one.start) & (one.start <= high)), one.name


@pytest.mark.slow
def test_what_does_not_repeat_is_looked_at_from_about_its_size(rig: SimulatedRig) -> None:
    problem = problem_of(rig, record(rig, [build("carriage-fluctuation:relative=0.001")], 83))
    fit = look(problem, find("carriage-fluctuation")).fit
    assert fit is not None
    weighted = problem.nuisances.whiten(fit.signature)
    assert 0.6 < float(weighted @ problem.residual) / float(weighted @ fit.signature) < 1.7
