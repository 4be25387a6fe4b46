"""A console in a process of its own, and browsers that are looked at through chromedriver."""

import os
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from selenium import webdriver
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.remote.webelement import WebElement
from selenium.webdriver.support.ui import WebDriverWait

ROOT = Path(__file__).parents[3]
EXAMPLES = ROOT / "examples" / "vertical"
COMMAND = ROOT / "tests" / "pmm" / "run" / "command.py"
CHROMIUM = shutil.which("chromium")
DRIVER = shutil.which("chromedriver")
WITHIN_S = 120.0
# So that a run at 2 Hz overloads them and one at 1 Hz does not; without hull nobody foresees it.
GAUGES = """
[[gauges]]
channel = "force_aft"
full_scale_n = 130.0
safe_load_n = 130.0

[[gauges]]
channel = "force_fore"
full_scale_n = 130.0
safe_load_n = 130.0
"""
needed = pytest.mark.skipif(
    CHROMIUM is None or DRIVER is None, reason="needs chromium and chromedriver (apt-get install)"
)


def rig_in(folder: Path, *, whole: bool = False) -> Path:
    """Write the example's rig with quick axes; return its file.

    Unless it is to be ``whole``, its gauges bear less and nothing is said of its hull.
    """
    folder.mkdir()
    shutil.copy(EXAMPLES / "simulated.toml", folder)
    text = (EXAMPLES / "rig.toml").read_text(encoding="utf-8")
    quick = {"speed = 0.005": "speed = 0.05", "speed = 0.2": "speed = 2.0", "0.01\n": "0.1\n"}
    for slow, fast in quick.items():
        assert slow in text
        text = text.replace(slow, fast)
    if whole:
        (folder / "rig.toml").write_text(text, encoding="utf-8")
        return folder / "rig.toml"
    without_hull = re.sub(r"\[hull\].*?(?=\[tank\])", "", text, flags=re.DOTALL)
    (folder / "rig.toml").write_text(without_hull + GAUGES, encoding="utf-8")
    return folder / "rig.toml"


def plan(name: str, *, frequency_hz: float = 1.0, periods: int = 5) -> str:
    """Return a plan of one run."""
    return (
        f'name = "{name}"\nrig = "rig.toml"\n[defaults]\nperiods = {periods}\n'
        f'settling_periods = 1\n[[runs]]\nname = "run"\nmotion = "heave"\n'
        f"frequencies_hz = {frequency_hz}\namplitudes_mm = 20.0\n"
    )


@dataclass
class Console:
    """A running console."""

    address: str
    output: Path
    pid: int
    said: str = ""  # on its standard error, once it has ended


@contextmanager
def console(rig: Path, output: Path, *options: str) -> Iterator[Console]:
    """Run ``pmm console`` on a free port; it is left by Ctrl-C."""
    command = [sys.executable, str(COMMAND), "console", str(rig), "--output", str(output)]
    command += ["--port", "0", *options]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "COLUMNS": "200"}
    # Unbuffered: what a buffer holds beside the first line would be lost to communicate().
    process = subprocess.Popen(command, stderr=subprocess.PIPE, bufsize=0, env=environment)
    try:
        assert process.stderr is not None
        line = process.stderr.readline().decode()
        found = re.search(r"https?://\S+", line)
        assert found, line + process.stderr.read().decode()
        one = Console(found.group(), output, process.pid)
        yield one
        process.send_signal(signal.SIGINT)
        one.said = process.communicate(timeout=30)[1].decode()
        assert process.returncode == 0, one.said
    finally:
        if process.poll() is None:
            process.kill()
            process.communicate()


class Browser:
    """A Chromium."""

    def __init__(self, profile: Path) -> None:
        options = webdriver.ChromeOptions()
        options.accept_insecure_certs = True  # tests sign their own
        options.binary_location = str(CHROMIUM)
        for one in ("headless=new", "no-sandbox", "disable-gpu", "disable-background-networking"):
            options.add_argument(f"--{one}")
        options.add_argument(f"--user-data-dir={profile}")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=Service(str(DRIVER)))
        self.resize(1400, 900)

    def resize(self, width: int, height: int) -> None:
        """Make the window that is looked at larger or smaller."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)

    @contextmanager
    def window(self) -> Iterator["Browser"]:
        """Look at a window of its own; it takes cookies and complaints with it when it closes."""
        first = self.driver.current_window_handle
        self.driver.switch_to.new_window("window")
        self.resize(1400, 900)
        try:
            yield self
        finally:
            for handle in set(self.driver.window_handles) - {first}:
                self.driver.switch_to.window(handle)
                self.driver.close()
            self.driver.switch_to.window(first)
            self.driver.execute_cdp_cmd("Network.clearBrowserCookies", {})
            self.complaints()

    def open(self, address: str) -> None:
        """Open the console's page and wait for its first data."""
        self.driver.get(address)
        self.until(lambda: self.find("body").get_attribute("data-ready") == "yes", "data")

    def find(self, selector: str) -> WebElement:
        """Return an element."""
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def text(self, selector: str) -> str:
        """Return what is written somewhere, shown or not."""
        return str(self.driver.execute_script(
            "return document.querySelector(arguments[0])?.textContent ?? ''", selector
        ))  # fmt: skip

    def click(self, selector: str) -> None:
        """Click what a person would first scroll into the middle."""
        self.until(lambda: self._clicked(selector), selector)

    def _clicked(self, selector: str) -> bool:
        self.run("document.querySelector(arguments[0]).scrollIntoView({block: 'center'})", selector)
        self.find(selector).click()
        return True

    def press(self, name: str) -> None:
        """Press a command's button as soon as it can be pressed."""
        selector = f"[data-command='{name}']"
        self.until(lambda: self.find(selector).is_enabled(), f"button {name}")
        self.click(selector)

    def queue(self, text: str) -> None:
        """Give a plan as text and queue it."""
        self.run("document.querySelector('#plan-form details').open = true")
        self.run("document.getElementById('plan-text').value = arguments[0]", text)
        self.click("[data-do=queue]")
        self.until(lambda: "queued" in self.text("#plan-said"), "queue")

    def run(self, script: str, *given: Any) -> Any:
        """Run a script in the page."""
        return self.driver.execute_script(script, *given)

    def until(self, condition: Callable[[], bool], what: str) -> None:
        """Wait for something that must come."""
        state = "state {}, alarms {}, plan {}"
        # What the page draws anew between two looks is looked at again.
        redrawn = [StaleElementReferenceException]
        try:
            WebDriverWait(self.driver, WITHIN_S, 0.05, redrawn).until(lambda _: condition())
        except Exception as error:
            seen = [self.text(one) for one in ("#state-name", "#alarms", "#plan-said")]
            raise AssertionError(f"{what} never came; {state.format(*seen)}") from error

    def complaints(self) -> list[str]:
        """Return what the browser complained of."""
        return [one["message"] for one in self.driver.get_log("browser")]


@contextmanager
def browser(profile: Path) -> Iterator[Browser]:
    """A browser with a profile of its own."""
    made = Browser(profile)
    try:
        yield made
    finally:
        made.driver.quit()
