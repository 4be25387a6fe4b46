"""Whether loads go with the square of the model's own speed as it turns: what the data support.

A model that yaws on a steady carriage goes on its own way at V, faster than the carriage's U as
the struts swing it. At one Froude number a hull's load is V^2 times what v/V and r/V make of it, so
that with coefficients at the speed U, as manoeuvring models take them, it is

    Y = Y_v v V/U + Y_v|v| v|v| + Y_vrr v r^2 U/V + ...

At small angles, and on tows and circles, that is the same as coefficients that do not change.
"""

from collections.abc import Sequence
from dataclasses import replace
from statistics import fmean

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_records import FormChoice
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.form_choice import choose_form, chosen_of_two
from hardware.description.errors import DataError


def choose_speed_form(
    cycles: Sequence[BodyCycle],
    row: int,
    motions: str,
    orders: tuple[int, ...],
    *,
    cross: bool,
    angles: Sequence[str],
) -> tuple[FormChoice, CycleFit, float | None]:
    """Return the form of one load, the fit of the richest, and the speed that its terms are of.

    They are of a speed where that is as many times better supported as
    :func:`~analysis.coefficients.form_choice.chosen_of_two` asks; else of none. Parameters and what
    is raised are those of :func:`choose_form`.
    """
    plain = choose_form(cycles, row, motions, orders, cross=cross, angles=angles)
    speed = fmean(cycle.speed_m_s for cycle in cycles)
    if "r" not in motions or not speed > 0.0:
        return (*plain, None)
    try:
        choice, richest = choose_form(
            cycles, row, motions, orders, cross=cross, angles=angles, of_speed_m_s=speed
        )
    except DataError:
        return (*plain, None)
    forms = ("loads of the speed squared", "coefficients that do not change")
    reason = (
        f"{choice.message}; that loads go with the square of the model's own speed as it turns is "
        "{} as well supported as coefficients that do not change"
    )
    of_speed = chosen_of_two(cycles, row, forms, (richest, plain[1]), reason)
    if of_speed is None:
        return (*plain, None)
    return replace(choice, message=of_speed.message), richest, speed
