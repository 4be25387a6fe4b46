"""A model that is not the one of ``rig.toml``: said before the run, in it, and in its recording."""

import json
import math
from pathlib import Path

import pytest

from analysis.readers import read_recording
from tests.pmm.run.processes import pmm
from tests.sim.devices.benches import ROOT

EXAMPLE = ROOT / "examples" / "vertical"
PLAN = """
rig = "rig.toml"
[defaults]
periods = 3
settling_periods = 1
pause_s = 0.5
[[runs]]
kind = "dry"
motion = "heave"
frequencies_hz = 1.4
amplitudes_mm = 20.0
"""


@pytest.mark.slow
def test_half_the_mass_is_seen(tmp_path: Path) -> None:
    for name in ("rig.toml", "simulated.toml"):
        text = (EXAMPLE / name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(text, encoding="utf-8")
    with (tmp_path / "simulated.toml").open("a", encoding="utf-8") as file:
        file.write("[model]\nmass_kg = 35.0\n")
    (tmp_path / "plan.toml").write_text(PLAN, encoding="utf-8")
    made = pmm("run", tmp_path / "plan.toml", "--output", tmp_path / "c")
    assert made.exit_code == 0, made.stderr
    assert "model.mass_kg = 35 is simulated, rig.toml states 70" in made.stderr
    assert "force_aft and force_fore far from the plan's estimate" in made.stderr
    (path,) = (tmp_path / "c").glob("*/run.nc")
    recording = read_recording(path)
    flags = {(one.code, one.channel): one.message for one in recording.flags}
    assert "model.mass_kg = 35" in flags["simulated_differs", None]
    newtons = (2.0 * math.pi * 1.4) ** 2 * 0.02 / 2.0
    for channel, side in (("force_aft", 1.0), ("force_fore", -1.0)):
        # The centre of gravity lies 0.02 m behind the midpoint, the struts 0.5 m from it.
        measured, planned = (m * newtons * (1.0 + side * 0.04) for m in (35.0, 70.0))
        text = flags["force_far", channel]
        assert f"the plan estimates {planned:.4g} N" in text
        assert abs(float(text.split("harmonic ")[1].split(" N")[0]) - measured) < 0.3
    kept = json.loads(recording.provenance["simulated_differs"])
    assert kept == {"model.mass_kg": {"stated": 70.0, "simulated": 35.0}}
