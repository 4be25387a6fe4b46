"""A user's own copy of an effect, under another name, is diagnosed as the catalogue's is."""

import inspect
import sys
from pathlib import Path

import numpy as np
import pytest

from analysis.gap.design.beside import NO_GAP
from analysis.gap.design.proposals import Choices, proposals
from analysis.gap.forward.candidate import candidates
from analysis.gap.forward.free_numbers import free_numbers
from analysis.gap.forward.problem import Problem
from analysis.gap.forward.tolerances import Tolerances
from analysis.gap.locate.traces import worth_a_look
from analysis.gap.observe.components import GapRun
from analysis.gap.search.engine import Engine, fit_leading
from analysis.gap.search.first_look import FirstLook
from analysis.gap.search.fit import Fit, linearised_at
from analysis.gap.search.hypotheses import COEFFICIENTS
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Range
from sim.effects.catalogue import catalogue, find, load_file
from sim.effects.effect import DeviationTrace, Effect, FurtherMeasurement, parameter
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of

FREQUENCIES_HZ = (0.5, 1.0)
SEEN: tuple[frozenset[DeviationTrace], ...] = (
    frozenset(),
    *(frozenset({one}) for one in DeviationTrace),
    frozenset(DeviationTrace),
)


def both(name: str, folder: Path) -> tuple[type[Effect], type[Effect]]:
    """Return an effect, and that of a file with the very same text but for the name."""
    theirs = find(name)
    text = inspect.getsource(sys.modules[theirs.__module__])
    path = folder / f"{name.replace('-', '_')}.py"
    path.write_text(text.replace(f'= "{name}"', f'= "own-{name}"'), encoding="utf-8")
    (own,) = load_file(path).values()
    assert own.name == f"own-{name}"
    return theirs, own


@pytest.fixture(scope="module")
def problem(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> Problem:
    return problem_of(rig, clean[:2])


def begun(problem: Problem, kind: type[Effect], times: float = 1.0) -> Fit:
    one = next(iter(candidates(kind, FREQUENCIES_HZ)))
    return linearised_at(problem, (one,), times * one.start)


@pytest.mark.parametrize("name", sorted(set(catalogue()) - set(COEFFICIENTS)))
def test_its_parameters_begin_and_it_is_looked_at_alike(name: str, tmp_path: Path) -> None:
    theirs, own = (
        (
            [(one.axes, one.fixed_values) for one in candidates(kind, FREQUENCIES_HZ)],
            [worth_a_look(kind, seen) for seen in SEEN],
        )
        for kind in both(name, tmp_path)
    )
    assert own == theirs


@pytest.mark.parametrize("name", ["hum", "trigger-jitter"])
def test_what_it_does_by_chance_is_left_out_of_the_harmonics(
    name: str, problem: Problem, tmp_path: Path
) -> None:
    simulator = problem.simulator
    theirs, own = (
        simulator.predict((kind(),)) - simulator.nominal for kind in both(name, tmp_path)
    )
    np.testing.assert_array_equal(own, theirs)
    assert not own[simulator.stack.steady].any()
    assert own[~simulator.stack.steady].any()


@pytest.mark.slow
@pytest.mark.parametrize(("name", "costs"), [("gear-backlash", True), ("torque-cogging", False)])
def test_what_is_costly_has_to_promise_more(
    name: str, costs: bool, problem: Problem, tmp_path: Path
) -> None:
    leaders = [
        FirstLook(one, (begun(problem, find(one)),), 9.0) for one in ("coulomb-friction", "cable")
    ]
    for kind in both(name, tmp_path):
        seen = [*leaders, FirstLook(kind.name, (begun(problem, kind),), 1.0)]
        names = [one.names for one in fit_leading(problem, seen, 0.0, Engine())]
        assert ((kind.name,) not in names) is costs


@pytest.mark.sample(2)
@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("hum", {"rest", "injection"}),
        ("gain-error", {"check-weight"}),
        ("amplifier-lag", {"injection"}),
        ("coulomb-friction", set()),
    ],
)
def test_the_same_measurements_show_it(
    name: str, shown: set[str], problem: Problem, tmp_path: Path
) -> None:
    choices = Choices(
        Range(0.5, 1.0), Range(0.01, 0.02), media=(), special=tuple(FurtherMeasurement)
    )
    for kind in both(name, tmp_path):
        leading = ((begun(problem, kind, 3.0), 0.6), (NO_GAP, 0.4))
        free = free_numbers(problem.simulator.rig, Tolerances())
        found = proposals(problem, leading, choices, free, Tolerances())
        assert {one.kind for one in found if one.gain > 1.0} == shown


def test_a_start_out_of_range_is_refused() -> None:
    with pytest.raises(ConfigurationError, match="start 0 is outside the plausible range 1 to 9"):
        parameter(5.0, 1.0, 9.0, "Hz", "frequency", starts=(2.0, 0.0))
