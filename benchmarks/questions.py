"""The archive's ten questions, over every campaign that the tests make.

The tests that make campaigns run in a folder of this benchmark's, and whatever they leave there
with a ``campaign.toml`` is added, those that were made to be refused too. Questions and readings by
hand are those of ``tests/pmm/archive``. Tests, analyses and verdicts are kept in a folder of the
commit's until the answers are there: who was interrupted gives the same command again.
"""

import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Final

from benchmarks.machine import ROOT, describe
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
_DIAGNOSED: Final = 3  # campaigns, those with the least bytes that have coefficients
_TRIED: Final = 20  # until so many have a verdict: some are made to be refused
_DIAGNOSING_S: Final = 240.0  # by the clock, after which none is begun
_FEWEST: Final = 3  # runs that a diagnosis needs


def _run(quick: bool, report: Report) -> Outcome:
    from tests.pmm.archive.by_hand import coefficients_of, hashes_of
    from tests.pmm.archive.questions import QUESTIONS, asked, spoil

    paths = _QUICK if quick else _MAKERS
    commit = describe()["commit"].replace(" ", "-")
    name = f"pmm-questions-{ROOT.name}-{commit}-{'quick' if quick else 'full'}"
    place = Path(tempfile.gettempdir()).resolve() / name
    ended = _made(place, paths, report)
    found = sorted(path.parent for path in (place / "tests").rglob("campaign.toml"))
    file = place / "archive.sqlite"
    report(f"adding {len(found)} campaigns")
    left = found[::_LEFT]
    told = _added(file, sorted({*found} - {*left}), "--analyse", "--jobs", "2")
    folders = _added(file, left) + told
    analysed = [one for one in folders if one not in left]
    report(f"reading {len(analysed)} of them by hand")
    answering = [one for one in sorted(analysed, key=_bytes) if coefficients_of(one)]
    telling = [one for one in answering if len(hashes_of(one)) >= _FEWEST]
    verdicts = dict(_verdicts(place / "verdicts.json", telling[: 1 if quick else _TRIED], report))
    _added(file, list(verdicts), "--gap", "--jobs", "2")
    _noted(file, folders)
    a = asked(file, folders, analysed, verdicts)
    questions = []
    for text in QUESTIONS:
        report(text)
        questions.append(_judged(text, QUESTIONS[text](a)))
    (place / "ended").unlink()
    spoil(a)
    questions += [_judged(f"{text} (after three changes)", QUESTIONS[text](a))
                  for text in QUESTIONS if "changed" in text]  # fmt: skip
    shutil.rmtree(place, ignore_errors=True)
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
    notes = (f"{' '.join(paths)}, those that `make test` runs: {ended}",)
    return Outcome({"Campaigns": [made], "Questions": questions}, measured, notes)


def _made(place: Path, tests: Sequence[str], report: Report) -> str:
    """Run tests, and leave what they make in a folder; one that fails has made something too."""
    mark = place / "ended"
    if not mark.exists():
        shutil.rmtree(place, ignore_errors=True)
        place.mkdir(exist_ok=True)
        report(f"running the tests of {' '.join(tests)} into {place}")
        words = ("-q", "-n", "auto", "--dist", "loadfile", "-p", "no:cacheprovider")
        command = [sys.executable, "-m", "pytest", *words, f"--basetemp={place / 'tests'}", *tests]
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True, check=False)
        if done.returncode not in (0, 1):
            sys.exit(f"{' '.join(command)}: ended with {done.returncode}")
        mark.write_text(done.stdout.splitlines()[-1].strip("= "), encoding="utf-8")
    return mark.read_text(encoding="utf-8")


def _verdicts(kept: Path, folders: Sequence[Path], report: Report) -> Iterator[tuple[Path, str]]:
    """Yield folders with the verdict of each that has one, until there are enough."""
    from tests.pmm.archive.by_hand import verdict_of

    known = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    began, count = time.monotonic(), 0
    for folder in folders:
        if count == _DIAGNOSED:
            return
        if str(folder) not in known:
            if time.monotonic() - began > _DIAGNOSING_S:
                continue
            report(f"diagnosing {folder}")
            known[str(folder)] = verdict_of(folder)
            kept.write_text(json.dumps(known), encoding="utf-8")
        if known[str(folder)]:
            count += 1
            yield folder, known[str(folder)]


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
