"""``pmm --help`` has to answer at once, so it imports nothing heavy; the time is a benchmark's."""

import subprocess
import sys
from pathlib import Path

import pytest

HOUSE = Path(__file__).parents[2]
HELP = "import sys; sys.argv = ['pmm', '--help']; from pmm.cli import main; main()"
HEAVY = ("numpy", "scipy", "pandas", "xarray", "pydantic", "matplotlib", "rich", "h5py", "h5netcdf")


def _run(code: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, "-c", code], cwd=HOUSE, capture_output=True, text=True, check=False
    )


def test_help_imports_nothing_heavy() -> None:
    code = f"import atexit, sys; atexit.register(lambda: print(*sys.modules)); {HELP}"
    loaded = _run(code).stdout.split()
    assert "pmm.cli.analyse" in loaded
    assert not set(HEAVY) & set(loaded)


@pytest.mark.parametrize("job", ["gap_diagnose", "gap_add", "gap_answer"])
def test_one_thread_is_asked_for_before_the_libraries_are_there(job: str) -> None:
    loaded = _run(f"import sys, pmm.cli.{job}; print(*sys.modules)").stdout.split()
    assert f"pmm.cli.{job}" in loaded
    assert not {"numpy", "scipy"} & set(loaded)
