"""Jobs whose periods are computed from known bodies give these bodies back."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.inertia.bifilar import yaw_period
from analysis.inertia.double_pendulum import mode_periods
from analysis.uncertainty.budget import linear_budget
from analysis.uncertainty.estimate import Estimate
from hardware.description.oscillator import Plane
from pmm.inertia import bifilar, incline, parts, pendulum, plan, swing
from pmm.inertia.outcome import Outcome
from tests.analysis.inertia.paper_formulas import gyradius_about, pendulum_period

G = 9.81
HEAD = "gravity_m_s2 = 9.81\nu_gravity_m_s2 = 0.0005\n"


def write(folder: Path, text: str) -> str:
    path = folder / "job.toml"
    path.write_text(HEAD + text if "gravity" not in text else text)
    return str(path)


def value(outcome: Outcome, name: str) -> float:
    return next(one.estimate.value for one in outcome.findings if one.name == name)


def timed(period_s: float) -> str:
    return f"{{ period_s = {float(period_s)!r}, u_period_s = 1e-5 }}"


def test_a_model_on_the_swing(tmp_path: Path) -> None:
    mass, place, gyradius = 30.0, 0.8, 0.6
    tare_moment, tare_inertia = 3.0, 40.0
    moment = tare_moment + mass * place
    inertia = tare_inertia + mass * (gyradius**2 + place**2)
    tare_s, loaded_s = (
        2.0 * math.pi * math.sqrt(i / (G * s))
        for i, s in ((tare_inertia, tare_moment), (inertia, moment))
    )
    text = f"""
[tare]
mass_kg = 42.0
moment_kg_m = {tare_moment}
u_moment_kg_m = 1e-4
period = {timed(tare_s)}
[loaded]
mass_kg = 72.0
moment_kg_m = {moment}
u_moment_kg_m = 1e-4
period = {timed(loaded_s)}
[model]
mass_kg = {mass}
u_mass_kg = 0.001
cg_x_m = 0.01
pivot_above_midpoint_m = 0.9
"""
    outcome = swing.run(write(tmp_path, text))
    assert value(outcome, "cg_below_pivot_m") == pytest.approx(place, rel=1e-5)
    assert value(outcome, "k_pitch_m") == pytest.approx(gyradius, rel=1e-4)
    assert value(outcome, "cg_z_m") == pytest.approx(-0.1, abs=1e-4)
    assert outcome.body is not None
    assert outcome.missing == ()
    assert outcome.next_step is not None
    assert "[check]" in outcome.next_step


Known = tuple[float, float]  # a value and its standard uncertainty


def _weighed(mass: Known, moments: tuple[Known, Known], periods_s: Known, pivot_m: float) -> str:
    """Return a swing's file: empty, then with a model whose pivot is so far above its midpoint."""
    swings = "".join(
        f"[{name}]\nmass_kg = {weight_kg}\nmoment_kg_m = {moment}\nu_moment_kg_m = {u_moment}\n"
        f"period = {timed(period_s)}\n"
        for name, weight_kg, (moment, u_moment), period_s in zip(
            ("tare", "loaded"), (42.0, 42.0 + mass[0]), moments, periods_s, strict=True
        )
    )
    return f"""
gravity_m_s2 = 9.81
{swings}
[model]
mass_kg = {mass[0]}
u_mass_kg = {mass[1]}
cg_x_m = 0.0
pivot_above_midpoint_m = {pivot_m}
"""


def test_the_midpoints_inertia_has_the_correlations_in_it(tmp_path: Path) -> None:
    mass, tare, total = (30.0, 0.01), (3.0, 0.004), (27.0, 0.006)
    tare_s, loaded_s = (2.0 * math.pi * math.sqrt(i / (G * s)) for i, s in ((40, 3), (70, 27)))
    text = _weighed(mass, (tare, total), (tare_s, loaded_s), 0.7)
    body = swing.run(write(tmp_path, text)).body
    assert body is not None

    def midpoint(m: float, s0: float, s1: float) -> float:
        place = (s1 - s0) / m
        own = (G / (4.0 * math.pi**2)) * (loaded_s**2 * s1 - tare_s**2 * s0) - m * place**2
        return own + m * (place - 0.7) ** 2

    inputs = {"m": Estimate.of(*mass), "s0": Estimate.of(*tare), "s1": Estimate.of(*total)}
    whole = linear_budget("I", midpoint, inputs).result
    own = body.about_midpoint(Plane.VERTICAL)
    assert own.value == pytest.approx(whole.value, rel=1e-4)
    assert own.uncertainty == pytest.approx(whole.uncertainty, rel=0.02)


def test_taking_parts_off_keeps_the_correlations(tmp_path: Path) -> None:
    """A mount of 5 kg is on the swing with the model; by hand, its moments are subtracted."""
    mass, tare, total = (35.0, 0.001), (3.0, 0.0005), (30.0, 0.02)
    tare_s, loaded_s = (2.0 * math.pi * math.sqrt(i / (G * s)) for i, s in ((40, 3), (72, 30)))
    text = f"""{_weighed(mass, (tare, total), (tare_s, loaded_s), 0.3)}
[[take_off]]
name = "mount"
mass_kg = 5.0
u_mass_kg = 0.002
z_m = -0.1
k_pitch_m = 0.2
"""
    body = swing.run(write(tmp_path, text)).body
    assert body is not None

    def midpoint(m: float, s0: float, s1: float, mount: float) -> float:
        about_pivot = (G / (4.0 * math.pi**2)) * (loaded_s**2 * s1 - tare_s**2 * s0)
        hung = about_pivot - 2.0 * 0.3 * (s1 - s0) + m * 0.3**2  # moved to the midpoint
        return hung - mount * (0.2**2 + 0.1**2)

    inputs = {
        "m": Estimate.of(*mass),
        "s0": Estimate.of(*tare),
        "s1": Estimate.of(*total),
        "mount": Estimate.of(5.0, 0.002),
    }
    whole = linear_budget("I", midpoint, inputs).result
    own = body.about_midpoint(Plane.VERTICAL)
    assert own.value == pytest.approx(whole.value, rel=1e-6)
    assert own.uncertainty == pytest.approx(whole.uncertainty, rel=0.02)
    k = body.gyradii["pitch"]
    alone = {"pitch": Estimate.of(k.value, k.uncertainty, "m")}
    loose = replace(body, gyradii=alone).about_midpoint(Plane.VERTICAL)
    assert abs(loose.uncertainty / whole.uncertainty - 1.0) > 0.2


@pytest.mark.parametrize(
    ("loaded_kg", "u_kg", "told"),
    [(72.0, 0.0, False), (72.05, 0.0, True), (72.05, 0.02, False), (72.05, 0.009, True)],
)
def test_masses_that_contradict_each_other_are_named(
    loaded_kg: float, u_kg: float, told: bool, tmp_path: Path
) -> None:
    """By hand: the joint u of three masses is 1.73 u, the limit three times that."""
    stated = "moment_kg_m = {}\nu_moment_kg_m = 1e-3\nperiod = {}\nmass_kg = {}\nu_mass_kg = {}\n"
    tare_s, loaded_s = (2.0 * math.pi * math.sqrt(i / (G * s)) for i, s in ((40, 3), (70, 27)))
    outcome = swing.run(
        write(
            tmp_path,
            f"[tare]\n{stated.format(3.0, timed(tare_s), 42.0, u_kg)}"
            f"[loaded]\n{stated.format(27.0, timed(loaded_s), loaded_kg, u_kg)}"
            f"[model]\nmass_kg = 30.0\nu_mass_kg = {u_kg}\n",
        )
    )
    messages = [flag.message for flag in outcome.flags if flag.code == "masses_disagree"]
    assert len(messages) == told
    assert all("42 kg and model.mass_kg = 30 kg" in message for message in messages)


def test_what_lever_and_inclinometer_add_is_common_to_both_states(tmp_path: Path) -> None:
    mass, tare, total, lever, tilt = 30.0, 3.0, 27.0, 0.002, 0.003
    tare_s, loaded_s = (2.0 * math.pi * math.sqrt(i / (G * s)) for i, s in ((40, 3), (70, 27)))

    def state(moment: float, kilograms: float, period_s: float, most_kg: float) -> str:
        weights = [most_kg * k / 5.0 for k in range(6)]
        tilts = [math.atan(0.2 * one / moment) for one in weights]
        return (
            f"mass_kg = {kilograms}\nu_tilt_relative = {tilt}\nperiod = {timed(period_s)}\n"
            f'levers = [{{ name = "C", lever_m = 0.2, u_lever_m = {0.2 * lever}, '
            f"weight_kg = {weights}, tilt_rad = {tilts} }}]\n"
        )

    text = (
        f"[tare]\n{state(tare, 42.0, tare_s, 0.5)}[loaded]\n{state(total, 72.0, loaded_s, 5.0)}"
        f"[model]\nmass_kg = {mass}\ncg_x_m = 0.0\npivot_above_midpoint_m = 0.3\n"
    )
    outcome = swing.run(write(tmp_path, text))

    def own(scale: float) -> tuple[float, float]:
        moment = scale * (total - tare)
        about_pivot = scale * (G / (4.0 * math.pi**2)) * (loaded_s**2 * total - tare_s**2 * tare)
        return about_pivot - moment**2 / mass, about_pivot - 0.6 * moment

    scale = {"scale": Estimate.of(1.0, math.hypot(lever, tilt))}
    inertia, midpoint = (
        linear_budget("I", lambda scale, k=k: own(scale)[k], scale).result for k in (0, 1)
    )
    found = next(one.estimate for one in outcome.findings if one.name == "i_pitch_kg_m2")
    assert found.value == pytest.approx(inertia.value, rel=1e-4)
    assert found.uncertainty == pytest.approx(inertia.uncertainty, rel=0.01)
    assert outcome.body is not None
    about = outcome.body.about_midpoint(Plane.VERTICAL)
    assert about.uncertainty == pytest.approx(midpoint.uncertainty, rel=0.02)


def _workflow(known: float, tare_again_s: float, tare_s: float, check_s: float) -> str:
    state = "mass_kg = 42.0\nu_mass_kg = 0.01\nmoment_kg_m = {}\nu_moment_kg_m = 1e-3\n"
    return f"""
[tare]
{state.format(3.0)}period = {timed(tare_s)}
[loaded]
{state.format(27.0)}period = {timed(3.1)}
[model]
mass_kg = 30.0
u_mass_kg = 0.001
[check]
{state.format(11.0)}period = {timed(check_s)}
known_inertia_kg_m2 = {known}
u_known_inertia_kg_m2 = 0.01
[tare_again]
{state.format(3.0)}period = {timed(tare_again_s)}
"""


@pytest.mark.parametrize(("known", "said_no"), [(8.0, False), (8.5, True)])
def test_the_workflow_tells_a_right_known_body_from_a_wrong_one(
    known: float, said_no: bool, tmp_path: Path
) -> None:
    tare_s = 2.0 * math.pi * math.sqrt(40.0 / (G * 3.0))
    check_s = 2.0 * math.pi * math.sqrt(48.0 / (G * 11.0))
    outcome = swing.run(write(tmp_path, _workflow(known, tare_s, tare_s, check_s)))
    assert value(outcome, "workflow_check_kg_m2") == pytest.approx(8.0, abs=1e-3)
    assert outcome.next_step is None
    assert outcome.said_no is said_no


def test_yaw_pitch_and_depth_of_one_suspension(tmp_path: Path) -> None:
    line, half, k_yaw, k_pitch, depth = 2.0, 0.5, 0.9, 1.0, 0.4
    slow, fast = mode_periods(k_pitch, depth, line, G)
    text = f"""
[[suspensions]]
half_spacing_m = {half}
u_half_spacing_m = 1e-4
line_m = {line}
u_line_m = 1e-5
yaw = {timed(yaw_period(k_yaw, half, line, G))}
[suspensions.pitch]
slow = {timed(slow)}
fast = {timed(fast)}
"""
    outcome = bifilar.run(write(tmp_path, text))
    assert value(outcome, "k_yaw_m") == pytest.approx(k_yaw, rel=1e-4)
    assert value(outcome, "k_pitch_m") == pytest.approx(k_pitch, rel=1e-4)
    assert value(outcome, "depth_m") == pytest.approx(depth, rel=1e-3)
    assert outcome.plane is None  # both planes' gyradii are there


def test_beats_and_ratio(tmp_path: Path) -> None:
    line, half, k_yaw = 3.0, 0.9, 1.05
    ratio = k_yaw / half
    count = 0.5 * (ratio + 1.0) / (ratio - 1.0)
    text = f"""
method = "beats"
[[suspensions]]
half_spacing_m = {half}
u_half_spacing_m = 1e-4
line_m = {line}
u_line_m = 1e-4
yaw = {timed(yaw_period(k_yaw, half, line, G))}
sway = {timed(yaw_period(half, half, line, G))}
beats = {{ oscillations = {count * 5.0}, beats = 5, counting_error = 0.01 }}
"""
    outcome = bifilar.run(write(tmp_path, text))
    for name in ("k_yaw_by_period_m", "k_yaw_by_ratio_m", "k_yaw_by_beats_m", "k_yaw_m"):
        assert value(outcome, name) == pytest.approx(k_yaw, rel=1e-4), name
    assert any("yaw by beats is the result" in note for note in outcome.notes)


def test_tilted_tests_give_the_principal_axes(tmp_path: Path) -> None:
    line, half, px, pz, psi = 2.0, 0.5, 0.25, 1.05, 0.06
    about = {phi: float(gyradius_about(px, pz, phi + psi)) for phi in (0.0, 0.7, -0.7)}
    tilted = "".join(
        f"[[tilted]]\nangle_rad = {phi}\nu_angle_rad = 1e-4\n"
        f"period_s = {float(yaw_period(about[phi], half, line, G))!r}\nu_period_s = 1e-5\n"
        for phi in (0.7, -0.7)
    )
    text = f"""
[[suspensions]]
half_spacing_m = {half}
u_half_spacing_m = 1e-6
line_m = {line}
u_line_m = 1e-6
yaw = {timed(yaw_period(about[0.0], half, line, G))}
{tilted}"""
    outcome = bifilar.run(write(tmp_path, text))
    axes = outcome.axes
    assert axes is not None
    assert (axes.roll_m, axes.yaw_m) == pytest.approx((px, pz), rel=1e-3)
    assert axes.angle_rad == pytest.approx(psi, abs=1e-3)
    # every measured axis lies on the ellipse that is drawn
    for angle, gyradius in axes.measured:
        drawn = np.hypot(
            axes.roll_m * np.sin(angle + axes.angle_rad),
            axes.yaw_m * np.cos(angle + axes.angle_rad),
        )
        assert drawn == pytest.approx(gyradius.value, rel=1e-3)


def test_a_frame_is_taken_off(tmp_path: Path) -> None:
    line, half = 2.0, 0.5
    hull, frame = (50.0, 0.9), (10.0, 0.6)  # mass, yaw gyradius; both at the same place
    joint = math.sqrt((hull[0] * hull[1] ** 2 + frame[0] * frame[1] ** 2) / 60.0)
    text = f"""
[[suspensions]]
half_spacing_m = {half}
line_m = {line}
yaw = {timed(yaw_period(joint, half, line, G))}
[model]
mass_kg = 60.0
cg_x_m = 0.1
cg_z_m = 0.0
[[take_off]]
name = "frame"
mass_kg = {frame[0]}
x_m = 0.1
k_yaw_m = {frame[1]}
"""
    outcome = bifilar.run(write(tmp_path, text))
    assert outcome.body is not None
    assert outcome.body.mass.value == pytest.approx(hull[0])
    assert outcome.body.gyradii["yaw"].value == pytest.approx(hull[1], rel=1e-6)
    assert value(outcome, "own_k_yaw_m") == pytest.approx(hull[1], rel=1e-6)


def test_lamboley_and_the_plain_pendulum_agree(tmp_path: Path) -> None:
    gyradius, depth, apart = 0.28, 0.31, 0.3
    first, second = (pendulum_period(gyradius, d, G) for d in (depth, depth + apart))
    plain = f"depth_m = {depth}\nperiod = {timed(first)}\n"
    two = f"period = {timed(first)}\n[second]\napart_m = {apart}\nperiod = {timed(second)}\n"
    for text in (plain, two):
        outcome = pendulum.run(write(tmp_path, text))
        assert value(outcome, "k_pitch_m") == pytest.approx(gyradius, rel=1e-4)
    assert value(outcome, "depth_m") == pytest.approx(depth, rel=1e-4)


def test_incline_from_both_ends(tmp_path: Path) -> None:
    weight, mass, depth, arm, drop = 5.0, 600.0, 0.45, 2.0, 0.1
    tilt = math.atan(weight * arm / (mass * depth + weight * drop))
    end = f"{{ drop_m = {drop}, tilt_rad = {tilt} }}"
    text = (
        f"mass_kg = {mass}\nweight_kg = {weight}\n# gravity cancels\n"
        f"[both_ends]\nlength_m = {2 * arm}\nstern = {end}\nbow = {end}\n"
    )
    assert value(incline.run(write(tmp_path, text)), "depth_m") == pytest.approx(depth, rel=1e-9)


def test_combine_draws_principal_axes_of_two_point_masses(tmp_path: Path) -> None:
    text = "# without gravity\n" + "".join(
        f'[[parts]]\nname = "{n}"\nmass_kg = 2.0\nx_m = {x}\nz_m = {z}\nk_roll_m = 0.1\n'
        "k_pitch_m = 0.1\nk_yaw_m = 0.1\n"
        for n, x, z in (("bow", 1.0, 0.5), ("stern", -1.0, -0.5))
    )
    outcome = parts.run_combine(write(tmp_path, text))
    assert outcome.axes is not None
    # the principal x axis is the line through both, from body x towards z
    assert outcome.axes.angle_rad == pytest.approx(math.atan2(0.5, 1.0))
    assert outcome.axes.roll_m == pytest.approx(0.1)
    assert outcome.axes.yaw_m == pytest.approx(math.sqrt(0.01 + 1.25))


def _plan(line_m: float, tolerance: float) -> str:
    return f"""
[expected]
mass_kg = 600.0
k_yaw_m = 1.05
k_pitch_m = 1.156
depth_m = 0.445
[bifilar]
half_spacing_m = 0.9
u_half_spacing_m = 0.0005
line_m = {line_m}
u_line_m = 0.002
[[targets]]
quantity = "bifilar_k_yaw_m"
value = 1.05
tolerance = {tolerance}
"""


def test_a_plan_warns_of_resonance_and_says_what_it_can_tell(tmp_path: Path) -> None:
    near = plan.run(write(tmp_path, _plan(3.477, 0.01)))
    far = plan.run(write(tmp_path, _plan(1.0, 0.001)))
    assert [flag.code for flag in near.flags if flag.severity == "warning"] == [
        "yaw_pitch_resonance"
    ]
    assert not [flag for flag in far.flags if flag.severity == "warning"]
    assert near.comparisons[0].verdict == "pass"
    assert far.comparisons[0].verdict == "undecided"
    assert value(near, "bifilar_best_line_fixed_m") == value(far, "bifilar_best_line_fixed_m")
    lines = dict((near.line_errors or {})["fixed"])
    assert min(lines, key=lines.__getitem__) == pytest.approx(
        value(near, "bifilar_best_line_fixed_m"), rel=0.04
    )
