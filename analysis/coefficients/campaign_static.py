"""The loads of static runs over drift (or trim) angles, straight tows among them."""

from collections.abc import Sequence

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_nonlinear import (
    STATIC_DRIFT,
    GroupFits,
    load_rows,
    try_form,
    try_surge,
)
from analysis.coefficients.campaign_plan import Request, set_heel_of
from analysis.coefficients.campaign_records import Missing
from analysis.coefficients.cycle_fit import STATIC
from analysis.coefficients.form_choice import LINEAR_FORM, choose_form, forms_of
from analysis.coefficients.terms import VELOCITY_LETTERS
from hardware.description.errors import DataError

_LINEAR_ANGLES = 4  # of rudder or heel; more of them tell what is cubic


def static_fits(cycles: Sequence[BodyCycle], request: Request) -> GroupFits:
    """Return the loads over drift (or trim) angles, straight tows among them.

    Runs on a circle beside them tell the terms of the rate of turn. Force and moment take the form
    that the data support; X is the resistance and, where the model was turned, quadratic. A rudder
    that was laid and a heel that was set add terms, as mirrored runs mirror the loads: odd ones, in
    X even.
    """
    plane = cycles[0].plane
    odd, even = _set_angles(cycles)
    turning = any(cycle.turn_rate_rad_s for cycle in cycles)
    motions = "vr" if turning else "v"
    cross = any(cycle.turn_rate_rad_s and cycle.drift_rad for cycle in cycles)
    group = GroupFits()
    fits, missing = group.fits, group.missing
    for row in load_rows(cycles):
        forms = forms_of(plane, row, motions, cross=cross, steady=True, angles=odd)
        try:
            choice, richest = choose_form(
                cycles, row, motions, STATIC, cross=cross, steady=True, angles=odd
            )
        except DataError as error:
            missing += [Missing(name, f"{STATIC_DRIFT}: {error}") for name in forms[LINEAR_FORM]]
            continue
        group.choices.append(choice)
        group.richest.append(richest)
        try_form(fits, missing, STATIC_DRIFT, cycles, forms, choice, STATIC, request)
    if all(cycle.has_surge for cycle in cycles):
        v, r = tuple(VELOCITY_LETTERS[plane])
        turned = any(round(cycle.drift_rad, 6) for cycle in cycles)
        names = ["X_0", *([f"X_{v}{v}"] if turned else []), *(f"X_{factors}" for factors in even)]
        names += [*([f"X_{r}{r}"] if turning else []), *([f"X_{v}{r}"] if cross else [])]
        try_surge(group, cycles, names, STATIC, request, f"X_{v * 4}")
    return group


def _set_angles(cycles: Sequence[BodyCycle]) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Return the factors of rudder and heel that static runs may tell: odd ones, even ones."""
    v = VELOCITY_LETTERS[cycles[0].plane][0]
    odd: list[str] = []
    even: list[str] = []
    for letter, angles in (
        ("d", [round(cycle.rudder_rad, 4) for cycle in cycles]),
        ("phi", [round(set_heel_of(cycle), 4) for cycle in cycles]),
    ):
        if set(angles) == {0.0}:
            continue
        pairs = [
            (angle, round(cycle.drift_rad, 4)) for angle, cycle in zip(angles, cycles, strict=True)
        ]
        turned = {abs(angle) for angle, drift in pairs if drift}
        odd += [letter] + ([letter * 3] if len(set(angles)) > _LINEAR_ANGLES else [])
        odd += [f"{v}{v}{letter}"] if turned - {0.0} else []
        odd += [f"{v}{letter * 2}"] if letter == "phi" and len(turned) > 1 else []
        even += [letter * 2] + ([f"{v}{letter}"] if turned - {0.0} else [])
    return tuple(odd), tuple(even)
