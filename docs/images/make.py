"""Make the README's pictures anew: ``python docs/images/make.py``.

Gate and phasors come from the example recording; console and report from runs on the simulated rig,
where chromium and chromedriver are installed.
"""

import shutil
from contextlib import chdir
from pathlib import Path
from tempfile import TemporaryDirectory
from time import sleep

from analysis.readers import read_recording
from analysis.readers.columns_toml import read_column_map
from analysis.resolver.analysis import analyse
from analysis.resolver.settings import ResolverSettings
from pmm.document.style import drawing
from pmm.report.plots import FIGURES

HERE = Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples"
EXAMPLE = EXAMPLES / "recordings"
PLAN = """name = "heave"
rig = "rig.toml"
[defaults]
periods = 14
settling_periods = 2
[[runs]]
name = "heave"
motion = "heave"
frequencies_hz = [0.65, 0.83, 1.2]
amplitudes_mm = 20.0
speeds_m_s = 1.2
"""


def main() -> None:
    """Draw the gate and the phasors of the example."""
    recording = read_recording(EXAMPLE / "heave.csv.gz", read_column_map(EXAMPLE / "heave.toml"))
    analysis = analyse(recording, settings=ResolverSettings(channels=("force_aft", "force_fore")))
    for name in ("gate", "phasors"):
        with drawing():
            FIGURES[name](analysis, 0).savefig(HERE / f"{name}.png", dpi=90)
    if shutil.which("chromium") and shutil.which("chromedriver"):
        show_console()
        show_report()


def show_console() -> None:
    """Run a plan under the console and take its picture, light and dark, while a gate is open."""
    from tests.pmm.console.chromium import browser, console

    # Relative names, for the page shows where it records.
    with TemporaryDirectory() as name, chdir(name):
        shutil.copytree(EXAMPLES / "vertical", "rig")
        with (
            console(Path("rig") / "rig.toml", Path("campaigns")) as one,
            browser(Path(name) / "profile") as page,
        ):
            page.open(one.address)
            page.queue(PLAN)
            page.press("start")
            page.until(lambda: "f0.65" in page.text("#finished-table tbody"), "first run")
            page.until(lambda: "Z_wdot" in page.text("#coefficient"), "coefficients")
            page.until(lambda: "3 of 3" in page.text("#state-run"), "last run")
            page.until(lambda: int(page.text("#periods")) >= 5, "five periods")
            for theme in ("light", "dark"):
                page.run("document.documentElement.dataset.theme = arguments[0]", theme)
                page.run("dispatchEvent(new Event('pmm-theme')); scrollTo(0, 0)")
                page.run("document.querySelector('#plan-form details').open = false")
                sleep(1.0)
                page.driver.save_screenshot(str(HERE / f"console-{theme}.png"))


def show_report() -> None:
    """Run the demo's vertical campaign and take a picture of the first run in its report."""
    from click.testing import CliRunner
    from PIL import Image

    from pmm.cli import cli
    from tests.pmm.console.chromium import browser

    with TemporaryDirectory() as name:
        folder, whole = Path(name), Path(name) / "whole.png"
        CliRunner().invoke(cli, ["demo", "--vertical-only", "--output", str(folder / "demo")])
        with browser(folder / "profile") as page:
            page.driver.set_window_size(1100, 1500)
            page.driver.get((folder / "demo" / "report.html").as_uri())
            page.run("document.documentElement.style.scrollbarWidth = 'none'")
            page.run("document.querySelector('h2').scrollIntoView(); scrollBy(0, -20)")
            page.driver.save_screenshot(str(whole))
        picture = Image.open(whole).convert("RGB").crop((0, 0, 1100, 990))
        picture.resize((880, 792)).quantize(64).save(HERE / "report.png", optimize=True)


if __name__ == "__main__":
    main()
