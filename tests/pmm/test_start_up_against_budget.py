"""``pmm --help`` has to answer at once, so it imports nothing heavy; the time is a benchmark's."""

import shutil
import subprocess
import sys
from pathlib import Path

import click
import pytest

from pmm.cli import cli
from pmm.cli.group import CommandGroup

HOUSE = Path(__file__).parents[2]
HELP = "import sys; sys.argv = ['pmm', *{words}, '--help']; from pmm.cli import main; main()"
HEAVY = {
    "numpy", "scipy", "pandas", "xarray", "pydantic", "matplotlib", "rich", "h5py", "h5netcdf",
    "can", "canopen", "control", "starlette", "uvicorn", "pmm.configuration",
}  # fmt: skip
# Of some commands alone: a tenth of the time.
SPARED = {"json", "tempfile", "importlib.resources", "analysis", "pmm.remote"}


def _run(code: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, "-c", code], cwd=HOUSE, capture_output=True, text=True, check=False
    )


def _loaded(code: str) -> set[str]:
    told = "import atexit, sys; atexit.register(lambda: print(*sys.modules, file=sys.stderr))"
    return set(_run(f"{told}; {code}").stderr.split())


def _commands(group: click.Group) -> dict[str, click.Command]:
    context = click.Context(group)
    found = {name: group.get_command(context, name) for name in group.list_commands(context)}
    return {name: one for name, one in found.items() if one is not None}


GROUPS = {name: one for name, one in _commands(cli).items() if isinstance(one, CommandGroup)}


def test_help_imports_no_command() -> None:
    loaded = _loaded(HELP.format(words=[]))
    assert "pmm.cli.group" in loaded
    assert not loaded & {*HEAVY, *SPARED, "pathlib", *(f"pmm.cli.{name}" for name in cli.names)}


def test_no_command_imports_anything_heavy() -> None:
    loaded = _loaded("from pmm.cli import cli; [cli.get_command(None, one) for one in cli.names]")
    assert "pmm.cli.analyse" in loaded
    assert not (HEAVY | SPARED) & loaded


def test_no_command_of_a_group_imports_anything_heavy() -> None:
    every = "[[one.get_command(None, name) for name in one.names] for one in groups]"
    groups = f"groups = [cli.get_command(None, one) for one in {[*GROUPS]}]"
    loaded = _loaded(f"from pmm.cli import cli; {groups}; {every}")
    assert {"pmm.cli.gap.diagnose", "pmm.cli.devices.scan"} <= loaded
    assert not HEAVY & loaded


@pytest.mark.parametrize("group", [cli, *GROUPS.values()], ids=["pmm", *GROUPS])
def test_a_line_of_the_help_is_the_beginning_of_what_the_command_says(group: CommandGroup) -> None:
    said = {name: one.help or "" for name, one in _commands(group).items() if name in group.names}
    assert group.names == {
        name: line
        for name, line in group.names.items()
        if " ".join(said[name].split()).startswith(line.removesuffix("."))
    }


MOTOR = """
[campaign.drive.motor]
constant_n_m_a = 0.8
current_loop_hz = 200.0
inertia_kg_m2 = 0.002
gear_ratio = 20.0
gear_inertia_kg_m2 = 0.2
loop = { proportional = 2.0, integral = 10.0 }
"""


@pytest.mark.slow
def test_only_tuning_a_drive_loads_the_library_of_controllers(tmp_path: Path) -> None:
    """It takes a second: checking a plan with a motor on its rig goes without."""
    for name in ("plan.toml", "rig.toml", "simulated.toml"):
        shutil.copy(HOUSE / "examples" / "vertical" / name, tmp_path)
    with (tmp_path / "rig.toml").open("a", encoding="utf-8") as file:
        file.write(MOTOR)
    code = HELP.replace(", '--help'", "").format(words=["plan", "check", f"{tmp_path}/plan.toml"])
    modules = "atexit.register(lambda: print(*sys.modules, file=sys.stderr))"
    done = _run(f"import atexit, sys; {modules}; {code}")
    assert "speed ripple" in done.stdout
    assert "control" not in done.stderr.split()
    at_the_top = [
        path
        for package in ("pmm", "analysis", "sim", "hardware")
        for path in (HOUSE / package).rglob("*.py")
        if any(line.startswith(("import control", "from control ")) for line in _lines(path))
    ]
    assert at_the_top == []


def _lines(path: Path) -> list[str]:
    return path.read_text(encoding="utf-8").splitlines()


@pytest.mark.parametrize("job", ["diagnose", "add", "answer"])
def test_one_thread_is_asked_for_before_the_libraries_are_there(job: str) -> None:
    loaded = _run(f"import sys, pmm.cli.gap.{job}; print(*sys.modules)").stdout.split()
    assert f"pmm.cli.gap.{job}" in loaded
    assert not {"numpy", "scipy"} & set(loaded)
