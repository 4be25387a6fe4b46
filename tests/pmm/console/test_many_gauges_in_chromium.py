"""Sixteen gauges on one screen, with channels that are made up: every one is there, none is cut."""

from pathlib import Path

import pytest

from benchmarks.console_source import CHANNELS, Source
from tests.pmm.console.chromium import Browser, needed

pytestmark = [needed, pytest.mark.slow]
GAUGES = [f"force_{k:02d}" for k in range(CHANNELS)]


@pytest.mark.parametrize(("width", "height"), [(1400, 900), (390, 844)])
def test_all_gauges_fit_and_any_can_be_seen_large(
    tmp_path: Path, chromium: Browser, width: int, height: int
) -> None:
    with Source(tmp_path) as source, chromium.window() as page:
        page.resize(width, height)
        page.open(source.address)
        source.wait(0.5)
        assert page.run(_SHOWN) == GAUGES
        assert page.run("return document.documentElement.scrollWidth") <= width
        assert page.run(_CUT) == []
        if width > height:
            last = page.find(".tile[data-channel='force_15']").rect
            assert last["y"] + last["height"] <= height  # seen without scrolling
        page.click(".tile[data-channel='force_09']")
        assert sorted(page.run(_SHOWN)) == GAUGES
        assert page.find(".card").get_attribute("data-channel") == "force_09"
        source.wait(0.5)
        card = float(page.text(".card .in-phase b"))
        assert card == pytest.approx(20.0, abs=0.5)  # what the source shows
        page.run("document.querySelector('#orders input[value=\"3\"]').click()")
        source.wait(0.5)
        tile = page.text(".tile[data-channel='force_00'] .quadrature b")
        assert float(tile) == pytest.approx(20.0, abs=0.5)
        assert not page.complaints()


_SHOWN = "return [...document.querySelectorAll('.card, .tile')].map((one) => one.dataset.channel)"
# Figures that do not fit into their card, tile or cell.
_CUT = """
return [...document.querySelectorAll(".card b, .tile b, .tile .name, .box strong")]
  .filter((one) => {
    const [inner, outer] = [one, one.closest(".reading, .line-reading, .tile, .box")]
      .map((each) => each.getBoundingClientRect());
    const range = document.createRange();
    range.selectNodeContents(one);
    return range.getBoundingClientRect().right > outer.right + 1 || inner.right > outer.right + 1;
  }).map((one) => one.outerHTML);
"""
