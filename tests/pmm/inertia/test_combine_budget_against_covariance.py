"""Budgets of parts put together, against the covariance that the parallel axis theorem carries."""

from pathlib import Path

import numpy as np
import pytest

from analysis.inertia.parts import combine, combined
from pmm.inertia import parts
from pmm.inertia.combine_budget import combined_budgets
from pmm.inertia.outcome import Outcome
from pmm.inertia.properties import PartTable

EXAMPLE = Path(__file__).parents[3] / "examples" / "inertia" / "combine.toml"
HULL = PartTable("hull", 600.0, 0.3, 0.02, 0.001, 0.0, 0.0, -0.05, 0.002, 0.3, 0.004, 1.1, 0.003)
FRAME = PartTable("frame", 12.0, 0.01, z_m=-0.4, square_half_side_m=0.9, u_square_half_side_m=0.01)


@pytest.fixture(scope="module")
def keelboat() -> Outcome:
    return parts.run_combine(str(EXAMPLE))


def test_each_budget_is_as_wide_as_the_covariance_says() -> None:
    whole = combine("model", [HULL.part()], without=[FRAME.part()])
    found = combined_budgets([HULL], [FRAME])
    x, _, z = whole.centre_of_gravity
    roll, pitch, _ = whole.gyradii
    for key, value in {"cg_x_m": x, "cg_z_m": z, "k_roll_m": roll, "k_pitch_m": pitch}.items():
        result = found[key].budget.result
        assert result.value == pytest.approx(value.value, abs=1e-12)
        assert result.uncertainty == pytest.approx(value.uncertainty, rel=1e-5)
        assert found[key].monte_carlo.uncertainty == pytest.approx(value.uncertainty, rel=0.02)


def test_a_square_frames_gyradii_err_together() -> None:
    alone = combined_budgets([FRAME])
    assert alone["k_pitch_m"].result.relative == pytest.approx(0.01 / 0.9, rel=1e-3)


def test_shares_add_up_and_name_part_and_key(keelboat: Outcome) -> None:
    found = {one.name: assessment for one, assessment in keelboat.budgeted}
    gyradii = {"k_roll_m", "k_pitch_m", "k_yaw_m"}
    assert set(found) == {"cg_x_m", "cg_z_m", "ixz_kg_m2"} | gyradii
    for one in found.values():
        assert sum(line.share for line in one.budget.shares) == pytest.approx(1.0)
        assert one.linear_good_enough
    assert found["k_roll_m"].budget.shares[0].name == "hull with frame.k_roll_m"
    names = {line.name for line in found["cg_z_m"].budget.shares}
    assert "less frame.z_m" in names
    assert not any(name.endswith("k_yaw_m") for name in names)


def test_only_what_was_given_without_doubt_is_taken_to_be_exact(keelboat: Outcome) -> None:
    assert not keelboat.flags


def test_parts_of_one_name_are_told_apart() -> None:
    weight = PartTable("weight", 2.0, 0.001, 1.0, 0.002)
    twice = combined_budgets([weight, PartTable("weight", 2.0, 0.001, -1.0, 0.002)])
    names = {line.name for line in twice["cg_x_m"].budget.shares}
    assert names == {"weight (1).mass_kg", "weight (1).x_m", "weight (2).mass_kg", "weight (2).x_m"}


def test_nothing_uncertain_has_no_budget() -> None:
    assert combined_budgets([PartTable("hull", 600.0, k_yaw_m=1.0)]) == {}


def test_trials_are_combined_one_by_one() -> None:
    rows = np.random.default_rng(0).uniform(0.5, 1.0, (3, 10, 4))
    signs = np.array([1.0, 1.0, -0.5])
    each = [combined(rows[..., k], signs) for k in range(4)]
    assert combined(rows, signs) == pytest.approx(np.stack(each, axis=1))
