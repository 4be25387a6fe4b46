"""How many states are chosen, and what is refused, of values drawn about closed forms."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.memory.fit import fit_measured
from analysis.memory.measured_matrices import FEWEST, MeasuredMatrix
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray
from hardware.description.oscillator import Plane
from tests.analysis.memory import planted

OMEGA = np.geomspace(1.8, 11.0, 9)
SHARE = 2e-3  # of the largest damping, scatter of each value


def drawn(true: FloatArray, seed: int, omega: FloatArray = OMEGA) -> MeasuredMatrix:
    """Values about true ones ``(e, 2, k)``, each frequency with a scatter of its own."""
    size = SHARE * np.abs(true[:, 1]).max(axis=1)
    spread = np.stack([size[:, None] / omega, np.broadcast_to(size[:, None], true[:, 1].shape)], 1)
    values = true + spread * np.random.default_rng(seed).standard_normal(true.shape)
    places = np.arange(true.size).reshape(true.shape)
    sources = tuple(
        Contribution(f"scatter: {k}", 30.0, places[..., k].ravel(), np.diag(spread[..., k].ravel()))
        for k in range(omega.size)
    )
    dofs = (0, 1) if len(true) == 3 else (0,)
    return MeasuredMatrix(Plane.HORIZONTAL, dofs, omega, UncertainValues(values.ravel(), sources))


def test_one_motion_by_itself_has_its_two_states() -> None:
    every = [fit_measured(drawn(planted.curves(OMEGA)[:1], seed)) for seed in range(3)]
    assert np.median([one.chosen.states for one in every]) == 2
    for one in every:
        told = one.curves(OMEGA)
        off = np.abs(told.values - planted.curves(OMEGA)[:1].ravel())
        assert (off <= 2.0 * told.half_width(0.95)).all()
        assert one.radiation.added_mass_infinite[1, 1] == 0.0


def test_the_fewest_frequencies_bear_two_states() -> None:
    omega = np.geomspace(2.0, 10.0, FEWEST)
    one = fit_measured(drawn(planted.curves(omega)[:1], 0, omega))
    assert [order.states for order in one.orders] == [0, 2]
    assert one.chosen.states == 2


def test_damping_that_gives_energy_is_contradicted() -> None:
    true = planted.curves(OMEGA)[:1]
    assert not fit_measured(drawn(true, 1)).contradicted
    true[0, 1] -= 60.0 * np.exp(-((OMEGA - 3.0) ** 2))
    assert true[0, 1].min() < -10.0
    one = fit_measured(drawn(true, 1))
    assert one.contradicted
    assert (one.radiation.damping(OMEGA)[:, 0, 0] + one.steady[0] >= -1e-9).all()


def test_a_steady_damping_that_comes_out_negative_is_none() -> None:
    true = planted.curves(OMEGA)[:1]
    true[0, 1] -= planted.STEADY[0, 0] + 2.0
    one = fit_measured(drawn(true, 2))
    assert one.steady[0] == 0.0


def test_what_all_runs_share_moves_the_curves_and_not_the_choice() -> None:
    measured = drawn(planted.curves(OMEGA)[:1], 4)
    mass = np.concatenate([np.full(OMEGA.size, 0.5), np.zeros(OMEGA.size)])
    uncertain = measured.uncertain.plus("mass", mass)
    both = [fit_measured(one) for one in (measured, replace(measured, uncertain=uncertain))]
    assert both[0].orders == both[1].orders
    told = both[1].curves(OMEGA)
    part = next(one for one in told.contributions if one.label == "mass").dense(len(told))[:, 0]
    assert part[: OMEGA.size] == pytest.approx(0.5, abs=1e-6)
    assert part[OMEGA.size :] == pytest.approx(0.0, abs=1e-5)


@pytest.mark.slow
def test_intervals_hold_the_truth_and_chance_is_seldom_a_memory() -> None:
    """Of 20 campaigns each: at least 0.90 of all values of 95 % intervals; at most 2 memories."""
    held, constant = [], np.ones((3, 2, OMEGA.size)) * np.array([60.0, 4.0, 17.0])[:, None, None]
    for seed in range(20):
        told = fit_measured(drawn(planted.curves(OMEGA), seed)).curves(OMEGA)
        off = np.abs(told.values - planted.curves(OMEGA).ravel())
        held.append(np.mean(off <= told.half_width(0.95)))
    assert np.mean(held) >= 0.90
    memories = [fit_measured(drawn(constant, seed)).chosen.states for seed in range(20)]
    assert np.count_nonzero(memories) <= 2
