"""The command that ``pmm simulate`` names next takes what the folder holds, for every example."""

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner

from pmm.cli import cli

EXAMPLES = Path(__file__).parents[2] / "examples"
NEXT = {
    "attitude": "analyse",
    "gap": "analyse",
    "horizontal": "analyse",
    "lines": "analyse",
    "roll": "analyse",
    "steering": "steering",
    "vertical": "analyse",
}


def tried(file: Path, folder: Path, command: str) -> None:
    """Simulate a campaign, and do what is named next."""
    made = CliRunner().invoke(cli, ["simulate", str(file), "--output", str(folder)])
    assert made.exit_code == 0, made.output
    words = shlex.split(made.stdout.splitlines()[-1])
    assert words[:3] == ["pmm", command, str(folder)]
    done = CliRunner().invoke(cli, words[1:])
    assert done.exit_code == 0, done.output


@pytest.mark.slow
@pytest.mark.parametrize(("example", "command"), NEXT.items())
def test_what_is_named_next_takes_the_folder(tmp_path: Path, example: str, command: str) -> None:
    tried(EXAMPLES / example / "campaign.toml", tmp_path / "a folder", command)


@pytest.mark.slow
def test_coefficients_take_what_is_towed_alone(tmp_path: Path) -> None:
    text = (EXAMPLES / "attitude" / "campaign.toml").read_text(encoding="utf-8")
    tows = re.sub(r"\[\[runs\]\].*?(?=\[\[|\Z)", "", text, flags=re.DOTALL)
    assert tows != text
    (tmp_path / "tows.toml").write_text(tows, encoding="utf-8")
    tried(tmp_path / "tows.toml", tmp_path / "tows", "coefficients")


def test_every_example_is_tried() -> None:
    assert {path.parent.name for path in EXAMPLES.glob("*/campaign.toml")} - set(NEXT) == {
        "foreign"  # records of another system, which nothing simulates
    }
