"""Check of a swing: two pivots a known distance apart must give the same inertia."""

from dataclasses import dataclass

from analysis.inertia.elementary_functions import Value
from analysis.inertia.swing import inertia_at_cg
from analysis.uncertainty.budget import derived
from analysis.uncertainty.estimate import Estimate

LIMIT = 2.0  # of the joint standard uncertainty


@dataclass(frozen=True)
class PivotTest:
    """One pivot: period in s and distance of the centre of gravity below it in m."""

    period: Estimate
    cg_below: Estimate


@dataclass(frozen=True)
class TwoPivotCheck:
    """Agreement of the results from two pivots.

    Attributes
    ----------
    distance_excess
        ``d_2 - d_1`` less the true distance, m.
    inertia_difference
        Inertia at the centre of gravity by pivot 1 less that by pivot 2, kg m2.
    from_periods_m
        The distance below pivot 1 at which both periods agree on the inertia, m.
    passes
        Whether both differences lie within twice their uncertainties.
    points_to
        What a failure points at, likeliest first; empty when it passes.
    """

    distance_excess: Estimate
    inertia_difference: Estimate
    from_periods_m: float
    passes: bool
    points_to: tuple[str, ...]


def check_two_pivots(
    first: PivotTest,
    second: PivotTest,
    mass: Estimate,
    pivot_distance: Estimate,
    gravity: Estimate,
) -> TwoPivotCheck:
    """Compare the lower pivot (``first``) with the upper one (``second``).

    With h the distance of the pivots, the periods alone give
    ``d_1 = h (T_2^2 g/(4 pi^2) - h)/(2 h - (T_2^2 - T_1^2) g/(4 pi^2))``: a centre of gravity
    without any tilt, which tells a wrong static fit from a wrong mass or period.

    Raises
    ------
    DataError
        If the inputs contradict each other.
    """
    from analysis.inertia.compound_pendulum import lamboley_depth

    def excess(d1: Value, d2: Value, h: Value) -> Value:
        return d2 - d1 - h

    def difference(t1: Value, d1: Value, t2: Value, d2: Value, m: Value, g: Value) -> Value:
        return inertia_at_cg(t1, m, d1, g) - inertia_at_cg(t2, m, d2, g)

    inputs = {"d1": first.cg_below, "d2": second.cg_below, "h": pivot_distance}
    distance = derived("distance of the pivots", excess, "m", **inputs)
    inputs = {
        "t1": first.period,
        "d1": first.cg_below,
        "t2": second.period,
        "d2": second.cg_below,
        "m": mass,
        "g": gravity,
    }
    inertia = derived("inertia by both pivots", difference, "kg m2", **inputs)
    from_periods = lamboley_depth(
        first.period.value, second.period.value, pivot_distance.value, gravity.value
    )
    bad = (_differs(distance), _differs(inertia))
    reasons = _reasons(bad, distance, from_periods, first, second, pivot_distance)
    return TwoPivotCheck(distance, inertia, from_periods, not any(bad), reasons)


def _differs(difference: Estimate) -> bool:
    return abs(difference.value) > LIMIT * difference.uncertainty


def _reasons(
    bad: tuple[bool, bool],
    distance: Estimate,
    from_periods_m: float,
    first: PivotTest,
    second: PivotTest,
    pivot_distance: Estimate,
) -> tuple[str, ...]:
    """Rank what explains the failure, by the correction that each pivot's distance would need."""
    if not any(bad):
        return ()
    wrong_first = abs(first.cg_below.value - from_periods_m)
    wrong_second = abs(second.cg_below.value - from_periods_m - pivot_distance.value)
    reasons = []
    if bad[0]:
        name, size = (
            ("upper", wrong_second) if wrong_second > wrong_first else ("lower", wrong_first)
        )
        reasons.append(
            f"the tilts at the {name} pivot: its distance is {1e3 * size:.2g} mm from what both "
            "periods agree on (lever, weights, inclinometer moved between the pivots, its scale)"
        )
        reasons.append(
            f"the distance of the pivots: it would have to be {1e3 * distance.value:+.2g} mm longer"
        )
    if bad[1] and not bad[0]:
        reasons.append("a period (inclinometer too slow or too far out, few swings), or the mass")
    if bad[1] and bad[0]:
        reasons.append("both differences follow from one wrong distance; correct that one first")
    return tuple(reasons)
