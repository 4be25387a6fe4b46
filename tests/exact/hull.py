"""Water loads as a polynomial in the motion in body axes, named as tables name them."""

import re
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

Motion = Mapping[str, NDArray[np.float64]]
"""``u``, ``v``, ``r`` (``w``, ``q``) and ``udot``, ``vdot``, ``rdot`` (``wdot``, ``qdot``);
against the tank ``psi`` and ``y`` (``theta``, ``z``) of the model and its reference point."""
Loads = tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]
"""On the model: X, Y, N, or X, Z, M (bow up)."""
Hull = Callable[[Motion], Loads]

_ROWS = {"X": 0, "Y": 1, "Z": 1, "N": 2, "M": 2}


def polynomial(coefficients: Mapping[str, float]) -> Hull:
    """Return the hull of ``{"Y_vdot": -120.0, "N_v|v|": ..., "X_vr": ..., "X_uu": ...}``."""
    terms = [(_ROWS[name[0]], _factors(name[2:]), value) for name, value in coefficients.items()]

    def loads(motion: Motion) -> Loads:
        found = [np.zeros_like(motion["u"]) for _ in range(3)]
        for row, factors, value in terms:
            product = np.full_like(motion["u"], value)
            for factor in factors:
                own = motion[factor.strip("|")]
                product = product * (np.abs(own) if "|" in factor else own)
            found[row] = found[row] + product
        return found[0], found[1], found[2]

    return loads


def _factors(text: str) -> list[str]:
    return re.findall(r"\|[uvwrq]\||[uvwrq]dot|[uvwrq]", text)
