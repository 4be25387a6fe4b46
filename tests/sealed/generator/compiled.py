"""The one place where numba is named, and where its compiled code is kept.

numba looks only at a function's own file when it decides whether kept code still holds, not at the
files of what it calls. So the code is kept under a digest of all compiled files.
"""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])

_HERE = Path(__file__).parent
_COMPILED = (
    "compiled",
    "places",
    "parameters",
    "loads",
    "mechanics",
    "attitude",
    "holding",
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


def compiled(function: FunctionT) -> FunctionT:
    """Return the function compiled, its code kept for the next process, its type as it was."""
    settings: Any = numba.config
    before = settings.CACHE_DIR
    settings.CACHE_DIR = _KEPT
    try:
        made = numba.njit(
            forceinline=function.__name__ != "integrate",
            cache=True,
            nogil=True,
            error_model="numpy",
            boundscheck=False,
            fastmath={"contract", "arcp", "nsz"},
        )(function)
        return cast("FunctionT", made)
    finally:
        settings.CACHE_DIR = before
