"""``pmm gap pursue``: run after run, until it is known why rig and simulation differ."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from pmm.cli.gap.options import LOOKS, Looks, engine
from pmm.cli.options import JSON, jobs_option

if TYPE_CHECKING:
    from collections.abc import Callable

    from pmm.gap.examination import Examined
    from pmm.gap.pursuit_rounds import Look

_EVERY_S = 2.0


@click.command()
@click.argument("folder", metavar="FOLDER")
@click.option(
    "--approve", type=click.Choice(["all"]), help="Approve of all runs.  [default: ask for each]"
)
@click.option(
    "--simulated",
    metavar="CAMPAIGN.toml",
    help="Make the runs on the simulated rig that this file describes, with its effects.",
)
@click.option(
    "--batch",
    type=click.IntRange(1, 5),
    default=1,
    show_default=True,
    help="Runs of a round at most.",
)
@click.option(
    "--worth",
    type=click.FloatRange(0.0, 20.0, min_open=True),
    default=1.0,
    show_default=True,
    help="Expected log odds below which a run is not proposed.",
)
@click.option(
    "--wait",
    type=click.FloatRange(0.0),
    default=0.0,
    show_default=True,
    metavar="MINUTES",
    help="How long to wait for recordings before the command ends.",
)
@LOOKS
@jobs_option("one for each core")
@JSON
def pursue(
    folder: str,
    approve: str | None,
    simulated: str | None,
    batch: int,
    worth: float,
    wait: float,
    jobs: int | None,
    as_json: bool,
    **chosen: Any,
) -> None:
    """Propose runs, take in their recordings and diagnose again, until one class is known.

    FOLDER holds a campaign.toml and its recordings. Each round writes a plan, next-1.toml,
    next-2.toml, ..., beside them. Call again when the recordings of its runs are in the folder: it
    goes on from there (docs/gap.md).

    \b
    pmm gap pursue my-campaign
    pmm gap pursue my-campaign --approve all --simulated truth.toml

    Exit status: 0 known, exhausted, waiting or not approved; 1 the data say no; 2 the request was
    wrong.
    """  # noqa: D301
    from pmm.parallel import one_thread

    one_thread()  # the matrices are small: threads would wait for each other
    from pmm.cli.screen import show
    from pmm.gap.pursuit import pursued, simulated_by
    from pmm.gap.pursuit_document import pursuit_document
    from pmm.gap.pursuit_rounds import Ways
    from pmm.gap.pursuit_rounds import pursue as pursued_until_known

    looks, path = Looks(**chosen), Path(folder)
    campaign = pursued(path).campaign
    ways = Ways(
        lambda: _examined(looks, path, jobs),
        _asked if approve is None else _shown,
        None if simulated is None else simulated_by(Path(simulated), campaign),
        _waiting(60.0 * wait),
        worth,
        batch,
    )
    found = pursued_until_known(path, ways)
    show(pursuit_document(campaign.name, found), as_json=as_json)


def _examined(looks: Looks, path: Path, jobs: int | None) -> "Examined":
    from pmm.cli.screen import doing
    from pmm.gap.examination import examine

    with doing("reading") as told, engine(looks, jobs) as executor:
        return examine(path, looks.options, executor, told)


def _shown(look: "Look") -> bool:
    from pmm.cli.screen import messages
    from pmm.gap.pursuit_document import look_lines

    for line in look_lines(look):
        messages().print(line, markup=False)
    return True


def _asked(look: "Look") -> bool:
    """Show what is proposed and ask for approval at the terminal."""
    from hardware.description.errors import ConfigurationError

    _shown(look)
    try:
        return click.confirm("Approve of these runs?", err=True)
    except click.Abort:
        raise ConfigurationError(
            "nobody answers whether these runs are to be made; --approve all approves of them"
        ) from None


def _waiting(seconds: float) -> "Callable[[], bool]":
    """Return what waits a little, and tells whether there was time left to."""
    from time import monotonic, sleep

    until = monotonic() + seconds

    def waited() -> bool:
        left = until - monotonic()
        if left <= 0.0:
            return False
        sleep(min(_EVERY_S, left))
        return True

    return waited
