"""What the runs cannot tell is refused by name, and the message says which run it takes."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign import Request, campaign_coefficients
from analysis.coefficients.cycle_fit import FIRST, fit_cycles
from analysis.coefficients.dry_run import without_dry
from analysis.coefficients.linear_fit import LinearFit, lacking_places, linear_fit
from analysis.coefficients.names import Form
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.uncertainty.values import Contribution
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium, SetPoint
from tests.analysis.coefficients.ideal import BODY, ECCENTRICITY_M, SMALL, ideal_struts, net, pair
from tests.analysis.coefficients.sources import of_covariance, scattering

HEAVE = SetPoint(0.8, ECCENTRICITY_M, 0.0, 1.2)


def run(
    set_point: SetPoint = HEAVE, name: str = "heave-0.8", plane: Plane = Plane.VERTICAL
) -> BodyCycle:
    return net(ideal_struts(set_point, plane, name=name))


def solve(cycles: list[BodyCycle], form: Form = Form.SEAKEEPING) -> LinearFit:
    return linear_fit(cycles, form, StatedUncertainties())


def test_heave_only_then_asking_for_a55() -> None:
    message = dict(lacking_places([run()], Form.SEAKEEPING))["a55"]
    assert "a55 cannot be determined from heave-0.8" in message
    assert "pitch there is 0 % of heave" in message
    assert "add a run in pitch at 0.8 Hz and 1.2 m/s" in message
    assert "180 deg" in message
    assert solve([run()]).fit.names == ("a33", "b33", "a53", "b53")
    with pytest.raises(DataError, match=r"a55 cannot be determined from heave-0\.8"):
        campaign_coefficients([run()], Request(Form.SEAKEEPING, wanted=("a33", "a55")))


def test_derivatives_of_pitch_need_the_phase_without_incidence() -> None:
    phase = math.degrees(2.0 * math.atan(2.0 * math.pi * 0.8 * 0.5 / 1.2))
    assert (
        f"strut phase of {phase:.4g} deg" in dict(lacking_places([run()], Form.MANOEUVRING))["M_q"]
    )


def test_pitch_about_the_midpoint_at_speed_tells_no_derivative_alone() -> None:
    pitch = run(replace(HEAVE, strut_phase_rad=math.pi), "pitch")
    with pytest.raises(DataError, match="w and q go together"):
        solve([pitch], Form.MANOEUVRING)
    assert set(solve([pitch]).fit.names) == {"a35", "b35", "a55", "b55"}
    assert len(solve([pitch, run()], Form.MANOEUVRING).fit.names) == 8


def test_runs_with_the_same_phase_tell_nothing_apart() -> None:
    mixed = [run(replace(HEAVE, strut_phase_rad=1.0), name) for name in ("one", "two")]
    with pytest.raises(DataError, match="go together"):
        solve(mixed)


def test_unknown_names_get_the_nearest() -> None:
    with pytest.raises(ConfigurationError, match=r"no seakeeping coefficient 'a34'.*a33"):
        campaign_coefficients([run()], Request(Form.SEAKEEPING, wanted=("a34",)))
    with pytest.raises(ConfigurationError, match="known: Y_vdot"):
        campaign_coefficients([run(plane=Plane.HORIZONTAL)], Request(wanted=("Z_w",)))


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (run(), "two runs are called 'heave-0.8'"),
        (run(plane=Plane.HORIZONTAL, name="x"), "x is horizontal"),
        (replace(run(name="x"), half_spacing_m=0.6), "x has half_spacing_m = 0.6"),
        (run(replace(HEAVE, medium=Medium.AIR), "x"), "x was run in air"),
        (replace(run(name="x"), frequency_hz=0.0), "x is static and tells through its mean"),
    ],
)
def test_runs_that_do_not_belong_together(other: BodyCycle, words: str) -> None:
    with pytest.raises(ConfigurationError, match=words):
        fit_cycles([run(), other], ("Z_w",), FIRST)


def test_values_that_are_not_finite_are_refused() -> None:
    broken = run()
    bad = scattering(broken.phasors, values=broken.phasors.values * np.nan)
    with pytest.raises(ConfigurationError, match="not finite"):
        fit_cycles([replace(broken, phasors=bad)], ("Z_w",), FIRST)
    with pytest.raises(ConfigurationError, match="no run was given"):
        fit_cycles([], ("Z_w",), FIRST)


def test_a_dry_run_that_is_not_one() -> None:
    wet = replace(run(), body=None)
    dry = net(ideal_struts(replace(HEAVE, medium=Medium.AIR), name="dry"))
    assert without_dry(wet, dry).flags[-1].code == "dry_run_taken_off"
    with pytest.raises(ConfigurationError, match="must not be, again"):
        without_dry(wet, dry).without(BODY)
    with pytest.raises(ConfigurationError, match="run in water"):
        without_dry(wet, wet)
    with pytest.raises(ConfigurationError, match="inertia is taken off as well"):
        without_dry(run(), dry)
    pitch = SetPoint(0.8, ECCENTRICITY_M, math.pi, medium=Medium.AIR)
    with pytest.raises(ConfigurationError, match="same set-point"):
        without_dry(wet, net(ideal_struts(pitch, name="dry pitch")))


def test_a_run_without_scatter_gives_values_and_no_interval() -> None:
    single = run()
    size = 2 * len(single.phasors.values)
    source = Contribution("scatter", 0.0, np.arange(size), np.full((size, 1), np.nan))
    phasors = scattering(single.phasors, source)
    result = solve([replace(single, phasors=phasors)])
    assert result.fit["a33"] == pytest.approx(75.0)
    assert np.isnan(result.fit.uncertain.half_width()).all()
    assert "no_interval" in {flag.code for flag in result.flags}


def test_runs_that_disagree_are_flagged() -> None:
    spread = {"across": 5e-7, "rotation": 1e-7, "force": 0.05, "moment": 0.05}
    runs = []
    for k, point in enumerate((*pair(), HEAVE)):
        one = run(point, f"{k}")
        size = [SMALL * spread.get(name.removesuffix(" 1"), 0.0) for name in one.phasors.names]
        source = of_covariance(f"scatter of {k}", np.diag(np.repeat(size, 2)) ** 2, 9.0)
        runs.append(replace(one, phasors=scattering(one.phasors, source)))
    good = solve(runs)
    assert good.misfit < 0.1
    assert "runs_disagree" not in {flag.code for flag in good.flags}
    names = runs[2].phasors.names
    off = runs[2].phasors.mapped(np.diag([1.02 if n == "force 1" else 1.0 for n in names]))
    bad = solve([*runs[:2], replace(runs[2], phasors=off)])
    assert bad.misfit > 3.0
    assert "runs_disagree" in {flag.code for flag in bad.flags}


def test_a_little_of_the_other_motion_is_said() -> None:
    leaning = run(replace(HEAVE, strut_phase_rad=0.006))
    codes = {flag.code for flag in solve([leaning]).flags}
    assert "other_motion_left_out" in codes
    with pytest.raises(DataError, match="go together"):
        solve([run(replace(HEAVE, strut_phase_rad=0.1))])
