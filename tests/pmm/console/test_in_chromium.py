"""The console as an operator sees it: a real browser, the simulated rig behind it."""

import json
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest

from analysis.readers import read_recording
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from tests.pmm.console.chromium import Browser, browser, console, needed, plan, rig_in

pytestmark = needed
NAME = "run-f1-a20"  # of the run that the entry "run" becomes
FAST = ("--speed", "6")


@pytest.fixture
def rig(tmp_path: Path) -> Path:
    return rig_in(tmp_path / "rig")


def _needles(page: Browser) -> list[float]:
    """Return what the needles of the aft gauge say: in phase and quadrature."""
    card = ".card[data-channel='force_aft']"
    return [float(page.text(f"{card} .{part} b")) for part in ("in-phase", "quadrature")]


@pytest.mark.slow
def test_needles_settle_where_the_analysis_ends(
    rig: Path, tmp_path: Path, chromium: Browser
) -> None:
    with (
        console(rig, tmp_path / "out", *FAST) as one,
        chromium.window() as page,
    ):
        page.open(one.address)
        page.run("document.getElementById('plan-text').value = arguments[0]", "[[runz]]")
        page.run("document.querySelector('#plan-form details').open = true")
        page.find("[data-do=check]").click()
        page.until(lambda: "did you mean runs" in page.text("#plan-said"), "refusal")
        page.queue(plan("heave"))
        page.press("start")
        page.until(lambda: page.text("#gate-name") == "open", "open gate")
        page.until(lambda: NAME in page.text("#finished-table tbody"), "finished run")
        page.until(lambda: "last reading" in page.text("#finality"), "last reading")
        seen = _needles(page)
        page.until(lambda: "Z_wdot" in page.text("#coefficient"), "coefficients")
        file = tmp_path / "out" / "heave" / NAME / "run.nc"
        page.until(file.exists, "recording")
        reading = analyse(read_recording(file), settings=ResolverSettings()).readings[0]
        row = reading.channel_names.index("force_aft")
        wanted = reading.coefficients[row, 1:3]
        half_width = reading.half_width()[row, 1:3].max()
        assert reading.periods == 5
        # The page rounds to two digits of the half-width.
        assert seen == pytest.approx(list(wanted), abs=0.06 * half_width)
        assert len(page.complaints()) == 1  # of the plan that was refused
    lines = (tmp_path / "out" / "heave" / "commands.jsonl").read_text(encoding="utf-8")
    assert [json.loads(line)["action"] for line in lines.splitlines()] == ["queue", "command"]


@pytest.mark.slow
def test_stops_quickly_comes_back_and_shows_what_was_missed(
    rig: Path, tmp_path: Path, chromium: Browser
) -> None:
    with (
        console(rig, tmp_path / "out", *FAST) as one,
        chromium.window() as page,
    ):
        page.open(one.address)
        page.queue(plan("long", periods=400))
        page.press("start")
        page.until(lambda: page.text("#state-name").endswith("settling"), "settling")
        page.driver.get("about:blank")
        page.until(lambda: (tmp_path / "out" / "long" / NAME).exists(), "recording")
        page.open(one.address)
        page.until(lambda: "missed" in page.text("#missed-text"), "what was missed")
        page.until(lambda: page.text("#gate-name") == "open", "open gate")
        assert page.find("body").get_attribute("data-holder") == "you"
        page.find("body").send_keys("\ue00c")  # Escape
        page.until(lambda: page.text("#state-name").endswith("stopped"), "stop")
        page.until(lambda: NAME in page.text("#finished-table tbody"), "stopped run")
        assert page.text("#finished-table tbody tr").startswith("■")
        assert not page.complaints()


@pytest.mark.slow
def test_an_alarm_is_shown_and_reset(rig: Path, tmp_path: Path, chromium: Browser) -> None:
    with (
        console(rig, tmp_path / "out", *FAST) as one,
        chromium.window() as page,
    ):
        page.resize(390, 844)
        page.open(one.address)
        page.queue(plan("overload", frequency_hz=2.0, periods=20))
        page.press("start")
        page.until(lambda: page.text("#state-name").endswith("fault"), "fault")
        page.until(lambda: "beyond its safe load" in page.text("#alarms"), "alarm")
        assert page.find("#alarms-panel").get_attribute("data-alarm") == "yes"
        assert "beyond its safe load" in page.find("#alarm-now").text
        assert page.find("#alarms-panel").rect["y"] < page.find("#readings").rect["y"]
        assert not page.find("[data-command='start']").is_enabled()
        page.until(lambda: "run-f2-a20" in page.text("#finished-table tbody"), "faulty run")
        page.press("reset")
        page.until(lambda: page.text("#state-name").endswith("idle"), "idle")
        assert page.find("#alarms-panel").get_attribute("data-alarm") == "no"
        assert not page.find("#alarm-now").is_displayed()
        assert page.text("#coefficient-problems") == ""
        assert page.run("return document.documentElement.scrollWidth") <= 390


@pytest.mark.slow
def test_a_second_browser_only_watches_until_it_takes_over(
    rig: Path, tmp_path: Path, chromium: Browser
) -> None:
    with (
        console(rig, tmp_path / "out", *FAST) as one,
        chromium.window() as first,
        browser(tmp_path / "second") as second,
    ):
        first.open(one.address)
        second.open(one.address)
        first.queue(plan("heave", periods=100))
        first.press("start")
        second.until(lambda: second.text("#gate-name") == "open", "open gate")
        assert "You watch" in second.text("#desk")
        assert not second.find("[data-command='stop']").is_enabled()
        answer = second.driver.execute_async_script(_POST, "", {"command": "stop"})
        assert answer == 403
        second.find("#take").click()
        second.find("#take-dialog button[value=yes]").click()
        second.until(lambda: "You have control" in second.text("#desk"), "control")
        first.until(lambda: "You watch" in first.text("#desk"), "loss of control")
        second.press("stop")
        first.until(lambda: first.text("#state-name").endswith("stopped"), "stop")


@pytest.mark.slow
def test_a_page_from_elsewhere_is_refused_and_beyond_here_a_token_is_asked(
    rig: Path, tmp_path: Path, chromium: Browser
) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "index.html").write_text("<!doctype html><title>elsewhere</title>")
    token = tmp_path / "token"
    token.write_text("a long and secret token")
    foreign = ThreadingHTTPServer(("127.0.0.1", 0), partial(_Silent, directory=str(elsewhere)))
    foreign.daemon_threads = False  # so that its end waits for them
    thread = threading.Thread(target=foreign.serve_forever)
    thread.start()
    try:
        with (
            console(
                rig, tmp_path / "out", "--host", "127.0.0.2", "--token-file", str(token)
            ) as one,
            chromium.window() as page,
        ):
            page.driver.get(one.address)
            assert page.driver.current_url == f"{one.address}login"
            page.find("#token").send_keys("a wrong and guessed token")
            page.find("#login button").click()
            page.until(lambda: "not the token" in page.text("#login-said"), "refusal")
            page.find("#token").clear()
            page.find("#token").send_keys("a long and secret token")
            page.find("#login button").click()
            page.until(lambda: page.text("#state-name").endswith("idle"), "console")
            page.driver.get(f"http://127.0.0.1:{foreign.server_address[1]}/")
            script = _POST.replace("/api", f"{one.address}api")
            assert page.driver.execute_async_script(script, "", {"command": "start"}) == 0
            assert page.driver.execute_async_script(_STREAM, one.address) == "refused"
    finally:
        foreign.shutdown()
        foreign.server_close()
        thread.join(10.0)


class _Silent(SimpleHTTPRequestHandler):
    timeout = 1.0  # a browser opens connections that it may never use

    def log_message(self, format: str, *args: object) -> None:  # noqa: A002 - its name there
        return


_POST = """
const [session, body, done] = arguments;
const headers = { "x-pmm-session": session };
fetch("/api/command", { method: "POST", headers, body: JSON.stringify(body) })
  .then((answer) => done(answer.status), () => done(0));
"""
_STREAM = """
const [address, done] = arguments;
const socket = new WebSocket(address.replace("http", "ws") + "stream");
socket.onopen = () => done("open");
socket.onerror = () => done("refused");
"""
