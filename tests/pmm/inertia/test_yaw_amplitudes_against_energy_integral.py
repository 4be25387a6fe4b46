"""Counted swings of a known amplitude on two lines, against the integral of their energy."""

import math
from pathlib import Path

import numpy as np
import pytest

from hardware.description.errors import ConfigurationError
from pmm.inertia import bifilar, pendulum

G, LINE, HALF = 9.81, 2.0, 0.5
HEAD = (
    f"gravity_m_s2 = {G}\n[[suspensions]]\nhalf_spacing_m = {HALF}\nu_half_spacing_m = 1e-4\n"
    f"line_m = {LINE}\n"
)
WIDE_DEG = 12.0


def exact_period_s(gyradius_m: float, amplitude_rad: float, half_m: float = HALF) -> float:
    """Integrate what the lines lift and what moves, phi = A sin s, by the midpoint rule."""
    s = (np.arange(400) + 0.5) * (0.5 * math.pi / 400)
    phi = amplitude_rad * np.sin(s)

    def upright_m(angle: np.ndarray | float) -> np.ndarray:
        return np.sqrt(LINE**2 - 4.0 * half_m**2 * np.sin(0.5 * angle) ** 2)

    rise = half_m**2 * np.sin(phi) / upright_m(phi)
    left = 2.0 * G * (upright_m(phi) - upright_m(amplitude_rad))
    rate = np.sqrt(left / (gyradius_m**2 + rise**2))
    return float(2.0 * math.pi * np.mean(amplitude_rad * np.cos(s) / rate))


def counted(gyradius_m: float, half_m: float = HALF) -> str:
    seconds = 50.0 * exact_period_s(gyradius_m, math.radians(WIDE_DEG), half_m)
    reading = f"{{ swings = 50, duration_s = {seconds!r} }}"
    return f"stopwatch = [{reading}, {reading}]\namplitude_deg = {WIDE_DEG}\n"


def found(run: Path, text: str) -> dict[str, float]:
    path = run / "job.toml"
    path.write_text(text, encoding="utf-8")
    return {one.name: one.estimate.value for one in bifilar.run(str(path)).findings}


def test_tilted_swings_are_taken_to_small_ones(tmp_path: Path) -> None:
    roll, yaw, product = 0.30, 1.05, 0.06
    text = HEAD + "[suspensions.yaw]\n" + counted(yaw)
    for angle_deg, half_m in ((42.0, HALF), (-41.0, 0.45)):
        s, c = (f(math.radians(angle_deg)) for f in (math.sin, math.cos))
        about = math.sqrt((roll * s) ** 2 + (yaw * c) ** 2 - 2.0 * product * s * c)
        text += f"[[tilted]]\nangle_deg = {angle_deg}\nhalf_spacing_m = {half_m}\n"
        text += counted(about, half_m)
    result = found(tmp_path, text)
    assert result["k_yaw_m"] == pytest.approx(yaw, rel=1e-5)
    assert result["k_roll_m"] == pytest.approx(roll, rel=1e-4)


def test_the_frames_swings_are_taken_to_small_ones(tmp_path: Path) -> None:
    frame, known = (10.0, 2.5), (50.0, 40.0)  # the hull: 100 kg, 99 kg m2

    def step(name: str, *bodies: tuple[float, float]) -> str:
        mass, inertia = (sum(column) for column in zip(*bodies, strict=True))
        return f"[{name}.period]\n{counted(math.sqrt(inertia / mass))}[{name}]\nmass_kg = {mass}\n"

    result = found(
        tmp_path,
        f"{HEAD}[suspensions.yaw]\n{counted(math.sqrt(101.5 / 110.0))}[model]\nmass_kg = 110.0\n"
        f"{step('check', frame, known)}known_inertia_kg_m2 = 40.0\n"
        f"{step('tare', frame)}{step('tare_again', frame)}",
    )
    assert result["workflow_model_kg_m2"] == pytest.approx(99.0, rel=2e-5)
    assert result["workflow_check_kg_m2"] == pytest.approx(40.0, rel=2e-5)


def gate_file(path: Path, period_s: float) -> None:
    """Write the edges of one gate that sees yaw that does not die, and some sway."""
    t = np.arange(0.0, 400.0, 1e-3)
    sway_s = 2.0 * math.pi * math.sqrt(LINE / G)
    y = np.cos(2.0 * np.pi * t / period_s) + 0.02 * np.cos(2.0 * np.pi * t / sway_s + 1.0)
    edges = []
    for side in (-0.02, 0.02):
        at = np.flatnonzero(np.signbit(y[1:] - side) != np.signbit(y[:-1] - side))
        edges.append(t[at] + 1e-3 * (side - y[at]) / (y[at + 1] - y[at]))
    rows = [f"{a:.7f},{(k + 1) % 2}" for k, a in enumerate(np.sort(np.concatenate(edges)))]
    path.write_text("\n".join(["Time,State", *rows]) + "\n")


@pytest.mark.parametrize("stated", [True, False])
def test_a_period_without_modulation_is_of_its_amplitude(stated: bool, tmp_path: Path) -> None:
    gyradius_m = 0.6
    gate_file(tmp_path / "gate.csv", exact_period_s(gyradius_m, math.radians(WIDE_DEG)))
    more = f"amplitude_deg = {WIDE_DEG}\n" if stated else ""
    path = tmp_path / "job.toml"
    path.write_text(
        f'{HEAD}[suspensions.yaw]\ngates = ["gate.csv"]\ngate_columns = ["State"]\n'
        f"remove_modulation = true\n{more}"
    )
    outcome = bifilar.run(str(path))
    found = next(one.estimate.value for one in outcome.findings if one.name == "k_yaw_m")
    assert ("amplitude_unknown" in {flag.code for flag in outcome.flags}) is not stated
    assert (found == pytest.approx(gyradius_m, rel=5e-5)) is stated


SMALL = "{ period_s = 4.0, u_period_s = 0.001 }"
STATED = "stopwatch = [{ swings = 50, duration_s = 100.0 }]\namplitude_deg = 5.0\n"


@pytest.mark.parametrize(
    "text",
    [
        f"{HEAD}yaw = {SMALL}\n[suspensions.sway]\n{STATED}",
        f"{HEAD}[suspensions.pitch]\nfast = {SMALL}\n[suspensions.pitch.slow]\n{STATED}",
        f"gravity_m_s2 = {G}\n[period]\n{STATED}",
        f"gravity_m_s2 = {G}\n[torsion]\nstiffness_n_m_rad = 2.0\n[period]\n{STATED}",
    ],
    ids=["sway", "pitch", "period alone", "torsion"],
)
def test_an_amplitude_without_known_lengthening_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "job.toml"
    path.write_text(text, encoding="utf-8")
    job = bifilar if "suspensions" in text else pendulum
    with pytest.raises(ConfigurationError, match=r"amplitude_deg: .* leave it out"):
        job.run(str(path))
