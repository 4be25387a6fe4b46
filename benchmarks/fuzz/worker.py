"""One process that reads mutated inputs of one reader, and says how far it is."""

import json
import re
import signal
import sys
import tempfile
import time
import traceback
import warnings
from pathlib import Path
from typing import Any, Final

import numpy as np

from benchmarks.fuzz.board import PROMISES
from benchmarks.fuzz.mutate import mutate
from benchmarks.fuzz.promises import REFUSED, SilentNanError
from benchmarks.fuzz.targets import TARGETS, Read, opened
from benchmarks.peak import peak_bytes

LONGEST_S: Final = 5.0
_MOST_BYTES: Final = 1e9
_MEMORY_DISK: Final = Path("/dev/shm")  # noqa: S108 - in a folder of its own
_NOVEL: Final = 300  # inputs whose outcome was new are mutated further, the latest so many
_VARIED: Final = re.compile(r"[\d.]+|'[^']*'|\"[^\"]*\"|/\S+")
_UNCAUGHT, _HANG, _MEMORY, _NAN = PROMISES


class _HangError(BaseException):
    """An input took too long; no reader catches this."""


def _late(*_: object) -> None:
    raise _HangError


def work(name: str, first: int, end: int, last: Path) -> None:
    """Read the inputs from one number to another; say a line of JSON of each.

    Parameters
    ----------
    last
        Holds the input that is being read, should this process not outlive it.
    """
    target = next(one for one in TARGETS if one.name == name)
    signal.signal(signal.SIGALRM, _late)
    warnings.simplefilter("ignore")
    memory = str(_MEMORY_DISK) if _MEMORY_DISK.is_dir() else None  # no disk is waited for
    with (
        tempfile.TemporaryDirectory(prefix="fuzz-", dir=memory) as folder,
        opened(target, Path(folder)) as (seeds, read),
    ):
        for one in seeds:
            _outcome(read, one)  # what is loaded at first takes its time, and is no input's
        pool, known = list(seeds), set[str]()
        for number in range(first, end):
            generator = np.random.default_rng([number, *name.encode()])
            # Half of them from good inputs: what was refused once is mostly refused again.
            known_good = seeds if generator.random() < 0.5 else pool
            good, other = (one[int(generator.integers(len(one)))] for one in (known_good, pool))
            data = mutate(good, other, generator)
            last.write_bytes(data)
            told, kind = _told(read, data)
            if kind not in known:
                known.add(kind)
                pool[len(seeds) :] = [*pool[len(seeds) :], data][-_NOVEL:]
            _say(kinds=len(known), **told)
            if told.get("broken") == _MEMORY:
                return  # what a process once took it has taken: the next one goes on


def _told(read: Read, data: bytes) -> tuple[dict[str, Any], str]:
    """Read an input, and once more where it took too long: another program may have been at it."""
    started = time.monotonic()
    told, kind = _outcome(read, data)
    if told.get("broken") == _HANG:
        started = time.monotonic()
        told, kind = _outcome(read, data)
    peak = peak_bytes()
    if peak > _MOST_BYTES and not told.get("broken"):
        told = {"broken": _MEMORY, "said": f"{peak / 1e9:.2f} GB"}
    return {**told, "took_s": time.monotonic() - started}, kind


def _outcome(read: Read, data: bytes) -> tuple[dict[str, Any], str]:
    signal.setitimer(signal.ITIMER_REAL, LONGEST_S)
    try:
        kind = f"taken {read(data)}"
    except REFUSED as error:
        return {"refused": 1}, f"{type(error).__name__} {_VARIED.sub('#', str(error))[:80]}"
    except SilentNanError as error:
        return {"broken": _NAN, "said": str(error)}, "nan"
    except _HangError:
        return {"broken": _HANG, "said": traceback.format_exc()}, "hang"
    except Exception as error:
        said = traceback.format_exc()
        return {"broken": _UNCAUGHT, "said": said}, f"uncaught {type(error).__name__}"
    else:
        return {"taken": 1}, kind
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _say(**values: Any) -> None:
    _OUTPUT.write(json.dumps(values) + "\n")
    _OUTPUT.flush()


_OUTPUT: Final = sys.stdout

if __name__ == "__main__":
    work(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), Path(sys.argv[4]))
