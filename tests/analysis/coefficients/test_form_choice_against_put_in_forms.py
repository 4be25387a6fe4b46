"""The form that was put in is named where the data tell it, and is left open where they do not."""

import numpy as np
import pytest

from analysis.coefficients.campaign import campaign_coefficients
from analysis.coefficients.campaign_plan import Request
from analysis.coefficients.form_choice import (
    BOTH,
    CUBIC,
    DECIDES,
    LINEAR_FORM,
    NOT_SEPARABLE,
    QUADRATIC,
    choose_form,
    forms_of,
)
from analysis.coefficients.recommendation import recommended
from benchmarks.coefficients_campaigns import HORIZONTAL, Made, amplitudes, made_up
from hardware.description.oscillator import Plane

LINEAR = {name: HORIZONTAL[name] for name in ("Y_vdot", "Y_v", "N_vdot", "N_v")}


def choice(extra: dict[str, float], sizes: slice = slice(0, 3), seed: int = 1):  # type: ignore[no-untyped-def]
    generator = np.random.default_rng(seed)
    made = Made(LINEAR | extra)
    return choose_form([made_up(p, made, n, generator) for n, p in amplitudes()[sizes]], 0)[0]


@pytest.mark.parametrize(
    ("extra", "form"),
    [
        ({"Y_vvv": -900.0}, CUBIC),
        ({"Y_v|v|": -250.0}, QUADRATIC),
        ({"Y_vvv": -900.0, "Y_v|v|": -250.0}, BOTH),
        ({}, LINEAR_FORM),
    ],
)
def test_what_was_put_in_is_named(extra: dict[str, float], form: str) -> None:
    found = choice(extra)
    assert found.verdict == form
    assert found.forms[0] == form
    assert sum(found.weights) == pytest.approx(1.0)
    assert len(found.runs) == 3


def test_a_weak_term_is_not_separable() -> None:
    found = choice({"Y_vvv": -30.0})
    assert found.verdict == NOT_SEPARABLE
    assert found.evidence_ratio < DECIDES
    assert "take a larger range of amplitudes" in found.message


def test_loads_that_no_form_describes_are_said_to_be_so() -> None:
    found = choice({"Y_vvvvv": -9000.0})
    assert found.dispersion > 3.0
    assert "no form describes these runs" in found.message
    assert choice({"Y_vvv": -900.0}).dispersion < 3.0


def test_forms_hold_cross_terms_only_where_runs_move_in_both() -> None:
    pure = forms_of(Plane.HORIZONTAL, 0, "v")
    assert pure[CUBIC] == ("Y_vdot", "Y_v", "Y_vvv")
    both = forms_of(Plane.VERTICAL, 1, "vr")
    assert both[QUADRATIC][-4:] == ("M_w|w|", "M_q|q|", "M_w|q|", "M_q|w|")
    assert forms_of(Plane.VERTICAL, 1, "vr", cross=False)[CUBIC][-2:] == ("M_www", "M_qqq")


@pytest.mark.parametrize("cubic", [0.0, -10.0])
def test_intervals_hold_the_linear_value_beside_a_curvature_that_is_not_seen(cubic: float) -> None:
    """Most of these campaigns are found linear; without what cubic gives half would miss."""
    held, verdicts = [], []
    for seed in range(20):
        generator = np.random.default_rng(seed)
        made = Made(LINEAR | ({"Y_vvv": cubic} if cubic else {}))
        cycles = [made_up(point, made, name, generator) for name, point in amplitudes()[:3]]
        found = campaign_coefficients(cycles, Request(trials=0))
        row = next(k for k in recommended(found) if found.entries[k].name == "Y_v")
        off = abs(found.values[row] - LINEAR["Y_v"])
        held.append(off <= found.uncertain.half_width(0.95)[row])
        verdicts += [one.verdict for one in found.choices if one.load == "force"]
    assert verdicts.count(LINEAR_FORM) > 10
    assert sum(held) >= 18
