"""The container's file against what its lines need, and its lines carried out without a builder."""

import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from pmm.cli.console import console

HOUSE = Path(__file__).parents[1]
FILE = (HOUSE / "Containerfile").read_text(encoding="utf-8").replace("\\\n", "")
LINES = [one.partition(" ") for one in FILE.splitlines() if one and not one.startswith("#")]
IGNORED = (HOUSE / ".containerignore").read_text(encoding="utf-8").split()


def _lines(word: str) -> list[str]:
    return [rest for first, _, rest in LINES if first == word]


def test_it_ends_as_a_user_without_rights() -> None:
    assert re.fullmatch(r"[1-9]\d+:[1-9]\d+", _lines("USER")[-1])


def test_the_program_that_it_starts_is_one_of_the_distribution() -> None:
    project = tomllib.loads((HOUSE / "pyproject.toml").read_text(encoding="utf-8"))
    assert [one.strip('["]') for one in _lines("ENTRYPOINT")] == list(project["project"]["scripts"])


def test_the_port_that_it_names_is_the_consoles() -> None:
    (port,) = (one.default for one in console.params if one.name == "port")
    assert _lines("EXPOSE") == [str(port)]


def test_what_was_built_meets_the_python_it_was_built_with() -> None:
    built, last = _lines("FROM")
    assert built == f"{last} AS built"


def test_nothing_that_the_build_reads_is_left_out() -> None:
    """Without git the version would be the fallback; without lock or sources nothing is built."""
    names = {"pmm", "hardware", "analysis", "sim", "planar_motion_mechanism.py", "pyproject.toml"}
    assert not (names | {"README.md", "LICENSE", "lock", ".git"}) & set(IGNORED)


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_its_lines_carried_out_here_make_a_program_that_runs(tmp_path: Path) -> None:
    """All but the system's own lines, in a copy of what is not ignored, without a container."""
    source, made = tmp_path / "source", tmp_path / "pmm"
    subprocess.run(["git", "clone", "-q", str(HOUSE), str(source)], check=True)  # noqa: S607
    install = _lines("RUN")[1].replace("/opt/pmm", str(made))
    without = {name: one for name, one in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run(["sh", "-ec", install], cwd=source, env=without, check=True)  # noqa: S607
    told = subprocess.run(
        [str(made / "bin" / "pmm"), "--help"],
        cwd=tmp_path, env=without, check=True, capture_output=True, text=True,
    )  # fmt: skip
    assert "Planar motion mechanism" in told.stdout
