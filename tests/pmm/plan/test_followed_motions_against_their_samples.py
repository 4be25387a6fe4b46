"""Sweeps and recorded motions that a plan asks for, drawn from their lines beside the samples."""

from pathlib import Path

import numpy as np
import pytest
from scipy.signal import chirp

from hardware.description.errors import ConfigurationError
from hardware.description.lines import struts_over_turn
from hardware.description.setpoint import SetPoint
from pmm.plan.plan import read_plan
from tests.pmm.plan.plans import write_plan

RUN = '[[runs]]\nmotion = "heave"\nfrequencies_hz = 0.05\namplitudes_mm = 20.0\nperiods = 2\n'


def point_of(folder: Path, more: str) -> SetPoint:
    plan = read_plan(write_plan(folder, RUN + more))
    (run,) = plan.runs
    return run.set_point


def test_a_sweep_is_scipys_chirp_but_for_its_ends(tmp_path: Path) -> None:
    struts = struts_over_turn(point_of(tmp_path, "sweep = [3, 17]\n").lines)
    t = np.arange(struts.shape[1]) / struts.shape[1]
    swept = chirp(t, 3.0, 1.0, 17.0, phi=-90.0)
    inner = (t > 0.1) & (t < 0.9)  # a sweep that repeats has a corner where it begins anew
    aft = struts[0] / struts[0, inner].max() * swept[inner].max()
    assert np.sqrt(np.mean((aft - swept)[inner] ** 2)) < 0.1
    assert struts[0] == pytest.approx(struts[1]), "heave"
    assert np.abs(struts).max() == pytest.approx(1.0, abs=1e-3)


def test_a_recorded_motion_is_followed(tmp_path: Path) -> None:
    t = np.arange(200) / 200.0
    moved = 3.0 + np.sin(2 * np.pi * 2 * t) + 0.4 * np.sin(2 * np.pi * 5 * t + 1.0)
    text = "# one period, in cm\n" + "\n".join(f"{one:.9f}  # at rest at 3" for one in moved)
    (tmp_path / "waves.txt").write_text(text, encoding="utf-8")
    point = point_of(tmp_path, 'recorded = "waves.txt"\n')
    assert [one.order for one in point.lines] == [2, 5]
    struts = struts_over_turn(point.lines, least=200)
    there = np.interp(t, np.arange(struts.shape[1]) / struts.shape[1], struts[0], period=1.0)
    size = np.abs(moved - 3.0).max()
    assert there == pytest.approx((moved - 3.0) / size, abs=0.01)


def test_harmonics_above_the_highest_are_left_out(tmp_path: Path) -> None:
    t = np.arange(64) / 64.0
    moved = np.sin(2 * np.pi * t) + np.sin(2 * np.pi * 9 * t)
    (tmp_path / "m.txt").write_text("\n".join(map(str, moved)), encoding="utf-8")
    point = point_of(tmp_path, 'recorded = "m.txt"\nhighest = 4\n')
    assert [one.order for one in point.lines] == [1]


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ('recorded = "none.txt"\n', "no such file; give one number a line"),
        ('recorded = "words.txt"\n', "words.txt, line 2: 'two' is not one number"),
        ('recorded = "still.txt"\n', "9 numbers that do not move"),
        ('recorded = "short.txt"\n', "give 8 or more"),
        ("sweep = [17, 3]\n", "two harmonics, from 1 on and rising"),
        ("sweep = [3, 17]\nlines = [3, 5]\n", "and lines are both given"),
        ("sweep = [3, 17]\nexact = true\n", "leave sweep out"),
        ("highest = 0\n", "highest"),
    ],
)
def test_bad_motions_are_one_sentence(tmp_path: Path, more: str, said: str) -> None:
    (tmp_path / "words.txt").write_text("1.0\ntwo\n", encoding="utf-8")
    (tmp_path / "still.txt").write_text("1.0\n" * 9, encoding="utf-8")
    (tmp_path / "short.txt").write_text("1.0\n2.0\n", encoding="utf-8")
    with pytest.raises(ConfigurationError, match=said):
        read_plan(write_plan(tmp_path, RUN + more))
