"""Plan, ``pmm run`` on the simulated rig, ``pmm coefficients``: the hull that was simulated."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from sim.rig import vertical_rig
from tests.sim.devices.benches import ROOT

PLAN = """
name = "short"
rig = "rig.toml"
[defaults]
periods = 6
settling_periods = 2
pause_s = 0.5
duration_s = 3.0
[zero]
duration_s = 3.0
every = 2
"""
RUN = """
[[runs]]
kind = "{kind}"
motion = "{motion}"
frequencies_hz = 0.83
amplitudes_mm = 20.0
{speed}
"""


def pmm(*words: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "tests.pmm.run.command", *map(str, words)],
        text=True, capture_output=True, cwd=ROOT, timeout=200, check=False,
    )  # fmt: skip


@pytest.mark.slow
def test_a_recorded_campaign_gives_the_simulated_hull(tmp_path: Path) -> None:
    for name in ("rig.toml", "simulated.toml"):
        text = (ROOT / "examples" / "vertical" / name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(text, encoding="utf-8")
    plan = PLAN + "".join(
        RUN.format(kind=kind, motion=motion, speed=speed)
        for kind, motion, speed in (
            ("dry", "heave", ""),
            ("dry", "pitch", "speeds_m_s = 1.2"),
            ("oscillation", "heave", "speeds_m_s = 1.2"),
            ("oscillation", "pitch", "speeds_m_s = 1.2"),
        )
    )
    (tmp_path / "plan.toml").write_text(plan, encoding="utf-8")
    made = pmm("run", tmp_path / "plan.toml", "--output", tmp_path / "c", "--json")
    assert made.returncode == 0, made.stderr
    water = vertical_rig().water  # as rig.toml has it
    for inertia in ("model", "dry"):
        done = pmm("coefficients", tmp_path / "c", "--inertia", inertia, "--json")
        assert done.returncode == 0, done.stderr
        found = json.loads(done.stdout)
        assert {one["name"] for one in found["runs"] if one["periods"] == 0} >= {"zero-01"}
        table = {row["name"]: row for row in found["coefficients"]["table"]}
        assert len(table) == 8
        for kind, matrix in (("dot", water.added_mass), ("", water.damping)):
            for row, load in enumerate("ZM"):
                for column, velocity in enumerate("wq"):
                    own = table[f"{load}_{velocity}{kind}"]
                    assert abs(own["value"] + matrix[row][column]) < 1.5 * own["half_width"], own
