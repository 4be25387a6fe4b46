"""What is stated wrong, against rigs that are otherwise than they are said to be.

Exact rigs at large angles, a little longer, faster, heavier ... than the analysis takes them to
be, or read by a chain that errs a little: what their coefficients are off by is the slope that the
budget has, but for its sign, which one quantity has in all of them.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.cycle_fit import CycleFit, fit_cycles
from analysis.coefficients.stated_uncertainties import STATED, StatedUncertainties
from analysis.coefficients.strut_cycle import StrutCycle
from analysis.coefficients.strut_phasors import MOTION_ASKED
from hardware.description.arrangement import Arrangement, DriftBy, Gauges, Joint, Pivot
from hardware.description.oscillator import Plane
from tests.analysis.coefficients.exact_campaigns import (
    HULLS,
    RESTORING,
    campaign,
    less_known,
    struts_of,
)
from tests.exact.hull import Hull, Loads, Motion, polynomial
from tests.exact.rig import ExactBody, ExactRig

ORDERS = 7
ARRANGEMENTS = (
    Arrangement(),
    Arrangement(Joint.SLIDES_ON_RIG, Pivot.FORE, Gauges.RIG, DriftBy.STRUTS_OFFSET),
)
Rigs = list[ExactRig]


def held(rig: ExactRig, factor: float = 1.0, ahead_m: float = 0.0) -> ExactRig:
    """The rig with a hull about a point ahead of the midpoint, and what hydrostatics hold it by."""
    vertical = rig.plane is Plane.VERTICAL
    turn = "q" if vertical else "r"
    across = "w" if vertical else "v"
    arm, water = rig.side * ahead_m, polynomial(HULLS[rig.plane])

    def loads(motion: Motion) -> Loads:
        moved = dict(motion)
        for rate in ("", "dot"):
            moved[across + rate] = motion[across + rate] + arm * motion[turn + rate]
        x, force, moment = water(moved)
        return x, force, moment + arm * force

    hull: Hull = loads
    to_point = np.array([[1.0, arm], [0.0, 1.0]])
    restoring = factor * to_point.T @ RESTORING[rig.plane] @ to_point
    return replace(rig, hull=hull, restoring=restoring)


def nominal(plane: Plane, arrangement: Arrangement) -> Rigs:
    """Runs with drift; without trim, where the budget leaves out that what was tared turns."""
    rigs = campaign(plane, arrangement)
    upright = plane is Plane.VERTICAL
    return [held(replace(one, drift_rad=0.0) if upright else one) for one in rigs]


def read(rig: ExactRig, said: ExactRig, name: str) -> StrutCycle:
    """What a rig's struts read, taken for another rig's."""
    own, other = struts_of(rig, name, ORDERS), struts_of(said, name, 2)
    return replace(
        own,
        oscillator=other.oscillator,
        set_point=other.set_point,
        frequency_hz=other.frequency_hz,
        flags=(MOTION_ASKED,),
    )


Chain = Callable[[StrutCycle], StrutCycle]


def fitted(
    rigs: Rigs,
    said: Rigs,
    stated: StatedUncertainties = StatedUncertainties(),  # noqa: B008
    chain: Chain = lambda one: one,
) -> CycleFit:
    plane = said[0].plane
    cycles = [
        less_known(chain(read(one, taken, f"run {k}")), taken)
        for k, (one, taken) in enumerate(zip(rigs, said, strict=True))
    ]
    return fit_cycles(cycles, tuple(HULLS[plane]), (0, 1, 2, 3), stated=stated)


def heavier(body: ExactBody, **change: float) -> ExactBody:
    return replace(body, **{key: getattr(body, key) + by for key, by in change.items()}).afloat()


def moved(rig: ExactRig, by: float) -> ExactRig:
    """The midpoint by so much ahead on the model: what is the model's own lies further aft."""
    body = rig.body
    ahead = body.cg_x_m - by
    own = body.inertia_kg_m2 + body.mass_kg * (ahead**2 - body.cg_x_m**2)
    return replace(
        held(rig, ahead_m=-by), body=replace(body, cg_x_m=ahead, inertia_kg_m2=own).afloat()
    )


RIGS: dict[str, Callable[[ExactRig, float], ExactRig]] = {
    "half_spacing_m": lambda one, by: replace(one, half_spacing_m=one.half_spacing_m + by),
    "speed_m_s": lambda one, by: replace(one, speed_m_s=one.speed_m_s + by),
    "frequency_relative": lambda one, by: replace(one, frequency_hz=one.frequency_hz * (1.0 + by)),
    "alignment_rad": lambda one, by: held(replace(one, drift_rad=one.drift_rad + by)),
    "midpoint_x_m": moved,
    "mass_kg": lambda one, by: replace(one, body=heavier(one.body, mass_kg=by)),
    "cg_x_m": lambda one, by: replace(one, body=heavier(one.body, cg_x_m=by)),
    "cg_z_m": lambda one, by: replace(
        one, body=heavier(one.body, cg_across_m=by if one.plane is Plane.VERTICAL else 0.0)
    ),
    "inertia_kg_m2": lambda one, by: replace(one, body=heavier(one.body, inertia_kg_m2=by)),
    "restoring_relative": lambda one, by: held(one, 1.0 + by),
    "density_relative": lambda one, by: held(one, 1.0 + by),
}


def responding(**responses: Callable[[float], complex]) -> Chain:
    """A chain whose channels' phasors are turned and stretched, by their angular frequency."""

    def chain(struts: StrutCycle) -> StrutCycle:
        omega = 2.0 * np.pi * struts.frequency_hz
        factors = []
        for label in struts.phasors.names:
            name, order = label.split()
            one = responses.get(name, lambda _: 1.0)
            factors.append(one(omega * int(order)))
        return replace(struts, phasors=struts.phasors.mapped(np.diag(factors)))

    return chain


def turned(by: float) -> Chain:
    """The fore strut's phase at the fundamental, whose multiples its harmonics have."""

    def chain(struts: StrutCycle) -> StrutCycle:
        omega = 2.0 * np.pi * struts.frequency_hz
        return responding(displacement_fore=lambda own: np.exp(1j * by * own / omega))(struts)

    return chain


def talking(reads: str, of: str, by: float) -> Chain:
    def chain(struts: StrutCycle) -> StrutCycle:
        whole = np.eye(len(struts.phasors.names))
        for n in range(struts.orders + 1):
            row, column = (struts.phasors.index(f"{name} {n}") for name in (reads, of))
            whole[row, column] = by
        return replace(struts, phasors=struts.phasors.mapped(whole))

    return chain


def late(by: float) -> Callable[[float], complex]:
    return lambda omega: complex(np.exp(-1j * omega * by))


CHAINS: dict[str, Callable[[float], Chain]] = {
    "amplitude_relative": lambda by: responding(
        displacement_aft=lambda _: 1.0 + by, displacement_fore=lambda _: 1.0 + by
    ),
    "strut_phase_rad": turned,
    "lag_s": lambda by: responding(force_aft=late(by), force_fore=late(by)),
    "latency_s": lambda by: responding(displacement_aft=late(by), displacement_fore=late(by)),
    "skew_s": lambda by: responding(force_fore=late(by)),
    "force_gain_relative": lambda by: responding(
        force_aft=lambda _: 1.0 + by, force_fore=lambda _: 1.0 + by
    ),
    "gauge_aft_relative": lambda by: responding(force_aft=lambda _: 1.0 + by),
    "gauge_fore_relative": lambda by: responding(force_fore=lambda _: 1.0 + by),
    "surge_gauge_relative": lambda by: responding(force_x=lambda _: 1.0 + by),
    "cross_talk_aft": lambda by: talking("force_aft", "force_fore", by),
    "cross_talk_fore": lambda by: talking("force_fore", "force_aft", by),
}
EVERY = [
    pytest.param(plane, arrangement, id=f"{plane}-{arrangement.joint}")
    for plane in Plane
    for arrangement in ARRANGEMENTS
]


def of_budget(name: str, rigs: Rigs) -> np.ndarray:
    """The budget's change of each coefficient per unit of a stated quantity."""
    fit = fitted(rigs, rigs, StatedUncertainties(**{name: 1.0}))
    found = [one.dense(len(fit.values))[:, 0] for one in fit.uncertain.contributions]
    return found[0] if found else np.zeros(len(fit.values))


def alike(found: np.ndarray, shown: np.ndarray) -> None:
    """Each coefficient's, within a part of itself and of the errors that go with it."""
    size = np.abs(shown).max()
    sign = np.sign(np.vdot(found, shown)) or 1.0
    np.testing.assert_allclose(sign * found, shown, rtol=1e-4, atol=1e-5 * size + 1e-6)


def test_all_that_can_be_stated_is_held() -> None:
    of_heel = {"heel_rad", "roll_gauge_relative"}  # test_heel_against_point_masses.py
    of_circles = {"turn_rate_relative", "turn_radius_m"}  # test_steady_turns_against_newton.py
    of_paths = {"speed_age_s"}  # test_age_of_a_speed_against_later_ones.py
    assert {*RIGS, *CHAINS, *of_heel, *of_circles, *of_paths} == set(STATED)


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", RIGS)
@pytest.mark.parametrize(("plane", "arrangement"), EVERY)
def test_a_rig_that_is_otherwise(name: str, plane: Plane, arrangement: Arrangement) -> None:
    rigs, by = nominal(plane, arrangement), 1e-4
    more, less = (
        fitted([RIGS[name](one, step) for one in rigs], rigs).values for step in (by, -by)
    )
    alike(of_budget(name, rigs), (more - less) / (2.0 * by))


@pytest.mark.sample(2)
@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.parametrize(("plane", "arrangement"), EVERY)
def test_a_chain_that_errs(name: str, plane: Plane, arrangement: Arrangement) -> None:
    rigs, by = nominal(plane, arrangement), 1e-5
    more, less = (fitted(rigs, rigs, chain=CHAINS[name](step)).values for step in (by, -by))
    alike(of_budget(name, rigs), (more - less) / (2.0 * by))
