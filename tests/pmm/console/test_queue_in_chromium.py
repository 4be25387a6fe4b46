"""The queue on the page: runs edited, moved and held by mouse and keys, as its console has them."""

from math import ceil
from pathlib import Path
from typing import Any

import pytest
from selenium.webdriver import ActionChains
from selenium.webdriver.common.keys import Keys

import pmm
from pmm.archive.notebook import read_notes
from pmm.interface.console_requests import ConsoleRefusalError
from tests.pmm.console.chromium import Browser, console, needed, plan, rig_in

pytestmark = needed
THREE = plan("three", periods=4).replace("= 1.0", "= [1.0, 1.1, 1.2]")


def _runs(page: Browser) -> list[str]:
    """Return the runs as the page lists them, without their buttons."""
    return list(page.run(
        "return [...document.querySelectorAll('#queue ol li')].map((one) => one.firstChild.data)"
    ))  # fmt: skip


def _press(page: Browser, label: str) -> None:
    page.click(f"#queue [aria-label='{label}']")


@pytest.mark.slow
def test_runs_are_edited_moved_and_held_on_the_page(tmp_path: Path, chromium: Browser) -> None:
    with (
        console(rig_in(tmp_path / "rig"), tmp_path / "out", "--speed", "8") as one,
        chromium.window() as page,
        pmm.connect(one.address) as watcher,
    ):
        page.open(one.address)
        page.click("#take")
        page.click("#take-dialog button")
        page.until(lambda: "You have control" in page.text("#desk"), "control")
        page.queue(THREE)
        page.queue(plan("later"))
        page.until(lambda: "later, 1 run (waits)" in page.text("#queue"), "the queue")
        page.click("#queue summary")
        first = ["run-f1-a20: 1 Hz, 20 mm, 4 periods ", "run-f1.1-a20: 1.1 Hz, 20 mm, 4 periods "]
        assert _runs(page)[:2] == first

        page.run("document.querySelector('#queue ol li').focus()")
        keys = ActionChains(page.driver).key_down(Keys.ALT).send_keys(Keys.ARROW_DOWN)
        keys.key_up(Keys.ALT).perform()
        page.until(lambda: _runs(page)[:2] == first[::-1], "the run one further down")
        assert page.run("return document.activeElement.dataset.key") == "run-f1-a20"
        ActionChains(page.driver).send_keys(Keys.DELETE).perform()
        page.until(lambda: _runs(page)[1].endswith("4 periods, held "), "a run that is held")

        _press(page, "Edit run-f1.2-a20")
        field = page.find("#queue form [name='frequency_hz']")
        field.clear()
        field.send_keys("9", Keys.ENTER)
        page.until(lambda: "Hz" in page.text("#said") and "9" in page.text("#said"), "a refusal")
        assert page.find("#said").get_attribute("data-tone") == "refused"
        field.clear()
        field.send_keys("1.25", Keys.ENTER)
        page.until(lambda: "frequency_hz 1.2 -> 1.25" in page.text("#queue"), "another frequency")

        _press(page, "Hold later")
        page.until(lambda: "(held)" in page.text("#queue"), "a plan that is held")
        told: dict[str, Any] = dict(watcher.known["plans"])
        assert told["1"]["held"] == ["run-f1-a20"]
        assert told["2"]["held"] == ["run-f1-a20"]
        assert [run["frequency_hz"] for run in told["1"]["runs"]] == [1.1, 1.0, 1.25]
        page.run("document.getElementById('note-run').value = '1 run-f1.2-a20'")
        page.find("#note-text").send_keys("gauge fore replaced before it")
        page.find("#note-author").send_keys("N. N.", Keys.ENTER)
        page.until(lambda: "note on run-f1.2-a20: gauge fore" in page.text("#alarms"), "a note")
        (note,) = read_notes(tmp_path / "out" / "three")
        assert (note.run, note.author) == ("run-f1.2-a20", "N. N.")
        assert note.text == "gauge fore replaced before it"
        page.press("start")
        page.until(lambda: "2 so far" in page.text("#finished-count"), "the runs not held")
        assert [run["run"] for run in watcher.known["finished"]] == ["run-f1.1-a20", "run-f1.2-a20"]
        _press(page, "Take out later")
        page.until(lambda: "later" not in page.text("#queue"), "a plan that is taken out")
        assert not [text for text in page.complaints() if "SEVERE" in text and "409" not in text]


@pytest.mark.slow
def test_the_time_left_is_that_of_the_runs_that_are_still_to_be_made(
    tmp_path: Path, chromium: Browser
) -> None:
    with (
        console(rig_in(tmp_path / "rig"), tmp_path / "out", "--speed", "8") as one,
        chromium.window() as page,
        pmm.connect(one.address) as client,
    ):
        client.queue(plan("same"))
        two = plan("same", periods=100).replace("= 1.0", "= [1.0, 1.1]")
        made, left = client.queue(two)["runs"]
        page.open(one.address)
        page.until(lambda: "same, 2 runs (waits)" in page.text("#queue"), "both runs of the second")
        client.command("start")
        page.until(lambda: client.frame["plan"] == 2, "the second plan's turn")
        page.until(lambda: "run 1 of 1" in page.text("#campaign-line"), "what is left of it")
        minutes = ceil(left["duration_s"] / 60)
        assert ceil((made["duration_s"] + left["duration_s"]) / 60) > minutes
        page.until(lambda: f"at most {minutes} min left" in page.text("#campaign-line"), "the time")
        client.command("quick stop")


@pytest.mark.slow
def test_the_page_shows_who_did_what(tmp_path: Path, chromium: Browser) -> None:
    with (
        console(rig_in(tmp_path / "rig"), tmp_path / "out") as one,
        chromium.window() as page,
        pmm.connect(one.address) as client,
    ):
        page.open(one.address)
        page.click("#audit-panel summary")
        page.find("body").send_keys(Keys.ESCAPE)
        page.until(lambda: "quick stop taken" in page.text("#audit"), "what the page did")
        with pytest.raises(ConsoleRefusalError, match="refused in state idle"):
            client.command("hold")
        page.until(lambda: "hold" in page.text("#audit"), "what another did")
        last, first = page.driver.find_elements("css selector", "#audit li")
        assert last.is_displayed()
        assert [one.get_attribute("data-taken") for one in (last, first)] == ["no", "yes"]
        assert "refused in state idle" in last.text
        told = client.audit()
        assert [(one["action"], one["taken"]) for one in told] == [
            ("command", True),
            ("command", False),
        ]
        assert told == client.known["audit"]
        assert told[0]["session"] != told[1]["session"]
