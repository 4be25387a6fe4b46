"""What rows that learn see of a world's first cases, kept so that they can be fitted anew.

A case is made anew from the seed of the worlds' lines and diagnosed once; its features, the
diagnosis's answer and the key stay of it.
"""

import json
import time
from typing import Any

from benchmarks.boards.worlds import made

Line = dict[str, Any]


def seen(world: str, index: int, commit: str, size: int) -> Line:
    """Make and diagnose a case, and return what rows that learn need of it.

    Parameters
    ----------
    index, commit, size
        As in :func:`benchmarks.boards.beside.compared`.
    """
    from benchmarks.boards.judged import scratch
    from pmm.cli.gap.answer import answer_to, diagnosis_of
    from tests.sealed.learning.seen import as_table, seen_of
    from tests.sealed.learning.training import features_of
    from tests.sealed.learning.weighed import numbers_of
    from tests.sealed.peers.scene import scene

    began = time.process_time()
    with scratch() as folder:
        name = made(world, index, commit, size, folder)
        case = folder / "cases" / name
        prepared, diagnosis = diagnosis_of(case)
        hypotheses = numbers_of(diagnosis.weighed)
        looks = {"components": as_table(seen_of(case)), "hypotheses": hypotheses}
        line = {"campaign": world, "seed": index, "frozen": commit, "features": features_of(looks)}
        line["diagnosis"] = answer_to(name, prepared, diagnosis)
        line["foretold"] = scene(case).foretold()
        line["key"] = json.loads((folder / "keys" / name / "truth.json").read_text())
    return {**line, "cpu_s": round(time.process_time() - began, 2)}
