"""What the page shows, piece by piece, and how: in a real browser."""

import math
import re
from pathlib import Path

import pytest

from analysis.readers import read_recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from tests.pmm.console.chromium import Browser, console, needed, rig_in

pytestmark = needed
FAST = ("--speed", "6")
PLAN = """name = "heave"
rig = "rig.toml"
[defaults]
periods = 12
settling_periods = 1
[[runs]]
name = "run"
motion = "heave"
frequencies_hz = [1.0, 1.1, 1.2]
amplitudes_mm = 20.0
"""
FIRST = "run-f1-a20"
NUMBER = r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?"


def _half_width(page: Browser) -> float:
    """Return the interval that stands below the aft gauge's first needle."""
    found = re.search(rf"± ({NUMBER})", page.text(".card[data-channel='force_aft'] .in-phase"))
    return float(found.group(1)) if found else math.nan


def _harmonics(page: Browser, run: str, gauge: str) -> list[list[float]]:
    """Return a finished run's rows of a gauge: order, in phase, its width, quadrature, its."""
    rows = page.run(
        "return [...document.querySelectorAll(`#finished-table tr[data-run='${arguments[0]}']`)]"
        ".map((one) => [...one.cells].map((cell) => cell.textContent))",
        run,
    )
    start = next(k for k, row in enumerate(rows) if row[1] == gauge)
    return [[float(n) for n in re.findall(NUMBER, " ".join(row[2:]))] for row in rows[start:][:3]]


@pytest.mark.slow
def test_all_that_an_operator_looks_for_is_there(tmp_path: Path, chromium: Browser) -> None:
    with (
        console(rig_in(tmp_path / "rig"), tmp_path / "out", *FAST) as one,
        chromium.window() as page,
    ):
        page.open(one.address)
        assert page.text("#gate-name") == "closed"
        page.queue(PLAN)
        page.press("start")
        page.until(lambda: _half_width(page) > 0, "an interval")
        wide = _half_width(page)
        assert page.text("#gate-name") == "open"
        assert "1 of 3" in page.text("#state-run")
        assert page.text("#wanted") == "12"
        assert page.text("#shaft-set") == "set 1.000 Hz"
        assert float(page.text("#shaft")) == pytest.approx(1.0, abs=0.01)
        for name in ("eccentricity", "phase", "bus", "disk", "loop late", "loop priority"):
            assert name in page.text("#facts")
        assert "20.00 mm, set 20.00" in page.text("#facts")
        assert "in order" in page.text("#facts")
        assert "GB left" in page.text("#facts")
        assert "run 1 of 3" in page.text("#campaign-line")
        assert "1.1 Hz" in page.text("#next")
        assert len(page.driver.find_elements("css selector", "#charts canvas")) >= 2
        assert page.run("return document.querySelectorAll('.phasor .arrow').length") == 6
        page.until(lambda: FIRST in page.text("#finished-table tbody"), "finished run")
        page.until(lambda: "2 of 3" in page.text("#state-run"), "second run")
        seen = _harmonics(page, FIRST, "force_aft")
        page.until(lambda: page.text("#gate-name") == "open", "second gate")
        page.press("next")
        page.until(lambda: "3 of 3" in page.text("#state-run"), "third run")
        page.until(lambda: page.text("#gate-name") == "open", "third gate")
        page.press("hold")
        page.until(lambda: page.text("#gate-name") == "hold", "hold")
        page.until(lambda: page.text("#state-name").endswith("done"), "end")
    assert [row[0] for row in seen] == [1.0, 2.0, 3.0]
    reading = analyse(
        read_recording(tmp_path / "out" / "heave" / FIRST / "run.nc"), settings=ResolverSettings()
    ).readings[0]
    row = reading.channel_names.index("force_aft")
    widths = reading.half_width()[row]
    assert widths[1] < 0.8 * wide  # it has closed in
    for order, *told in seen:
        k = 2 * int(order) - 1
        wanted = [reading.coefficients[row, k], widths[k]]
        wanted += [reading.coefficients[row, k + 1], widths[k + 1]]
        # Two digits of each width are shown.
        assert told == pytest.approx(wanted, abs=0.06 * float(widths[k : k + 2].max()))


@pytest.mark.slow
def test_pages_of_gap_and_inertia_open_beside_the_console(
    tmp_path: Path, chromium: Browser
) -> None:
    campaign = tmp_path / "out" / "earlier"
    (campaign.parent / "inertia").mkdir(parents=True)
    campaign.mkdir()
    script = "<script>document.title = 'gap page of ' + origin</script>"
    (campaign / "gap.html").write_text(f"<!doctype html><p>gap</p>{script}", encoding="utf-8")
    drawing = "<svg xmlns='http://www.w3.org/2000/svg'><title>ellipse</title></svg>"
    (campaign.parent / "inertia" / "hull.svg").write_text(drawing, encoding="utf-8")
    with (
        console(rig_in(tmp_path / "rig"), tmp_path / "out", *FAST) as one,
        chromium.window() as page,
    ):
        page.open(one.address)
        page.until(lambda: "gap" in page.text("#pages-list"), "pages")
        console_page, there = page.driver.current_window_handle, {*page.driver.window_handles}
        for label, shown in (("earlier: gap", "gap"), ("inertia: hull", "ellipse")):
            page.run(
                "[...document.querySelectorAll('#pages-list a')]"
                ".find((one) => one.textContent === arguments[0]).click()",
                label,
            )
            page.until(lambda: len(page.driver.window_handles) > len(there), "a page")
            (opened,) = {*page.driver.window_handles} - there
            page.driver.switch_to.window(opened)
            page.until(lambda shown=shown: shown in page.driver.page_source, label)  # type: ignore[misc]
            if shown == "gap":
                assert page.driver.title == "gap page of null"  # an origin of its own
            page.driver.close()
            page.driver.switch_to.window(console_page)
        assert page.text("#state-name").endswith("idle")


@pytest.mark.slow
def test_keys_alone_reach_every_command_and_no_text_is_too_pale(
    tmp_path: Path, chromium: Browser
) -> None:
    with (
        console(rig_in(tmp_path / "rig"), tmp_path / "out", *FAST) as one,
        chromium.window() as page,
    ):
        page.open(one.address)
        page.queue(PLAN)
        page.until(lambda: page.find("[data-command='start']").is_enabled(), "start")
        page.run("document.activeElement.blur(); scrollTo(0, 0)")
        reached = []
        for _ in range(60):
            page.driver.switch_to.active_element.send_keys("\ue004")  # Tab
            reached.append(page.run(_WHERE))
        for wanted in ("start", "quick stop", "far", "theme", "plan-name", "plan-form check"):
            assert wanted in reached
        page.find("[data-command='start']").send_keys("\ue007")  # Enter
        page.until(lambda: page.text("#state-name").endswith("settling"), "start by key")
        page.find("body").send_keys("\ue00c")  # Escape
        page.until(lambda: page.text("#state-name").endswith("stopped"), "stop by key")
        for theme in ("light", "dark"):
            page.run("document.documentElement.dataset.theme = arguments[0]", theme)
            pale = [one for one in page.run(_PAIRS) if _contrast(one[1], one[2]) < 4.5]
            assert not pale
        page.click("#far")
        for part in (".reading b", "#state-name", "#gate-name", "#periods", "#shaft"):
            size = float(page.find(part).value_of_css_property("font-size").removesuffix("px"))
            # 16 minutes of arc at two metres are 9.3 mm; a figure is 0.73 of the size, and a pixel
            # 0.265 mm.
            assert 0.73 * size * 0.265 >= 2000.0 * math.tan(math.radians(16.0 / 60.0))
        assert not page.find("#traces").is_displayed()
        assert page.find("#alarms").is_displayed()
        page.click("#far")
        assert page.find("#traces").is_displayed()


def _luminance(colour: list[float]) -> float:
    """Return the relative luminance of an sRGB colour (WCAG 2.2)."""
    linear = [
        c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4
        for c in (one / 255.0 for one in colour[:3])
    ]
    return sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))


def _contrast(one: list[float], other: list[float]) -> float:
    low, high = sorted((_luminance(one), _luminance(other)))
    return (high + 0.05) / (low + 0.05)


_WHERE = """
const at = document.activeElement;
return at.dataset.command || at.id || (at.dataset.do ? `plan-form ${at.dataset.do}` : at.tagName);
"""
# Text that is shown on a ground of its own colour, with both colours; what cannot be pressed is
# pale on purpose.
_PAIRS = """
const numbers = (colour) => colour.match(/[\\d.]+/g).map(Number);
const ground = (one) => {
  for (let at = one; at; at = at.parentElement) {
    const found = numbers(getComputedStyle(at).backgroundColor);
    if (found.length < 4 || found[3] === 1) return found;
  }
  return [255, 255, 255];
};
return [...document.querySelectorAll("body *")].filter((one) =>
  one.offsetParent && !one.closest(":disabled, svg") &&
  [...one.childNodes].some((node) => node.nodeType === 3 && node.data.trim()))
  .map((one) => [one.outerHTML, numbers(getComputedStyle(one).color), ground(one)]);
"""
