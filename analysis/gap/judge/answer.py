"""What a diagnosis answers: how probable each name is, and what part of a gap it makes go away."""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.gap.design.forecast import Forecast
from analysis.gap.judge.diagnosis import Diagnosis
from analysis.gap.judge.withheld import share_gone
from analysis.gap.observe.components import Stack
from analysis.gap.search.fit import Fit
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCES

_SUREST: Final = 0.85  # of the names above 0.9, 86 % were right on a sealed board
_FORM_KNOWN: Final = 1.0  # standard deviation of the logarithm of by how much a form is off
# What a wrong name makes go away elsewhere, about what it did so far: by how much less at mean,
# and the standard deviation about that.
_LESS: Final = 0.32
_SCATTER: Final = 0.2
_LEVELS: Final = (0.025, 0.5, 0.975)
_DRAWS: Final = 400
_SEED: Final = 20260


@dataclass(frozen=True, eq=False)
class NamedAnswer:
    """What the answer names, the second best, how probable the first is, and what it did so far.

    Attributes
    ----------
    tried
        Part of the gap that went away on regimes of the campaign that were withheld from it.
    """

    best: Fit | None
    rival: Fit | None
    share: float
    tried: float


def named_answer(diagnosis: Diagnosis) -> NamedAnswer:
    """Return what a diagnosis names."""
    best, shrinks = diagnosis.best, diagnosis.shrinkage
    share = 0.0 if best is None else diagnosis.answers.by_answer[best.answer]
    return NamedAnswer(best, diagnosis.rival, share, 0.0 if shrinks is None else shrinks.share)


def predicted_shrinkage(
    named: NamedAnswer, stack: Stack, plain: Forecast, cured: Forecast
) -> tuple[float, float, float]:
    """Return the part of the forces' gap that goes away at further runs: 2.5 %, median, 97.5 %.

    By how much a form is off is itself known to a factor of three only; and where the answer is
    another one, as much goes away at most, but for some scatter, as on the regimes that were
    withheld from it.

    Parameters
    ----------
    stack
        The further runs.
    plain, cured
        What is predicted of them without an effect, and with the best answer.
    """
    if named.best is None:
        return 0.0, 0.0, 0.0
    rows = np.array([component.channel in FORCES for component in stack.components])
    gap, root, form = (cured.mean - plain.mean)[rows], cured.root[rows], cured.form[rows]
    rng, shares = np.random.default_rng(_SEED), []
    right = min(named.share, _SUREST) * _DRAWS
    for number in range(_DRAWS):
        if number >= right:
            share = _SCATTER * rng.standard_normal() - _LESS * rng.exponential()
            shares.append(min(named.tried + float(share), 1.0))
            continue
        off = root @ rng.standard_normal(root.shape[1])
        size = math.exp(_FORM_KNOWN * float(rng.standard_normal()))
        off = off + size * (form @ rng.standard_normal(form.shape[1]))
        shares.append(share_gone(_rms(gap + off), _rms(off)))
    low, middle, high = np.quantile(shares, _LEVELS)
    return float(low), float(middle), float(high)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
