"""Fuzz every reader: ``python -m benchmarks.fuzz [--share 0.1] [--folder FOLDER] [--only NAME]``.

Goes on where it was left. One worker, a process of its own; one that dies is counted and replaced.
The whole board is kept as ``benchmarks/results/fuzz.json``; exit status 1 where a promise is
broken, and the inputs that did it are in the folder.
"""

import argparse
import json
import selectors
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import IO, Any, Final

from benchmarks.fuzz.board import (
    PROMISES,
    Count,
    document,
    keep_broken,
    keep_counts,
    read_counts,
)
from benchmarks.fuzz.targets import TARGETS, Target
from benchmarks.machine import ROOT, describe

_BATCH: Final = 2_000  # inputs of one process
_SILENT_S: Final = 120.0  # then a worker hangs where no alarm reaches it: twice 5 s, and loading
_RESULT: Final = ROOT / "benchmarks" / "results" / "fuzz.json"
_UNCAUGHT, _HANG, _, _ = PROMISES


def main(arguments: Sequence[str]) -> int:
    """Read what is left of the board; return 1 where a promise was broken."""
    request = _parse(arguments)
    request.folder.mkdir(parents=True, exist_ok=True)
    counts = read_counts(request.folder)
    for target in TARGETS:
        if not request.only or target.name in request.only:
            count = counts.setdefault(target.name, Count())
            wanted = round(target.inputs * request.share)
            while count.done < wanted:
                _batch(target, count, min(wanted, count.done + _BATCH), request.folder)
                keep_counts(request.folder, counts)
            _print(target.name, count)
    found = document(counts, describe())
    print(json.dumps(found["broken"]), found["inputs"], "inputs")
    if not request.only and request.share == 1.0:
        _RESULT.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    return int(any(found["broken"].values()))


def _batch(target: Target, count: Count, end: int, folder: Path) -> None:
    """Have a worker read inputs up to a number, or until it dies."""
    last = folder.resolve() / "last"
    words = ["-m", "benchmarks.fuzz.worker", target.name, str(count.done), str(end), str(last)]
    errors = (folder / "errors.txt").open("w+b")
    process = subprocess.Popen(
        [sys.executable, *words], cwd=ROOT, stdout=subprocess.PIPE, stderr=errors
    )
    with errors, process:
        stopped = process.stdout is None
        for line in _lines(process.stdout) if process.stdout is not None else ():
            _take(target, count, json.loads(line), last, folder)
            stopped = bool(json.loads(line).get("broken"))
        hung = process.poll() is None and count.done < end and not stopped
        if process.poll() is None:
            try:
                process.wait(timeout=10.0)
            except subprocess.TimeoutExpired:
                process.kill()
        process.wait()
        if count.done < end and not stopped:
            errors.seek(0)
            said = f"ended with {process.returncode}\n{errors.read().decode(errors='replace')}"
            told = {"broken": _HANG if hung else _UNCAUGHT, "said": said}
            _take(target, count, told, last, folder)


def _lines(stream: IO[bytes]) -> Iterator[bytes]:
    """Yield lines until the stream ends or is silent for too long."""
    with selectors.DefaultSelector() as selector:
        selector.register(stream, selectors.EVENT_READ)
        while selector.select(_SILENT_S):
            line = stream.readline()
            if not line:
                return
            yield line


def _take(target: Target, count: Count, told: dict[str, Any], last: Path, folder: Path) -> None:
    if broken := told.get("broken"):
        count.broken[broken] = count.broken.get(broken, 0) + 1
        data = last.read_bytes() if last.exists() else b""
        path = keep_broken(folder, target.name, count.done, data, told.get("said", ""))
        print(f"{target.name} {count.done}: {broken}: {path}")
    count.done += 1
    count.taken += told.get("taken", 0)
    count.refused += told.get("refused", 0)
    count.slowest_s = max(count.slowest_s, told.get("took_s", 0.0))
    count.kinds = max(count.kinds, told.get("kinds", 0))


def _print(name: str, count: Count) -> None:
    broken = ", ".join(f"{value} {key}" for key, value in count.broken.items()) or "none broken"
    print(
        f"{name:20} {count.done:7} inputs, {count.taken} taken, {count.refused} refused, "
        f"slowest {count.slowest_s:.2f} s, {count.kinds} kinds: {broken}",
        flush=True,
    )


def _parse(arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.fuzz", description=__doc__)
    parser.add_argument("--share", type=float, default=1.0, help="part of the board")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "fuzz")
    parser.add_argument("--only", action="append", help="a reader; repeatable")
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
