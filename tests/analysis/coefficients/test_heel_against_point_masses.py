"""Terms of heel and roll from the cycles of point masses that Newton's law moves, exact."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import campaign_coefficients
from analysis.coefficients.campaign_plan import Request
from analysis.coefficients.campaign_records import HIGHER_ORDER
from analysis.coefficients.cycle_fit import fit_cycles
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.stated_uncertainties import STATED, StatedUncertainties
from analysis.coefficients.strut_cycle import StrutCycle
from hardware.description.body import Body
from hardware.description.errors import DataError
from hardware.description.heel import Heel, HeelGauges, RollConstraint
from hardware.description.oscillator import HORIZONTAL_1963
from hardware.description.setpoint import SetPoint
from tests.exact.heeled import HeeledModel, HeeledRun
from tests.exact.run import harmonics

TERMS = {
    "X_0": -5.0, "X_phiphi": -6.0, "X_vphi": 7.0, "X_vr": 30.0, "X_vv": -9.0,
    "Y_vdot": -60.0, "Y_v": -120.0, "Y_rdot": -3.0, "Y_r": 25.0, "Y_vvv": -300.0,
    "Y_phi": 6.0, "Y_vphiphi": 90.0,
    "N_vdot": -4.0, "N_v": -45.0, "N_rdot": -18.0, "N_r": -30.0, "N_phi": -4.0, "N_rrphi": 20.0,
    "K_vdot": 6.0, "K_v": 18.0, "K_rdot": 1.0, "K_r": -5.0, "K_phi": -3.0, "K_vvphi": -40.0,
}  # fmt: skip
ROLLING = {"Y_p": 3.0, "Y_pdot": 5.0, "N_p": 0.7, "K_p": -2.5, "K_pdot": -0.8}
MASSES = np.array([20.0, 15.0, 15.0, 12.0, 8.0, 8.0])
PLACES = np.array([
    [1.0, 0.0, 0.05], [-0.9, 0.15, 0.02], [-0.9, -0.15, 0.02],
    [0.1, 0.0, 0.12], [0.4, 0.2, -0.1], [0.4, -0.2, -0.1],
])  # fmt: skip
FREQUENCY_HZ, SPEED_M_S, ORDERS, ANGLES = 0.25, 1.5, 7, 128
GM_M, BM_M = 0.03, 0.06


def exact_model(terms: dict[str, float]) -> HeeledModel:
    return HeeledModel(MASSES, PLACES, terms, GM_M, BM_M)


def body_and_heel(held: RollConstraint, gauges: HeelGauges) -> tuple[Body, Heel]:
    model = exact_model({})
    mass = model.integral(0, 0, 0)
    body = Body(mass, model.integral(2, 0, 0) + model.integral(0, 2, 0),
                model.integral(1, 0, 0) / mass, model.integral(0, 0, 1) / mass)  # fmt: skip
    width, height = model.integral(0, 2, 0), model.integral(0, 0, 2)
    return body, Heel(
        held, gauges, width + height, model.integral(1, 0, 1), width - height, GM_M, BM_M
    )


UNITS = {"displacement": "m", "force": "N", "roll": "N m", "heel": "rad"}


def cycle(
    name: str,
    *given: Any,
    held: RollConstraint = RollConstraint.SET,
    gauges: HeelGauges = HeelGauges.UPRIGHT,
    **more: Any,
) -> BodyCycle:
    """The averaged cycle of one run, inertia and weight to be taken off."""
    body, own = body_and_heel(held, gauges)
    struts = struts_of(name, *given, gauges=gauges, **more)
    return struts.heeled(own).model().without(body)


def struts_of(
    name: str,
    terms: dict[str, float],
    amplitude_m: float,
    phase: float,
    heel: tuple[float, complex] = (0.0, 0j),
    *,
    drift: float = 0.0,
    gauges: HeelGauges = HeelGauges.UPRIGHT,
    roll_gauge: bool = True,
    stated_heel: float = 0.0,
) -> StrutCycle:
    """What the gauges of one run read over its cycle, tared at its heel at rest."""
    half, omega = HORIZONTAL_1963.half_spacing_m, 2.0 * np.pi * FREQUENCY_HZ
    rest, wave = heel

    def strut(by: float):
        return lambda time: amplitude_m * np.sin(omega * time + by)

    def rolled(time):
        return rest + abs(wave) * np.sin(omega * time + np.angle(wave)) + 0.0 * np.asarray(time)

    run = HeeledRun(exact_model(terms), strut(0.0), strut(phase), half, SPEED_M_S, drift, rolled)
    time = np.arange(ANGLES) / (ANGLES * FREQUENCY_HZ)
    x, y, n, k = run.struts(time)
    k = k - float(run.model.righting(rest))  # type: ignore[arg-type]
    lever = 2.0 * half / np.cos(run.heading(time) - drift)  # type: ignore[operator]
    fore = (n + half * y) / lever
    read = np.cos(rolled(time)) if gauges is HeelGauges.HEELED else 1.0
    rows = {
        "displacement_aft": run.aft(time), "displacement_fore": run.fore(time),
        "force_aft": (y - fore) * read, "force_fore": fore * read, "force_x": x,
        "roll_moment": k, "heel_angle": rolled(time) - rest,
    }  # fmt: skip
    if not roll_gauge:
        del rows["roll_moment"]
    found = harmonics(np.stack(list(rows.values())), ORDERS)
    names = tuple(f"{one} {order}" for order in range(ORDERS + 1) for one in rows)
    units = tuple(UNITS[one.split("_")[0]] for one in names)
    phasors = Phasors.of(names, units, found.ravel())
    point = SetPoint(FREQUENCY_HZ, amplitude_m, phase, SPEED_M_S, drift_rad=drift,
                     heel_rad=rest + stated_heel)  # fmt: skip
    return StrutCycle(name, HORIZONTAL_1963, point, FREQUENCY_HZ, phasors, ORDERS, True)


# Heel, amplitude, strut phase and drift: sway, yaw and mixed motions, upright and heeled.
MATRIX = tuple(
    (heel, *motion)
    for heel in (-0.2, 0.0, 0.1)
    for motion in ((0.2, 0.0, 0.0), (0.12, 2.2, 0.0), (0.22, 2.2, 0.1), (0.2, 1.0, -0.15))
)


def matrix(terms: dict[str, float], **more: Any) -> list[BodyCycle]:
    return [
        cycle(str(one), terms, one[1], one[2], (one[0], 0j), drift=one[3], **more) for one in MATRIX
    ]


@pytest.mark.parametrize("gauges", list(HeelGauges))
def test_terms_of_a_set_heel_come_back(gauges: HeelGauges) -> None:
    fit = fit_cycles(matrix(TERMS, gauges=gauges), tuple(TERMS), (0, 1, 2, 3))
    for name, value in TERMS.items():
        assert fit[name] == pytest.approx(value, rel=1e-5, abs=1e-4), name


def test_terms_of_a_model_that_rolls_come_back() -> None:
    every = TERMS | ROLLING
    waves = [(0.05, 0.1 + 0.05j), (-0.1, 0.08j), (0.0, -0.12 + 0j), (0.1, 0.03 - 0.1j)]
    motions = ((0.2, 0.0), (0.15, 2.2), (0.22, 2.2), (0.2, 1.0))
    runs = [
        cycle(f"{k} {amplitude} {phase}", every, amplitude, phase, heel, held=RollConstraint.FREE)
        for k, heel in enumerate(waves)
        for amplitude, phase in motions
    ]
    fit = fit_cycles(runs, tuple(every), (0, 1, 2, 3))
    for name, value in every.items():
        assert fit[name] == pytest.approx(value, rel=1e-5, abs=1e-4), name


@pytest.mark.slow
def test_a_campaign_tells_them_by_itself() -> None:
    found = campaign_coefficients(matrix(TERMS), Request(wanted=("K_v", "K_r", "Y_vphiphi")))
    for name in ("K_v", "K_r", "K_vdot", "Y_vphiphi", "N_rrphi", "K_vvphi"):
        rows = found.rows(name, method=HIGHER_ORDER)
        assert found.values[rows[0]] == pytest.approx(TERMS[name], rel=0.02, abs=0.05), name
    upright = campaign_coefficients([cycle("sway", TERMS, 0.1, 0.0), cycle("yaw", TERMS, 0.1, 2.2)])
    (row,) = upright.rows("K_v")
    assert upright.values[row] == pytest.approx(TERMS["K_v"], rel=0.01)


@pytest.mark.slow
def test_without_a_roll_gauge_a_sentence_says_so() -> None:
    runs = matrix(TERMS, roll_gauge=False)
    with pytest.raises(DataError, match="a missing roll gauge: K terms need the channel roll_mom"):
        fit_cycles(runs, ("K_v",), (1,))
    with pytest.raises(DataError, match="a missing roll gauge"):
        campaign_coefficients(runs, Request(wanted=("K_v",)))
    across = fit_cycles(runs, [name for name in TERMS if name[0] == "Y"], (0, 1, 2, 3))
    assert across["Y_phi"] == pytest.approx(TERMS["Y_phi"], rel=1e-5)
    bare = []
    for one in runs:
        names = [name for name in one.phasors.names if "heel" not in name]
        kept = replace(one, phasors=one.phasors.select(names), heel=None)
        bare.append(replace(kept, sensitivity=np.zeros((0, len(STATED)))))
    with pytest.raises(DataError, match=r"Y_phi: these runs have no heel; state \[heel\]"):
        fit_cycles(bare, ("Y_v", "Y_phi"), (0, 1))


def test_a_heel_that_was_set_wrong_moves_what_its_uncertainty_says() -> None:
    off = 2e-3
    stated = StatedUncertainties(heel_rad=off)
    names = [name for name in TERMS if name[0] in "YK"]
    right = fit_cycles(matrix(TERMS), names, (0, 1, 2, 3), stated=stated)
    wrong = fit_cycles(matrix(TERMS, stated_heel=off), names, (0, 1, 2, 3))
    moved = wrong.values - right.values
    told = right.uncertain.standard_uncertainty
    allowed = 0.1 * told + 2e-3 * np.abs(right.values)
    assert (np.abs(np.abs(moved) - told) < allowed).all()
    assert told[names.index("K_phi")] > 0.0
