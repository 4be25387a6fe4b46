"""Rows that learn, on a world's first cases: boosted ones, and the diagnosis calibrated by others.

They answer what :mod:`benchmarks.boards.seen` has kept of the cases. The diagnosis that made the
hypotheses is marked too: where it has the marks of :mod:`benchmarks.boards.worlds`, it is the same.
"""

import json
import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path
from typing import Any, Final

from analysis.gap.inference.constants import ODDS
from benchmarks.boards.beside import marks_by_row
from benchmarks.boards.row_figures import row_means
from pmm.gap.answer import SCHEMA as ANSWER_SCHEMA
from tests.sealed.answering import DIAGNOSIS, Asked
from tests.sealed.learning.boosted import classifier
from tests.sealed.learning.calibration import Conformal, Isotonic
from tests.sealed.learning.campaigns import LOOKS
from tests.sealed.learning.rows import with_shares
from tests.sealed.scoring.answers import NONE, VERDICTS, Answer
from tests.sealed.scoring.by_world import Figure, Marks, figures_of
from tests.sealed.scoring.keys import Truth, read_truth
from tests.sealed.scoring.rows import BINS

Line = dict[str, Any]

_BOOSTED: Final = tuple(f"boosted-{look}" for look in LOOKS)
CALIBRATED: Final = (f"{DIAGNOSIS}-isotonic", f"{DIAGNOSIS}-conformal")
"""Rows that change probabilities alone: stages and forecasts are the diagnosis's."""
ROWS: Final = (DIAGNOSIS, *_BOOSTED, *CALIBRATED)


def answered(seen: Line, training: Path) -> Line:
    """Have a case answered by the rows that learn, and return the marks.

    Parameters
    ----------
    seen
        A line of :mod:`benchmarks.boards.seen`.
    training
        Campaigns that ``python -m tests.sealed.learning keep`` has written.

    Raises
    ------
    DataError
        If scikit-learn is not installed or there are too few campaigns.
    """
    from benchmarks.boards.judged import scratch

    began = time.process_time()
    with scratch() as folder:
        truth = read_truth(_written(seen["key"], folder / "truth.json"))
        for row, found in _answers(seen, training):
            _written(found, Asked(folder, truth.case, (row,)).target(row))
        rows = dict(marks_by_row(folder, truth, ROWS))
    line = {key: seen[key] for key in ("campaign", "seed", "frozen")} | {"rows": rows}
    line |= {"counts": BINS[-1].holds(truth), "verdict": truth.verdict}
    line["trained_on"] = max(classifier(training, look).trained_on for look in LOOKS)
    return {**line, "cpu_s": round(time.process_time() - began, 2)}


def _answers(seen: Line, training: Path) -> Iterator[tuple[str, Line]]:
    """Yield every row's answer, the diagnosis's own first."""
    said, foretold = seen["diagnosis"], seen["foretold"]
    yield DIAGNOSIS, said
    for row, look in zip(_BOOSTED, LOOKS, strict=True):
        model = classifier(training, look)
        yield row, model.answer_to(said["case"], seen["features"][look], foretold)
    for row, fit in _calibrators().items():
        yield row, with_shares(said, fit)


def _written(table: Line, file: Path) -> Path:
    file.parent.mkdir(exist_ok=True)
    file.write_text(json.dumps(table))
    return file


@cache
def _calibrators() -> dict[str, Isotonic | Conformal]:
    """Return a calibration by row, fitted to the cases that the prior odds were fitted to."""
    from benchmarks.boards.rows import kept
    from benchmarks.boards.weighings import reweighed

    lines = [line for line in kept("weighings") if line["is_clear"]]
    shares = [reweighed(line, asdict(ODDS)) for line in lines]
    return dict(zip(CALIBRATED, calibrations(lines, shares), strict=True))


def calibrations(
    lines: Sequence[Line], shares: Sequence[dict[str, float]]
) -> tuple[Isotonic, Conformal]:
    """Return both calibrations of some cases' answers.

    Parameters
    ----------
    lines
        As :mod:`benchmarks.boards.weighings` keeps them; which of the answers are right.
    shares
        Of each case, how probable each answer is.
    """
    pairs = [
        (Answer(ANSWER_SCHEMA, "", said, {}), _truth(line))
        for line, said in zip(lines, shares, strict=True)
    ]
    return Isotonic.of(pairs), Conformal.of(pairs)


def _truth(line: Line) -> Truth:
    """Return a key that calls right what a line does; of a gap that no answer names, nothing."""
    named = tuple(tuple(name.split("+")) for name in line["right"] if name not in VERDICTS)
    verdict = line["verdict"]
    right = named or ((("",),) if verdict == "gap" else ())
    return Truth("", verdict, verdict == NONE, verdict, math.inf, right, (), {}, {})


def figures_by_row(lines: Sequence[Line]) -> Iterator[tuple[str, dict[str, Figure], float]]:
    """Yield each row's name, its figures as of a world's diagnosis, and its mean of columns."""
    means = row_means([line for line in lines if line["counts"]])
    for name in ROWS if lines else ():
        marks = [
            Marks(one["is_clear"], one["values"], one["stated"])
            for one in (line["rows"][name] for line in lines)
        ]
        yield name, figures_of({DIAGNOSIS: marks}), means[name]
