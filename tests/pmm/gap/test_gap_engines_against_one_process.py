"""Campaigns and boards in this process, in local processes and on a cluster: the same numbers."""

import json
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sim.effects.catalogue import catalogue
from tests.clusters import cluster
from tests.pmm.gap.rigs import FEW, run, with_friction

CASES = ("case-0001", "case-0002", "case-0003")


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return with_friction(tmp_path_factory.mktemp("engines"))


@pytest.fixture(scope="module")
def alone(rig: Path) -> dict[str, Any]:
    """What one process finds."""
    return found(rig)


def found(campaign: Path, *options: str) -> dict[str, Any]:
    done = run("gap", campaign, *FEW, "--json", *options)
    assert done.exit_code == 0, done.output
    document: dict[str, Any] = json.loads(done.stdout)
    return document


@pytest.fixture(scope="module")
def board(rig: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a board of two such campaigns, one with a run less, and of one with no runs at all."""
    folder = tmp_path_factory.mktemp("board")
    for name in CASES:
        shutil.copytree(rig, folder / "cases" / name)
    (folder / "cases" / CASES[1] / "heave-0.50-20.nc").unlink()
    for path in (folder / "cases" / CASES[2]).glob("*.nc"):
        path.unlink()
    others = sorted({*catalogue()} - {*FEW[1::2]})
    (folder / "leave-out.json").write_text(json.dumps(dict.fromkeys(CASES, others)))
    return folder


@pytest.fixture(scope="module")
def answers(board: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What one process answers, and says of the case that has no runs."""
    return answered(board, tmp_path_factory.mktemp("one"), "--jobs", "1")


def answered(board: Path, target: Path, *options: str) -> dict[str, bytes]:
    """Return the bytes of each answer, and why a case has none."""
    few = ("--leave-out", board / "leave-out.json")
    done = run("gap", "answer", board, *few, "--output", target, *options)
    assert done.exit_code == 1, done.output
    said = "".join(line for line in done.stderr.splitlines() if line.startswith("error:"))
    written = {path.name: path.read_bytes() for path in target.iterdir()}
    assert sorted(written) == [f"{name}.json" for name in CASES[:2]]
    return {**written, "": said.encode()}


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Yield every number and text of a document with its place."""
    if isinstance(value, dict | list):
        pairs = value.items() if isinstance(value, dict) else enumerate(value)
        for key, one in pairs:
            yield from leaves(one, f"{path}.{key}")
    else:
        yield path, value


def assert_same(one: dict[str, Any], other: dict[str, Any]) -> None:
    left, right = dict(leaves(one)), dict(leaves(other))
    assert left.keys() == right.keys()
    for place, value in left.items():
        if isinstance(value, float):
            np.testing.assert_allclose(right[place], value, rtol=1e-6, atol=1e-9, err_msg=place)
        else:
            assert right[place] == value, place


@pytest.mark.slow
def test_two_processes(rig: Path, alone: dict[str, Any]) -> None:
    assert alone["ranking"][0]["answer"] == "coulomb-friction"
    assert_same(alone, found(rig, "--jobs", "2"))


@pytest.mark.slow
def test_a_board_in_two_processes(board: Path, answers: dict[str, bytes], tmp_path: Path) -> None:
    assert answered(board, tmp_path / "two", "--jobs", "2") == answers


@pytest.mark.slow
def test_a_cluster(
    rig: Path, alone: dict[str, Any], board: Path, answers: dict[str, bytes], tmp_path: Path
) -> None:
    with cluster() as address:
        assert_same(alone, found(rig, "--scheduler", address))
        assert answered(board, tmp_path / "cluster", "--scheduler", address) == answers


@pytest.mark.slow
def test_a_scheduler_that_is_not_there_is_named(
    board: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed")
    monkeypatch.setattr("pmm.cluster._TIMEOUT", "1s")
    done = run("gap", "answer", board, "--output", tmp_path, "--scheduler", "tcp://127.0.0.1:9")
    assert done.exit_code == 1
    assert "--scheduler tcp://127.0.0.1:9: no Dask scheduler answers there" in done.stderr
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_a_board_has_one_engine(board: Path, tmp_path: Path) -> None:
    both = ("--jobs", "2", "--scheduler", "tcp://127.0.0.1:9")
    done = run("gap", "answer", board, "--output", tmp_path, *both)
    assert done.exit_code == 2
    assert "give --jobs or --scheduler, not both" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "shared"),
    [
        (("gap",), ("--jobs", "2")),
        (("gap",), ("--scheduler", "tcp://127.0.0.1:1")),
        (("gap", "add"), ("--jobs", "2")),
    ],
)
def test_effects_of_ones_own_stay_in_this_process(
    rig: Path, tmp_path: Path, command: tuple[str, ...], shared: tuple[str, str]
) -> None:
    done = run(*command, rig, "--effects", tmp_path / "own.py", *shared)
    assert done.exit_code == 2
    assert f"leave {shared[0]} out" in done.stderr
