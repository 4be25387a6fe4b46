"""One value a coefficient: the one that was put in, and no form that the data do not ask for."""

import numpy as np
import pytest

from analysis.coefficients.campaign import Request, campaign_coefficients
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.form_choice import DECIDES, LINEAR_FORM, NOT_SEPARABLE, choose_form
from analysis.coefficients.names import Form
from analysis.coefficients.recommendation import recommended
from benchmarks.coefficients_campaigns import (
    CUBIC,
    HORIZONTAL,
    RESTORING,
    VERTICAL,
    Made,
    amplitudes,
    made_up,
    pure_pair,
)
from hardware.description.oscillator import Plane

FREQUENCIES_HZ = (0.25, 0.35)


def campaign(truth: dict[str, float], seed: int) -> CampaignCoefficients:
    generator = np.random.default_rng(seed)
    cycles = [
        made_up(point, Made(truth), f"{name} {f}", generator)
        for f in FREQUENCIES_HZ
        for name, point in amplitudes(frequency_hz=f)
    ]
    return campaign_coefficients(cycles, Request())


@pytest.mark.slow
@pytest.mark.parametrize("truth", [HORIZONTAL, {**HORIZONTAL, **CUBIC}])
def test_each_coefficient_has_one_value_and_it_is_the_one_put_in(truth: dict[str, float]) -> None:
    inside = []
    for seed in (1, 2):
        found = campaign(truth, seed)
        names = [found.entries[k].name for k in recommended(found)]
        assert len(names) == len(set(names))
        assert set(HORIZONTAL) <= set(names) <= set(truth)  # nothing that was not put in
        assert all(found.entries[k].runs for k in recommended(found))
        for k in recommended(found):
            off = abs(found.values[k] - truth[found.entries[k].name])
            inside.append(off <= found.half_widths[k])
    assert np.mean(inside) > 0.85  # intervals of 95 %


@pytest.mark.slow
def test_a_cubic_campaign_that_the_fit_explains_has_no_disagreement() -> None:
    found = campaign({**HORIZONTAL, **CUBIC}, 1)
    assert len(found.checks) > 20
    assert all(check.agrees for check in found.checks)
    assert not [check for check in found.checks if check.kind == "two tests"]


def test_a_form_is_taken_at_its_evidence_and_linear_below_it() -> None:
    """Terms from none to plain: below the threshold the fit is linear, above it is not."""
    fitted = {}
    for seed, put_in in enumerate((0.0, -8.0, -15.0, -30.0, -60.0, -900.0)):
        generator = np.random.default_rng(seed)
        made = Made({**HORIZONTAL, "Y_vvv": put_in})
        cycles = [made_up(p, made, n, generator) for n, p in amplitudes()[:3]]
        choice, _ = choose_form(cycles, 0)
        linear = choice.aicc[choice.forms.index(LINEAR_FORM)]
        evidence = np.exp(min((linear - min(choice.aicc)) / 2.0, 700.0))
        assert (choice.fitted == LINEAR_FORM) == (evidence < DECIDES), (put_in, evidence)
        fitted[put_in] = choice.fitted
    assert fitted[0.0] == LINEAR_FORM
    assert fitted[-900.0] != LINEAR_FORM


@pytest.mark.slow
def test_what_an_undecided_form_leaves_open_is_in_the_intervals() -> None:
    """Where cubic and quadratic do as well, the linear term lies in an interval that holds both."""
    truth = {**HORIZONTAL, "Y_vvv": -60.0}
    for seed in range(12):
        found = campaign(truth, seed)
        choices = [one for one in found.choices if one.load == "force"]
        open_ones = [
            one for one in choices
            if one.verdict == NOT_SEPARABLE and one.fitted != LINEAR_FORM
        ]  # fmt: skip
        if len(open_ones) == len(choices):
            break
    assert open_ones
    names = [found.entries[k].name for k in recommended(found)]
    assert not [name for name in names if name not in HORIZONTAL]  # no term of a form in doubt
    k = next(k for k in recommended(found) if found.entries[k].name == "Y_v")
    assert any(source.startswith("form of the force") for source in found.uncertain.shares(k))
    assert abs(found.values[k] - HORIZONTAL["Y_v"]) <= found.half_widths[k]


def test_a_coefficient_of_the_seakeeping_form_belongs_to_its_frequency() -> None:
    made = Made(VERTICAL, Plane.VERTICAL, restoring=RESTORING)
    generator = np.random.default_rng(3)
    cycles = [
        made_up(point, made, f"{kind} {f}", generator)
        for f in (0.4, 0.8)
        for kind, point in zip(("heave", "pitch"), pure_pair(f, 0.02, 0.0), strict=True)
    ]
    found = campaign_coefficients(cycles, Request(Form.SEAKEEPING))
    told = [(found.entries[k].name, found.entries[k].frequency_hz) for k in recommended(found)]
    assert sorted(told) == sorted(
        (letter + place, f) for letter in "ab" for place in ("33", "35", "53", "55")
        for f in (0.4, 0.8)
    )  # fmt: skip
