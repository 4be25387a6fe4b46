"""``pmm --help`` has to answer at once, so it imports nothing heavy; the time is a benchmark's."""

import subprocess
import sys
from pathlib import Path

import click
import pytest

from pmm.cli import cli

HOUSE = Path(__file__).parents[2]
HELP = "import sys; sys.argv = ['pmm', *{words}, '--help']; from pmm.cli import main; main()"
HEAVY = {
    "numpy", "scipy", "pandas", "xarray", "pydantic", "matplotlib", "rich", "h5py", "h5netcdf",
    "can", "canopen", "control", "starlette", "uvicorn",
}  # fmt: skip


def _run(code: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, "-c", code], cwd=HOUSE, capture_output=True, text=True, check=False
    )


def _loaded(words: list[str]) -> set[str]:
    code = (
        f"import atexit, sys; atexit.register(lambda: print(*sys.modules, file=sys.stderr)); {HELP}"
    )
    return set(_run(code.format(words=words)).stderr.split())


def _groups() -> list[list[str]]:
    context = click.Context(cli)
    commands = {name: cli.get_command(context, name) for name in cli.list_commands(context)}
    return [[name] for name, one in commands.items() if isinstance(one, click.Group)]


def test_help_imports_nothing_heavy() -> None:
    loaded = _loaded([])
    assert "pmm.cli.analyse" in loaded
    assert not HEAVY & loaded


@pytest.mark.parametrize("words", _groups(), ids=" ".join)
def test_help_of_a_group_imports_nothing_heavy(words: list[str]) -> None:
    """Nor does the help of any command in it: the group's help has imported each of them."""
    loaded = _loaded(words)
    assert f"pmm.cli.{words[0]}" in loaded
    assert not HEAVY & loaded


@pytest.mark.parametrize("job", ["diagnose", "add", "answer"])
def test_one_thread_is_asked_for_before_the_libraries_are_there(job: str) -> None:
    loaded = _run(f"import sys, pmm.cli.gap.{job}; print(*sys.modules)").stdout.split()
    assert f"pmm.cli.gap.{job}" in loaded
    assert not {"numpy", "scipy"} & set(loaded)
