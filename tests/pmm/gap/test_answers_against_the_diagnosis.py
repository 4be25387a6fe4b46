"""``pmm gap answer`` takes the way of ``pmm gap``: it begins where the coefficients fit."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest

from sim.effects import catalogue as effects
from tests.pmm.gap.rigs import made, rewritten, run

FAR = ("[[75.0, 3.0]", "[[30.0, 3.0]")  # in a tolerance of 20 %
FEW = {name: effects.catalogue()[name] for name in ("coulomb-friction", "gain-error")}


def answered(rig: Path, folder: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Return the answer to a board of this one case."""
    monkeypatch.setattr(effects, "catalogue", lambda: FEW)
    shutil.copytree(rig, folder / "board" / "cases" / "case-0001")
    done = run("gap", "answer", folder / "board", "--jobs", "1")
    assert done.exit_code == 0, done.output
    found: dict[str, Any] = json.loads(
        (folder / "board" / "answers" / "case-0001.json").read_text()
    )
    return found


@pytest.mark.slow
def test_coefficients_that_had_to_be_moved_are_the_answer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    far = rewritten(made(tmp_path), tmp_path, *FAR)
    (tmp_path / "one").mkdir()
    shares = answered(far, tmp_path / "one", monkeypatch)["probabilities"]
    assert shares["coefficients"] > 0.8
    assert shares["none"] < 0.2
    assert sum(shares.values()) == pytest.approx(1.0)


@pytest.mark.slow
def test_an_effect_beside_coefficients_that_had_to_be_moved(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rig = made(tmp_path, "--effect", "coulomb-friction:friction_n=0.3")
    copy = rewritten(rig, tmp_path, *FAR)
    (copy / "heave-0.50-20.nc").unlink()
    found = answered(copy, tmp_path, monkeypatch)
    assert max(found["probabilities"], key=found["probabilities"].get) == "coulomb-friction"
    (effect,) = found["effects"]
    assert effect["parameters"]["friction_n"]["value"] == pytest.approx(0.3, rel=0.05)
