"""The process that reads: ``python -m analysis.foreign.child``, a request a line.

A request is JSON: the path, the function that reads it, memory in bytes and time in seconds. The
answer is a line of JSON, the columns with their units and lengths or why there are none, and behind
it the columns' numbers as they lie in memory. It ends when its parent closes the line, or dies.
"""

import faulthandler
import json
import os
import sys
from collections.abc import Mapping
from pathlib import Path
from pkgutil import resolve_name
from typing import Any, BinaryIO, Final

import numpy as np

from analysis.foreign.columns import LONGEST_ANSWER, ForeignColumns
from analysis.process_memory import limit_memory
from analysis.reading_limits import MOST_COLUMNS
from hardware.description.errors import DataError

_GRACE_S: Final = 5.0  # after the parent's own deadline: it may be dead


def main() -> None:
    """Answer requests until there are no more."""
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no answer
    for line in sys.stdin.buffer:
        request = json.loads(line)
        limit_memory(int(request["memory_bytes"]))
        # A thread of C, not of Python: it ends the process whatever that is at.
        faulthandler.dump_traceback_later(request["seconds"] + _GRACE_S, exit=True)
        _answer(request["reader"], Path(request["path"]), answers)
        faulthandler.cancel_dump_traceback_later()


def _answer(reader: str, path: Path, answers: BinaryIO) -> None:
    try:
        columns: ForeignColumns = resolve_name(reader)(path)
    except DataError as error:
        _say({"refused": str(error)}, answers)
    except MemoryError:
        _say({"memory": True}, answers)
    except Exception as error:  # a library may raise anything over a damaged file
        reason = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        _say({"refused": f"damaged: {reason[:500]}"}, answers)
    else:
        _hand_on(columns, answers)
    answers.flush()


def _hand_on(content: ForeignColumns, answers: BinaryIO) -> None:
    units, values = content.units, content.values
    columns = [[name, units.get(name, ""), len(column)] for name, column in values.items()]
    rate = {"sample_rate_hz": content.sample_rate_hz, "no_rate": content.no_rate}
    answer = {"columns": columns, **rate}
    if len(columns) > MOST_COLUMNS or len(json.dumps(answer)) >= LONGEST_ANSWER:
        _say({"refused": f"{len(columns)} columns; the limit is {MOST_COLUMNS}"}, answers)
        return
    _say(answer, answers)
    for column in values.values():
        answers.write(np.ascontiguousarray(column, np.float64).data)


def _say(answer: Mapping[str, Any], answers: BinaryIO) -> None:
    answers.write(json.dumps(answer).encode() + b"\n")


if __name__ == "__main__":
    main()
