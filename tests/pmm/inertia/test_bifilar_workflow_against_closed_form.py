"""Tare, test, known body, tare again on two lines, from periods of known bodies."""

import math
from pathlib import Path

import pytest

from analysis.inertia.bifilar import yaw_period
from hardware.description.errors import ConfigurationError
from pmm.inertia import bifilar
from pmm.inertia.outcome import Outcome

G, LINE, HALF = 9.81, 2.0, 0.5
FRAME = (10.0, 0.6)  # mass, yaw gyradius
MODEL = (50.0, 0.9)
BODY = (20.0, 0.5)


def inertia(*bodies: tuple[float, float]) -> float:
    return sum(mass * gyradius**2 for mass, gyradius in bodies)


def period(*bodies: tuple[float, float], stretch: float = 1.0, half: float = HALF) -> str:
    gyradius = math.sqrt(inertia(*bodies) / sum(mass for mass, _ in bodies))
    seconds = float(stretch * yaw_period(gyradius, half, LINE, G))
    return f"{{ period_s = {seconds!r}, u_period_s = {1e-4 * seconds} }}"


def run(folder: Path, steps: int, known: float = inertia(BODY), **changes: float) -> Outcome:
    """Write the file of the first steps of four; the true half spacing may be another."""
    test = f"yaw = {period(FRAME, MODEL, **changes)}\n" if steps > 1 else ""
    text = f"""
gravity_m_s2 = {G}
[[suspensions]]
half_spacing_m = {HALF}
u_half_spacing_m = 1e-3
line_m = {LINE}
{test}
[model]
mass_kg = 60.0
u_mass_kg = 0.005
[tare]
mass_kg = 10.0
period = {period(FRAME, **changes)}
"""
    if steps > 2:
        text += f"""
[check]
mass_kg = 30.0
period = {period(FRAME, BODY, **changes)}
known_inertia_kg_m2 = {known}
u_known_inertia_kg_m2 = 0.005
"""
    if steps > 3:
        text += f"[tare_again]\nmass_kg = 10.0\nperiod = {period(FRAME, **changes)}\n"
    (folder / "job.toml").write_text(text)
    return bifilar.run(str(folder / "job.toml"))


@pytest.mark.parametrize(
    ("steps", "step"), [(1, "2 of 4, [suspensions.yaw]"), (2, "3 of 4, [check]"), (3, "4 of 4, [t")]
)
def test_the_next_step_is_said(steps: int, step: str, tmp_path: Path) -> None:
    found = run(tmp_path, steps).next_step
    assert found is not None
    assert found.startswith(step)


def test_the_model_is_what_the_test_has_more_than_the_tares(tmp_path: Path) -> None:
    outcome = run(tmp_path, 4)
    found = {one.name: one.estimate for one in outcome.findings}
    assert outcome.next_step is None
    assert not outcome.said_no
    assert found["tare_i_yaw_kg_m2"].value == pytest.approx(inertia(FRAME))
    model = found["workflow_model_kg_m2"]
    assert model.value == pytest.approx(inertia(MODEL))
    # the spacing is the same in all: a scale of the result, and nothing in the drift
    assert model.uncertainty == pytest.approx(2.0 * 1e-3 / HALF * inertia(MODEL), rel=0.05)
    assert found["workflow_drift_kg_m2"].uncertainty < 3e-4 * inertia(FRAME)


def test_the_air_that_stays_in_the_workflow_is_said(tmp_path: Path) -> None:
    plain = run(tmp_path, 4)
    path = tmp_path / "job.toml"
    air = "[entrained_air]\ncoefficient = 0.4\n"
    text = f"air_density_kg_m3 = 1.2\nbody_density_kg_m3 = 800.0\n{path.read_text()}{air}"
    path.write_text(text)
    aired = bifilar.run(str(path))
    assert [note for note in aired.notes if "workflow's inertias still have theirs" in note]
    assert not [note for note in plain.notes if "still have theirs" in note]


def test_a_wrong_spacing_is_caught_by_the_known_body(tmp_path: Path) -> None:
    right, wrong = run(tmp_path, 4, half=0.502), run(tmp_path, 4, half=0.52)
    assert not right.said_no
    assert wrong.said_no
    assert "known_weight_failed" in {flag.code for flag in wrong.flags}


def test_no_workflow_without_a_tare(tmp_path: Path) -> None:
    run(tmp_path, 2)
    path = tmp_path / "job.toml"
    path.write_text(path.read_text().split("[tare]")[0])
    assert bifilar.run(str(path)).next_step is None


@pytest.mark.parametrize(
    ("gone", "message"),
    [
        ("known_inertia_kg_m2 =", "known_inertia_kg_m2 is missing"),
        ("mass_kg = 60.0\nu_mass_kg", "needs mass_kg, of all that hung"),
        ("yaw =", "the test comes before the known body"),
    ],
)
def test_what_is_missing_is_named(gone: str, message: str, tmp_path: Path) -> None:
    run(tmp_path, 4)
    path = tmp_path / "job.toml"
    lines = gone.splitlines()
    kept = [one for one in path.read_text().splitlines() if not one.startswith(tuple(lines))]
    path.write_text("\n".join(kept))
    with pytest.raises(ConfigurationError, match=message):
        bifilar.run(str(path))


def test_nothing_measured_and_no_tare(tmp_path: Path) -> None:
    path = tmp_path / "job.toml"
    path.write_text("[[suspensions]]\nhalf_spacing_m = 0.5\nline_m = 2.0\n")
    with pytest.raises(ConfigurationError, match="measures nothing; add one of yaw"):
        bifilar.run(str(path))
