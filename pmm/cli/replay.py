"""``pmm replay``: a run's raw log through the live path again."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hardware.description.errors import ConfigurationError
from pmm.cli.screen import busy, error_line, output

if TYPE_CHECKING:
    from rich.console import Console

    from pmm.recorder.replay import Replay


@click.command()
@click.argument("folder", metavar="RUN")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a table.")
def replay(folder: str, as_json: bool) -> None:
    """Run a run's raw log through the live path again, and compare.

    RUN is the folder of a run. The frames of bus.blf and the lines of lines.jsonl are decoded by
    the rig that the run's header names; samples and pulses have to be the recorded ones bit by bit,
    and the harmonics of its gates the same. Exit status 1 if they are not, or if a file of the run
    is not what was written.
    """
    from pmm.recorder.replay import replay as replay_run

    if not Path(folder).is_dir():
        raise ConfigurationError(f"{folder}: no such folder")
    with busy("replaying"):
        found = replay_run(Path(folder))
    if as_json:
        click.echo(json.dumps(_document(found), indent=1))
    else:
        _print(output(), found)
    wrong = [f"{folder}: {name} was changed: {words}" for name, words in found.changed.items()]
    if not found.same:
        wrong.append(f"{folder}: the replay differs from the recording")
    for one in wrong:
        error_line(one)
    if wrong:
        click.get_current_context().exit(1)


def _document(found: "Replay") -> dict[str, Any]:
    return {
        "same": found.same,
        "samples": found.recorded.shape[1],
        "differing_values": found.differing_samples,
        "pulses": len(found.pulses),
        "recorded_pulses": len(found.recorded_pulses_s),
        "readings": [one and one["coefficients"] for one in found.readings],
        "recorded_readings": [one["coefficients"] for one in found.recorded_readings],
        "largest_difference": found.difference,
        "faults": list(found.faults),
        "changed": dict(found.changed),
    }


def _print(console: "Console", found: "Replay") -> None:
    count = found.recorded.shape[1]
    console.print(f"samples    {count}, {found.differing_samples} values differ")
    console.print(f"pulses     {len(found.recorded_pulses_s)} recorded, {len(found.pulses)} again")
    told = len(found.recorded_readings)
    console.print(f"readings   {told} recorded, largest difference {found.difference:.2g}")
    if told:
        _print_reading(console, found.recorded_readings[-1], found.readings[-1])
    for one in found.faults:
        console.print(f"reported again: {one}", style="dim")


def _print_reading(
    console: "Console", told: Mapping[str, Any], again: Mapping[str, Any] | None
) -> None:
    """Print the last reading of both."""
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    periods, closed_s = told["periods"], told["closed_s"]
    table.add_column(f"last: {periods} periods to {closed_s:.3f} s")
    for name in ("in phase 1", "quadrature 1", "in phase 1 again", "quadrature 1 again"):
        table.add_column(name, justify="right")
    for i, channel in enumerate(told["channels"]):
        before = told["coefficients"][i][1:3]
        after = again["coefficients"][i][1:3] if again else (float("nan"),) * 2
        table.add_row(channel, *(f"{one:.9g}" for one in (*before, *after)))
    console.print(table)
