"""Every campaign that is shipped or made, through every command: done, or a refusal with a remedy.

What may refuse, and which way out it has to name, stands here. The demo's campaigns are walked
beside its other promises.
"""

import shutil
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Final

import pytest

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
from tests.end_to_end.walk import COMMANDS, done_or_a_way_out

SEED: Final = 22


def _example(name: str, folder: Path) -> Path:
    return simulated(EXAMPLES / name / "campaign.toml", folder, SEED, ())


def _as_shipped(folder: Path) -> Path:
    return shutil.copytree(EXAMPLES / "foreign", folder / "foreign")


def _begun(folder: Path) -> Path:
    return initiated(sorted((EXAMPLES / "foreign").glob("*.csv.gz")), folder)


def _carried_out(without: tuple[str, ...], folder: Path) -> Path:
    return carried_out("vertical", without, SHORT, folder, SEED, ())


# With files of other programs, which have no checksums.
OF_OTHERS: Final[Mapping[str, Callable[[Path], Path]]] = {
    "examples/foreign": _as_shipped,
    "examples/foreign, simulated": lambda folder: foreign(folder, SEED, ()),
    "pmm init campaign": _begun,
}
MADE: Final[Mapping[str, Callable[[Path], Path]]] = {
    "examples/vertical": partial(_example, "vertical"),
    "examples/horizontal": partial(_example, "horizontal"),
    "examples/gap": partial(_example, "gap"),
    **OF_OTHERS,
    **{less(one): partial(_carried_out, one) for one in LESS},
}
ONE_FORCE: Final = less(LESS[-1])
# What may refuse, and the way out that it names.
REFUSED: Final[Mapping[tuple[str, str], str]] = {
    ("examples/horizontal", "gap"): "2 runs to fit, a diagnosis needs 3: record more set-points",
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


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS, ids=lambda words: words[0])
@pytest.mark.parametrize("name", MADE)
def test_done_or_a_way_out(
    name: str, command: tuple[str, ...], campaign: Callable[[str], Path]
) -> None:
    refusal = REFUSED.get((name, command[0]))
    done_or_a_way_out(campaign(name), command, refusal, checked=name not in OF_OTHERS)
