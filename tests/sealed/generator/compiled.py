"""The one place where numba is named, and where its compiled code is kept.

numba looks only at a function's own file when it decides whether kept code still holds, not at the
files of what it calls. So the code is kept under a digest of all compiled files.

Each function is compiled as two programs from the same text. ``WIDE`` is a constant in both: in the
plain one, false, in the wide one, true. What stands behind it costs the plain program nothing, not
even the last bit of a number, which the compiler's sums of products would else decide anew.
"""

import hashlib
from collections.abc import Callable
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar, cast

import numba

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

WIDE = False

_HERE = Path(__file__).parent
_COMPILED = (
    "compiled",
    "places",
    "parameters",
    "loads",
    "mechanics",
    "rigid",
    "finite",
    "rates",
    "rubbing",
    "integrate",
    "gauges",
)


def _kept() -> str:
    digest = hashlib.sha256()
    for name in _COMPILED:
        digest.update((_HERE / f"{name}.py").read_bytes())
    return str(_HERE / "__pycache__" / f"compiled-{digest.hexdigest()[:12]}")


_KEPT = _kept()
_TWINS: dict[int, Any] = {}


def compiled(function: FunctionT) -> FunctionT:
    """Return the function compiled, its code kept for the next process, its type as it was."""
    made = _compiled(function, _KEPT)
    names = {name: _TWINS.get(id(it), it) for name, it in function.__globals__.items()}
    twin = FunctionType(function.__code__, {**names, "WIDE": True}, function.__name__)
    _TWINS[id(made)] = _compiled(twin, f"{_KEPT}-wide")
    return cast("FunctionT", made)


def wide(function: FunctionT) -> FunctionT:
    """Return a compiled function's other program."""
    return cast("FunctionT", _TWINS[id(function)])


def _compiled(function: Callable[..., Any], kept: str) -> Any:
    settings: Any = numba.config
    before = settings.CACHE_DIR
    settings.CACHE_DIR = kept
    try:
        return numba.njit(
            forceinline=function.__name__ != "integrate",
            cache=True,
            nogil=True,
            error_model="numpy",
            boundscheck=False,
            fastmath={"contract", "arcp", "nsz"},
        )(function)
    finally:
        settings.CACHE_DIR = before
