"""What ``docs/inertia-files.md`` shows is what its commands do, and every key is on the page."""

import json
import re
import shlex
import tomllib
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, get_args, get_type_hints

import pytest
from click.testing import CliRunner, Result

from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli
from pmm.inertia.bifilar_tables import BifilarTable
from pmm.inertia.incline import InclineJob
from pmm.inertia.parts import BallastJob, CombineJob
from pmm.inertia.pendulum import PendulumJob
from pmm.inertia.plan import PlanJob
from pmm.inertia.swing_tables import SwingTable

HOUSE = Path(__file__).parents[2]
EXAMPLES = HOUSE / "examples" / "inertia"
PAGE = (HOUSE / "docs" / "inertia-files.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)


def run(command: str) -> Result:
    program, *arguments = shlex.split(command.replace("examples/", f"{HOUSE}/examples/"))
    assert program == "pmm"
    return CliRunner().invoke(cli, arguments, catch_exceptions=False)


COMMANDS = [line for block in blocks("sh") for line in block.strip().splitlines()]


def test_every_job_has_a_command() -> None:
    assert {line.split()[2] for line in COMMANDS} == {
        "swing",
        "bifilar",
        "pendulum",
        "incline",
        "combine",
        "ballast",
        "plan",
    }


@pytest.mark.sample(1)
@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_runs(command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    result = run(command)
    assert result.exit_code == 0, result.stderr
    if "--plot" in command:
        assert len(list((tmp_path / "plots").glob("*.svg"))) >= 2
    if "--json" in command:
        assert json.loads(result.stdout)["schema"] == "pmm-inertia-1"
    if "--output" in command:
        assert set(tomllib.loads(Path("model.toml").read_text())) == {
            "model",
            "model_uncertainty",
        }


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("job", "number", "example"), [("swing", 0, "swing"), ("bifilar", 1, "hull")]
)
def test_the_shown_lines_are_printed(
    job: str, number: int, example: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    printed = run(f"pmm inertia {job} examples/inertia/{example}.toml").stdout
    lines = {" ".join(line.split()) for line in printed.splitlines()}
    for line in blocks("text")[number].splitlines():
        assert " ".join(line.split()) in lines


@pytest.mark.slow
@pytest.mark.parametrize(("job", "number"), [("swing", 0), ("bifilar", 1)])
def test_every_file_on_the_page_runs(job: str, number: int, tmp_path: Path) -> None:
    for record in EXAMPLES.glob("*.csv.gz"):
        (tmp_path / record.name).symlink_to(record)
    (tmp_path / "job.toml").write_text(blocks("toml")[number])
    result = run(f"pmm inertia {job} {tmp_path}/job.toml")
    assert result.exit_code == 0, result.stderr


def _keys(kind: Any) -> set[str]:
    """Return the keys of a table and of all within it, but for uncertainties."""
    if not is_dataclass(kind):
        return set().union(*map(_keys, get_args(kind)))
    hints = get_type_hints(kind)
    own = {one.name for one in fields(kind) if not one.name.startswith("u_")}
    return own.union(*(_keys(hints[name]) for name in own))


@pytest.mark.parametrize(
    "kind", [SwingTable, BifilarTable, PendulumJob, InclineJob, CombineJob, BallastJob, PlanJob]
)
def test_every_key_is_on_the_page(kind: type) -> None:
    words = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`\n]+)`", PAGE))))
    assert sorted(_keys(kind) - words) == []


@pytest.mark.slow
def test_the_section_is_a_campaigns(tmp_path: Path) -> None:
    target = tmp_path / "campaign.toml"
    result = run(f"pmm inertia bifilar examples/inertia/hull.toml --output {target}")
    assert result.exit_code == 0, result.stderr
    campaign = read_campaign(target)
    body, spread = campaign.model, campaign.model_uncertainty
    assert body is not None
    assert spread is not None
    assert body.mass_kg == 603.2
    assert body.inertia_kg_m2 == pytest.approx(603.2 * (1.056**2 + 0.018**2), rel=2e-3)
    assert spread.inertia_kg_m2 == pytest.approx(2.0 * 603.2 * 1.056 * 0.00085, rel=0.2)
    assert spread.cg_x_m == 0.001


@pytest.mark.slow
def test_forms_of_one_oscillation_are_said_to_be_that() -> None:
    told = {
        example: run(f"pmm inertia {job} examples/inertia/{example}.toml --fits").stdout
        for job, example in (("swing", "swing"), ("bifilar", "hull"))
    }
    assert "F4 damped, with an offset" in told["swing"]
    assert "no record here has just one" not in told["swing"]
    assert "F1 to F4 are forms of one oscillation; no record here has just one" in told["hull"]
