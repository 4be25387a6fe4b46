"""Oracle: a string of six hundred lumps with a body at its end; nothing in it is a rod."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.linalg import eigh

from pmm.cli import cli
from pmm.inertia import bifilar
from pmm.inertia.outcome import Outcome

G, LINE, HALF, MASS = 9.81, 2.0, 0.4, 120.0
LUMPS = 600
HEAD = "gravity_m_s2 = 9.81\nu_gravity_m_s2 = 0.0005\n"


def periods(
    lines_kg: float, end_kg: float, *, depth: float = 0.0, gyradius: float = 0.0
) -> list[float]:
    """Return the longest periods of a string under the body's weight, slowest first.

    ``end_kg`` moves with the string's end; with a depth the body turns about that end as well.
    """
    step = LINE / LUMPS
    pull = (MASS + lines_kg * (1.0 - (np.arange(LUMPS) + 0.5) / LUMPS)) * G / step
    stiffness = np.diag(pull + np.append(pull[1:], 0.0))
    stiffness -= np.diag(pull[1:], 1) + np.diag(pull[1:], -1)
    mass = np.diag(np.append(np.full(LUMPS - 1, lines_kg / LUMPS), lines_kg / LUMPS / 2.0 + end_kg))
    if depth:
        turn = np.zeros((1, LUMPS))
        stiffness = np.block([[stiffness, turn.T], [turn, np.array([[MASS * G * depth]])]])
        turn[0, -1] = MASS * depth
        square = MASS * (gyradius**2 + depth**2)
        mass = np.block([[mass, turn.T], [turn, np.array([[square]])]])
    squares = eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 1])
    return [2.0 * math.pi / math.sqrt(one) for one in squares]


def timed(period_s: float) -> str:
    return f"{{ period_s = {period_s!r}, u_period_s = 1e-6 }}"


def job(folder: Path, text: str, lines_kg: float | None) -> str:
    path = folder / "job.toml"
    heavy = "" if lines_kg is None else f"line_mass_kg = {lines_kg}\nu_line_mass_kg = 0.01\n"
    table = f"[[suspensions]]\nhalf_spacing_m = {HALF}\nline_m = {LINE}\n{heavy}{text}"
    path.write_text(f"{HEAD}{table}\n[model]\nmass_kg = {MASS}\n")
    return str(path)


def value(outcome: Outcome, name: str) -> float:
    return next(one.estimate.value for one in outcome.findings if one.name == name)


@pytest.mark.sample(1)
@pytest.mark.parametrize("share", [0.01, 0.05, 0.1])
@pytest.mark.parametrize("ratio", [0.5, 1.3])
def test_yaw(tmp_path: Path, share: float, ratio: float) -> None:
    """Each line carries half of the body: yaw is a string with ``(k/d)^2 M`` at its end."""
    lines_kg, gyradius = share * MASS, ratio * HALF
    yaw = periods(lines_kg, MASS * ratio**2)[0]
    sway = periods(lines_kg, MASS)[0]
    text = f"yaw = {timed(yaw)}\nsway = {timed(sway)}\n"
    outcome = bifilar.run(job(tmp_path, text, lines_kg))
    for name in ("k_yaw_by_period_m", "k_yaw_by_ratio_m"):
        assert value(outcome, name) == pytest.approx(gyradius, rel=5e-4)
    light = bifilar.run(job(tmp_path, text, None))
    off = abs(value(light, "k_yaw_by_period_m") / gyradius - 1.0)
    assert off > 5.0 * abs(value(outcome, "k_yaw_by_period_m") / gyradius - 1.0)


@pytest.mark.parametrize("sway_known", [True, False])
def test_pitch_and_depth(tmp_path: Path, sway_known: bool) -> None:
    lines_kg, gyradius, depth = 0.05 * MASS, 0.5, 0.35
    slow, fast = periods(lines_kg, MASS, depth=depth, gyradius=gyradius)
    text = f"[suspensions.pitch]\nslow = {timed(slow)}\nfast = {timed(fast)}\n"
    if sway_known:
        sway = periods(lines_kg, MASS)[0]
        text = f"sway = {timed(sway)}\n{text}"
    outcome = bifilar.run(job(tmp_path, text, lines_kg))
    assert value(outcome, "k_pitch_m") == pytest.approx(gyradius, rel=2e-3)
    depth_name = next(one.name for one in outcome.findings if "depth" in one.name)
    assert value(outcome, depth_name) == pytest.approx(depth, rel=2e-3)
    light = bifilar.run(job(tmp_path, text, None))
    assert abs(value(light, depth_name) / depth - 1.0) > 1e-2


@pytest.mark.parametrize(
    ("lines_kg", "model", "said"),
    [
        (6.0, "", "needs mass_kg, of all that hung, beside line_mass_kg"),
        (40.0, f"[model]\nmass_kg = {MASS}\n", "use lighter ones"),
        (-1.0, f"[model]\nmass_kg = {MASS}\n", "below zero"),
    ],
)
def test_what_is_refused(tmp_path: Path, lines_kg: float, model: str, said: str) -> None:
    path = tmp_path / "job.toml"
    table = f"half_spacing_m = {HALF}\nline_m = {LINE}\nline_mass_kg = {lines_kg}\n"
    path.write_text(f"{HEAD}[[suspensions]]\n{table}yaw = {timed(2.0)}\n{model}")
    done = CliRunner().invoke(cli, ["inertia", "bifilar", str(path)])
    assert done.exit_code == 2
    assert said in done.stderr.replace("\n", " ")


def test_fits_by_form_are_those_of_a_known_decay(tmp_path: Path) -> None:
    """A decay about an offset: F4 gives its period, F1 leaves most over."""
    time_s = np.arange(0.0, 60.0, 0.05)
    angle = 0.05 * np.exp(-0.02 * time_s) * np.cos(2.0 * np.pi * time_s / 2.5) + 2e-3
    angle += np.random.default_rng(3).normal(0.0, 1e-5, time_s.size)
    rows = "\n".join(f"{a:.3f},{b:.8f}" for a, b in zip(time_s, angle, strict=True))
    (tmp_path / "swing.csv").write_text(f"Time [s],Tilt [rad]\n{rows}\n")
    path = tmp_path / "job.toml"
    path.write_text(f'{HEAD}depth_m = 0.5\n[period]\nrecords = ["swing.csv"]\n')
    done = CliRunner().invoke(cli, ["inertia", "pendulum", str(path), "--fits", "--json"])
    assert done.exit_code == 0, done.output
    fits = {one["form"]: one for one in json.loads(done.stdout)["fits"]}
    assert list(fits) == ["F1", "F2", "F3", "F4"]
    assert fits["F4"]["period_s"] == pytest.approx(2.5, abs=1e-4)
    assert fits["F4"]["decay_1_s"] == pytest.approx(0.02, rel=1e-2)
    assert fits["F4"]["offset"] == pytest.approx(2e-3, rel=1e-2)
    assert fits["F1"]["residual"] > fits["F2"]["residual"] > 10.0 * fits["F4"]["residual"]
