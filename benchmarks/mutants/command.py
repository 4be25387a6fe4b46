"""Draw mutations over all four packages, run the tests that cover each, list the survivors.

``make coverage`` says which tests run which line (``.coverage``). Where it names none, as of what
is compiled, or there was no such run, a mutation is tried on the test files that import its module,
then on those that import it through another, as far as patience goes. The draw is seeded: the same
sources give the same mutations, each kind as often.
``--before`` takes a checkout of an earlier state: then only mutations are drawn that stand once in
both, and what survives now is tried there too. It goes on where it was broken off, also on later
sources; a line of the results is one mutation.
"""

import argparse
import json
import shutil
import tempfile
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.machine import commit, describe
from benchmarks.mutants.nearest import rings
from benchmarks.mutants.sites import Mutation, mutations
from benchmarks.mutants.trial import Covering, House, Outcome

ROOT: Final = Path(__file__).parents[2]
_PACKAGES: Final = ("analysis", "sim", "pmm", "hardware")
_RESULTS: Final = ROOT / "benchmarks" / "results" / "mutants.jsonl"
_LEFT: Final = (".git", ".venv", "site", "demo", "board", ".mypy_cache", ".ruff_cache")


def drawn(
    root: Path, packages: Sequence[str], count: int, seed: int, before: Path | None = None
) -> list[tuple[str, Mutation]]:
    """Return so many mutations with their files, no two the same, each kind equally likely."""
    ones = _all(root, packages)
    if before:
        there = {one.told for _, one in _single(_all(before, packages))}
        ones = [(file, one) for file, one in _single(ones) if one.told in there]
    by_kind: dict[str, list[tuple[str, Mutation]]] = {}
    for file, one in ones:
        by_kind.setdefault(one.kind, []).append((file, one))
    generator = np.random.default_rng(seed)
    found: list[tuple[str, Mutation]] = []
    while len(found) < count and any(by_kind.values()):
        kind = str(generator.choice(sorted(name for name, left in by_kind.items() if left)))
        left = by_kind[kind]
        found.append(left.pop(int(generator.integers(len(left)))))
    return found


def _all(root: Path, packages: Sequence[str]) -> list[tuple[str, Mutation]]:
    return [
        (path.relative_to(root).as_posix(), one)
        for package in packages
        for path in sorted((root / package).rglob("*.py"))
        for one in mutations(path.read_text(encoding="utf-8"))
    ]


def _single(ones: Sequence[tuple[str, Mutation]]) -> list[tuple[str, Mutation]]:
    counted = Counter(one.told for _, one in ones)
    return [(file, one) for file, one in ones if counted[one.told] == 1]


@dataclass(frozen=True)
class State:
    """A checkout whose tests are asked.

    Attributes
    ----------
    house
        Its copy, in which mutations are made.
    """

    root: Path
    packages: Sequence[str]
    coverage: Path
    house: House

    def judge(self, file: str, one: Mutation) -> Outcome:
        """Return what becomes of a mutation."""
        covered: list[str] = []
        if self.coverage.exists():
            covered = covering(self.coverage, self.root, file).of(one.line)
        tests = [covered] if covered else rings(self.root, self.packages, file)
        return self.house.judge(file, one, tests)

    def again(self, mutation: Mutation) -> Outcome:
        """Return what becomes here of a mutation of another state."""
        ones = _all(self.root, self.packages)
        return self.judge(*next(place for place in ones if place[1].told == mutation.told))


def covering(data: Path, root: Path, file: str) -> Covering:
    """Read the tests of a file's lines from a coverage run with a context for each test."""
    from coverage import CoverageData

    read = CoverageData(str(data))
    read.read()
    tests = read.contexts_by_lineno(str(root / file))
    return Covering(
        {line: [name.rpartition("|")[0] for name in names] for line, names in tests.items()}
    )


def tried(
    request: argparse.Namespace, now: State, before: State | None
) -> Iterator[dict[str, Any]]:
    """Yield the outcome of each mutation that the results do not have yet."""
    known = {_told(row) for row in _kept(request.output)}
    ones = drawn(now.root, request.packages, request.count, request.seed, request.before)
    for number, (file, one) in enumerate(ones):
        if _told(vars(one)) in known:
            continue
        row = {
            "seed": request.seed, "number": number, "file": file, "line": one.line,
            "kind": one.kind, "text": one.text, "before": one.before, "after": one.after,
            **now.judge(file, one), "commit": commit(), "cpu": describe()["cpu"],
        }  # fmt: skip
        if before and row["outcome"] != "killed":
            row["earlier"] = before.again(one)
        yield row


def _told(row: Mapping[str, Any]) -> tuple[str, ...]:
    return tuple(row[key] for key in ("kind", "text", "before", "after"))


def _kept(output: Path) -> list[dict[str, Any]]:
    text = output.read_text(encoding="utf-8") if output.exists() else ""
    return [json.loads(line) for line in text.splitlines()]


def main(arguments: Sequence[str]) -> int:
    """Run the command."""
    request = _parsed(arguments)
    with tempfile.TemporaryDirectory() as place:
        now = _state(request, ROOT, request.coverage, Path(place) / "house")
        before = None
        if request.before:
            data = request.before / ".coverage"
            before = _state(request, request.before, data, Path(place) / "earlier")
        for row in tried(request, now, before):
            with request.output.open("a", encoding="utf-8") as file:
                file.write(json.dumps(row) + "\n")
            where = f"{row['file']}:{row['line']}"
            print(f"{row['number'] + 1} of {request.count}: {where} {row['outcome']}", flush=True)
    rows = [one for one in _kept(request.output) if one["seed"] == request.seed]
    for row in rows:
        if row["outcome"] != "killed":
            print(
                f"{row['outcome']}: {row['file']}:{row['line']} {row['kind']}: "
                f"{row['before']} -> {row['after']} ({row['tests']} tests)"
            )
    print(dict(Counter(row["outcome"] for row in rows)))
    return 0


def _state(request: argparse.Namespace, root: Path, coverage: Path, folder: Path) -> State:
    shutil.copytree(root, folder, ignore=shutil.ignore_patterns(*_LEFT))
    house = House(folder, request.workers, request.patience)
    return State(root, request.packages, coverage, house)


def _parsed(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutants", description=__doc__)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=25)
    parser.add_argument("--workers", type=int, default=1, help="processes that test a mutation")
    parser.add_argument("--patience", type=float, default=1800.0, help="seconds for a mutation")
    parser.add_argument("--before", type=Path, help="a checkout of an earlier state")
    parser.add_argument("--coverage", type=Path, default=ROOT / ".coverage")
    parser.add_argument("--output", type=Path, default=_RESULTS)
    parser.add_argument("--packages", nargs="+", default=list(_PACKAGES))
    return parser.parse_args(arguments)
