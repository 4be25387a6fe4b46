"""What ``pmm init`` does: ask, write, and say what to do next."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import click

from pmm.cli.folders import check_folder
from pmm.cli.hints import pasted
from pmm.cli.screen import messages, output
from pmm.start.jobs import FILES, StartTask, write
from pmm.start.questions import StartQuestion, answers
from pmm.start.writing import check_free

_NEXT: Final[Mapping[str, tuple[tuple[str, ...], ...]]] = {
    "rig": (
        ("devices", "scan", "{}/rig.toml"),
        ("plan", "check", "{}/plan.toml"),
        ("run", "{}/plan.toml"),
    ),
    "recordings": (("analyse", "{}"), ("coefficients", "{}")),
    "campaign": (
        ("simulate", "{}/campaign.toml", "--output", "{}/simulated"),
        ("analyse", "{}/simulated"),
    ),
    "swing": (("inertia", "swing", "{}/swing.toml"),),
    "bifilar": (("inertia", "bifilar", "{}/bifilar.toml"),),
}


def run(job: str, options: dict[str, Any]) -> None:
    """Write a job's files and print the commands that come next.

    Raises
    ------
    ConfigurationError, DataError
        As :func:`pmm.start.jobs.write` does.
    """
    folder = Path(options["output"])
    recordings = tuple(Path(one) for one in options.get("recordings", ()))
    check_folder(folder, "--output")
    check_free(folder, FILES[job], force=options["force"])
    given = answers(job, options, _default if options["yes"] else _asked)
    done = write(StartTask(job, given, folder, recordings), force=options["force"])
    for path in done.paths:
        messages().print(f"written: {path}")
    for note in done.notes:
        messages().print(note, soft_wrap=True, markup=False)
    kind = "recordings" if job == "campaign" and recordings else job
    for words in _NEXT[kind]:
        place = folder.as_posix()
        command = pasted(*(Path(word.format(place)) if "{}" in word else word for word in words))
        output().print(f"next: {command}", soft_wrap=True)


def _default(question: StartQuestion) -> str | float:
    return question.default


def _asked(question: StartQuestion) -> str | float:
    kind: Any = click.Choice(question.choices) if question.choices else type(question.default)
    answer: str | float = click.prompt(question.text, default=question.default, type=kind, err=True)
    return answer
