"""Sealed loops of worlds A and C: each case made, pursued in four ways, and what was known kept.

The seed is the hash of the commit whose diagnosis is measured, as with the worlds' cases.
"""

import time
from collections import Counter
from dataclasses import asdict
from typing import Any, Final

from tests.sealed.loops import Loop, looped

Line = dict[str, Any]

WORLDS: Final = ("A", "C")
CASES: Final = 40  # of each world


def pursued(world: str, number: int, commit: str) -> Line:
    """Return what became known of a world's case of this number, from 0.

    It is the first that starts unsure of every ``CASES``-th one, from the number on.
    """
    from benchmarks.boards.judged import scratch

    began, passed, index = time.process_time(), Counter[str](), 1 + number
    while True:
        with scratch() as folder:
            found = looped(int(commit, 16), index, world, folder)
        if isinstance(found, Loop):
            break
        passed[found.partition(":")[0]] += 1
        index += CASES
    line = {"campaign": world, "seed": number, "frozen": commit, "index": index, **asdict(found)}
    return {**line, "passed": passed, "cpu_s": round(time.process_time() - began, 1)}
