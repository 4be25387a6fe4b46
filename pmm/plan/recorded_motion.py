"""The motion that the struts are to follow, read from the file that a plan names."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pmm.configuration import Fault, Place

_FEWEST = 8  # samples of a period


def read_recorded(table: dict[str, Any], folder: Path) -> Iterator[Fault]:
    """Put the samples of each entry's ``recorded`` file in its place; yield what is wrong.

    A file has one number a line, of the struts over one base period, evenly spaced and in any unit;
    what follows a ``#`` is a comment.

    Parameters
    ----------
    folder
        Of the plan: files are named from there.
    """
    runs = table.get("runs")
    for number, run in enumerate(runs if isinstance(runs, list) else []):
        if isinstance(run, dict) and "recorded" in run:
            place: Place = ("runs", number, "recorded")
            try:
                run["recorded"] = _samples(folder / str(run["recorded"]))
            except (OSError, ValueError) as error:
                del run["recorded"]
                yield Fault(place, f": {error}")


def _samples(path: Path) -> list[float]:
    if not path.is_file():
        raise ValueError(f"{path}: no such file; give one number a line, over one base period")
    said = (line.partition("#")[0].strip() for line in path.read_text("utf-8-sig").splitlines())
    found = []
    for number, text in enumerate(said, 1):
        if text:
            try:
                found.append(float(text))
            except ValueError:
                raise ValueError(f"{path}, line {number}: {text!r} is not one number") from None
    if len(found) < _FEWEST or len(set(found)) == 1:
        raise ValueError(
            f"{path}: {len(found)} numbers that do not move; give {_FEWEST} or more over one period"
        )
    return found
