"""What ``pmm gap add-pendulum`` does: fit, append to the file, and keep the old one."""

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, cast

from analysis.gap.pendulum.settle import Settled
from hardware.description.errors import DataError
from pmm.cli.gap_adding import add_and_say, check_appendable
from pmm.cli.gap_diagnose_work import progress
from pmm.cli.gap_options import Chosen
from pmm.cli.hints import pasted
from pmm.gap.appending import Added, refuse_twice
from pmm.gap.pendulum_conclusion import conclusion_of
from pmm.gap.pendulum_examine import PendulumOptions, examine_pendulum, fitted_causes
from pmm.gap.pendulum_file import read_case
from pmm.gap.pendulum_words import what_is_wrong

JSON_SCHEMA = "pmm-gap-add-pendulum-1"


@dataclass(frozen=True)
class GapAddPendulumOptions(Chosen):
    """The options of the command, by their names there."""

    file: str
    causes: tuple[str, ...]
    most: int
    as_json: bool


def run(request: GapAddPendulumOptions) -> None:
    """Add effects to a pendulum's file.

    Raises
    ------
    ConfigurationError
        If the file or an option is wrong, or the file has that effect already.
    DataError
        If no cause is found, or a named one cannot be fitted.
    """
    path = Path(request.file)
    there = [one.name for one in read_case(path).effects]
    check_appendable(path)
    refuse_twice(path, there, request.causes)
    after = _settled(request, path)
    refuse_twice(path, there, after.best.names)
    effects = after.best.effects(after.problem.trials[0])
    added = [Added(one.name, _told(one)) for one in effects]
    files = [word for one in request.files for word in ("--effects", one)]
    again = pasted("gap", "pendulum", request.file, *files)
    schema = JSON_SCHEMA if request.as_json else None
    add_and_say(path, added, read_case, again=again, schema=schema)


def _settled(request: GapAddPendulumOptions, path: Path) -> Settled:
    """Return the causes to add, fitted."""
    options = PendulumOptions(request.effects, request.without, request.most)
    if request.causes:
        return fitted_causes(path, request.causes, options)
    with progress() as shown:
        found = examine_pendulum(path, options, shown).diagnosis
    concluded = conclusion_of(found)
    if not concluded.adds:
        said = what_is_wrong(found, concluded)
        raise DataError(f"{path.stem}: {said} So there is nothing to add")
    return found.settled


def _told(effect: object) -> dict[str, float | str]:
    """Return an effect's parameters; what is left to the record is left out."""
    return {key: value for key, value in asdict(cast("Any", effect)).items() if value != ""}
