"""The campaign that ``pmm run`` leaves, against the rig that was simulated; sensors taken away."""

import json
from pathlib import Path

import pytest

from pmm.campaign.campaign_file import read_campaign
from tests.pmm.run.processes import pmm
from tests.sim.devices.benches import ROOT

RIG = (ROOT / "examples" / "vertical" / "rig.toml").read_text(encoding="utf-8")
PLAN = """
rig = "rig.toml"
[defaults]
periods = 3
settling_periods = 1
pause_s = 0.5
[zero]
duration_s = 20.0
every = 10
[[runs]]
motion = "heave"
frequencies_hz = 1.2
amplitudes_mm = 20.0
"""
SIMULATED = """
rig = "rig.toml"
[acquisition.force_aft]
noise_rms = 0.2
"""
CELL = '[photocell]\ndriver = "touch-probe"\n'
NOISE_N = {"force_aft": 0.2, "force_fore": 0.05}  # simulated: stated here, nominal
MISSING = [
    (),
    ("force_fore",),
    ("displacement_aft", "photocell"),
    ("force_aft", "displacement_fore"),
]


@pytest.mark.slow
@pytest.mark.parametrize("missing", MISSING)
def test_sensors_and_noise_are_those_of_the_rig(missing: tuple[str, ...], tmp_path: Path) -> None:
    rig = "".join(
        line for line in RIG.splitlines(True) if not any(f'"{name}"' in line for name in missing)
    )
    rig = rig.replace(CELL, "") if "photocell" in missing else rig
    for name, text in (("rig", rig), ("simulated", SIMULATED), ("plan", PLAN)):
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    folder = tmp_path / "c"
    made = pmm("run", tmp_path / "plan.toml", "--output", folder)
    assert made.exit_code == 0, made.stderr
    campaign = read_campaign(folder / "campaign.toml")
    assert (campaign.photocell is None) == ("photocell" in missing)
    assert campaign.simulation.sample_rate_hz == 100.0
    for name in ("force_aft", "force_fore", "displacement_aft", "displacement_fore"):
        how = getattr(campaign.acquisition, name)
        assert (how is None) == (name in missing)
        if how is not None and name in NOISE_N:
            # 2 x 20 s at 100 Hz: the standard deviation is known to 2 %; the converter adds 0.4 %.
            assert how.noise_rms == pytest.approx(NOISE_N[name], rel=0.08)
            assert (how.full_scale, how.resolution) == (500.0, 1e-3)
    assert campaign.acquisition.shaft_angle is not None
    assert campaign.acquisition.shaft_angle.noise_rms == 0.0
    analysed = pmm("analyse", folder, "--json")
    assert analysed.exit_code == 0, analysed.stderr
    (run,) = json.loads(analysed.stdout)["runs"]
    assert (run["window"], run["window_periods"]) == ("run's gate", 3)
    assert run["reference_frequency_hz"] == pytest.approx(1.2, rel=0.2)
    assert run["gates"][0]["frequency_hz"] == pytest.approx(1.2, rel=1e-5)
    assert "set_point_differs" not in [one["code"] for one in run["flags"]]
