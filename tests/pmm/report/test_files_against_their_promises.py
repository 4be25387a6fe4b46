"""Files of figures: well-formed, small, the same each time, whatever the names are."""

from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as ET

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import _pylab_helpers

from analysis.resolver.analysis import Analysis
from hardware.description.errors import ConfigurationError
from pmm.document.style import render, write_figures
from pmm.report.plots import FIGURES, figures
from tests.pmm.report.runs import analysed, run

HOSTILE = ("<script>alert(1)</script>", '_hidden $x^2$ \\frac & \'q" id="a"', "力\x00\n\x1b")


@pytest.fixture(scope="module")
def wide() -> Analysis:
    """Eight loads over minutes: as much as a rig's usual record has."""
    return analysed(run(loads=7, seconds=240.0))


@pytest.mark.slow
@pytest.mark.parametrize("kind", FIGURES)
def test_drawings_are_well_formed_and_small(wide: Analysis, kind: str) -> None:
    svg = render(FIGURES[kind](wide), "svg", kind)
    assert len(svg) < 300_000
    assert ET.fromstring(svg).tag.endswith("svg")  # noqa: S314  drawn here
    assert b"<dc:date>" not in svg
    assert b"displacement_aft" in svg  # text stays text


@pytest.mark.slow
@pytest.mark.parametrize("kind", FIGURES)
def test_a_file_does_not_depend_on_those_written_before(kind: str) -> None:
    """A figure is laid out once, for whichever file comes first."""
    small = analysed(run(2))
    figure, alone = FIGURES[kind](small), FIGURES[kind](small)
    pixels = render(alone, "png", "s")
    drawn = render(figure, "svg", "s")
    assert render(figure, "png", "s") == pixels
    assert render(alone, "svg", "s") == drawn == render(figure, "svg", "s")


@pytest.mark.slow
@pytest.mark.parametrize("kind", FIGURES)
def test_hostile_names_are_drawn_as_they_are(kind: str) -> None:
    analysis = analysed(run(3, names=HOSTILE, name="a <b> & $c$"))
    svg = render(FIGURES[kind](analysis), "svg", "s")
    root = ET.fromstring(svg)  # noqa: S314  drawn here
    text = " ".join("".join(part.itertext()) for part in root.iter() if "text" in str(part.tag))
    assert "<script>alert(1)</script>" in text
    assert "_hidden $x^2$" in text
    assert "a <b> & $c$" in text
    assert not [part for part in root.iter() if str(part.tag).endswith("script")]


@pytest.mark.slow
def test_the_same_analysis_gives_the_same_bytes(tmp_path: Path) -> None:
    analysis = analysed()
    first = write_figures(figures(analysis), tmp_path / "a" / "b", "run", ("svg", "png"))
    with mpl.rc_context({"font.size": 20.0, "text.parse_math": True}):
        second = write_figures(figures(analysis), tmp_path / "c", "run", ("svg", "png"))
    assert [path.name for path in first] == [
        f"run-{kind}.{suffix}" for kind in FIGURES for suffix in ("svg", "png")
    ]
    assert all(a.read_bytes() == b.read_bytes() for a, b in zip(first, second, strict=True))


@pytest.mark.slow
def test_a_channel_of_nothing_is_drawn(tmp_path: Path) -> None:
    recording = run(1)
    values = np.array(recording.samples[:, 0 : recording.sample_count])
    values[1] = 0.0
    written = write_figures(
        figures(analysed(replace(recording, samples=values))), tmp_path, "z", ("pdf",)
    )
    assert all(path.read_bytes().startswith(b"%PDF") for path in written)


@pytest.mark.slow
def test_no_setting_and_no_figure_stays_behind(tmp_path: Path) -> None:
    before = dict(mpl.rcParams)
    write_figures(figures(analysed()), tmp_path, "run", ("svg",))
    assert dict(mpl.rcParams) == before
    assert not _pylab_helpers.Gcf.figs


def test_wrong_requests_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="choose from svg, png, pdf"):
        write_figures(figures(analysed()), tmp_path, "run", ("bmp",))
    with pytest.raises(ConfigurationError, match="without a folder"):
        write_figures(figures(analysed()), tmp_path, "../run")
