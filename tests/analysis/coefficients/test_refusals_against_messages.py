"""What the runs cannot tell is refused by name, and the message says which run it takes."""

import math
from dataclasses import replace

import numpy as np
import pytest

from analysis.coefficients.names import Form
from analysis.coefficients.phasors import Phasors, Source
from analysis.coefficients.run import Run
from analysis.coefficients.solve import solve
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import Medium, SetPoint
from tests.analysis.coefficients.ideal import BODY, ideal_struts, net, pair

HEAVE = SetPoint(0.8, 0.02, 0.0, 1.2)


def run(set_point: SetPoint = HEAVE, name: str = "heave-0.8", plane: Plane = Plane.VERTICAL) -> Run:
    return net(ideal_struts(set_point, plane, name=name))


def test_heave_only_then_asking_for_a55() -> None:
    with pytest.raises(DataError) as caught:
        solve([run()], wanted=["a33", "a55"])
    message = str(caught.value)
    assert "a55 cannot be determined from heave-0.8" in message
    assert "pitch there is 0 % of heave" in message
    assert "add a run in pitch at 0.8 Hz and 1.2 m/s" in message
    assert "180 deg" in message
    with pytest.raises(DataError, match=r"a55 was not determined by heave-0\.8"):
        solve([run()])["a55"]


def test_derivatives_of_pitch_need_the_phase_without_incidence() -> None:
    phase = math.degrees(2.0 * math.atan(2.0 * math.pi * 0.8 * 0.5 / 1.2))
    with pytest.raises(DataError, match=f"strut phase of {phase:.4g} deg"):
        solve([run()], Form.MANOEUVRING, wanted=["M_q"])


def test_pitch_about_the_midpoint_at_speed_tells_no_derivative_alone() -> None:
    pitch = run(replace(HEAVE, strut_phase_rad=math.pi), "pitch")
    with pytest.raises(DataError, match="w and q go together"):
        solve([pitch], Form.MANOEUVRING)
    assert solve([pitch]).names == ("a35", "b35", "a55", "b55")
    assert len(solve([pitch, run()], Form.MANOEUVRING).names) == 8


def test_runs_with_the_same_phase_tell_nothing_apart() -> None:
    mixed = [run(replace(HEAVE, strut_phase_rad=1.0), name) for name in ("one", "two")]
    with pytest.raises(DataError, match="go together"):
        solve(mixed)


def test_unknown_names_get_the_nearest() -> None:
    with pytest.raises(ConfigurationError, match=r"no seakeeping coefficient 'a34'.*a33"):
        solve([run()], wanted=["a34"])
    with pytest.raises(ConfigurationError, match="known: Y_vdot"):
        solve([run(plane=Plane.HORIZONTAL)], Form.MANOEUVRING, wanted=["Z_w"])


@pytest.mark.parametrize(
    ("other", "words"),
    [
        (run(), "two runs are called 'heave-0.8'"),
        (run(SetPoint(0.9, 0.02, 0.0, 1.2), "x"), "x moves at 0.9 Hz, heave-0.8 at 0.8 Hz"),
        (run(SetPoint(0.8, 0.02, 0.0, 1.3), "x"), "x ran at 1.3 m/s, heave-0.8 at 1.2 m/s"),
        (run(plane=Plane.HORIZONTAL, name="x"), "x is horizontal"),
        (replace(run(name="x"), half_spacing_m=0.6), "x has half_spacing_m = 0.6"),
        (run(replace(HEAVE, medium=Medium.AIR), "x"), "x was run in air"),
        (replace(run(name="x"), order=0), "x holds the mean"),
        (run(replace(HEAVE, eccentricity_m=0.0), "x"), "x does not move"),
    ],
)
def test_runs_that_do_not_belong_together(other: Run, words: str) -> None:
    with pytest.raises(ConfigurationError, match=words):
        solve([run(), other])


def test_values_that_are_not_finite_are_refused() -> None:
    broken = run()
    bad = replace(broken.phasors, values=broken.phasors.values * np.nan)
    with pytest.raises(ConfigurationError, match="not finite"):
        solve([replace(broken, phasors=bad)])
    with pytest.raises(ConfigurationError, match="no run was given"):
        solve([])


def test_a_dry_run_that_is_not_one() -> None:
    wet = replace(run(), body=None)
    dry = net(ideal_struts(replace(HEAVE, medium=Medium.AIR), name="dry"))
    assert wet.without_dry(dry).flags[-1].code == "dry_run_taken_off"
    with pytest.raises(ConfigurationError, match="must not be, again"):
        wet.without_dry(dry).without(BODY)
    with pytest.raises(ConfigurationError, match="run in water"):
        wet.without_dry(wet)
    with pytest.raises(ConfigurationError, match="inertia is taken off as well"):
        run().without_dry(dry)
    pitch = SetPoint(0.8, 0.02, math.pi, medium=Medium.AIR)
    with pytest.raises(ConfigurationError, match="same set-point"):
        wet.without_dry(net(ideal_struts(pitch, name="dry pitch")))


def test_a_run_without_scatter_gives_values_and_no_interval() -> None:
    single = run()
    size = 2 * len(single.phasors.values)
    source = Source("scatter", np.full((size, size), np.nan), 0.0)
    phasors: Phasors = replace(single.phasors, sources=(source,))
    result = solve([replace(single, phasors=phasors)])
    assert result["a33"] == pytest.approx(75.0)
    assert np.isnan(result.half_width()).all()
    assert "no_interval" in {flag.code for flag in result.flags}


def test_runs_that_disagree_are_flagged() -> None:
    size = 8
    source = Source("scatter", np.diag(np.repeat([1e-7, 1e-7, 0.05, 0.05], 2)) ** 2, 9.0)
    runs = []
    for k, point in enumerate((*pair(), HEAVE)):
        one = run(point, f"{k}")
        assert len(source.covariance) == size
        runs.append(replace(one, phasors=replace(one.phasors, sources=(source,))))
    good = solve(runs)
    assert good.misfit < 0.1
    assert "runs_disagree" not in {flag.code for flag in good.flags}
    off = runs[2].phasors.mapped(np.diag([1.0, 1.0, 1.02, 1.0]))
    bad = solve([*runs[:2], replace(runs[2], phasors=off)])
    assert bad.misfit > 3.0
    assert "runs_disagree" in {flag.code for flag in bad.flags}


def test_a_little_of_the_other_motion_is_said() -> None:
    leaning = run(replace(HEAVE, strut_phase_rad=0.006))
    codes = {flag.code for flag in solve([leaning]).flags}
    assert "other_motion_left_out" in codes
    with pytest.raises(DataError, match="go together"):
        solve([run(replace(HEAVE, strut_phase_rad=0.1))])
