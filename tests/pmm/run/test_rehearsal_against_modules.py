"""What a run loads while its loop keeps time: nothing, all of it was loaded before."""

import json
import subprocess
import sys
from pathlib import Path

from tests.pmm.run.processes import written_plan
from tests.sim.devices.benches import ROOT

PLAN = """
name = "short"
rig = "rig.toml"
[defaults]
periods = 2
settling_periods = 1
[[runs]]
motion = "heave"
frequencies_hz = 1.1
amplitudes_mm = 20.0
[[runs]]
kind = "zero"
duration_s = 0.5
"""
READINGS = "0\n0\n20.0\n0.0\n0\n"  # homed, set for heave, then eccentricity 0 for the zero
# What is loaded after the first command, while the loop runs, as JSON on standard output.
WATCHED = """
import json, sys
import can
can.interface.BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
from pmm.cli import main
from pmm.run import session
loop = session._Loop.make
def watched(*words):
    before = set(sys.modules)
    loop(*words)
    print(json.dumps(sorted(set(sys.modules) - before)), file=sys.__stdout__)
session._Loop.make = watched
main()
"""


def test_the_loop_loads_nothing(tmp_path: Path) -> None:
    words = ["run", str(written_plan(tmp_path, PLAN)), "--output", str(tmp_path / "out")]
    done = subprocess.run(
        [sys.executable, "-c", WATCHED, *words, "--real-time"],
        input=READINGS,
        capture_output=True,
        text=True,
        cwd=ROOT,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "2 of 2 runs complete" in done.stdout
    assert json.loads(done.stdout.splitlines()[0]) == []
