"""One mutation, made in a copy of the sources, and the tests that cover it."""

import re
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from benchmarks.mutants.sites import Mutation

_FAILED: Final = re.compile(r"^(?:FAILED|ERROR) (\S+::.+?|\S+\.py)(?: - .*)?$", re.MULTILINE)
_NO_TEST_RAN: Final = 5  # pytest's exit status
_PATIENCE_S: Final = 1800.0


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
    """A copy of the sources, to be mutated, and what fails in it anyway."""

    folder: Path
    workers: int = 1
    sound: dict[str, bool] = field(default_factory=dict)

    def judge(self, file: str, mutation: Mutation, tests: Sequence[str]) -> dict[str, str]:
        """Return the outcome: ``survived``, ``untested``, or ``killed`` with the test it was by.

        A test that fails without the mutation too is left out, and the others are asked again.
        """
        asked = list(tests)
        while asked:
            with self._mutated(file, mutation):
                failed = self._failed(asked)
            if failed is None:
                return {"outcome": "survived"}
            broken = [one for one in failed if not self._is_sound(one)]
            if len(broken) < len(failed) or not failed:
                return {"outcome": "killed", "by": next(iter({*failed} - {*broken}), "no end")}
            asked = [one for one in asked if one not in broken]
        return {"outcome": "untested"}

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
            self.sound[test] = self._failed([test]) is None
        return self.sound[test]

    def _failed(self, tests: Sequence[str]) -> list[str] | None:
        """Return the first tests that fail; ``None`` where none does, empty for no end."""
        listed = self.folder / "asked.txt"
        listed.write_text("\n".join(tests), encoding="utf-8")
        options = ["-x", "-q", "-p", "no:cacheprovider", "-n", str(self.workers)]
        if self.workers == 1:
            options = options[:-2]
        try:
            done = subprocess.run(
                [sys.executable, "-B", "-m", "pytest", *options, f"@{listed}"],
                cwd=self.folder, capture_output=True, text=True, check=False,
                timeout=_PATIENCE_S,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return []
        if done.returncode in (0, _NO_TEST_RAN):
            return None
        return _FAILED.findall(done.stdout) or ["collection"]
