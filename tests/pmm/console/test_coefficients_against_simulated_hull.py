"""The coefficients on the page are the simulated hull's; what cannot be read is said."""

from pathlib import Path

import pytest

from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.simulation import copy_campaign, simulate_runs
from pmm.console.figures import figures_of

CAMPAIGN = Path(__file__).parents[3] / "examples" / "vertical" / "campaign.toml"
ADDED_MASS_KG = 75.0


def _campaign(folder: Path) -> Path:
    campaign = read_campaign(CAMPAIGN)
    runs = [one for one in campaign.runs if one.name == "heave-0.83"]
    list(simulate_runs(campaign, runs, folder, campaign.simulation.seed, overwrite=False))
    copy_campaign(CAMPAIGN, campaign, folder)
    return folder


def test_added_mass_stands_beside_earlier_and_reference(tmp_path: Path) -> None:
    folder = _campaign(tmp_path / "now")
    table = tmp_path / "strips.csv"
    table.write_text("# strip theory\nfrequency_hz,Z_wdot\n0.5,-80\n1.0,-76.5\n", encoding="utf-8")
    found = figures_of((folder,), (folder,), table)
    points = [one for one in found["points"] if one["name"] == "Z_wdot"]
    measured = {one["of"]: one for one in points if one["of"] != "reference"}
    assert set(measured) == {"now", "earlier"}
    now = measured["now"]
    assert now["runs"] == ["heave-0.83"]
    assert now["value"] == pytest.approx(-ADDED_MASS_KG, abs=2.0 * now["half_width"])
    reference = [(o["frequency_hz"], o["value"]) for o in points if o["of"] == "reference"]
    assert reference == [(0.5, -80.0), (1.0, -76.5)]
    assert not found["problems"]


def test_what_cannot_be_read_is_said_by_name(tmp_path: Path) -> None:
    folder = _campaign(tmp_path / "now")
    found = figures_of((folder,), (tmp_path / "gone",), tmp_path / "none.csv")
    assert {one["of"] for one in found["points"]} == {"now"}
    gone, none = found["problems"]
    assert gone.startswith("gone:")
    assert f"{tmp_path / 'none.csv'}: no such file" in none


def test_a_table_is_read_as_the_report_reads_it(tmp_path: Path) -> None:
    folder = _campaign(tmp_path / "now")
    table = tmp_path / "panels.csv"
    values = "omega_rad_s,coefficient,value\n3.1415926535897931,Z_wdot,-80\n"
    table.write_text(values, encoding="utf-8")
    found = figures_of((folder,), (), table)
    reference = [one for one in found["points"] if one["of"] == "reference"]
    assert [(one["frequency_hz"], one["value"]) for one in reference] == [(0.5, -80.0)]
    table.write_text(f"# system = prime\n{values}", encoding="utf-8")
    found = figures_of((folder,), (), table)
    assert not [one for one in found["points"] if one["of"] == "reference"]
    (problem,) = found["problems"]
    assert "in the system prime, the page shows dimensional" in problem


@pytest.mark.parametrize("left", ['outcome = "fault"', 'medium = "air"'])
def test_nothing_is_missed_before_a_run_in_water_is_complete(tmp_path: Path, left: str) -> None:
    (tmp_path / "campaign.toml").write_text(f'[[runs]]\nname = "a"\n{left}\n', encoding="utf-8")
    assert figures_of((tmp_path,), (), None) == {"points": [], "problems": []}
