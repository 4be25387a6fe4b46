"""Compiled loops, where numba is there; the same numbers by NumPy, where it is not.

Only loops that carry something from sample to sample need this; everything else is NumPy on whole
blocks. numba comes with the extra ``fast``; it is loaded when the first such loop runs.
"""

from collections.abc import Callable
from functools import cache
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np

from hardware.description.arrays import FloatArray

FunctionT = TypeVar("FunctionT", bound=Callable[..., Any])


@cache
def available() -> bool:
    """Tell whether numba is installed."""
    return find_spec("numba") is not None


def compile_loop(function: FunctionT) -> FunctionT:
    """Return the function compiled by numba, or as it is without numba: the same to rounding."""
    if not available():
        return function
    import numba

    # Sums may be taken in another order; nothing is assumed about infinities and NaN.
    any_order = {"reassoc", "contract", "nsz"}
    config: Any = numba.config
    before = config.CACHE_DIR
    config.CACHE_DIR = str(cache_folder(before))
    try:
        compiled = numba.njit(cache=True, nogil=True, fastmath=any_order)(function)
    finally:
        config.CACHE_DIR = before
    return cast("FunctionT", compiled)


def callable_when_compiled(*functions: Callable[..., Any], by: Any = None) -> None:
    """Let compiled loops call functions that stay as they are for arrays.

    Parameters
    ----------
    by
        What stands for them in compiled loops; by default they themselves.
    """
    if not available():
        return
    from numba.extending import overload

    for function in functions:
        overload(function, strict=False)(lambda *_, stand_in=by or function: stand_in)


@cache
def cache_folder(chosen: str) -> Path:
    """Return where the compiled loops are kept: another folder for every change of their sources.

    numba looks at the file of a function only, not at those of the functions that it calls.

    Parameters
    ----------
    chosen
        The folder that the user has chosen for numba; empty for beside the sources.
    """
    folder = Path(__file__).parents[1]
    contents = sha256()
    for source in sorted(folder.rglob("*.py")):
        text = source.read_bytes()
        if b"compile_loop" in text:
            contents.update(text)
    return (Path(chosen) if chosen else folder / "__pycache__") / f"sim-{contents.hexdigest()[:16]}"


def follow(step: FloatArray, forcing: FloatArray, state: FloatArray) -> FloatArray:
    """Return the states ``x_k = step x_(k-1) + forcing_k``.

    The result has the shape ``(samples, n)``.

    Parameters
    ----------
    step
        Shape ``(n, n)``.
    forcing
        Shape ``(samples, n)``.
    state
        The state before the first sample, shape ``(n,)``.
    """
    states = np.empty((len(forcing) + 1, len(state)))
    states[0] = state
    loop = _compiled_follow() if available() else follow_interpreted
    loop(np.ascontiguousarray(step), np.ascontiguousarray(forcing), states)
    return states[1:]


@cache
def _compiled_follow() -> Callable[[FloatArray, FloatArray, FloatArray], None]:
    return compile_loop(follow_loop)


def follow_interpreted(step: FloatArray, forcing: FloatArray, states: FloatArray) -> None:
    """Fill rows 1 on of ``states`` from row 0 without numba: one matrix product a sample."""
    for k, driven in enumerate(forcing):
        np.dot(step, states[k], states[k + 1])
        states[k + 1] += driven


def follow_loop(step: FloatArray, forcing: FloatArray, states: FloatArray) -> None:
    """Fill rows 1 on of ``states`` from row 0: what numba compiles; the same to rounding."""
    size = states.shape[1]
    for k in range(forcing.shape[0]):
        for i in range(size):
            total = forcing[k, i]
            for j in range(size):
                total += step[i, j] * states[k, j]
            states[k + 1, i] = total
