"""Which non-linear form the data support: cubic, ``|v|v``, both or none; or that they cannot tell.

Linear is taken unless another form is :data:`DECIDES` times as well supported.

All forms are fitted to the same harmonics. Squares of the residuals over their scatter give
Akaike's criterion for few data, and ``exp(difference/2)`` is the evidence ratio. Where even the
richest form leaves more than scatter explains, all squares are divided by that excess (quasi-AIC):
a model that fits nowhere must not seem to decide.
"""

import math
from collections.abc import Mapping, Sequence

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_records import FormChoice
from analysis.coefficients.cycle_fit import HIGHER, CycleFit, fit_cycles
from analysis.coefficients.terms import (
    LOAD_WORDS,
    VELOCITY_LETTERS,
    linear_terms,
    name_of_term,
    term_of,
)
from hardware.description.errors import DataError
from hardware.description.oscillator import Plane

LINEAR_FORM = "linear"
CUBIC = "cubic"
QUADRATIC = "quadratic"
BOTH = "cubic and quadratic"
NOT_SEPARABLE = "not separable"

DECIDES = 20.0  # evidence ratio: 1 in 20 is what the intervals leave open too
BEYOND_DOUBT = 1e6  # an evidence ratio above is not counted out
DESCRIBES = 3.0  # squares left over by the richest form, for each degree of freedom


def forms_of(
    plane: Plane,
    row: int,
    motions: str,
    *,
    cross: bool = True,
    steady: bool = False,
    angles: Sequence[str] = (),
) -> Mapping[str, tuple[str, ...]]:
    """Return the terms of each form of one load.

    Parameters
    ----------
    motions
        ``"v"``, ``"r"`` or ``"vr"`` (``w`` and ``q`` alike): in what the runs move.
    cross
        Whether terms of both motions together are among them, where the runs move in both.
    steady
        Whether the runs are static: a constant stands where there is no acceleration.
    angles
        Factors of terms of rudder and heel, which every form has.
    """
    v, r = tuple(VELOCITY_LETTERS[plane])
    load = name_of_term(term_of(linear_terms(plane, (row,))[0], plane), plane)[0]
    letters = [letter for letter, motion in ((v, "v"), (r, "r")) if motion in motions]
    linear = (
        (f"{load}_0", *(f"{load}_{letter}" for letter in letters))
        if steady
        else tuple(name for name in linear_terms(plane, (row,)) if name[2] in letters)
    )
    linear += tuple(f"{load}_{factors}" for factors in angles)
    cubic = tuple(f"{load}_{letter * 3}" for letter in letters)
    quadratic = tuple(f"{load}_{letter}|{letter}|" for letter in letters)
    if len(letters) == 2 and cross:
        cubic += (f"{load}_{v}{v}{r}", f"{load}_{v}{r}{r}")
        quadratic += (f"{load}_{v}|{r}|", f"{load}_{r}|{v}|")
    return {
        LINEAR_FORM: linear,
        CUBIC: linear + cubic,
        QUADRATIC: linear + quadratic,
        BOTH: linear + cubic + quadratic,
    }


def choose_form(
    cycles: Sequence[BodyCycle],
    row: int,
    motions: str = "v",
    orders: tuple[int, ...] = HIGHER,
    *,
    cross: bool = True,
    steady: bool = False,
    angles: Sequence[str] = (),
    of_speed_m_s: float | None = None,
) -> tuple[FormChoice, CycleFit]:
    """Return which form of one load the cycles support, and the fit of the richest.

    Parameters
    ----------
    row
        0 force, 1 moment, 3 roll moment.
    motions, cross, steady, angles
        As in :func:`forms_of`.
    of_speed_m_s
        The speed that the terms are of; ``None`` where they do not change with it.

    Raises
    ------
    DataError
        If not even the linear terms are determined.
    """
    plane = cycles[0].plane
    forms = forms_of(plane, row, motions, cross=cross, steady=steady, angles=angles)
    fits = {LINEAR_FORM: fit_cycles(cycles, forms[LINEAR_FORM], orders, of_speed_m_s=of_speed_m_s)}
    for form in [form for form in forms if form != LINEAR_FORM]:
        try:
            fits[form] = fit_cycles(cycles, forms[form], orders, of_speed_m_s=of_speed_m_s)
        except DataError:
            continue  # terms that these runs cannot tell apart are no candidate
    criteria, dispersion, richest = _criteria(fits, row)
    best = min(criteria.values())
    weights = {form: math.exp((best - value) / 2.0) for form, value in criteria.items()}
    verdict, fitted, ratio, reason = _verdict(criteria)
    if dispersion > DESCRIBES:
        reason += (
            f"; but even the richest leaves {dispersion:.3g} times what scatter explains (limit "
            f"{DESCRIBES:g}): no form describes these runs"
        )
    ranked = sorted(criteria, key=lambda form: criteria[form])
    total = sum(weights.values())
    choice = FormChoice(
        LOAD_WORDS[row],
        tuple(cycle.name for cycle in cycles),
        tuple(ranked),
        tuple(len(fits[form].names) for form in ranked),
        tuple(float(fits[form].chi_square[row]) for form in ranked),
        tuple(criteria[form] for form in ranked),
        tuple(weights[form] / total for form in ranked),
        dispersion,
        verdict,
        fitted,
        ratio,
        reason,
    )
    return choice, richest


def chosen_of_two(
    cycles: Sequence[BodyCycle],
    row: int,
    forms: tuple[str, str],
    fits: tuple[CycleFit, CycleFit],
    reason: str,
) -> FormChoice | None:
    """Return the choice of the first of two forms; ``None`` where the data do not ask for it.

    It is taken where it is :data:`DECIDES` times as well supported as the second.

    Parameters
    ----------
    reason
        The message, with ``{}`` for how many times.
    """
    counts = (len(fits[0].names), len(fits[1].names))
    squares = (float(fits[0].chi_square[row]), float(fits[1].chi_square[row]))
    spare = float(fits[0].data[row]) - counts[0]
    dispersion = max(1.0, squares[0] / spare) if spare > 0 else 1.0
    criteria = tuple(
        square / dispersion + 2.0 * count for square, count in zip(squares, counts, strict=True)
    )
    ratio = math.exp(max(-700.0, min((criteria[1] - criteria[0]) / 2.0, 700.0)))
    if ratio < DECIDES or (spare < 1 and counts[0] > counts[1]):
        return None
    weight = 1.0 / (1.0 + 1.0 / ratio)
    return FormChoice(
        LOAD_WORDS[row],
        tuple(cycle.name for cycle in cycles),
        forms,
        counts,
        squares,
        criteria,
        (weight, 1.0 - weight),
        dispersion,
        forms[0],
        forms[0],
        ratio,
        reason.format(ratio_text(ratio)),
    )


def rival_forms(choice: FormChoice) -> tuple[tuple[str, float], ...]:
    """Return the forms that do about as well as the one taken, each with its Akaike weight.

    Runs that show no curvature do not tell that there is none.
    """
    if choice.verdict not in (NOT_SEPARABLE, LINEAR_FORM):
        return ()
    rivals = zip(choice.forms, choice.aicc, choice.weights, strict=True)
    return tuple(
        (form, weight)
        for form, criterion, weight in rivals
        if form != choice.fitted and criterion - min(choice.aicc) < _NEAR
    )


def _criteria(fits: Mapping[str, CycleFit], row: int) -> tuple[dict[str, float], float, CycleFit]:
    """Akaike's criterion for few data by form, what squares were divided by, the richest's fit.

    A form with so many terms that the criterion does not exist is no candidate.
    """
    judged = {form: fit for form, fit in fits.items() if float(fit.data[row]) > len(fit.names) + 1}
    fits = judged or {LINEAR_FORM: fits[LINEAR_FORM]}
    richest = max(fits.values(), key=lambda fit: len(fit.names))
    spare = float(richest.data[row]) - len(richest.names)
    dispersion = max(1.0, float(richest.chi_square[row]) / spare) if spare > 0 else 1.0
    criteria = {}
    for form, fit in fits.items():
        count, data = len(fit.names), float(fit.data[row])
        few = data - count - 1.0
        penalty = 2.0 * count * (count + 1.0) / few if few > 0 else 0.0
        criteria[form] = float(fit.chi_square[row]) / dispersion + 2.0 * count + penalty
    return criteria, dispersion, richest


def _verdict(criteria: Mapping[str, float]) -> tuple[str, str, float, str]:
    """Return the verdict, the form taken, the evidence ratio that decided, and words for it."""
    best = min(criteria, key=lambda form: criteria[form])

    def ratio(forms: Sequence[str]) -> float:
        values = [criteria[form] for form in forms if form in criteria]
        return math.exp(min((min(values) - criteria[best]) / 2.0, 700.0)) if values else math.inf

    if best == LINEAR_FORM:
        verdict = ratio((CUBIC, QUADRATIC, BOTH))
        needed = "no non-linear term is needed within the scatter"
        return best, best, verdict, needed if len(criteria) > 1 else _TOO_FEW
    if best == BOTH and ratio((CUBIC, QUADRATIC)) < DECIDES:
        return _verdict({form: value for form, value in criteria.items() if form != BOTH})
    rivals = [form for form in (CUBIC, QUADRATIC) if form != best]
    over_linear, over_rivals = ratio((LINEAR_FORM,)), ratio(rivals)
    if (verdict := min(over_linear, over_rivals)) >= DECIDES:
        return best, best, verdict, f"{best} is {ratio_text(verdict)} as well supported as the next"
    if over_linear < DECIDES:
        taken, close, verdict = LINEAR_FORM, LINEAR_FORM, over_linear
    else:
        taken, close = best, rivals[0]
    reason = (
        f"{best} is {ratio_text(verdict)} as well supported as {close} (evidence ratio; "
        f"{DECIDES:g} is needed): {taken} is fitted, with what the others give in its intervals; "
        "to tell them, take a larger range of amplitudes (or of drift angles, and more sizes), or "
        "more periods"
    )
    return NOT_SEPARABLE, taken, verdict, reason


def ratio_text(ratio: float) -> str:
    """Return an evidence ratio in words; very large ones are given as a bound."""
    return f"{ratio:.3g} times" if ratio < BEYOND_DOUBT else f"over {BEYOND_DOUBT:g} times"


_NEAR = 2.0 * math.log(DECIDES)
_TOO_FEW = "too few runs to judge any other form by: add runs at other amplitudes or drift angles"
