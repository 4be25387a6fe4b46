"""``pmm run`` on a short plan: what it writes, says and returns; and the chain's own harmonics."""

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from pmm.recorder.recording import read_run
from sim.devices.bench_file import read_bench
from sim.run import steady_run
from tests.pmm.run.processes import READINGS, full_disk, pmm, written_plan
from tests.sim.devices.benches import ROOT

PLAN = """
name = "short"
rig = "rig.toml"
[defaults]
periods = 4
settling_periods = 2
pause_s = 0.5
[[runs]]
motion = "heave"
frequencies_hz = [0.8, 1.1]
amplitudes_mm = 20.0
[[runs]]
motion = "pitch"
frequencies_hz = 1.1
amplitudes_mm = 20.0
"""
NOISE_N = 0.02  # of a first harmonic: noise of 0.05 N over four periods, counts of 1 mN


@pytest.fixture
def plan(tmp_path: Path) -> Path:
    return written_plan(tmp_path, PLAN)


@pytest.mark.slow
def test_a_plan_with_piped_readings_is_recorded_analysed_and_resumed(
    plan: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "campaign"
    words = ("run", plan, "--output", folder, "--json")
    first = pmm(*words, "--only", "heave-f0.8-a20", given=READINGS)
    assert first.exit_code == 0, first.stderr
    assert [one["outcome"] for one in json.loads(first.stdout)["runs"]] == ["complete"]
    again = pmm(*words, given=READINGS)
    assert again.exit_code == 2
    assert "--resume" in again.stderr
    rest = pmm(*words, "--resume", given=READINGS)
    assert rest.exit_code == 0, rest.stderr
    made = json.loads(rest.stdout)
    assert len(made["runs"]) == len(made["planned"]) == 2
    assert "heave-f0.8-a20" not in made["planned"]
    analysed = pmm("analyse", folder, "--json")
    assert analysed.exit_code == 0, analysed.stderr
    header = json.loads((folder / "heave-f0.8-a20" / "header.json").read_text(encoding="utf-8"))
    assert header["readings"]["eccentricity"]["source"] == "micrometer"
    assert header["readings"]["eccentricity"]["value"] == pytest.approx(0.02)
    _check_against_chain(plan, folder / "heave-f0.8-a20")


def _check_against_chain(plan: Path, folder: Path) -> None:
    """The harmonics of the recording are those of the chain's own steady state, within noise."""
    recording = read_recording(folder / "run.nc")
    readings = (folder / "harmonics.jsonl").read_text(encoding="utf-8").splitlines()
    live = json.loads(readings[-1])
    scene = read_bench(plan.parent / "simulated.toml").scene
    assert recording.set_point is not None
    own = steady_run(scene.rig, recording.set_point)
    for name in ("force_aft", "force_fore"):
        row = live["coefficients"][live["channels"].index(name)]
        wanted = own.referred(f"recorded_{name}")[1]
        found = complex(row[2], -row[1])  # quadrature, minus in phase
        assert abs(found - wanted) < NOISE_N + 2e-4 * abs(wanted)
    assert np.isfinite(recording.samples[0:1, 0:10]).all()


def test_a_dry_run_moves_nothing(plan: Path, tmp_path: Path) -> None:
    done = pmm("run", plan, "--output", tmp_path / "none", "--dry-run")
    assert done.exit_code == 0, done.stderr
    assert "3 runs would be recorded" in done.stdout
    assert not (tmp_path / "none").exists()


def test_an_unknown_run_names_the_nearest(plan: Path, tmp_path: Path) -> None:
    done = pmm("run", plan, "--output", tmp_path / "none", "--only", "heave-f0.8")
    assert done.exit_code == 2
    assert "did you mean heave-f0.8-a20" in done.stderr


@pytest.mark.slow
def test_a_full_disk_ends_the_run_and_what_was_flushed_is_there(plan: Path, tmp_path: Path) -> None:
    folder = tmp_path / "campaign"
    words = ("run", plan, "--output", folder, "--real-time")
    with full_disk(40_000):
        done = pmm(*words, given=READINGS)
    assert done.exit_code == 1
    assert "no room" in done.stderr or "full" in done.stderr or "File too large" in done.stderr
    runs = [one for one in folder.iterdir() if (one / "samples.arrows").exists()]
    assert len(runs) == 1
    samples = read_run(runs[0]).samples
    assert samples is not None


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_an_interrupt_stops_gently_and_closes_the_recording(
    plan: Path, tmp_path: Path, number: signal.Signals
) -> None:
    folder = tmp_path / "campaign"
    with _started(plan, folder) as process:
        _wait_for(folder, process)
        process.send_signal(number)
        _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    (marker,) = folder.glob("*/complete.json")
    assert json.loads(marker.read_text(encoding="utf-8"))["outcome"] == "stopped"
    assert read_recording(marker.parent / "run.nc").sample_count > 0


@pytest.mark.slow
def test_a_killed_controller_leaves_what_was_flushed(plan: Path, tmp_path: Path) -> None:
    folder = tmp_path / "campaign"
    with _started(plan, folder) as process:
        run = _wait_for(folder, process)
        time.sleep(1.5)
        process.kill()
        process.communicate(timeout=60)
    assert not (run / "complete.json").exists()
    samples = read_run(run).samples
    assert samples is not None
    recovered = pmm("recover", run)
    assert recovered.exit_code == 0, recovered.stderr
    assert read_recording(run / "run.nc").sample_count > 0


def _started(plan: Path, folder: Path) -> subprocess.Popen[str]:
    """Start a campaign in real time, its readings piped; no signal is ignored from before."""

    def heed() -> None:
        signal.signal(signal.SIGHUP, signal.SIG_DFL)

    words = ["run", str(plan), "--output", str(folder), "--real-time"]
    process = subprocess.Popen(
        [sys.executable, "-m", "tests.pmm.run.command", *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        cwd=ROOT,
        env=os.environ,
        preexec_fn=heed,
    )
    assert process.stdin is not None
    process.stdin.write(READINGS)
    process.stdin.flush()
    return process


def _wait_for(folder: Path, process: subprocess.Popen[str]) -> Path:
    """Wait until a run is being recorded; return its folder."""
    for _ in range(600):
        found = list(folder.glob("*/samples.arrows"))
        if found:
            return found[0].parent
        assert process.poll() is None
        time.sleep(0.1)
    raise AssertionError("no run began")
