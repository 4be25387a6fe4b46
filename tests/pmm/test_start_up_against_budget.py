"""``pmm --help`` has to answer at once: within 150 ms, which no heavy import fits into."""

import subprocess
import sys
import time
from pathlib import Path

HOUSE = Path(__file__).parents[2]
HELP = "import sys; sys.argv = ['pmm', '--help']; from pmm.cli import main; main()"
HEAVY = ("numpy", "scipy", "pandas", "xarray", "pydantic", "matplotlib", "rich", "h5py", "h5netcdf")


def _run(code: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(  # noqa: S603
        [sys.executable, "-c", code], cwd=HOUSE, capture_output=True, text=True, check=False
    )


def test_help_answers_within_the_budget() -> None:
    took = []
    for _ in range(10):
        begun = time.perf_counter()
        done = _run(HELP)
        took.append(time.perf_counter() - begun)
        assert done.returncode == 0
        assert "simulate" in done.stdout
    assert min(took) < 0.150


def test_help_imports_nothing_heavy() -> None:
    code = f"import atexit, sys; atexit.register(lambda: print(*sys.modules)); {HELP}"
    loaded = _run(code).stdout.split()
    assert "pmm.cli.analyse" in loaded
    assert not set(HEAVY) & set(loaded)
