"""``pmm devices tune``: the speed loop of the shaft, and gains that would serve it better."""

from contextlib import ExitStack
from pathlib import Path
from typing import TYPE_CHECKING

import click

from hardware.description.errors import ConfigurationError
from pmm.cli.devices import RIG, YES, confirm, opened
from pmm.cli.options import PLOT
from pmm.cli.screen import show
from pmm.cli.terminal import Terminal

if TYPE_CHECKING:
    from analysis.speed_loop.identification import SpeedRecord
    from pmm.devices.speed_test import SpeedTest
    from pmm.plan.rig_file import RigFile


_SLOW, _FAST = 0.2, 0.6  # of the highest speed: well within it, and well apart


@click.command()
@RIG
@YES
@click.option("--stated", is_flag=True, help="From the stated data alone; nothing moves.")
@click.option("--speeds", "speeds_hz", type=float, nargs=2, metavar="SLOW FAST",
              help="Of the test, Hz.  [default: 0.2 and 0.6 times the highest]")  # fmt: skip
@click.option("--delay", "delay_s", type=click.FloatRange(min=0.0), default=0.001,
              show_default=True, metavar="S", help="Dead time of the drive's own sampling.",
              )  # fmt: skip
@click.option("--sensitivity", type=click.FloatRange(min=1.0, min_open=True), metavar="M",
              help="How near to instability the proposal may come: 1.2 cautious, 2 bold.  "
              "[default: 1.4]")  # fmt: skip
@click.option("--plan", metavar="PLAN.toml", help="Whose runs' speed ripple is to be told.")
@PLOT
def tune(
    rig: str,
    free_running: bool,
    as_json: bool,
    yes: bool,
    stated: bool,
    speeds_hz: tuple[float, float] | None,
    delay_s: float,
    sensitivity: float | None,
    plan: str | None,
    plot: str | None,
) -> None:
    """Find the shaft's speed loop, and propose gains for it.

    The speed is changed up and down at the smallest eccentricity; the encoder tells inertia, gain
    and friction. The motor's data stand in [campaign.drive.motor] of the rig's file. Gains are
    proposed, never written to the drive.

    \b
    pmm devices tune rig.toml --plan plan.toml --plot plots
    pmm devices tune rig.toml --stated
    """  # noqa: D301
    from pmm.cli.files import check_folder
    from pmm.document.style import write_figures
    from pmm.plan.plan import read_plan
    from pmm.plan.rig_file import read_rig_file
    from pmm.plan.tuning import stated_loop, tuned
    from pmm.report.tune_document import tune_document

    check_folder(plot, "--plot")
    file = read_rig_file(rig)
    runs = read_plan(plan).runs if plan is not None else ()
    loop, record = stated_loop(file, delay_s), None
    if not stated:
        test = _speed_test(file, speeds_hz, loop.settling_s)
        record = _record(file, test, free_running=free_running, yes=yes)
    document = tune_document(tuned(file, loop, record, sensitivity, runs))
    show(document, as_json=as_json)
    if plot is not None:
        write_figures(document.figures, Path(plot), Path(rig).stem)


def _record(file: "RigFile", test: "SpeedTest", *, free_running: bool, yes: bool) -> "SpeedRecord":
    from pmm.devices.axis_move import look

    with (
        ExitStack() as stack,
        opened(file.hardware, free_running=free_running, limits=file.watched) as rig,
    ):
        test.check(rig)
        confirm(
            f"the shaft will turn at {test.slow_hz:g} and {test.fast_hz:g} Hz at the smallest "
            "eccentricity. Is everything clear of it?",
            yes=yes,
        )
        stack.enter_context(Terminal())
        rig.prepare()
        look(rig)
        return test.run(rig)


def _speed_test(
    rig: "RigFile", speeds_hz: tuple[float, float] | None, settle_s: float
) -> "SpeedTest":
    """Return the test of a rig, at the speeds that are asked for or at its own.

    Raises
    ------
    ConfigurationError
        If the rig's drive does not ramp its speed by itself.
    """
    from pmm.devices.speed_test import SpeedTest

    shaft = rig.hardware.shaft
    settings = None if shaft is None else shaft.settings
    acceleration = getattr(settings, "acceleration_hz_per_s", None)
    if acceleration is None:
        raise ConfigurationError(
            f"{rig.path}: its [shaft] has no acceleration_hz_per_s, so its ramps are not known; "
            "--stated looks at the stated data alone"
        )
    highest_hz = rig.oscillator.frequency_hz.high
    slow_hz, fast_hz = speeds_hz or (_SLOW * highest_hz, _FAST * highest_hz)
    return SpeedTest(slow_hz, fast_hz, acceleration, settle_s)
