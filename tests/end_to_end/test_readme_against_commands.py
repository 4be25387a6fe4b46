"""What the README shows is what its commands print, and what it points to is there."""

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.cli import cli

HOUSE = Path(__file__).parents[2]
README = (HOUSE / "README.md").read_text()


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", README, flags=re.DOTALL | re.MULTILINE)


def run(command: str) -> str:
    program, *arguments = shlex.split(command)
    assert program == ".venv/bin/pmm"
    result = CliRunner().invoke(cli, arguments)
    assert result.exit_code == 0, result.stderr
    return result.stdout


def test_the_example_prints_what_the_readme_shows(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(HOUSE)
    (command,) = (block for block in blocks("sh") if "heave.toml" in block)
    (shown,) = blocks("text")
    printed = [line.rstrip() for line in run(command.strip()).splitlines()]
    for line in shown.splitlines():
        assert line in {*printed, "..."}


@pytest.mark.slow
def test_the_campaign_commands_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    wanted = [block for block in blocks("sh") if " my-campaign" in block]
    assert len(wanted) == 2
    monkeypatch.chdir(tmp_path)
    for command in "".join(wanted).strip().splitlines():
        run(command.replace("examples/", f"{HOUSE}/examples/"))
    assert (tmp_path / "my-campaign" / "report.html").is_file()
    assert len(list((tmp_path / "my-campaign").glob("*.nc"))) >= 6
    assert len(list((tmp_path / "my-campaign" / "plots").glob("*.svg"))) >= 18


def test_every_link_leads_somewhere() -> None:
    targets = re.findall(r"\]\((?!https?:)([^)#]+)\)", README)
    assert targets
    assert [target for target in targets if not (HOUSE / target).exists()] == []
