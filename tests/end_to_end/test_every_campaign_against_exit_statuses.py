"""Every campaign that is shipped or made, through every command: done, or a refusal with a remedy.

The oracle is the promise of the command line: status 0, or 1 or 2 with a sentence; what may refuse,
and which way out it has to name, stands here.
"""

import re
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Final

import pytest
from click.testing import CliRunner

from benchmarks.boards.campaigns import (
    EXAMPLES,
    LESS,
    SHORT,
    carried_out,
    foreign,
    initiated,
    less,
    simulated,
)
from pmm.cli import cli

# Two effects in place of the catalogue: what takes time is not what is asked for here.
GAP: Final = ("gap", "--jobs", "1", "--effects", "coulomb-friction", "--effects", "gain-error")
COMMANDS: Final = (("analyse",), ("coefficients",), ("report", "--output"), GAP)
SEED: Final = 22


def _example(name: str, folder: Path) -> Path:
    return simulated(EXAMPLES / name / "campaign.toml", folder, SEED, ())


def _as_shipped(_: Path) -> Path:
    return EXAMPLES / "foreign"


def _begun(folder: Path) -> Path:
    return initiated(sorted((EXAMPLES / "foreign").glob("*.csv.gz")), folder)


def _carried_out(rig: str, plan: str | None, without: tuple[str, ...], folder: Path) -> Path:
    return carried_out(rig, without, plan, folder, SEED, ())


MADE: Final[Mapping[str, Callable[[Path], Path]]] = {
    "examples/vertical": partial(_example, "vertical"),
    "examples/horizontal": partial(_example, "horizontal"),
    "examples/gap": partial(_example, "gap"),
    "examples/foreign": _as_shipped,
    "examples/foreign, simulated": lambda folder: foreign(folder, SEED, ()),
    "demo/vertical": partial(_carried_out, "vertical", None, ()),
    "demo/horizontal": partial(_carried_out, "horizontal", None, ()),
    "pmm init campaign": _begun,
    **{less(one): partial(_carried_out, "vertical", SHORT, one) for one in LESS},
}
ONE_FORCE: Final = less(LESS[-1])
# What may refuse, and the way out that it names.
REFUSED: Final[Mapping[tuple[str, str], str]] = {
    ("examples/horizontal", "gap"): "2 runs to fit, a diagnosis needs 3: record more set-points",
    ("demo/horizontal", "gap"): "2 runs to fit, a diagnosis needs 3: record more set-points",
    (ONE_FORCE, "coefficients"): "force_aft",
    (ONE_FORCE, "report"): "force_aft",
}


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    """Return what makes a campaign the first time that it is asked for."""
    there: dict[str, Path] = {}

    def made(name: str) -> Path:
        if name not in there:
            there[name] = MADE[name](tmp_path_factory.mktemp("walk"))
        return there[name]

    return made


@pytest.mark.parametrize("command", COMMANDS, ids=lambda words: words[0])
@pytest.mark.parametrize("name", MADE)
def test_done_or_a_way_out(
    name: str, command: tuple[str, ...], campaign: Callable[[str], Path], tmp_path: Path
) -> None:
    page = [str(tmp_path / "page.html")] if command[-1] == "--output" else []
    done = CliRunner().invoke(cli, [command[0], str(campaign(name)), *command[1:], *page])
    assert done.exception is None or isinstance(done.exception, SystemExit), repr(done.exception)
    refusal = REFUSED.get((name, command[0]))
    if done.exit_code == 0:
        assert refusal is None, f"{name}: {command[0]} does not refuse any more"
        assert done.stdout
        return
    said = re.sub(r"\s+", " ", done.stderr)
    assert done.exit_code in (1, 2)
    assert "error: " in said
    assert refusal is not None, said
    assert re.search(refusal, said), said
