"""A run of many lines, planned, checked and carried out over the protocols of a simulated rig.

The oracle of the recording is the simulator's periodic steady state of the same motion; that of the
checks are finely sampled sums of sines.
"""

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from analysis.response.multisine import multisine
from hardware.description.setpoint import SetPoint
from pmm.plan.force_estimate import force_peak_n, single_sines
from pmm.plan.limits import limit_findings
from pmm.plan.motion_peaks import acceleration_peak_m_s2, velocity_peak_m_s
from pmm.plan.plan import read_plan, read_plan_and_rig
from pmm.plan.run_plan import RunPlan
from pmm.run.surroundings import Surroundings
from sim.rig import vertical_rig
from sim.run import steady_run
from tests.pmm.plan.plans import HORIZONTAL_TEXT, write_plan
from tests.pmm.run.harness import E_M, bench, oscillation

PLAN = """
[[runs]]
motion = "yaw"
frequencies_hz = 0.1
amplitudes_mm = 40
speeds_m_s = 1.0
lines = [3, 5, 7]
"""


def planned(folder: Path, text: str = PLAN) -> RunPlan:
    (run,) = (one for one in read_plan(write_plan(folder, text, HORIZONTAL_TEXT)).runs)
    return run


@pytest.mark.slow
def test_a_recording_has_the_lines_that_were_asked_for(tmp_path: Path) -> None:
    lines = multisine((1, 2, 4), np.array([1.0, 0.5, 0.2]), (0.0, math.pi))
    run = oscillation("lines", 0.5)
    point = replace(run.set_point, strut_phase_rad=0.0, lines=lines)
    rig = vertical_rig().ideal()
    with bench(tmp_path, [replace(run, set_point=point)], simulated=rig) as one:
        one.finish(40000)
    recording = read_recording(tmp_path / "lines" / "run.nc")
    assert recording.set_point == point
    samples = recording.values("force_aft")
    period = round(recording.sample_rate_hz / 0.5)
    spectrum = 2.0 * np.abs(np.fft.rfft(samples[-3 * period : -period])[::2]) / (2 * period)
    steady = steady_run(rig, SetPoint(0.5, E_M, lines=lines))
    expected = np.abs(steady.spectra["recorded_force_aft"])
    assert spectrum[1:6] == pytest.approx(expected[1:6], abs=0.02 * expected.max())
    header = json.loads((tmp_path / "lines" / "header.json").read_text(encoding="utf-8"))
    assert len(header["set_point"]["lines"]) == 3


def test_each_line_of_a_yaw_has_its_own_strut_phase(tmp_path: Path) -> None:
    run = planned(tmp_path)
    half = 0.5
    for line in run.set_point.lines:
        omega = 2.0 * math.pi * 0.1 * line.order
        assert math.tan(line.strut_phase_rad / 2.0) == pytest.approx(omega * half / 1.0)
    shares = [line.share * line.order for line in run.set_point.lines]
    assert shares == pytest.approx([shares[0]] * 3)
    assert RunPlan.from_json(run.to_json(), "here") == run


def test_peaks_are_those_of_the_sum(tmp_path: Path) -> None:
    path = write_plan(tmp_path, PLAN, HORIZONTAL_TEXT)
    plan, rig = read_plan_and_rig(path)
    (run,) = plan.runs
    t = np.linspace(0.0, 10.0, 200_000)
    peaks = np.zeros(3)
    for fore in (0.0, 1.0):
        for times in range(3):
            wave = sum(
                0.04 * one.share * (0.2 * math.pi * one.order) ** times
                * np.sin(0.2 * math.pi * one.order * t + one.phase_rad
                         + fore * one.strut_phase_rad + times * math.pi / 2.0)
                for one in run.set_point.lines
            )  # fmt: skip
            peaks[times] = max(peaks[times], np.abs(wave).max())
    assert peaks[0] == pytest.approx(0.04, rel=0.01)
    assert velocity_peak_m_s(run, rig.oscillator) == pytest.approx(peaks[1], rel=0.01)
    assert acceleration_peak_m_s2(run, rig.oscillator) == pytest.approx(peaks[2], rel=0.01)
    parts = [force_peak_n(one, rig) for one in single_sines(run)]
    whole = force_peak_n(run, rig)
    assert whole is not None
    assert max(one for one in parts if one is not None) < whole
    assert whole <= sum(one for one in parts if one is not None) * (1.0 + 1e-9)


def test_a_line_beyond_the_oscillator_is_refused(tmp_path: Path) -> None:
    plan, rig = read_plan_and_rig(
        write_plan(tmp_path, PLAN.replace("[3, 5, 7]", "[3, 51]"), HORIZONTAL_TEXT)
    )
    found = [one for run in plan.runs for one in limit_findings(run, rig)]
    assert any(one.quantity == "frequency [Hz]" and one.value > 5.0 for one in found)


@pytest.mark.parametrize("lines", ["[5, 3]", "[0, 1]", "[3, 3]"])
def test_lines_that_are_none_are_refused(tmp_path: Path, lines: str) -> None:
    from hardware.description.errors import ConfigurationError

    with pytest.raises(ConfigurationError, match="rising harmonics"):
        planned(tmp_path, PLAN.replace("[3, 5, 7]", lines))


def test_an_operator_is_asked_once_for_each_change(tmp_path: Path) -> None:
    run, around = planned(tmp_path), Surroundings()
    single = replace(run, set_point=replace(run.set_point, lines=()))
    oscillator = read_plan_and_rig(tmp_path / "plan.toml")[1].oscillator
    asked = [
        [one.part for one in around.before(each, oscillator)] for each in (run, run, single, single)
    ]
    assert asked == [["lines"], [], ["lines"], []]
