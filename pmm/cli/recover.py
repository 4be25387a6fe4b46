"""``pmm recover``: recordings out of whatever a crash left of runs."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from pmm.cli.options import JSON

if TYPE_CHECKING:
    from pmm.report.recording_document import Recovery


@click.command()
@click.argument("places", metavar="FOLDER...", nargs=-1, required=True)
@JSON
def recover(places: tuple[str, ...], as_json: bool) -> None:
    """Make recordings of runs that were not closed.

    FOLDER is the folder of a run or of a campaign. Each run that was not closed gets its run.nc, up
    to the last sample that is whole. Nothing that is there is changed or removed; doing it again
    does nothing. What is not what was written is named, and made again where the run's other
    files tell how. Exit status 1 if there was such, or if a run has nothing to recover.
    """
    from hardware.description.errors import ConfigurationError
    from pmm.cli.screen import error_line, output, show_progress
    from pmm.document.data import as_data
    from pmm.document.terminal import print_document
    from pmm.recorder.recovery import runs_in
    from pmm.report.recording_document import recovery_document

    missing = [place for place in places if not Path(place).is_dir()]
    if missing:
        raise ConfigurationError(f"{', '.join(missing)}: no such folder")
    folders = [folder for place in places for folder in runs_in(Path(place))]
    recoveries = [_recovered(folder) for folder in show_progress(folders, "recovering")]
    document = recovery_document(recoveries)
    if as_json:
        import json

        click.echo(json.dumps(as_data(document)["runs"], indent=1))
    else:
        print_document(output(), document)
    faults = [recovery.error for recovery in recoveries if recovery.error]
    for recovery in recoveries:
        if recovery.run is not None and recovery.run.changed:
            names = ", ".join(recovery.run.changed)
            faults.append(f"{recovery.folder}: {names}: not what was written, see its flags")
    for line in faults:
        error_line(line)
    if faults:
        click.get_current_context().exit(1)


def _recovered(folder: Path) -> "Recovery":
    from hardware.description.errors import PmmError
    from pmm.recorder.recovery import NothingWrittenError
    from pmm.recorder.recovery import recover as recover_run
    from pmm.report.recording_document import Recovery

    try:
        return Recovery(folder, recover_run(folder))
    except NothingWrittenError as error:
        return Recovery(folder, empty=str(error))
    except PmmError as error:
        return Recovery(folder, error=str(error))
