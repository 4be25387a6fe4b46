"""Moments of inertia that no body has, and those that bodies of points have."""

from pathlib import Path

import numpy as np
import pytest

from hardware.description.flags import Flag
from pmm.inertia.parts import run_combine

KEYS = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


def flags(tmp_path: Path, *moments: float, u: float = 0.0, more: str = "") -> list[Flag]:
    path = tmp_path / "parts.toml"
    rows = [
        f"{key}_kg_m2 = {value!r}\nu_{key}_kg_m2 = {u!r}"
        for key, value in zip(KEYS, moments, strict=False)
    ]
    text = "\n".join(rows)
    path.write_text(f'[[parts]]\nname = "hull"\nmass_kg = 10.0\n{text}\n{more}')
    return [flag for flag in run_combine(str(path)).flags if flag.code == "inertia_impossible"]


def test_more_about_one_axis_than_about_the_other_two_is_flagged_with_the_likely_one(
    tmp_path: Path,
) -> None:
    (flag,) = flags(tmp_path, 0.2, 0.5, 1.0)
    assert "hull: no body has izz above ixx + iyy" in flag.message
    assert "measure izz again first, which -0.3 kg m2 (-30 %) would mend" in flag.message
    (flag,) = flags(tmp_path, 1.6, 0.5, 1.0)
    assert "no body has ixx above iyy + izz" in flag.message


def test_of_two_that_would_mend_it_as_well_the_smaller_change_is_named(tmp_path: Path) -> None:
    (flag,) = flags(tmp_path, 0.2, 0.5, 1.0, u=0.02)
    assert "measure izz again first" in flag.message


@pytest.mark.parametrize(("u", "seen"), [(0.01, True), (0.1, True), (0.2, False)])
def test_uncertainties_may_allow_it(tmp_path: Path, u: float, seen: bool) -> None:
    # ixx + iyy - izz = -0.4, of which one standard uncertainty is sqrt(3) u.
    assert bool(flags(tmp_path, 0.1, 0.5, 1.0, u=u)) is seen


def test_bodies_of_points_have_what_they_have(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    for flat in (1.0, 1.0, 0.0):  # the last ones lie in a plane, where the sum is what it must be
        place = rng.normal(size=(6, 3)) * [1.0, 1.0, flat]
        place -= place.mean(axis=0)
        x, y, z = place.T
        moments = [y @ y + z @ z, x @ x + z @ z, x @ x + y @ y, x @ y, x @ z, y @ z]
        assert not flags(tmp_path, *(float(one) for one in moments))


def test_products_too_large_for_the_moments_are_flagged(tmp_path: Path) -> None:
    for larger in (1.0, 1.1):  # along a diagonal exactly, and nearly
        (flag,) = flags(tmp_path, 1.0, 1.2, larger, 0.0, 0.9)
        assert "measure the products first" in flag.message


def test_moments_that_were_not_given_are_not_judged(tmp_path: Path) -> None:
    weight = '[[parts]]\nname = "weight"\nmass_kg = 1.0\nx_m = 2.0\n'
    path = tmp_path / "parts.toml"
    path.write_text(f'[[parts]]\nname = "hull"\nmass_kg = 9.0\nk_yaw_m = 0.5\n{weight}')
    assert not [f for f in run_combine(str(path)).flags if f.code == "inertia_impossible"]


def test_too_much_taken_off_is_seen_in_the_whole(tmp_path: Path) -> None:
    frame = (
        '[[without]]\nname = "frame"\nmass_kg = 2.0\n'
        "ixx_kg_m2 = 0.8\niyy_kg_m2 = 0.8\nizz_kg_m2 = 0.2\n"
    )
    (flag,) = flags(tmp_path, 1.0, 1.0, 1.0, more=frame)
    assert flag.message.startswith("combined: no body has izz")
