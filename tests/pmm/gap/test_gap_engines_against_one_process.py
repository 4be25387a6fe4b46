"""``pmm gap`` in this process, in local processes and on a Dask cluster: the same numbers."""

import json
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.pmm.gap.rigs import FEW, run, with_friction


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


def test_two_processes(rig: Path, alone: dict[str, Any]) -> None:
    assert alone["ranking"][0]["answer"] == "coulomb-friction"
    assert_same(alone, found(rig, "--jobs", "2"))


@pytest.mark.slow
def test_a_cluster(rig: Path, alone: dict[str, Any]) -> None:
    distributed = pytest.importorskip("distributed")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # distributed's own, of ports
        with distributed.LocalCluster(
            n_workers=1, threads_per_worker=1, host="127.0.0.1", dashboard_address=None
        ) as cluster:
            assert_same(alone, found(rig, "--scheduler", cluster.scheduler_address))


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
