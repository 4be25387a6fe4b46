"""Position and velocity that a motor's drive reports, compared as a user would, and by hand.

The records are public (``docs/measured.md``). The fit by hand is of a spline of the position, both
smoothed alike.
"""

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d
from scipy.optimize import least_squares

from hardware.description.arrays import FloatArray
from pmm.cli import cli

RECORDS = Path(__file__).parents[2].parent / "shared" / "data" / "torque_limited_pendulum"
SMOOTH_S = 0.02

pytestmark = pytest.mark.skipif(
    not RECORDS.exists(), reason="the measured motor pendulum is not beside the project"
)


def by_hand(path: Path) -> FloatArray:
    """Return gain and lag."""
    time, position, velocity, _ = np.genfromtxt(path, delimiter=",", skip_header=1).T
    step = float(np.diff(time).mean())
    even = step * np.arange(time.size)
    smooth = [
        gaussian_filter1d(np.interp(even, time - time[0], one), SMOOTH_S / step)
        for one in (position, velocity)
    ]
    rate, inside = CubicSpline(even, smooth[0]).derivative(), (even > 2.0) & (even < 18.0)

    def left(asked: FloatArray) -> FloatArray:
        gain, lag_s, offset = asked
        moved = gain * rate(even[inside] - lag_s) + offset
        return np.asarray(moved - smooth[1][inside])

    return np.asarray(least_squares(left, np.array([1.0, 0.0, 0.0])).x[:2])


@pytest.mark.parametrize("name", ["energy_shaping", "ilqr"])
def test_gain_and_lag_are_those_by_hand(name: str) -> None:
    path = RECORDS / f"{name}_measured.csv.gz"
    asked = ["compare", f"{path}:position", ":velocity", "--derivative", "1", "--json"]
    done = CliRunner().invoke(cli, asked, catch_exceptions=False)
    assert done.exit_code == 0
    found = json.loads(done.stdout)
    gain, lag_s = by_hand(path)
    assert abs(found["gain"]["value"] - gain) < found["gain"]["half_width"]
    assert abs(found["lag"]["value"] - lag_s) < found["lag"]["half_width"]
    assert abs(found["clock_rate"]["value"]) < found["clock_rate"]["half_width"]
