"""Whether the recordings support the stated arrangement of the rig, and what depends on it.

The recordings contradict a key where an alternative is
:data:`~analysis.coefficients.form_choice.DECIDES` times as likely as what is stated. Where neither
is, each value that the alternative moves by more than its half-width depends on the statement
alone; the recordings do not test it.
"""

import math
from collections.abc import Sequence

import numpy as np

from analysis.coefficients.campaign_records import OtherArrangement
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.form_choice import DECIDES, ratio_text
from hardware.description.arrangement import Arrangement
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag, Severity

BETTER = "fits better"
WORSE = "fits worse"
OPEN = "cannot be told"
SAME = "indistinguishable"
NOT_COMPARED = "not compared"

_NAMED = 5  # coefficients that a message names; the record holds all
_LARGEST_LOG = 700.0  # of a ratio that a float holds


def other_arrangement(
    coefficients: CampaignCoefficients,
    stated: Arrangement,
    key: str,
    alternative: str,
    values: FloatArray,
    evidence: float,
) -> OtherArrangement:
    """Return how likely one alternative is, and which coefficients it changes.

    Parameters
    ----------
    values
        Of all entries under the alternative, shape ``(n,)``; NaN where not reckoned.
    evidence
        Natural logarithm of its likelihood over that of what is stated.
    """
    stated_value = str(getattr(stated, key))
    if np.isnan(values).any():
        text = f"{key} = {alternative!r} was not compared: it takes force_x, or smaller angles"
        return OtherArrangement(
            key, stated_value, alternative, math.nan, math.nan, (), (), NOT_COMPARED, text
        )
    changes, half = np.abs(values - coefficients.values), coefficients.half_widths
    change_ratios = np.divide(changes, half, out=np.zeros_like(half), where=half > 0.0)
    order = [int(k) for k in np.argsort(-change_ratios) if change_ratios[k] > 1.0]
    sizes: dict[str, float] = {}
    for k in order:
        sizes.setdefault(coefficients.entries[k].name, float(change_ratios[k]))
    verdict = _verdict(evidence, bool(sizes))
    ratio = math.exp(min(max(evidence, -_LARGEST_LOG), _LARGEST_LOG))
    largest = float(change_ratios.max(initial=0.0))
    text = _message(verdict, key, stated_value, alternative, ratio, largest, sizes)
    moves = (largest, tuple(sizes), tuple(sizes.values()))
    return OtherArrangement(key, stated_value, alternative, ratio, *moves, verdict, text)


def arrangement_flags(arrangements: Sequence[OtherArrangement]) -> tuple[Flag, ...]:
    """Return a warning for each key that the recordings contradict, a note for each open one."""
    codes = {
        BETTER: ("arrangement_doubted", Severity.WARNING),
        OPEN: ("rests_on_arrangement", Severity.NOTE),
    }
    return tuple(
        Flag(*codes[arrangement.verdict], arrangement.message)
        for arrangement in arrangements
        if arrangement.verdict in codes
    )


def _verdict(evidence: float, moves: bool) -> str:
    if abs(evidence) >= math.log(DECIDES):
        return BETTER if evidence > 0.0 else WORSE
    return OPEN if moves else SAME


def _message(
    verdict: str,
    key: str,
    stated: str,
    alternative: str,
    ratio: float,
    largest: float,
    sizes: dict[str, float],
) -> str:
    words = [f"{name} by {size:.3g}" for name, size in list(sizes.items())[:_NAMED]]
    remainder = [f"{len(sizes) - _NAMED} more"] if len(sizes) > _NAMED else []
    change = (
        f"{', '.join([*words, *remainder])} half-widths"
        if sizes
        else "no coefficient beyond its own"
    )
    alternative, stated = f"{key} = {alternative!r}", f"{key} = {stated!r}"
    if verdict == BETTER:
        return (
            f"the recordings fit {alternative} better than {stated}, which is stated "
            f"({ratio_text(ratio)} as likely; {DECIDES:g} decides); it would move {change}: look "
            "at the rig, and correct [oscillator]"
        )
    if verdict == WORSE:
        return (
            f"the recordings bear {stated} out ({ratio_text(1.0 / ratio)} as likely as "
            f"{alternative})"
        )
    if verdict == OPEN:
        return (
            f"the recordings do not tell {stated} from {alternative}, which would move {change}: "
            "they rest on what is stated; larger angles, more amplitudes or more periods would tell"
        )
    return f"{alternative} moves no coefficient by more than {largest:.2g} of its half-width"
