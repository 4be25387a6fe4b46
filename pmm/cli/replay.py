"""``pmm replay``: a run's raw log through the live path again."""

from pathlib import Path

import click

from pmm.cli.options import JSON


@click.command()
@click.argument("folder", metavar="RUN")
@JSON
def replay(folder: str, as_json: bool) -> None:
    """Run a run's raw log through the live path again, and compare.

    RUN is the folder of a run. The frames of bus.blf and the lines of lines.jsonl are decoded by
    the rig that the run's header names; samples and pulses have to be the recorded ones bit by bit,
    and the harmonics of its gates the same. Exit status 1 if they are not, or if a file of the run
    is not what was written.
    """
    from hardware.description.errors import ConfigurationError
    from pmm.cli.screen import busy, error_line, show
    from pmm.recorder.replay import replay as replay_run
    from pmm.report.recording_document import replay_document

    if not Path(folder).is_dir():
        raise ConfigurationError(f"{folder}: no such folder")
    with busy("replaying"):
        comparison = replay_run(Path(folder))
    show(replay_document(comparison), as_json=as_json)
    faults = [
        f"{folder}: {name} was changed: {words}" for name, words in comparison.changed.items()
    ]
    if not comparison.same:
        faults.append(f"{folder}: the replay differs from the recording")
    for fault in faults:
        error_line(fault)
    if faults:
        click.get_current_context().exit(1)
