"""What air, frames, torsion rods and inclinometers add is taken off again."""

import math
from pathlib import Path

import numpy as np
import pytest

from analysis.inertia.plane_inertia import plane_inertia
from analysis.uncertainty.estimate import Estimate, exactly
from hardware.description.errors import ConfigurationError
from pmm.inertia import bifilar, parts, pendulum, swing
from pmm.inertia.outcome import Outcome

G = 9.81
HEAD = "gravity_m_s2 = 9.81\nu_gravity_m_s2 = 0.0005\n"
RATIO, COEFFICIENT, SWAY_COEFFICIENT = 0.02, 0.7, 0.9
AIR = f"""
air_density_kg_m3 = 1.2
body_density_kg_m3 = 60.0
[entrained_air]
coefficient = {COEFFICIENT}
u_coefficient = 0.2
sway_coefficient = {SWAY_COEFFICIENT}
gyradius_m = 0.5
"""


def write(folder: Path, text: str) -> str:
    path = folder / "job.toml"
    path.write_text(HEAD + text)
    return str(path)


def value(outcome: Outcome, name: str) -> float:
    return next(one.estimate.value for one in outcome.findings if one.name == name)


def timed(square_s2: float) -> str:
    period_s = 2.0 * math.pi * math.sqrt(square_s2)
    return f"{{ period_s = {period_s!r}, u_period_s = 1e-5 }}"


def in_air(gyradius: float, depth: float = 0.0) -> float:
    """Inertia about the axis of 1 kg of the body and of its air."""
    return gyradius**2 + depth**2 + COEFFICIENT * RATIO * (0.5**2 + depth**2)


def test_air_of_a_compound_pendulum(tmp_path: Path) -> None:
    gyradius, depth = 0.45, 0.6
    square = in_air(gyradius, depth) / (depth * G * (1.0 - RATIO))
    outcome = pendulum.run(write(tmp_path, f"depth_m = {depth}\nperiod = {timed(square)}\n{AIR}"))
    assert value(outcome, "k_pitch_m") == pytest.approx(gyradius, rel=1e-5)
    assert value(outcome, "k_pitch_in_air_m") > 1.01 * gyradius
    found = next(one for one in outcome.findings if one.name == "k_pitch_m")
    assert found.assessment is not None
    assert found.assessment.budget.shares[0].name == "coefficient"


@pytest.mark.parametrize("like_the_body", [False, True])
def test_air_about_two_axes(tmp_path: Path, like_the_body: bool) -> None:
    gyradius, depth, apart = 0.5 if like_the_body else 0.35, 0.30, 0.25
    air = AIR.replace("gyradius_m = 0.5\n", "") if like_the_body else AIR
    first, second = (
        timed(in_air(gyradius, below) / (below * G * (1.0 - RATIO)))
        for below in (depth, depth + apart)
    )
    text = f"period = {first}\nsecond = {{ apart_m = {apart}, period = {second} }}\n{air}"
    outcome = pendulum.run(write(tmp_path, text))
    found = {one.name: one for one in outcome.findings}
    assert found["depth_m"].estimate.value == pytest.approx(depth, rel=1e-5)
    assert found["k_pitch_m"].estimate.value == pytest.approx(gyradius, rel=1e-5)
    assert found["k_pitch_in_air_m"].estimate.value > 1.005 * gyradius
    # by hand: what the same periods give with another coefficient
    wrong = pendulum.run(
        write(tmp_path, text.replace(f"coefficient = {COEFFICIENT}\n", "coefficient = 0.701\n"))
    )
    for name in ("depth_m", "k_pitch_m"):
        slope = (value(wrong, name) - value(outcome, name)) / 0.001
        assert found[name].estimate.uncertainty == pytest.approx(abs(slope) * 0.2, rel=0.03)


def test_air_of_a_model_on_the_swing(tmp_path: Path) -> None:
    """The air bears the model, not the swing."""
    mass, gyradius, depth = 30.0, 0.6, 0.8
    tare = timed(40.0 / (3.0 * G))
    righting = 3.0 + mass * depth * (1.0 - RATIO)
    total = timed((40.0 + mass * in_air(gyradius, depth)) / (righting * G))
    state = "mass_kg = 42.0\nmoment_kg_m = {}\nu_moment_kg_m = 1e-4\nperiod = {}\n"
    text = AIR + f"[tare]\n{state.format(3.0, tare)}[loaded]\n{state.format(27.0, total)}"
    outcome = swing.run(write(tmp_path, text + f"[model]\nmass_kg = {mass}\n"))
    assert value(outcome, "k_pitch_m") == pytest.approx(gyradius, rel=1e-4)
    assert value(outcome, "k_pitch_in_air_m") > 1.01 * gyradius


@pytest.mark.parametrize("tilted", [False, True])
def test_air_bears_the_model_once(tmp_path: Path, tilted: bool) -> None:
    """Tilts tell the moment in air, a stated one is that of the masses."""
    ratio, tare, mass, gyradius, depth = 1.2 / 250.0, 21.0, 60.0, 1.1, 0.8
    righting = {"tare": tare, "loaded": tare + mass * depth * (1.0 - ratio)}
    inertia = {"tare": 45.0, "loaded": 45.0 + mass * (gyradius**2 + depth**2)}
    weights, text = [0.0, 2.0, 4.0], "air_density_kg_m3 = 1.2\nbody_density_kg_m3 = 250.0\n"
    for key, kilograms in (("tare", 42.0), ("loaded", 42.0 + mass)):
        period = timed(inertia[key] / (righting[key] * G))
        text += f"[{key}]\nmass_kg = {kilograms}\nperiod = {period}\n"
        if tilted:
            tilts = [math.atan(weight * 0.4 / righting[key]) for weight in weights]
            row = f'name = "C", lever_m = 0.4, weight_kg = {weights}, tilt_rad = {tilts}'
            text += f"levers = [{{ {row} }}]\n"
        else:
            text += f"moment_kg_m = {tare if key == 'tare' else tare + mass * depth}\n"
    outcome = swing.run(write(tmp_path, f"{text}[model]\nmass_kg = {mass}\n"))
    about_cg = inertia["loaded"] - (tare + mass * depth) ** 2 / (42.0 + mass)
    expected = {
        "tare_i_pivot_kg_m2": 45.0,
        "loaded_i_pivot_kg_m2": inertia["loaded"],
        "loaded_i_cg_kg_m2": about_cg,
        "loaded_cg_below_pivot_m": (tare + mass * depth) / (42.0 + mass),
        "cg_below_pivot_m": depth,
        "i_pitch_kg_m2": mass * gyradius**2,
        "k_pitch_m": gyradius,
    }
    assert {name: value(outcome, name) for name in expected} == pytest.approx(expected, rel=1e-5)


def test_air_of_yaw_by_period_and_by_ratio(tmp_path: Path) -> None:
    gyradius, half, line = 0.55, 0.4, 2.0
    lines = line / (G * (1.0 - RATIO))
    yaw, sway = in_air(gyradius) / half**2 * lines, (1.0 + SWAY_COEFFICIENT * RATIO) * lines
    text = (
        f"{AIR}[[suspensions]]\nhalf_spacing_m = {half}\nline_m = {line}\n"
        f"yaw = {timed(yaw)}\nsway = {timed(sway)}\n"
    )
    outcome = bifilar.run(write(tmp_path, text))
    for name in ("k_yaw_by_period_m", "k_yaw_by_ratio_m"):
        assert value(outcome, name) == pytest.approx(gyradius, rel=1e-4)


def test_air_needs_both_densities(tmp_path: Path) -> None:
    text = AIR.replace("body_density_kg_m3 = 60.0\n", "")
    with pytest.raises(ConfigurationError, match="body_density_kg_m3 is missing beside entrained"):
        pendulum.run(write(tmp_path, f"depth_m = 0.6\nperiod = {timed(0.1)}\n{text}"))


def test_a_square_frame_is_four_bars(tmp_path: Path) -> None:
    half, thin = 0.4, 0.8 / math.sqrt(12.0)
    bars = "".join(
        f'[[parts]]\nname = "bar {x}{y}"\nmass_kg = 1.5\nx_m = {x}\ny_m = {y}\n'
        f"k_{'pitch' if y else 'roll'}_m = {thin}\nk_yaw_m = {thin}\n"
        for x, y in ((half, 0.0), (-half, 0.0), (0.0, half), (0.0, -half))
    )
    path = tmp_path / "bars.toml"
    path.write_text(bars)
    frame = tmp_path / "frame.toml"
    frame.write_text(
        f'[[parts]]\nname = "frame"\nmass_kg = 6.0\nsquare_half_side_m = {half}\n'
        "u_square_half_side_m = 0.004\n"
    )
    four, one = parts.run_combine(str(path)), parts.run_combine(str(frame))
    for axis in ("roll", "pitch", "yaw"):
        assert value(one, f"k_{axis}_m") == pytest.approx(value(four, f"k_{axis}_m"))
    yaw = next(found.estimate for found in one.findings if found.name == "k_yaw_m")
    assert yaw.relative == pytest.approx(0.01)


def test_a_frame_has_a_side_or_gyradii(tmp_path: Path) -> None:
    path = tmp_path / "frame.toml"
    path.write_text(
        '[[parts]]\nname = "frame"\nmass_kg = 6.0\nsquare_half_side_m = 0.4\nk_yaw_m = 0.3\n'
    )
    with pytest.raises(ConfigurationError, match="k_yaw_m and square_half_side_m are both given"):
        parts.run_combine(str(path))


STIFFNESS = 5.0


def test_a_rod_by_its_stiffness_and_by_a_bar(tmp_path: Path) -> None:
    mass, length, diameter, inertia = 3.0, 0.8, 0.03, 0.4
    bar = mass * (length**2 / 12.0 + diameter**2 / 16.0)
    by_bar = (
        f"[torsion.bar]\nmass_kg = {mass}\nlength_m = {length}\nu_length_m = 0.001\n"
        f"diameter_m = {diameter}\nperiod = {timed(bar / STIFFNESS)}\n"
    )
    given = f"[torsion]\nstiffness_n_m_rad = {STIFFNESS}\nu_stiffness_n_m_rad = 0.01\n"
    for rod in (by_bar, given):
        text = f'axis = "yaw"\nperiod = {timed(inertia / STIFFNESS)}\n[model]\nmass_kg = 2.5\n{rod}'
        outcome = pendulum.run(write(tmp_path, text))
        assert value(outcome, "i_yaw_kg_m2") == pytest.approx(inertia, rel=1e-5)
        assert value(outcome, "k_yaw_m") == pytest.approx(math.sqrt(inertia / 2.5), rel=1e-5)
    found = next(one.estimate for one in outcome.findings if one.name == "i_yaw_kg_m2")
    assert found.relative == pytest.approx(0.002, rel=0.01)


def _axes(*degrees: float) -> str:
    xx, zz, xz = 0.2, 1.1, 0.08
    rows = []
    for angle in degrees:
        s, c = math.sin(math.radians(angle)), math.cos(math.radians(angle))
        about = xx * s * s + zz * c * c - 2.0 * xz * s * c
        rows.append(f"{{ angle_deg = {angle}, {timed(about / STIFFNESS)[2:-2]} }}")
    return (
        f"[torsion]\nstiffness_n_m_rad = {STIFFNESS}\nu_stiffness_n_m_rad = 0.005\n"
        f"axes = [{', '.join(rows)}]\n"
    )


def test_roll_yaw_and_product_from_three_axes(tmp_path: Path) -> None:
    outcome = pendulum.run(write(tmp_path, "[model]\nmass_kg = 8.0\n" + _axes(10.0, 60.0, 130.0)))
    for name, true in (("ixx_kg_m2", 0.2), ("izz_kg_m2", 1.1), ("ixz_kg_m2", 0.08)):
        assert value(outcome, name) == pytest.approx(true, rel=1e-4)
    psi = 0.5 * math.atan(0.16 / 0.9)
    assert value(outcome, "psi_rad") == pytest.approx(psi, rel=1e-4)
    axes = outcome.axes
    assert axes is not None
    assert 8.0 * (axes.roll_m**2 + axes.yaw_m**2) == pytest.approx(1.3)
    for angle, gyradius in axes.measured:
        drawn = math.hypot(axes.roll_m * math.sin(angle + psi), axes.yaw_m * math.cos(angle + psi))
        assert drawn == pytest.approx(gyradius.value, rel=1e-4)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (_axes(10.0, 60.0), "are 2; roll, yaw and their product need three"),
        ("[torsion]\nstiffness_n_m_rad = 5.0\n", "period is missing"),
        (f"period = {timed(0.1)}\n" + _axes(0.0, 60.0, 120.0), "period and torsion.axes are both"),
        (f"period = {timed(0.1)}\n[torsion]\n", "needs one of stiffness_n_m_rad, bar"),
    ],
)
def test_what_a_rod_needs_is_said(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=message):
        pendulum.run(write(tmp_path, text))


@pytest.mark.slow
def test_the_principal_angles_uncertainty_is_that_of_its_slopes() -> None:
    angles, true = [0.1, 1.0, 2.2], np.array([0.2, 1.1, 0.08])
    s, c = np.sin(angles), np.cos(angles)
    about = np.column_stack([s * s, c * c, -2.0 * s * c]) @ true
    generator = np.random.default_rng(3)
    seen = [
        plane_inertia(
            [Estimate.of(v + 1e-3 * generator.standard_normal(), 1e-3) for v in about],
            [exactly(angle) for angle in angles],
        ).principal_angle
        for _ in range(2000)
    ]
    assert np.std([one.value for one in seen]) == pytest.approx(seen[0].uncertainty, rel=0.06)
