"""Exact rigs recorded with one arrangement and analysed with another: what moves is told.

The oracle is the exact rig of ``tests/exact``: analysed with its own arrangement it gives what the
wrong key moved, without any of what is tested.
"""

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.arrangements import BETTER, NOT_COMPARED, OPEN, SAME, WORSE
from analysis.coefficients.campaign import campaign_coefficients
from analysis.coefficients.campaign_plan import Request
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.uncertainty.values import UncertainValues
from hardware.description.arrangement import Arrangement, Gauges, Joint
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.exact_campaigns import afloat, less_known, struts_of
from tests.analysis.coefficients.sources import of_draws
from tests.exact.rig import ExactRig
from tests.exact.rigs import exact_rig

ORDERS, PERIODS = 7, 10
FORCE_N, MOTION_M = 0.05, 1e-5  # standard deviation of one period's harmonics
RUNS = ((0.0, 0.12, 0.0), (1.0, 0.0, 0.0), (0.5, 0.0, 0.0), (1.0, 0.1, 0.1), (0.6, 0.05, -0.15))
"""Part of the largest angle, sway or heave in m, drift or trim in rad."""
LARGE = {Plane.HORIZONTAL: math.radians(25.0), Plane.VERTICAL: math.radians(15.0)}
TABLE = Arrangement(joint=Joint.YAW_TABLE)


def wrong_keys() -> Iterator[tuple[Arrangement, str, Arrangement]]:
    """Yield each true arrangement, the key that is stated wrongly, and what is stated."""
    for base, keys in (
        (Arrangement(), ("joint", "pivot", "gauges", "drift_by")),
        (TABLE, ("gauges", "drift_by")),
    ):
        for key in keys:
            ways = [way for way in type(getattr(base, key)) if way is not Joint.YAW_TABLE]
            for true in ways:
                for stated in (way for way in ways if way is not true):
                    yield replace(base, **{key: true}), key, replace(base, **{key: stated})


CASES = tuple(wrong_keys())


def rigs_of(plane: Plane, true: Arrangement, part: float = 1.0) -> list[ExactRig]:
    """Return a campaign whose angles, sways and drifts are a part of the large ones."""
    found = [
        exact_rig(
            plane, true, rotation_rad=part * turn * LARGE[plane], drift_rad=part * drift,
            sway_m=part * sway, frequency_hz=0.25,
        )
        for turn, sway, drift in RUNS
    ]  # fmt: skip
    turning = np.array([[1.0], [1.0], [part]])
    return [afloat(replace(one, coordinates=one.coordinates * turning)) for one in found]


def recorded(rigs: list[ExactRig], seed: int) -> list[StrutCycle]:
    """Return noisy readings with the covariance that their periods show."""
    generator = np.random.default_rng(seed)
    return [noisy(struts_of(rig, f"run {k}", ORDERS), generator) for k, rig in enumerate(rigs)]


def noisy(struts: StrutCycle, generator: np.random.Generator) -> StrutCycle:
    moved = [name.startswith("displacement") for name in struts.phasors.names]
    spread = np.repeat(np.where(moved, MOTION_M, FORCE_N), 2)
    spread[1 : 2 * len(moved) // (ORDERS + 1) : 2] = 0.0  # a mean has no quadrature
    draws = spread * generator.standard_normal((PERIODS, len(spread)))
    source = of_draws(f"scatter of {struts.name}", draws)
    real = UncertainValues(struts.phasors.real.values + draws.mean(axis=0), (source,))
    return replace(struts, phasors=replace(struts.phasors, real=real))


def analysed(
    struts: list[StrutCycle], rigs: list[ExactRig], given: Arrangement, *, nonlinear: bool = True
) -> CampaignCoefficients:
    cycles = [
        less_known(replace(one, oscillator=replace(one.oscillator, **vars(given))), rig)
        for one, rig in zip(struts, rigs, strict=True)
    ]
    return campaign_coefficients(cycles, Request(nonlinear=nonlinear))


def largest_move(wrong: CampaignCoefficients, right: CampaignCoefficients) -> float:
    """Return how far the wrong key moved any coefficient, in its half-widths."""
    true = {
        (one.name, one.method, one.runs): value
        for one, value in zip(right.entries, right.values, strict=True)
    }
    rows = zip(wrong.entries, wrong.values, wrong.half_widths, strict=True)
    return max(
        abs(value - true[one.name, one.method, one.runs]) / half
        for one, value, half in rows
        if (one.name, one.method, one.runs) in true
    )


def told(found: CampaignCoefficients, key: str, true: Arrangement) -> tuple[str, str]:
    """Return the verdict on the true value of a key, and the code of the flag that names it."""
    way = getattr(true, key)
    (one,) = (one for one in found.arrangements if (one.key, one.other) == (key, way))
    codes = [flag.code for flag in found.flags if flag.message == one.message]
    return one.verdict, codes[0] if codes else ""


EVERY = pytest.mark.parametrize(
    ("true", "key", "stated"), CASES, ids=lambda one: one if isinstance(one, str) else ""
)


@pytest.mark.sample(2)
@pytest.mark.parametrize("plane", Plane)
@pytest.mark.parametrize("part", [1.0, 0.1, 0.01])
@EVERY
def test_a_wrong_key_that_moves_a_coefficient_is_told(
    true: Arrangement, key: str, stated: Arrangement, part: float, plane: Plane
) -> None:
    rigs = rigs_of(plane, true, part)
    struts = recorded(rigs, seed=7)
    wrong, right = analysed(struts, rigs, stated), analysed(struts, rigs, true)
    verdict, code = told(wrong, key, true)
    moved = largest_move(wrong, right) > 1.0
    assert verdict == BETTER or (verdict == SAME and not moved)
    assert code == ("arrangement_doubted" if verdict == BETTER else "")
    doubted = [flag for flag in right.flags if flag.code == "arrangement_doubted"]
    assert not doubted, "the recordings doubt the true arrangement"


@pytest.mark.sample(4)
@pytest.mark.parametrize("plane", Plane)
@EVERY
def test_what_the_recordings_do_not_tell_is_named_as_resting_on_the_key(
    true: Arrangement, key: str, stated: Arrangement, plane: Plane
) -> None:
    """First harmonics of one motion each leave nothing over that could tell."""
    rigs = rigs_of(plane, true)[:2]
    struts = recorded(rigs, seed=8)
    wrong, right = (analysed(struts, rigs, one, nonlinear=False) for one in (stated, true))
    moved = largest_move(wrong, right) > 1.0
    assert moved == (key != "drift_by"), "without a drift angle all ways to set one are the same"
    assert told(wrong, key, true) == ((OPEN, "rests_on_arrangement") if moved else (SAME, ""))


@pytest.mark.slow
def test_the_message_says_what_moves_and_by_how_much() -> None:
    true, stated = Arrangement(gauges=Gauges.RIG), Arrangement()
    rigs = rigs_of(Plane.HORIZONTAL, true)
    struts = recorded(rigs, seed=7)
    wrong, right = analysed(struts, rigs, stated), analysed(struts, rigs, true)
    (one,) = (one for one in wrong.arrangements if one.verdict == BETTER and one.key == "gauges")
    assert one.largest == pytest.approx(largest_move(wrong, right), rel=0.2)
    assert one.coefficients[0] in one.message
    assert "the recordings fit gauges = 'rig' better than gauges = 'model'" in one.message
    (other,) = (one for one in right.arrangements if one.key == "gauges")
    assert other.verdict == WORSE
    assert other.evidence_ratio < 1e-6


def test_gauges_of_the_rig_are_not_compared_without_force_x() -> None:
    rigs = rigs_of(Plane.HORIZONTAL, Arrangement())
    struts = [
        replace(one, phasors=one.phasors.select([n for n in one.phasors.names if "_x" not in n]))
        for one in recorded(rigs, seed=7)
    ]
    found = analysed(struts, rigs, Arrangement())
    assert told(found, "gauges", Arrangement(gauges=Gauges.RIG)) == (NOT_COMPARED, "")
    assert told(found, "joint", Arrangement(joint=Joint.SLIDES_ON_RIG))[0] == WORSE
