"""``pmm init campaign`` on K. R. Sundsdal's measured waves, whose periods are published (CC0)."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from pmm.start.recordings import find_campaign

NEAR = [place / "shared" / "data" / "wave_forces" for place in Path(__file__).parents]
WAVES = next((place for place in NEAR if place.is_dir()), None)
PERIODS_S = {"2091_1": 1.036, "2111_1": 0.802}  # numbers 9 and 11 of the data's table

pytestmark = pytest.mark.skipif(WAVES is None, reason="the measured waves are not beside it")


def records() -> list[Path]:
    assert WAVES is not None
    return [WAVES / f"{name}.csv.gz" for name in PERIODS_S]


def pmm(*words: object) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in words])


def test_the_wave_maker_tells_the_frequency_and_no_balance_is_a_gauge(tmp_path: Path) -> None:
    found = find_campaign(records(), tmp_path)
    for run in found.runs:
        assert run.doubt == ""
        assert run.frequency_hz == pytest.approx(1.0 / PERIODS_S[run.name], rel=2e-3)
    sure = {one.name: one.column for one in found.columns if not one.doubt}
    assert sure["displacement_aft"] == "WM_Position"
    assert not {"shaft_angle", "force_aft", "force_fore", "force_x"} & set(sure)
    assert sure["Fy"] == "Fy"


@pytest.mark.slow
def test_the_commands_take_it_or_say_what_is_missing(tmp_path: Path) -> None:
    model = ("--mass-kg", "70", "--inertia-kg-m2", "27.5")
    made = pmm("init", "campaign", "--yes", "--output", tmp_path, *model, *records())
    assert made.exit_code == 0, made.stderr
    assert "not sure, commented out: force_aft = 'Fy'" in made.stderr
    analysed = pmm("analyse", tmp_path, "--json")
    assert analysed.exit_code == 0
    assert len(json.loads(analysed.stdout)["runs"]) == 2
    for command in ("coefficients", "gap"):
        refused = pmm(command, tmp_path)
        assert refused.exit_code == 1
        assert "no channel force_aft or force_fore" in refused.stderr
