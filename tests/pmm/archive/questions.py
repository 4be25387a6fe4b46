"""Ten questions of ``docs/archive.md`` to an archive, each with the answer that the files give.

An answer is a set of facts; folders stand in it as paths, runs by name. The same questions are
asked of a few campaigns in `make test` and of every campaign that the tests make by
``python -m benchmarks questions``.
"""

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from click.testing import CliRunner

from pmm.cli import cli
from tests.pmm.archive.by_hand import (
    HandRun,
    began,
    coefficients_of,
    first_harmonics_of,
    hashes_of,
    notes_of,
    runs_of,
)

_DIGITS = 9  # significant, in which two ways through the same analysis agree
Fact = tuple[object, ...]
Answer = list[Fact]


@dataclass(frozen=True)
class Asked:
    """An archive, and what its folders were when they were added.

    Attributes
    ----------
    analysed, verdicts
        Folders of which the analysis, or the diagnosis, was asked for; verdicts as it told them.
    hashes
        Of the recordings of each folder.
    spoiled
        Told by who changed something since, by folder.
    """

    file: Path
    folders: tuple[Path, ...]
    analysed: frozenset[Path]
    verdicts: Mapping[Path, str]
    hashes: Mapping[Path, Mapping[str, str]]
    runs: tuple[HandRun, ...]
    spoiled: dict[Path, list[str]] = field(default_factory=dict)

    def told(self, *words: object) -> Any:
        """Return what ``pmm archive`` prints."""
        given = ["archive", *map(str, words), "--archive", str(self.file), "--json"]
        done = CliRunner().invoke(cli, given, catch_exceptions=False)
        if done.exit_code:
            raise AssertionError(f"{given}: {done.stderr}")
        return json.loads(done.stdout)

    def find(self, expression: str, *columns: str) -> Answer:
        """Return columns of the runs that fulfil a condition."""
        rows = self.told("find", expression)["runs"]
        return [(Path(one["folder"]), *(one[key] for key in columns)) for one in rows]


def asked(
    file: Path, folders: list[Path], analysed: list[Path], verdicts: Mapping[Path, str]
) -> Asked:
    """Return an archive with what its folders are now."""
    runs = tuple(run for folder in folders for run in runs_of(folder))
    hashes = {folder: hashes_of(folder) for folder in folders}
    return Asked(file, tuple(folders), frozenset(analysed), verdicts, hashes, runs)


def _fast(a: Asked) -> tuple[Answer, Answer]:
    found, wanted = list[Fact](), list[Fact]()
    for hull in sorted({run.hull for run in a.runs}):
        quoted = hull.replace("'", "''")
        found += a.find(f"hull = '{quoted}' and frequency_hz > 0.5", "run", "hull")
    wanted += [(one.folder, one.name, one.hull) for one in a.runs if one.frequency_hz > 0.5]
    return found, wanted


def _cut_short(a: Asked) -> tuple[Answer, Answer]:
    wanted = [(one.folder, one.name, one.outcome) for one in a.runs if one.outcome != "complete"]
    return a.find("outcome != 'complete'", "run", "outcome"), wanted


def _missing(a: Asked) -> tuple[Answer, Answer]:
    wanted = [(one.folder, one.name) for one in a.runs if one.name not in a.hashes[one.folder]]
    return a.find("not recording != ''", "run"), wanted


def _hashes(a: Asked) -> tuple[Answer, Answer]:
    wanted = [(folder, *one) for folder, each in a.hashes.items() for one in each.items()]
    return a.find("recording != ''", "run", "sha256"), wanted


def _notes(a: Asked) -> tuple[Answer, Answer]:
    found, wanted = list[Fact](), list[Fact]()
    for folder in a.folders:
        names = {run.name for run in a.runs if run.folder == folder}
        notes = [one for one in notes_of(folder) if one["run"] in names]
        wanted += [(folder, *(one[key] for key in ("run", "author", "text"))) for one in notes]
        for name in {one["run"] for one in notes}:
            rows = a.told("show", name, "--campaign", folder)["notes"]
            found += [(folder, name, one["author"], one["text"]) for one in rows if one["run"]]
    return found, wanted


def _not_analysed(a: Asked) -> tuple[Answer, Answer]:
    rows = a.told("list")["campaigns"]
    found: Answer = [(Path(one["folder"]),) for one in rows if not one["analysed"]]
    return found, [(one,) for one in a.folders if one not in a.analysed]


def _changed(a: Asked) -> tuple[Answer, Answer]:
    rows = a.told("list")["campaigns"]
    found = [(Path(one["folder"]), text) for one in rows for text in one["changes"]]
    return list(found), [(folder, text) for folder, every in a.spoiled.items() for text in every]


def _verdicts(a: Asked) -> tuple[Answer, Answer]:
    wanted = [
        (run.folder, run.name, a.verdicts[run.folder])
        for run in a.runs
        if a.verdicts.get(run.folder, "none") != "none"
    ]
    return a.find("verdict != 'none'", "run", "verdict"), list(wanted)


def _trend(a: Asked) -> tuple[Answer, Answer]:
    """Rows of a model, speed and frequency are numbered by time: their order is a fact too."""
    rows = [
        (folder, one)
        for folder in sorted(a.analysed, key=lambda one: (_first(a, one), str(one)))
        for one in coefficients_of(folder)
    ]
    wanted = _numbered((one["name"], _hull(a, folder), folder, one) for folder, one in rows)
    every = a.told("find", "coefficient != ''", "--coefficients")["coefficients"] if rows else []
    found = [
        fact
        for name in sorted({one["coefficient"] for one in every})
        for fact in _numbered(
            (name, one["hull"], Path(one["folder"]), one) for one in a.told("trend", name)["trend"]
        )
    ]
    return found, list(wanted)


def _numbered(rows: Iterator[tuple[str, str, Path, Mapping[str, Any]]] | Any) -> Iterator[Fact]:
    count: dict[Fact, int] = {}
    for name, hull, folder, one in rows:
        group = (name, hull, one["unit"], round(one["speed_m_s"], 3), round(one["frequency_hz"], 4))
        count[group] = count.get(group, 0) + 1
        yield (*group, count[group], folder, f"{one['value']:.{_DIGITS}g}")


def _first(a: Asked, folder: Path) -> float:
    """Return when a campaign's first recording began."""
    paths = [run.recording for run in a.runs if run.folder == folder]
    return min((began(one).timestamp() for one in paths if one is not None), default=0.0)


def _hull(a: Asked, folder: Path) -> str:
    return next(run.hull for run in a.runs if run.folder == folder)


def _repeats(a: Asked) -> tuple[Answer, Answer]:
    """One run of each analysed campaign is asked for, by the channel that is first by name."""
    found, wanted = list[Fact](), list[Fact]()
    told = {
        (folder, run): channels
        for folder in sorted(a.analysed)
        for run, channels in first_harmonics_of(folder).items()
        if channels
    }
    by_name = {(run.folder, run.name): run for run in a.runs}
    for folder in sorted(a.analysed):
        key = next((one for one in told if one[0] == folder), None)
        if key is None:
            continue
        channel = min(told[key])
        rows = a.told("trend", channel, "--run", key[1], "--campaign", folder)["trend"]
        found += [
            (*key, Path(one["folder"]), one["run"], one["part"], f"{one['value']:.{_DIGITS}g}")
            for one in rows
        ]
        for other, channels in told.items():
            if by_name[key].repeats(by_name[other]) and channel in channels:
                parts = zip(("in phase", "quadrature"), channels[channel], strict=True)
                wanted += [(*key, *other, part, f"{one:.{_DIGITS}g}") for part, one in parts]
    return found, wanted


QUESTIONS: dict[str, Callable[[Asked], tuple[Answer, Answer]]] = {
    "Which runs of this hull were faster than 0.5 Hz?": _fast,
    "Which runs were cut short?": _cut_short,
    "Which runs have no recording?": _missing,
    "Which bytes belong to which run?": _hashes,
    "What was noted about a run?": _notes,
    "What is not analysed yet?": _not_analysed,
    "What changed or vanished since it was added?": _changed,
    "Where does the diagnosis say anything but none?": _verdicts,
    "How does a coefficient go over time?": _trend,
    "Does a repeated run agree with its past?": _repeats,
}


def spoil(a: Asked) -> None:
    """Append a byte to a recording, take one of another campaign away, and move a third folder."""
    recorded = {run.folder: path for run in a.runs if (path := run.recording) is not None}
    (first, longer), (second, gone) = list(recorded.items())[:2]
    third = next(one for one in a.folders if one not in (first, second))
    longer.write_bytes(longer.read_bytes() + b"\0")
    gone.unlink()
    third.rename(third.with_name(f"{third.name}-elsewhere"))
    a.spoiled[first] = [f"{longer.relative_to(first)} changed"]
    a.spoiled[second] = [f"{gone.relative_to(second)} vanished"]
    a.spoiled[third] = ["the folder vanished"]
