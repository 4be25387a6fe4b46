"""The archive's ten questions, over every campaign that the tests make.

The tests that make campaigns run in a folder of this benchmark's, and whatever they leave there
with a ``campaign.toml`` is added, those that were made to be refused too. Questions and readings by
hand are those of ``tests/pmm/archive``.
"""

import json
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from itertools import islice
from pathlib import Path
from typing import Final

from benchmarks.machine import ROOT
from benchmarks.outcome import Benchmark, Outcome, Report, Row

# Folders of the tests that write a campaign's file; `make test` runs the same.
_MAKERS: Final = (
    "tests/analysis", "tests/benchmarks", "tests/docs", "tests/end_to_end", "tests/examples",
    "tests/pmm", "tests/sim",
)  # fmt: skip
_QUICK: Final = (
    "tests/pmm/archive/test_many_folders_against_one_process.py",
    "tests/pmm/test_campaign_errors_against_messages.py",
)
_LEFT: Final = 10  # each so-manieth campaign is not analysed
_DIAGNOSED: Final = 5  # campaigns, those with the least bytes that have coefficients
_TRIED: Final = 20  # until so many have a verdict: some are made to be refused
_FEWEST: Final = 3  # runs that a diagnosis needs


def _run(quick: bool, report: Report) -> Outcome:
    from tests.pmm.archive.by_hand import coefficients_of, hashes_of, verdict_of
    from tests.pmm.archive.questions import QUESTIONS, asked, spoil

    with tempfile.TemporaryDirectory() as name:
        place = Path(name).resolve()
        report("running the tests")
        ended = _made(place / "tests", _QUICK if quick else _MAKERS)
        found = sorted(path.parent for path in (place / "tests").rglob("campaign.toml"))
        file = place / "archive.sqlite"
        report(f"adding {len(found)} campaigns")
        left = found[::_LEFT]
        folders = _added(file, left) + _added(file, sorted({*found} - {*left}), "--analyse")
        analysed = [one for one in folders if one not in left]
        answering = [one for one in sorted(analysed, key=_bytes) if coefficients_of(one)]
        telling = [one for one in answering if len(hashes_of(one)) >= _FEWEST]
        report("diagnosing")
        tried = ((one, verdict_of(one)) for one in telling[: 1 if quick else _TRIED])
        verdicts = dict(islice(((one, told) for one, told in tried if told), _DIAGNOSED))
        _added(file, list(verdicts), "--gap")
        _noted(file, folders)
        a = asked(file, folders, analysed, verdicts)
        questions = [_judged(text, QUESTIONS[text](a)) for text in QUESTIONS]
        spoil(a)
        questions += [_judged(f"{text} (after three changes)", QUESTIONS[text](a))
                      for text in QUESTIONS if "changed" in text]  # fmt: skip
    made: Row = {
        "campaigns found": len(found), "refused": len(found) - len(folders),
        "archived": len(folders), "runs": len(a.runs),
        "recordings": sum(map(len, a.hashes.values())),
        "analysed": len(analysed), "with coefficients": len(answering), "diagnosed": len(verdicts),
    }  # fmt: skip
    measured = {
        "campaigns": float(len(folders)),
        "wrong": float(sum(int(one["wrong"]) for one in questions)),
        "silent": float(sum(one["facts"] == 0 for one in questions[:-1])),
    }
    notes = (f"{' '.join(_QUICK if quick else _MAKERS)}: pytest ended with {ended}",)
    return Outcome({"Campaigns": [made], "Questions": questions}, measured, notes)


def _made(folder: Path, tests: Sequence[str]) -> int:
    """Run tests, and leave what they make in a folder; one that fails has made something too."""
    words = ("-q", "-n", "auto", "--dist", "loadfile", "-p", "no:cacheprovider")
    command = [sys.executable, "-m", "pytest", *words, "--basetemp", str(folder), *tests]
    done = subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL, check=False)
    if done.returncode not in (0, 1):
        sys.exit(f"{' '.join(command)}: ended with {done.returncode}")
    return done.returncode


def _added(file: Path, folders: Sequence[Path], *words: str) -> list[Path]:
    """Return the folders that ``pmm archive add`` takes."""
    if not folders:
        return []
    text = _archive("add", *map(str, folders), *words, "--archive", str(file), "--json")
    return [Path(row["folder"]) for row in json.loads(text)["added"]]


def _noted(file: Path, folders: Sequence[Path]) -> None:
    from tests.pmm.archive.by_hand import runs_of

    run = next(run for folder in folders for run in runs_of(folder))
    _archive("note", run.name, "a word", "--campaign", str(run.folder), "--archive", str(file))


def _archive(*words: str) -> str:
    from click.testing import CliRunner

    from pmm.cli import cli

    return CliRunner().invoke(cli, ["archive", *words], catch_exceptions=False).stdout


def _bytes(folder: Path) -> int:
    return sum(path.stat().st_size for path in folder.iterdir() if path.is_file())


def _judged(text: str, answer: tuple[list[tuple[object, ...]], list[tuple[object, ...]]]) -> Row:
    """Return how many facts the files give, and how many the archive has not or has too many."""
    found, wanted = (sorted(map(str, one)) for one in answer)
    wrong = len(set(found) ^ set(wanted)) + abs(len(found) - len(wanted))
    return {"question": text, "facts": len(wanted), "wrong": wrong}


BENCHMARK = Benchmark("questions", "Ten questions to an archive of every test's campaign", _run)
