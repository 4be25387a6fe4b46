"""A run that a fit of several does not agree with, against fits made without it, and chance."""

from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.cycle_fit import CycleFit
from analysis.coefficients.linear_fit import linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.run_agreement import run_agreement, run_flags
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from benchmarks.coefficients_campaigns import RESTORING, VERTICAL, Made, Scatter, made_up
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint

HEAVE = Made(VERTICAL, Plane.VERTICAL, orders=1, restoring=RESTORING)
AMPLITUDES = (0.01, 0.015, 0.02, 0.02, 0.025, 0.03)


def runs(generator: np.random.Generator, scatter_n: float = 0.035) -> list[BodyCycle]:
    scatter = Scatter(motion_m=1e-6, force_n=scatter_n)
    found = []
    for k, amplitude in enumerate(AMPLITUDES):
        one = made_up(SetPoint(0.8, amplitude), HEAVE, "heave", generator, scatter)
        own = replace(one.phasors.real.contributions[0], label=f"s {k}")
        real = replace(one.phasors.real, contributions=(own,))
        found.append(replace(one, name=f"run {k}", phasors=replace(one.phasors, real=real)))
    return found


def turned(cycle: BodyCycle, factor: complex) -> BodyCycle:
    """Return a run whose loads are off by a factor (a gain, a lag)."""
    factors = np.ones(len(cycle.phasors.names), dtype=complex)
    for place, name in enumerate(cycle.phasors.names):
        if name.split()[0] in ("force", "moment"):
            factors[place] = factor
    return replace(cycle, phasors=cycle.phasors.mapped(np.diag(factors)))


def solved(cycles: list[BodyCycle]) -> CycleFit:
    return linear_fit(cycles, Form.SEAKEEPING, StatedUncertainties()).fit


def test_a_run_that_is_off_is_named_with_the_coefficients_without_it() -> None:
    cycles = runs(np.random.default_rng(1))
    cycles[5] = turned(cycles[5], 1.02)
    fit = solved(cycles)
    found = run_agreement(fit, 0)
    assert found.stands_out == ("run 5",)
    assert found.chi_squared == fit.chi_square[0]
    others = solved(cycles[:5])
    own = [name in found.results for name in others.names]
    assert found.without[5] == pytest.approx(others.values[own], rel=2e-3)
    (flag,) = (one for one in run_flags(fit) if one.message.startswith("force"))
    assert flag.code == "data_disagree"
    assert flag.runs == ("run 5",)
    assert "without it a33" in flag.message.lower()


@pytest.mark.slow
def test_clean_runs_name_none() -> None:
    generator, named = np.random.default_rng(2), 0
    for _ in range(100):
        named += bool(list(run_flags(solved(runs(generator)))))
    assert named <= 4  # two loads of a hundredth each


def test_residuals_of_rounding_are_no_disagreement() -> None:
    cycles = runs(np.random.default_rng(3), scatter_n=1e-12)
    assert list(run_flags(solved(cycles))) == []


def test_two_runs_cannot_tell_which() -> None:
    cycles = runs(np.random.default_rng(4))[:2]
    cycles[1] = turned(cycles[1], 1.1)
    assert run_agreement(solved(cycles), 0).stands_out == ()
