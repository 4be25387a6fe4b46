"""One mutation, made in a copy of the sources, and the tests that cover it."""

import os
import re
import resource
import subprocess
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from benchmarks.mutants.sites import Mutation

_FAILED: Final = re.compile(r"^(?:FAILED|ERROR) (\S+::.+?|\S+\.py)(?: - .*)?$", re.MULTILINE)
_NO_TEST_RAN: Final = 5  # pytest's exit status
_STUCK: Final = 60.0  # of patience, by the clock: tests wait for ever

Outcome = dict[str, str | int]


@dataclass(frozen=True)
class Covering:
    """The tests that run each line: those of a file's lines, by context of a coverage run."""

    by_line: Mapping[int, Sequence[str]]

    def of(self, line: int) -> list[str]:
        """Return the tests of a line; of what runs at import, those of the file."""
        found = {*self.by_line.get(line, ())} - {""}
        if not found and line in self.by_line:
            found = {one for tests in self.by_line.values() for one in tests} - {""}
        return sorted(found)


@dataclass
class House:
    """A copy of the sources, to be mutated, and what fails in it anyway.

    Attributes
    ----------
    patience_s
        How long the tests of one mutation may take, in seconds of a processor: how busy the machine
        is decides nothing.
    """

    folder: Path
    workers: int = 1
    patience_s: float = 1800.0
    sound: dict[str, bool] = field(default_factory=dict)

    def judge(self, file: str, mutation: Mutation, rings: Iterable[Sequence[str]]) -> Outcome:
        """Return the outcome: ``killed`` with the test it was by, or else how many tests passed.

        Rings of tests are asked one after the other. A test that fails without the mutation too is
        left out, and the others of its ring are asked again. ``survived`` where all passed,
        ``unfinished`` where patience ended before, ``untested`` where there was none to ask.
        """
        end, passed = _spent_s() + self.patience_s, 0
        for ring in rings:
            broken: set[str] = set()
            while left := [one for one in ring if one not in broken]:
                with self._mutated(file, mutation):
                    failed = self._failed(left, end - _spent_s(), broken)
                if failed is None:
                    return {"outcome": "unfinished", "tests": passed}
                if by := next((one for one in failed if self._is_sound(one)), ""):
                    return {"outcome": "killed", "by": by, "tests": passed + len(left)}
                broken.update(failed)
                if not failed:
                    passed += len(left)
                    break
        return {"outcome": "survived" if passed else "untested", "tests": passed}

    @contextmanager
    def _mutated(self, file: str, mutation: Mutation) -> Iterator[None]:
        path = self.folder / file
        source = path.read_text(encoding="utf-8")
        path.write_text(mutation.applied(source), encoding="utf-8")
        try:
            yield
        finally:
            path.write_text(source, encoding="utf-8")

    def _is_sound(self, test: str) -> bool:
        if test not in self.sound:
            self.sound[test] = self._failed([test], self.patience_s) == []
        return self.sound[test]

    def _failed(
        self, tests: Sequence[str], patience_s: float, left_out: Iterable[str] = ()
    ) -> list[str] | None:
        """Return the first tests that fail; ``None`` where patience ended before."""
        listed = self.folder / "asked.txt"
        listed.write_text("\n".join(tests), encoding="utf-8")
        options = ["-x", "-q", "-m", "", "-p", "no:cacheprovider", "--timeout", "0"]
        options += [f"--deselect={one}" for one in left_out]
        if self.workers > 1:
            options += ["-n", str(self.workers)]
        end_s = max(1, round(patience_s))
        try:
            done = subprocess.run(
                [sys.executable, "-B", "-m", "pytest", *options, f"@{listed}"],
                cwd=self.folder, env={**os.environ, "PYTHONPATH": str(self.folder)},
                capture_output=True, text=True, check=False, timeout=_STUCK * self.patience_s,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (end_s, end_s)),
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return None
        if done.returncode < 0:
            return None
        if done.returncode in (0, _NO_TEST_RAN):
            return []
        failed = _FAILED.findall(done.stdout)
        if not failed:
            raise RuntimeError(
                f"pytest says of no test that it failed:\n{done.stdout}{done.stderr}"
            )
        return failed


def _spent_s() -> float:
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime
