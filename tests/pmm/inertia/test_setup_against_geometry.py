"""The drawing of a set-up has its file's measures to scale; a photo is within the page."""

import base64
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from matplotlib.image import imread, imsave

from hardware.description.errors import ConfigurationError
from pmm.cli import cli
from pmm.inertia import pendulum
from pmm.report.inertia_setup import setup_figure

LAMBOLEY = """\
name = "plank"
gravity_m_s2 = 9.81
{more}
[period]
period_s = 1.53216
u_period_s = 0.001
[second]
apart_m = 0.1
period = {{ period_s = 1.5384, u_period_s = 0.001 }}
"""


def _file(folder: Path, more: str = "") -> Path:
    path = folder / "plank.toml"
    path.write_text(LAMBOLEY.format(more=more))
    return path


def test_axes_and_centre_lie_where_the_test_says(tmp_path: Path) -> None:
    outcome = pendulum.run(str(_file(tmp_path)))
    depth_m = next(one.estimate.value for one in outcome.findings if one.name == "depth_m")
    assert depth_m == pytest.approx(0.25, abs=0.01)  # of an even plank of 1 m, hung 0.25 m up
    (axes,) = setup_figure("plank", outcome.sketches).axes
    drawn = [np.asarray(line.get_xydata(), dtype=float)[-1] for line in axes.lines]
    for height in (0.0, 0.1, -depth_m):
        assert any(np.allclose(at, (0.0, height)) for at in drawn)
    assert axes.get_aspect() == 1.0
    shown = {text.get_text() for text in axes.texts}
    assert {"0.1 m", f"body: {1e3 * depth_m:.4g} mm"} <= shown


@pytest.mark.slow
def test_a_photo_is_within_the_page(tmp_path: Path) -> None:
    pixels = np.zeros((40, 2000, 3))
    pixels[:, :1000, 0] = 1.0
    imsave(tmp_path / "rig.png", pixels)
    path, page = _file(tmp_path, 'photo = "rig.png"'), tmp_path / "page.html"
    ran = CliRunner().invoke(cli, ["inertia", "pendulum", str(path), "--page", str(page)])
    assert ran.exit_code == 0, ran.output
    found = re.search(r'href="data:image/png;base64,([^"]+)"', page.read_text())
    assert found is not None
    (tmp_path / "shown.png").write_bytes(base64.b64decode(found[1]))
    shown = imread(tmp_path / "shown.png")
    assert shown.shape[1] <= 1600
    red = shown[..., 0] - shown[..., 2]
    assert red[:, : red.shape[1] // 3].mean() > 0.9
    assert red[:, -red.shape[1] // 3 :].mean() < 0.1


@pytest.mark.parametrize(
    ("photo", "said"), [("none.jpg", "there is no such file"), ("rig.gif", "name a file .jpg or")]
)
def test_a_photo_that_cannot_be_shown_is_refused(tmp_path: Path, photo: str, said: str) -> None:
    (tmp_path / "rig.gif").write_text("x")
    with pytest.raises(ConfigurationError, match=said):
        pendulum.run(str(_file(tmp_path, f'photo = "{photo}"')))
