"""Measured wave forces, first half against second: one is no model of the other's but by chance.

The harmonics of the first half of the steady stretch are the model; the second half has no gap by
the rule that every step of the walk keeps: a mean square within four standard deviations of noise.
"""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from pmm.cli import cli

FOLDER = Path(__file__).parents[2].parent / "shared" / "data" / "wave_forces"
PERIOD_S = {"2091_1": 1.036, "2111_1": 0.802}  # of the waves: the records' own list

pytestmark = pytest.mark.skipif(
    not FOLDER.exists(), reason="the measured wave forces are not beside the project"
)


def _analysed(record: str, *options: str) -> dict[str, Any]:
    arguments = ["analyse", str(FOLDER / f"{record}.csv.gz"), "--reference", "WM_Position"]
    arguments += ["--channel", "Fy", "--json", *options]
    done = CliRunner().invoke(cli, arguments, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    (rows,) = json.loads(done.stdout)["runs"]
    return dict(rows)


def _amplitudes(rows: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Return amplitudes and standard uncertainties of harmonics 1 to 3."""
    (channel,) = rows["gates"][0]["channels"]
    found = [one["amplitude"] for one in channel["harmonics"]][:3]
    values = np.array([one["value"] for one in found])
    return values, np.array([one["half_width"] for one in found]) / 1.96


@pytest.mark.parametrize("record", sorted(PERIOD_S))
def test_the_second_half_has_no_gap(record: str) -> None:
    whole = _analysed(record)
    periods, opened_s = int(whole["window_periods"]) // 2, float(whole["window_opened_s"])
    length = ("--periods", str(periods))
    later_s = opened_s + periods * PERIOD_S[record]
    first, second = (
        _amplitudes(_analysed(record, "--opens-at", f"{at_s:.3f}", *length))
        for at_s in (opened_s, later_s)
    )
    off = (second[0] - first[0]) / np.hypot(first[1], second[1])
    assert float(np.mean(off**2)) < 1.0 + 4.0 * math.sqrt(2.0 / len(off))
    # It would show: a force larger by a fifth is a gap.
    larger = (1.2 * second[0] - first[0]) / np.hypot(first[1], second[1])
    assert float(np.mean(larger**2)) > 1.0 + 4.0 * math.sqrt(2.0 / len(off))
