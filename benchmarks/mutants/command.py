"""Draw mutations over all four packages, run the tests that cover each, list the survivors.

``make coverage`` says which tests run which line (``.coverage``). The draw is seeded: the same
sources give the same mutations, each kind as often, so that two states of the tests can be compared
on the same product. It goes on where it was broken off; a line of the results is one mutation.
"""

import argparse
import json
import os
import shutil
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.mutants.sites import Mutation, mutations
from benchmarks.mutants.trial import Covering, House

ROOT: Final = Path(__file__).parents[2]
_PACKAGES: Final = ("analysis", "sim", "pmm", "hardware")
_RESULTS: Final = ROOT / "benchmarks" / "results" / "mutants.jsonl"
_LEFT: Final = (".git", ".venv", "site", "demo", "board", ".mypy_cache", ".ruff_cache")


def drawn(root: Path, packages: Sequence[str], count: int, seed: int) -> list[tuple[str, Mutation]]:
    """Return so many mutations with their files, no two the same, each kind equally likely."""
    by_kind: dict[str, list[tuple[str, Mutation]]] = {}
    for package in packages:
        for path in sorted((root / package).rglob("*.py")):
            file = path.relative_to(root).as_posix()
            for one in mutations(path.read_text(encoding="utf-8")):
                by_kind.setdefault(one.kind, []).append((file, one))
    generator = np.random.default_rng(seed)
    found: list[tuple[str, Mutation]] = []
    while len(found) < count and any(by_kind.values()):
        kind = str(generator.choice(sorted(name for name, ones in by_kind.items() if ones)))
        ones = by_kind[kind]
        found.append(ones.pop(int(generator.integers(len(ones)))))
    return found


def covering(data: Path, root: Path, file: str) -> Covering:
    """Read the tests of a file's lines from a coverage run with a context for each test."""
    from coverage import CoverageData

    read = CoverageData(str(data))
    read.read()
    tests = read.contexts_by_lineno(str(root / file))
    return Covering(
        {line: [one.partition("|")[0] for one in names] for line, names in tests.items()}
    )


def tried(request: argparse.Namespace, root: Path, house: House) -> Iterator[dict[str, Any]]:
    """Yield the outcome of each mutation that the results do not have yet."""
    known = {one["number"] for one in _kept(request.output) if one["seed"] == request.seed}
    for number, (file, one) in enumerate(
        drawn(root, request.packages, request.count, request.seed)
    ):
        if number in known:
            continue
        tests = covering(request.coverage, root, file).of(one.line)
        yield {
            "seed": request.seed, "number": number, "file": file, "line": one.line,
            "kind": one.kind, "before": one.before, "after": one.after, "tests": len(tests),
            **house.judge(file, one, tests),
        }  # fmt: skip


def _kept(output: Path) -> list[dict[str, Any]]:
    text = output.read_text(encoding="utf-8") if output.exists() else ""
    return [json.loads(line) for line in text.splitlines()]


def main(arguments: Sequence[str]) -> int:
    """Run the command."""
    request = _parsed(arguments)
    with tempfile.TemporaryDirectory() as place:
        folder = Path(place) / "house"
        shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(*_LEFT))
        os.environ["PYTHONPATH"] = str(folder)
        house = House(folder, request.workers)
        for row in tried(request, ROOT, house):
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


def _parsed(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.mutants", description=__doc__)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=25)
    parser.add_argument("--workers", type=int, default=1, help="processes that test a mutation")
    parser.add_argument("--coverage", type=Path, default=ROOT / ".coverage")
    parser.add_argument("--output", type=Path, default=_RESULTS)
    parser.add_argument("--packages", nargs="+", default=list(_PACKAGES))
    return parser.parse_args(arguments)
