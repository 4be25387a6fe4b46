"""Powers that add up: what an effect that does not repeat makes of the noise that is there."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from analysis.gap.observe.components import Component, Part
from hardware.description.arrays import BoolArray, FloatArray

# What each of these is the logarithm of, to this power, adds up like powers do.
_POWERS: Final = {
    Part.BETWEEN: 1.0,
    Part.LINE: 1.0,
    Part.CYCLE_SCATTER: 2.0,
    Part.PERIOD_SCATTER: 2.0,
}


def are_powers(parts: Sequence[Component]) -> BoolArray:
    """Tell which components are logarithms of powers, shape ``(components,)``."""
    return _powers(parts) > 0.0


def _powers(parts: Sequence[Component]) -> FloatArray:
    return np.array([_POWERS.get(component.part, 0.0) for component in parts])


def _logarithms(ratio: FloatArray, power: FloatArray) -> FloatArray:
    """Return by how much components rise to which a share of their power is added."""
    return np.asarray(np.log1p(ratio) / np.where(power, power, 1.0), np.float64)


def scaled_change(parts: Sequence[Component], change: FloatArray, share: float) -> FloatArray:
    """Return what an effect of another size changes, by what it changes as it is.

    Parameters
    ----------
    change
        Of each component, shape ``(components,)``.
    share
        Of the effect's size: powers go with its square.
    """
    power = _powers(parts)
    ratio = np.expm1(np.maximum(power * change, 0.0)) * share**2
    logs = _logarithms(ratio, power)
    return np.where((power > 0.0) & (change > 0.0), logs, share * change)


def on_noise(
    parts: Sequence[Component], alone: FloatArray, base: FloatArray, usual: FloatArray
) -> FloatArray:
    """Return a record with an effect as it is on usual noise in place of its own draw.

    Parameters
    ----------
    alone, base
        With and without the effect on the same draw, shape ``(components,)``.
    usual
        Without it, at mean over the draws.
    """
    power = _powers(parts)
    pulses = np.array([component.part is Part.PERIOD_SCATTER for component in parts])
    # The same power on top of another one of the noise is the effect at another size. The pulses'
    # deviates are scaled, not added to: what is odd about them is odd with the effect, too.
    ratio = np.expm1(np.maximum(power * (alone - base), 0.0)) * np.exp(power * (base - usual))
    on_usual = _logarithms(ratio, power)
    adds = (power > 0.0) & (alone > base) & ~pulses
    return usual + np.where(adds, on_usual, alone - base)
