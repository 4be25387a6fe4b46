"""Forces of a model on elastic struts: model and springs as one linear system."""

from collections.abc import Callable

import numpy as np

from hardware.description.arrays import ComplexArray
from sim.effects.effect import Signature
from sim.effects.situation import Situation, at_struts

HIGHEST = 4  # order up to which the nominal force is carried on


def yielding_signature(situation: Situation, give: Callable[[complex], ComplexArray]) -> Signature:
    """Return the change of the force where the model yields ``G F`` to the force F.

    With ``h = y - G F`` and ``F = Z h``, F is ``(1 + Z G)^-1`` of the rigid rig's: to first order
    it changes by ``-Z G Z y``. Each harmonic that the rigid rig has is magnified by itself.

    Parameters
    ----------
    give
        G, displacement per force of shape ``(2, 2)``, at a Laplace variable.
    """
    predicted: dict[tuple[str, int], complex] = {}
    for order in range(HIGHEST + 1):
        s = 1j * order * situation.omega
        loop = np.eye(2) + situation.impedance(order) @ give(s)
        rigid = situation.force(order)
        predicted |= at_struts(np.linalg.solve(loop, rigid) - rigid, order)
    return predicted


def in_series(first: float | None, second: float) -> float:
    """Return the stiffness of two springs one behind the other; ``None`` is a rigid one."""
    return second if first is None else 1.0 / (1.0 / first + 1.0 / second)
