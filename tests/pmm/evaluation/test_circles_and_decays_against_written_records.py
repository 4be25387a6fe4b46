"""What is shown of circles and free decays, of records that Newton's law and ``solve_ivp`` made."""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from pmm.campaign.campaign_file import read_campaign
from pmm.document.data import as_json
from pmm.evaluation.evaluation import Evaluation
from pmm.evaluation.water_tests import InWater, in_water
from pmm.report.evaluation_document import evaluation_document, evaluation_figures
from tests.pmm.coefficients import test_circles_against_newton as circles
from tests.pmm.coefficients import test_free_decays_against_solve_ivp as decays
from tests.pmm.coefficients.test_free_decays_against_solve_ivp import folder

__all__ = ["folder"]


def shown(water: InWater) -> tuple[dict, list[str]]:
    found = Evaluation((), None, (), (), (), water)
    return json.loads(as_json(evaluation_document(found))), [
        one.name for one in evaluation_figures(found)
    ]


def test_circles_have_their_rate_and_loads(tmp_path: Path) -> None:
    circles.campaign(tmp_path, rate_error=0.03)
    water = in_water(read_campaign(tmp_path / "campaign.toml"), tmp_path)
    assert not water.failed
    assert not water.tows
    document, _ = shown(water)
    rows = {one["run"]: one for one in document["steady_turns"]}
    assert len(rows) == 12
    first = rows["c0"]
    assert first["turn_rate_rad_s"] == pytest.approx(1.03 * circles.U_M_S / 4.0, rel=1e-4)
    assert first["radius_m"] == pytest.approx(4.0, rel=1e-3)
    gauges = np.loadtxt(tmp_path / "c0.csv", delimiter=",", skiprows=1)[:, 1:3]
    force = float(np.sum(gauges.mean(axis=0) - circles.OFFSET_N))
    assert first["force_n"] == pytest.approx(force, abs=4.0 * first["u_force_n"] + 1e-3)


def test_decays_have_period_and_damping_ratio(folder: Path) -> None:
    water = in_water(read_campaign(folder / "campaign.toml"), folder)
    document, figures = shown(water)
    (row,) = document["free_decays"]
    assert row["runs"] == ["decay-0", "decay-1", "decay-2"]
    stiffness = decays.MASS_KG * decays.GRAVITY * decays.GM_M
    inertia = decays.INERTIA_KG_M2 - decays.K_PDOT
    natural = math.sqrt(stiffness / inertia)
    ratio = -decays.K_P / (2.0 * inertia * natural)
    period = 2.0 * math.pi / (natural * math.sqrt(1.0 - ratio**2))
    assert abs(row["period_s"] - period) < 4.0 * row["u_period_s"]
    assert abs(row["damping_ratio"] - ratio) < 4.0 * row["u_damping_ratio"]
    assert "decays" in figures
    assert "decays" not in shown(replace(water, decays=()))[1]
