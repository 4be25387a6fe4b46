"""Numbers of the gap report as people read them: no minus before nothing, no interval of a fact."""

import math

import pytest

from pmm.document.notation import NOT_KNOWN, percent
from pmm.gap.sizes import SpoiledCoefficient
from pmm.gap.tables import ControlRow, interval, parameters, shrinks
from tests.pmm.gap.rigs import run


def control(share: float, low: float, high: float, before: float = 10.0) -> tuple[str, str]:
    one = ControlRow("any", before, before * (1.0 - share), share, low, high)
    return shrinks(one), interval(one)


def test_a_share_that_rounds_to_nothing_has_no_sign() -> None:
    assert control(-0.003, -0.004, 0.002) == ("0 %", "0 to 0 %")
    assert control(-0.02, -0.09, 0.15) == ("-2 %", "-9 to 15 %")
    assert percent("z.1f")(-0.0004) == "0.0 %"


def test_what_is_not_known_is_a_dash() -> None:
    assert control(0.5, math.nan, math.nan) == ("50 %", NOT_KNOWN)
    assert control(0.0, 0.0, 0.0, before=0.0) == (NOT_KNOWN, NOT_KNOWN)


@pytest.mark.parametrize(
    ("per_cent", "said"),
    [(412.3, "+410 %"), (-0.0312, "-0.031 %"), (11.7, "+12 %"), (-1823.0, "-18 times its value")],
)
def test_by_how_much_a_coefficient_is_off_has_no_power_of_ten(per_cent: float, said: str) -> None:
    assert SpoiledCoefficient("M_q", per_cent).percentage == said


def test_a_parameter_that_is_held_has_no_interval() -> None:
    held = {
        "force_n": {"value": 0.30126, "low": 0.3, "high": 0.3025},
        "since_zero_s": {"value": 1800.0, "low": 1800.0, "high": 1800.0},
    }
    assert parameters([{"name": "any", "parameters": held}]) == [
        "force_n = 0.3013 (0.3 to 0.3025)",
        "since_zero_s = 1800",
    ]


@pytest.mark.parametrize("command", ["diagnose", "add", "answer"])
def test_default_and_range_of_an_option_stand_in_one_bracket(command: str) -> None:
    said = " ".join(run("gap", command, "--help").stdout.split())
    (jobs,) = [one for one in said.split(" --") if one.startswith("jobs ")]
    assert jobs.count("[") == 1
    assert "; x>=1]" in jobs
