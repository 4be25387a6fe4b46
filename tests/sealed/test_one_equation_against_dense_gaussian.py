"""The covariance of a hypothesis, factored, against the same covariance written out in full."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap import diagnose
from analysis.gap.components import GapRun, Stack
from analysis.gap.diagnose import Settings
from analysis.gap.free import free_numbers
from analysis.gap.hypotheses import weigh
from analysis.gap.look import look
from analysis.gap.priors import Priors
from analysis.gap.unknown import likeness
from hardware.description.arrays import FloatArray
from pmm.gap.load import unlimited
from sim.effects.catalogue import build, find
from sim.rig import SimulatedRig, vertical_rig
from tests.analysis.gap.small import problem_of, record
from tests.sealed.one_equation.constants import PLAIN, TAUS, TOLERATED, VISIBLE, WIDE
from tests.sealed.one_equation.evidence import Beside
from tests.sealed.one_equation.kernel import Kernel, units
from tests.sealed.one_equation.metric import Metric
from tests.sealed.one_equation.weights import Weights, weigh_again


@pytest.fixture(scope="module")
def rig() -> SimulatedRig:
    return unlimited(vertical_rig())


@pytest.fixture(scope="module")
def clean(rig: SimulatedRig) -> tuple[GapRun, ...]:
    return record(rig, (), seed=1)


def _kernel(rng: np.random.Generator, cells: int, runs: int) -> tuple[Kernel, FloatArray]:
    rows = rng.permutation(cells * runs).reshape(cells, runs)
    roots = rng.standard_normal((cells, runs, runs))
    blocks = tuple(root @ root.T for root in roots)
    whole = np.zeros((cells * runs, cells * runs))
    for cell, block in zip(rows, blocks, strict=True):
        whole[np.ix_(cell, cell)] = block
    return Kernel(tuple(rows), blocks, cells * runs), whole


@given(
    seed=st.integers(0, 2**32 - 1),
    cells=st.integers(1, 4),
    runs=st.integers(1, 5),
    count=st.integers(0, 6),
    tau=st.sampled_from(TAUS),
)
def test_the_factored_covariance_is_the_dense_one(
    seed: int, cells: int, runs: int, count: int, tau: float
) -> None:
    rng = np.random.default_rng(seed)
    kernel, whole = _kernel(rng, cells, runs)
    columns = rng.standard_normal((cells * runs, count))
    dense = np.eye(len(whole)) + tau**2 * whole + columns @ columns.T
    metric = Metric(columns, kernel, tau)
    seen = rng.standard_normal((len(whole), 2))
    np.testing.assert_allclose(metric.whiten(seen), np.linalg.solve(dense, seen), atol=1e-9)
    np.testing.assert_allclose(metric.whiten(seen[:, 0]), metric.whiten(seen)[:, 0], atol=1e-12)
    assert metric.log_determinant == pytest.approx(np.linalg.slogdet(dense)[1], abs=1e-9)


@given(seed=st.integers(0, 2**32 - 1), tau=st.sampled_from(TAUS))
def test_a_deviation_of_some_observations_is_that_of_no_others(seed: int, tau: float) -> None:
    rng = np.random.default_rng(seed)
    kernel, whole = _kernel(rng, 3, 4)
    some = rng.random(12) < 0.5
    dense = np.eye(12) + tau**2 * np.where(np.outer(some, some), whole, 0.0)
    metric = Metric(np.zeros((12, 0)), kernel.only(some), tau)
    assert metric.log_determinant == pytest.approx(np.linalg.slogdet(dense)[1], abs=1e-9)


def test_runs_alike_deviate_alike(clean: tuple[GapRun, ...]) -> None:
    alike = likeness([one.set_point for one in clean])
    np.testing.assert_allclose(np.diagonal(alike), 1.0)
    assert np.linalg.eigvalsh(alike).min() > 0.0
    assert likeness([clean[0].set_point, clean[0].set_point])[0, 1] == pytest.approx(0.8)


def test_a_deviation_is_relative_to_what_is_predicted(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    stack = Stack.of(clean)
    nominal = problem_of(rig, clean).simulator.nominal
    once, twice = units(stack, nominal), units(stack, 2.0 * nominal)
    forces = np.array([one.channel == "force_aft" for one in stack.components])
    harmonics = forces & stack.steady
    np.testing.assert_allclose(twice[harmonics], 2.0 * once[harmonics])
    finer = units(stack, nominal) / (0.1 * stack.uncertainty)
    np.testing.assert_allclose(finer, 10.0 * once / stack.uncertainty)


def test_each_answer_s_evidence_is_its_normal_density(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    problem = problem_of(rig, clean)
    looked = [look(problem, find(name)) for name in ("viscous-guides", "amplifier-lag")]
    columns = problem.nuisances.columns
    sought = np.arange(columns.shape[1]) < 4
    moved = np.array([1.5, 0.0, 0.0, 0.0])
    beside = Beside.of(problem, looked, sought, moved)
    stated = problem.residual + 1.5 * columns[:, 0]
    dense, one = _dense(beside.kernel), np.eye(len(stated))
    free = one + columns @ columns.T
    none, coefficients, unknown = beside.none(), beside.coefficients(), beside.unknown()
    # Each of the four coefficients wide by itself, or all of them.
    wide = [np.where(np.arange(columns.shape[1]) == k, WIDE, 1.0) for k in range(4)]
    wide.append(np.where(sought, WIDE, 1.0))
    for at, tau in enumerate(TAUS):
        within = one + tau**2 * dense
        if tau > TOLERATED:
            assert none[at] == coefficients[at] == -np.inf
        else:
            assert none[at] == pytest.approx(_log(stated, within + columns @ columns.T), rel=1e-6)
            each = [_log(stated, within + (columns * w**2) @ columns.T) for w in wide]
            mean = np.logaddexp.reduce(each) - np.log(len(each))
            assert coefficients[at] == pytest.approx(mean, rel=1e-6)
        plain = free + PLAIN * tau**2 * (dense + beside.own @ beside.own.T)
        for stage, logs in unknown.items():
            shapes = tau * beside.learned.at(stage)
            whole = plain + shapes @ shapes.T
            if np.isfinite(logs[at]):
                assert logs[at] == pytest.approx(_log(stated, whole), rel=1e-6)
            else:
                told = np.linalg.slogdet(whole)[1] - np.linalg.slogdet(free)[1]
                assert 0.5 * told <= VISIBLE


def test_what_stands_beside_an_effect_has_not_its_shape(
    rig: SimulatedRig, clean: tuple[GapRun, ...]
) -> None:
    problem = problem_of(rig, clean)
    names = ("viscous-guides", "amplifier-lag", "cubic-damping")
    looked = [look(problem, find(name)) for name in names]
    none = np.zeros(0)
    beside = Beside.of(problem, looked, none.astype(bool), none)
    kept = beside.learned.beside(["viscous-guides"])
    alike = beside.learned.alike["viscous-guides"]
    assert "viscous-guides" in alike
    assert kept.shape[1] == sum(one not in alike for one in beside.learned.effects)
    assert kept.shape[1] < len(beside.learned.effects)
    scale = units(problem.simulator.stack, problem.simulator.nominal)
    relative = kept / (scale / problem.simulator.stack.uncertainty)[:, None]
    assert np.mean(np.sum(relative**2, axis=1)) == pytest.approx(1.0 - PLAIN)


def _dense(kernel: Kernel) -> FloatArray:
    whole = np.zeros((kernel.count, kernel.count))
    for cell, block in zip(kernel.cells, kernel.blocks, strict=True):
        whole[np.ix_(cell, cell)] = block
    return whole


def _log(residual: FloatArray, covariance: FloatArray) -> float:
    """Return a normal's log density but for the constant that all answers share."""
    root = np.linalg.cholesky(covariance)
    left = np.linalg.solve(root, residual)
    return float(-0.5 * left @ left - np.log(np.diagonal(root)).sum())


@pytest.mark.parametrize(
    ("effects", "said"),
    [((), "none"), (("coulomb-friction:friction_n=0.3",), "coulomb-friction")],
)
def test_what_is_put_in_is_what_is_weighed_most(
    rig: SimulatedRig, effects: tuple[str, ...], said: str
) -> None:
    runs = record(rig, [build(one) for one in effects], 21)
    found = _weighed(rig, runs, ("coulomb-friction", "amplifier-lag"))
    assert sum(found.by_answer.values()) == pytest.approx(1.0)
    assert max(found.by_answer, key=lambda name: found.by_answer[name]) == said
    assert sum(found.stages.values()) == pytest.approx(1.0)


def test_what_no_effect_resembles_is_unknown(rig: SimulatedRig) -> None:
    """One force has a second harmonic of its own that nothing in the catalogue makes."""
    runs = [_with_second_harmonic(run) for run in record(rig, (), 22)]
    found = _weighed(rig, runs, ("viscous-guides",)).by_answer
    assert max(found, key=lambda name: found[name]) == "unknown"


def _with_second_harmonic(run: GapRun) -> GapRun:
    seen = run.observed
    second = [one.channel == "force_aft" and one.order == 2 for one in seen.components]
    return replace(run, observed=replace(seen, values=seen.values + 0.5 * np.array(second)))


def _weighed(rig: SimulatedRig, runs: Sequence[GapRun], names: Sequence[str]) -> Weights:
    free = free_numbers(rig, Priors())
    settings = Settings({name: find(name) for name in names})
    problem = diagnose.problem_of(rig, runs, settings, free)
    searched = weigh(problem, settings.catalogue)
    nothing = np.zeros(0)
    return weigh_again(searched, Beside.of(problem, searched.looked, nothing.astype(bool), nothing))
