"""The evidence of each hypothesis, reduced, against its covariance written out in full."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.gap.inference.constants import FORMS, PLAIN, STRANGE, TAUS, TOLERATED, VISIBLE, WIDE
from analysis.gap.inference.evidence import Background
from analysis.gap.inference.gram import Weighted
from analysis.gap.inference.kernel import Kernel
from analysis.gap.observe.components import GapRun, Stack
from analysis.gap.search.deviation import background, likeness, units
from analysis.gap.search.first_look import look
from analysis.gap.search.fit import linearised_at
from analysis.gap.search.linear_hypothesis import hypothesis
from hardware.description.arrays import BoolArray, FloatArray
from sim.effects.catalogue import find
from sim.rig import SimulatedRig
from tests.analysis.gap.small import problem_of

NAMES = ("viscous-guides", "amplifier-lag")


def _kernel(rng: np.random.Generator, cells: int, runs: int) -> tuple[Kernel, FloatArray]:
    rows = rng.permutation(cells * runs).reshape(cells, runs)
    roots = rng.standard_normal((cells, runs, runs))
    scale = rng.uniform(0.5, 2.0, cells * runs)
    kernel = Kernel.of(tuple(rows), tuple(root @ root.T for root in roots), scale)
    return kernel, _dense(kernel)


def _dense(kernel: Kernel) -> FloatArray:
    count = sum(len(cell) for cell in kernel.cells)
    whole = np.zeros((count, count))
    for cell, block in zip(kernel.cells, kernel.blocks, strict=True):
        whole[np.ix_(cell, cell)] = block
    return whole


@given(
    seed=st.integers(0, 2**32 - 1),
    cells=st.integers(1, 4),
    runs=st.integers(1, 5),
    count=st.integers(0, 6),
    more=st.integers(0, 3),
    tau=st.sampled_from(TAUS),
)
def test_products_under_the_reduced_covariance_are_those_under_the_dense_one(
    seed: int, cells: int, runs: int, count: int, more: int, tau: float
) -> None:
    rng = np.random.default_rng(seed)
    kernel, whole = _kernel(rng, cells, runs)
    size = len(whole)
    columns, beside = rng.standard_normal((size, count)), rng.standard_normal((size, more))
    shared = int(rng.integers(0, count + 1))
    scale = rng.integers(0, 2, count) * rng.uniform(0.1, 3.0, count)
    scale[:shared] = 1.0
    of = rng.standard_normal((size, 2))
    sizes = rng.uniform(0.1, 3.0, more)
    chosen = np.hstack((columns * scale, beside * sizes))
    dense = np.eye(size) + tau**2 * whole + chosen @ chosen.T
    weighted = Weighted(kernel.rotated(columns), 1.0 + tau**2 * kernel.values, shared)
    reduced = weighted.reduced(scale[shared:], kernel.rotated(np.hstack((of, beside))))
    found = reduced.widened(2, range(2, 2 + more), sizes)
    np.testing.assert_allclose(found.gram, of.T @ np.linalg.solve(dense, of), rtol=1e-8, atol=1e-9)
    assert found.log_determinant == pytest.approx(np.linalg.slogdet(dense)[1], abs=1e-8)


def test_runs_alike_deviate_alike(clean: tuple[GapRun, ...]) -> None:
    alike = likeness([one.set_point for one in clean])
    np.testing.assert_allclose(np.diagonal(alike), 1.0)
    assert np.linalg.eigvalsh(alike).min() > 0.0
    assert likeness([clean[0].set_point, clean[0].set_point])[0, 1] == pytest.approx(0.8)


@pytest.mark.slow
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


@pytest.fixture(scope="module")
def beside(rig: SimulatedRig, clean: tuple[GapRun, ...]) -> Background:
    problem = replace(problem_of(rig, clean), moved={"a11": 1.5})
    looked = [look(problem, find(name)) for name in NAMES]
    return background(problem, looked, np.arange(len(problem.free)) < 4)


def test_what_nothing_names_has_its_normal_density(beside: Background) -> None:
    stated, columns = beside.residual, beside.tolerances
    dense, one = _dense(beside.kernel), np.eye(len(stated))
    none, coefficients = beside.no_effect(), beside.coefficients()
    # Each of the four coefficients wide by itself, or all of them.
    wide = [np.where(np.arange(columns.shape[1]) == k, WIDE, 1.0) for k in range(4)]
    wide.append(np.where(beside.sought, WIDE, 1.0))
    for at_, tau in enumerate(TAUS):
        within = one + tau**2 * dense
        if tau > TOLERATED:
            assert none[at_] == coefficients[at_] == -np.inf
        else:
            assert none[at_] == pytest.approx(_log(stated, within + columns @ columns.T), rel=1e-6)
            each = [_log(stated, within + (columns * w**2) @ columns.T) for w in wide]
            mean = np.logaddexp.reduce(each) - np.log(len(each))
            assert coefficients[at_] == pytest.approx(mean, rel=1e-6)


@pytest.mark.slow
def test_what_is_unknown_has_its_normal_density(beside: Background) -> None:
    stated = beside.residual
    dense, free = _dense(beside.kernel), np.eye(len(stated)) + _square(beside.tolerances)
    for at_, tau in enumerate(TAUS):
        for stage, logs in beside.unknown_by_stage().items():
            plain = STRANGE * tau**2 * dense * _both(beside.rows_by_stage[stage])
            _holds(
                logs[at_], stated, free + plain + _square(tau * beside.shapes.of_stage(stage)), free
            )
        for kind, logs in beside.unknown_by_kind().items():
            _holds(logs[at_], stated, free + tau**2 * dense * _both(beside.kinds[kind].rows), free)


@pytest.mark.slow
def test_an_odd_run_has_its_normal_density(beside: Background) -> None:
    stated, dense = beside.residual, _dense(beside.kernel)
    free = np.eye(len(stated)) + _square(beside.tolerances)
    small = [tau for tau in TAUS if tau <= TOLERATED]
    run, columns = next(iter(beside.run_columns.items()))
    for at_, tau in enumerate(TAUS):
        odd = _square(tau * columns)
        each = [_log(stated, free + t**2 * dense + odd) for t in small]
        told = [np.linalg.slogdet(free + t**2 * dense + odd)[1] for t in small]
        seen = np.array(told) - np.linalg.slogdet(free)[1] > 2.0 * VISIBLE
        wanted = np.logaddexp.reduce(np.where(seen, each, -np.inf)) - np.log(len(small))
        assert beside.odd_runs()[run][at_] == pytest.approx(wanted, rel=1e-6)


@pytest.mark.slow
def test_a_named_effect_of_no_free_size_has_its_normal_density(
    rig: SimulatedRig, clean: tuple[GapRun, ...], beside: Background
) -> None:
    """Where no parameter is a size, Laplace of what is linear is exact."""
    problem = problem_of(rig, clean)
    fit = look(problem, find("connecting-rod")).fit
    assert fit is not None
    fit = linearised_at(problem, fit.candidates, fit.units)
    forms = np.random.default_rng(4).standard_normal((len(fit.signature), 2))
    one = replace(hypothesis(problem, replace(fit, forms=forms)), sizes=[], reaches=[])
    free = replace(one, bounds=np.array([[-1e9], [1e9]]) * np.ones(fit.columns.shape[1]))
    own = _square(np.hstack(list(beside.run_columns.values())))
    shapes = beside.shapes.columns * beside.shapes.weights_beside(fit.names)
    for at_, tau in enumerate(TAUS):
        whole = np.eye(len(one.target)) + _square(beside.tolerances) + _square(fit.columns)
        whole += PLAIN * tau**2 * (_dense(beside.kernel) + own) + _square(tau * shapes)
        each = [_log(one.target, whole + _square(share * forms)) for share in FORMS]
        wanted = np.logaddexp.reduce(each) - np.log(len(each))
        assert beside.effect_evidence([free])[0][at_].log_evidence == pytest.approx(
            wanted, rel=1e-6
        )


def test_what_stands_beside_an_effect_has_not_its_shape(beside: Background) -> None:
    shapes = beside.shapes
    kept = shapes.weights_beside(["viscous-guides"])
    alike = shapes.alike["viscous-guides"]
    assert "viscous-guides" in alike
    assert [bool(one) for one in kept] == [one not in alike for one in shapes.effects]
    relative = (shapes.columns * kept)[:, kept > 0.0]
    assert relative.shape[1] < len(shapes.effects)


def _both(rows: BoolArray) -> FloatArray:
    return np.outer(rows, rows).astype(np.float64)


def _square(columns: FloatArray) -> FloatArray:
    return np.asarray(columns @ columns.T, np.float64)


def _holds(log: float, residual: FloatArray, covariance: FloatArray, free: FloatArray) -> None:
    """Hold a log evidence against the dense one; it is none where the deviation hardly shows."""
    told = np.linalg.slogdet(covariance)[1] - np.linalg.slogdet(free)[1]
    if np.isfinite(log):
        assert log == pytest.approx(_log(residual, covariance), rel=1e-6)
    else:
        assert told <= 2.0 * VISIBLE


def _log(residual: FloatArray, covariance: FloatArray) -> float:
    """Return a normal's log density but for the constant that all answers share."""
    root = np.linalg.cholesky(covariance)
    left = np.linalg.solve(root, residual)
    return float(-0.5 * left @ left - np.log(np.diagonal(root)).sum())
