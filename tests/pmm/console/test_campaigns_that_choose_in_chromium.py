"""A campaign that chooses its runs, in a real browser: what is shown, changed, and made of it."""

from pathlib import Path

import pytest
from selenium.webdriver import ActionChains
from selenium.webdriver.common.keys import Keys

from pmm.sequential.look import read_decisions
from tests.pmm.console.chromium import Browser, console, needed, rig_in
from tests.pmm.sequential.campaigns import DESIGN

pytestmark = needed
HULL = """
[believed]
Z_wdot = -75.0
Z_w = -190.0
Z_qdot = -3.0
Z_q = -12.0
M_wdot = -3.0
M_w = -12.0
M_qdot = -22.0
M_q = -55.0
"""


def _proposed(page: Browser) -> list[str]:
    """Return the proposed runs as the page has them, without their buttons."""
    return list(page.run(
        "return [...document.querySelectorAll('#proposed li')].map((one) => one.firstChild.data)"
    ))  # fmt: skip


def _in_words(shown: str) -> str:
    """Return a run without its time."""
    return shown.rpartition(", ")[0]


@pytest.mark.slow
def test_runs_are_moved_left_out_and_approved(tmp_path: Path, chromium: Browser) -> None:
    rig = rig_in(tmp_path / "rig")
    design = DESIGN.format(repeat=0.007)
    (tmp_path / "rig" / "design.toml").write_text(design + HULL, encoding="utf-8")
    with console(rig, tmp_path / "out", "--speed", "6") as one, chromium.window() as page:
        page.open(one.address)
        page.until(lambda: "design.toml" in page.text("#plan-name"), "the design is offered")
        page.run("document.getElementById('plan-name').value = 'design.toml'")
        page.click("[data-do=queue]")
        page.until(lambda: len(_proposed(page)) == 4, "proposed runs")
        assert page.find("#question").is_displayed() is False  # its own buttons ask
        assert "the first plan" in page.text("#until-said")
        first = _proposed(page)

        page.run("document.querySelector('#proposed li').focus()")
        ActionChains(page.driver).key_down(Keys.ALT).send_keys(Keys.ARROW_DOWN).key_up(
            Keys.ALT
        ).perform()
        moved = [first[1], first[0], *first[2:]]
        assert _proposed(page) == moved
        assert page.run("return document.activeElement.firstChild.data") == first[0]

        last, top = page.find("#proposed li:last-child"), page.find("#proposed li")
        page.run("arguments[0].scrollIntoView({block: 'center'})", top)
        ActionChains(page.driver).drag_and_drop(last, top).perform()
        dragged = [moved[-1], *moved[:-1]]
        page.until(lambda: _proposed(page) == dragged, "the dragged order")

        page.run("document.querySelector('#proposed li:last-child').focus()")
        ActionChains(page.driver).send_keys(Keys.DELETE).perform()
        assert _proposed(page) == dragged[:-1]
        page.click("#approve")
        page.until(lambda: "1 run," in page.text("#until-made"), "what one run told")
        (decided,) = read_decisions(one.output / "heave-pitch")[:1]
        assert list(decided.added) == [_in_words(shown) for shown in dragged[:-1]]
        assert decided.approved == "the operator"

        page.until(lambda: page.find("#known progress") is not None, "a bar")
        page.until(lambda: _answered(page), "the end")
        assert "all targets are met" in page.text("#until-said")
        shares = page.run(
            "return [...document.querySelectorAll('#known progress')].map((p) => p.value)"
        )
        assert shares == [1.0, 1.0]
        assert not [text for text in page.complaints() if "SEVERE" in text]
    ended = read_decisions(one.output / "heave-pitch")[-1]
    assert ended.ending == "all targets are met"


def _answered(page: Browser) -> bool:
    """Approve of what is proposed besides; return whether the campaign has ended."""
    if page.find("#until-buttons").is_displayed():
        page.click("#approve")
    return page.text("#until-said").startswith("Ended")


CAUSE = """
[[runs]]
name = "first"
motion = "heave"
frequencies_hz = [0.8, 1.0, 1.2]
amplitudes_mm = 20.0
[gap]
effects = ["eccentricity-error", "gain-error"]
"""


@pytest.mark.slow
def test_causes_are_shown_as_bars_that_close(tmp_path: Path, chromium: Browser) -> None:
    rig = rig_in(tmp_path / "rig", whole=True)
    text, simulated = rig.read_text(), (tmp_path / "rig" / "simulated.toml").read_text()
    (tmp_path / "rig" / "true.toml").write_text(text.replace("unit = 1e6", "unit = 0.97e6"))
    (tmp_path / "rig" / "simulated.toml").write_text(simulated.replace("rig.toml", "true.toml"))
    design = DESIGN.format(repeat=0.007).partition("[targets]")[0] + CAUSE
    (tmp_path / "rig" / "cause.toml").write_text(design, encoding="utf-8")
    with console(rig, tmp_path / "out", "--speed", "6") as one, chromium.window() as page:
        page.open(one.address)
        page.until(lambda: "cause.toml" in page.text("#plan-name"), "the design is offered")
        page.run("document.getElementById('plan-name').value = 'cause.toml'")
        page.click("[data-do=queue]")
        page.until(lambda: "As planned: 3 more" in page.text("#until-said"), "the given runs")
        page.until(lambda: page.find("#question").is_displayed(), "a question before it begins")
        page.find("#answer").send_keys("y", Keys.ENTER)
        page.until(lambda: page.text("#until-said").startswith("Ended"), "the end")
        assert "the cause is known" in page.text("#until-said")
        assert page.text("#known li").startswith("✓ eccentricity-error: ")
        assert page.find("#known li").get_attribute("data-met") == "yes"
        assert page.run("return document.querySelector('#known progress').value") == 1.0
        assert not [text for text in page.complaints() if "SEVERE" in text]
    ended = read_decisions(one.output / "heave-pitch")[-1]
    assert ended.ending == "the cause is known"
