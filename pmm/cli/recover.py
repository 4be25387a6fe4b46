"""``pmm recover``: recordings out of whatever a crash left of runs."""

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from hardware.description.errors import ConfigurationError, PmmError
from pmm.cli.screen import error_line, output, print_flags, show_progress

if TYPE_CHECKING:
    from pmm.recorder.recovery import RecoveredRun


@dataclass(frozen=True)
class _Result:
    folder: Path
    run: "RecoveredRun | None"
    error: str = ""
    empty: str = ""


@click.command()
@click.argument("places", metavar="FOLDER...", nargs=-1, required=True)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document, not a table.")
def recover(places: tuple[str, ...], as_json: bool) -> None:
    """Make recordings of runs that were not closed.

    FOLDER is the folder of a run or of a campaign. Each run that was not closed gets its run.nc, up
    to the last sample that is whole. Nothing that is there is changed or removed; doing it again
    does nothing. What is not what was written is named, and made again where the run's other
    files tell how. Exit status 1 if there was such, or if a run has nothing to recover.
    """
    from pmm.recorder.recovery import runs_in

    missing = [place for place in places if not Path(place).is_dir()]
    if missing:
        raise ConfigurationError(f"{', '.join(missing)}: no such folder")
    folders = [folder for place in places for folder in runs_in(Path(place))]
    results = [_recover(folder) for folder in show_progress(folders, "recovering")]
    if as_json:
        click.echo(json.dumps([_document(one) for one in results], indent=1))
    else:
        _print(results)
    changed = [one for one in results if one.run is not None and one.run.changed]
    for one in changed:
        if one.run is not None:
            names = ", ".join(one.run.changed)
            error_line(f"{one.folder}: {names}: not what was written, see its flags")
    if changed or any(one.error for one in results):
        click.get_current_context().exit(1)


def _recover(folder: Path) -> _Result:
    from pmm.recorder.recovery import NothingWrittenError
    from pmm.recorder.recovery import recover as recover_run

    try:
        return _Result(folder, recover_run(folder))
    except NothingWrittenError as error:
        return _Result(folder, None, empty=str(error))
    except PmmError as error:
        return _Result(folder, None, str(error))


def _document(result: _Result) -> dict[str, Any]:
    if result.empty:
        return {"folder": str(result.folder), "nothing_written": result.empty}
    if result.run is None:
        return {"folder": str(result.folder), "error": result.error}
    return {"folder": str(result.folder), **asdict(result.run), "path": str(result.run.path)}


def _print(results: Sequence[_Result]) -> None:
    from rich.table import Table

    console = output()
    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for name in ("run", "samples", "missing", "frames", "bytes not whole", "what was done"):
        table.add_column(name, justify="left" if name in ("run", "what was done") else "right")
    for one in results:
        if not one.error:
            table.add_row(one.folder.name, *_cells(one.run))
    if table.row_count:
        console.print(table)
    for one in results:
        if one.run is not None and one.run.flags:
            console.print(one.folder.name, style="bold")
            print_flags(console, one.run.flags)
        elif one.error:
            error_line(one.error)


def _cells(run: "RecoveredRun | None") -> tuple[str, ...]:
    if run is None:
        return ("0", "0", "0", "0", "nothing: the program ended before anything was written")
    numbers = (run.samples, run.missing, run.frames, sum(run.lost_tail_bytes.values()))
    done = "nothing: it was closed" if run.was_whole else f"{run.path.name} is there"
    return (*map(str, numbers), done)
