"""Small campaigns on the vertical rig that choose their runs, in this process."""

import json
from pathlib import Path
from shutil import copy
from typing import Any

from click.testing import CliRunner, Result

from pmm.cli import cli

EXAMPLE = Path("examples/vertical")
DESIGN = """
name = "heave-pitch"
rig = "rig.toml"
[defaults]
settling_periods = 1
periods = 4
[zero]
duration_s = 2.0
every = 10
[[grid]]
motion = "heave"
frequencies_hz = 1.0
amplitudes_mm = [10.0, 20.0]
[[grid]]
motion = "pitch"
frequencies_hz = 1.0
amplitudes_mm = [10.0, 20.0]
[noise]
force_n = 0.5
repeat_relative = {repeat}
[targets]
Z_w = "3 %"
M_q = "3 %"
"""


def written(folder: Path, *, repeat: float = 0.003, more: str = "") -> Path:
    """Write the rig's files and a design; return where the design lies."""
    for one in EXAMPLE.glob("*.toml"):
        copy(one, folder)
    path = folder / "design.toml"
    path.write_text(DESIGN.format(repeat=repeat) + more, encoding="utf-8")
    return path


def until(design: Path, folder: Path, *more: str, given: str = "") -> Result:
    """Run ``pmm run --until targets``."""
    words = ["run", str(design), "--until", "targets", "--output", str(folder), *more]
    return CliRunner().invoke(cli, words, input=given)


def made(design: Path, folder: Path, *more: str) -> Any:
    """Run it on the simulated rig with all approved; return what it tells as JSON."""
    done = until(design, folder, "--approve", "all", "--json", *more)
    assert done.exit_code == 0, f"{done.output}{done.exception}"
    return json.loads(done.stdout)
