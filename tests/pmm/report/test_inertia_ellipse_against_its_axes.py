"""The principal axes of the inertia ellipse's figure are the ellipse's own axes."""

import math

import numpy as np
import pytest

from pmm.inertia.outcome import PlaneAxes
from pmm.report.inertia_ellipse import ellipse_figure

ROLL_M, YAW_M = 0.11, 0.62


@pytest.mark.parametrize("angle_rad", [0.0, 0.07, -0.3])
def test_they_end_on_it_where_it_is_nearest_and_farthest(angle_rad: float) -> None:
    figure = ellipse_figure("model", PlaneAxes(ROLL_M, YAW_M, angle_rad, ()))
    lines = {str(line.get_label()): line.get_xydata() for line in figure.axes[0].get_lines()}
    radius = np.hypot(*lines["1/gyradius"].T)
    for name, gyradius_m, extreme in (
        ("principal x", ROLL_M, radius.max()),
        ("principal z", YAW_M, radius.min()),
    ):
        ends = lines[name]
        assert np.hypot(*ends.T) == pytest.approx(1.0 / gyradius_m)
        assert extreme == pytest.approx(1.0 / gyradius_m, rel=2e-3)
        gaps = [np.hypot(*(lines["1/gyradius"] - end).T).min() for end in ends]
        assert max(gaps) < 2.0 * math.pi / 720.0 / gyradius_m  # between two points of the curve
