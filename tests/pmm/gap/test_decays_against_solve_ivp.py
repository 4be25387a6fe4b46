"""Oracle: decays and forced runs whose equations scipy integrates; nothing of the simulator."""

import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from pmm.cli import cli
from tests.analysis.gap.pendulum.decaying_bodies import TABLE, Released, written

FloatArray = NDArray[np.float64]


def told(
    folder: Path, time_s: FloatArray, values: FloatArray, *, table: str = TABLE,
    most: int = 2, noise: float = 1e-4,
) -> dict[str, Any]:  # fmt: skip
    """Return the document of a record with noise."""
    known = {"inertia": 1e-3, "restoring": 1e-3}
    file = written(folder, time_s, values, known, table=table, noise=noise)
    words = ["gap", "pendulum", str(file), "--most", str(most), "--json"]
    done = CliRunner().invoke(cli, words, catch_exceptions=False)
    assert done.exit_code == 0, done.stderr
    return dict(json.loads(done.stdout))


def size(found: dict[str, Any], cause: str, name: str) -> dict[str, float]:
    """Return a parameter's value and uncertainty."""
    return dict(found["parameters"][cause][name])


@pytest.mark.slow
@pytest.mark.parametrize("rate_hz", [10.0, 50.0, 400.0])
def test_quadratic_drag_is_told_with_its_law_at_any_rate(tmp_path: Path, rate_hz: float) -> None:
    """A law of any power that comes out as 1 is no other law than the quadratic one."""
    found = told(tmp_path, *Released(loss=0.4).record(rate_hz=rate_hz))
    assert found["said"][0].startswith("The cause: quadratic_drag")
    assert "cannot be told" not in found["said"][0]
    loss = size(found, "quadratic_drag", "loss")
    assert abs(loss["value"] - 0.4) < 4.0 * loss["uncertainty"]


@pytest.mark.slow
def test_small_long_decays_are_no_dry_friction(tmp_path: Path) -> None:
    """A law that would stop the body is no better than one that is right."""
    found = told(tmp_path, *Released(loss=0.3, held=math.radians(2.0)).record(40.0))
    laws = {row["name"]: row["log_ratio"] for row in found["laws"]}
    assert max(laws, key=lambda name: laws[name]) in ("quadratic", "cubic", "any power")
    assert all(ratio > -1e4 for ratio in laws.values())


@pytest.mark.slow
@pytest.mark.parametrize("lag_s", [0.05, 0.1])
def test_a_sensor_that_lags_is_no_gap_of_a_decay(tmp_path: Path, lag_s: float) -> None:
    """Settled, it turns and scales a decay, as a release does."""
    time_s, roll = Released().record()
    kept = {"rtol": 1e-9, "atol": 1e-11, "t_eval": time_s, "max_step": 0.02}
    behind = solve_ivp(
        lambda t, y: (np.interp(t, time_s, roll) - y) / lag_s, (0.0, time_s[-1]), [0.0], **kept
    ).y[0]
    assert told(tmp_path, time_s, behind)["verdict"] == "none"


@pytest.mark.slow
def test_a_hand_that_lets_go_slowly_is_no_gap(tmp_path: Path) -> None:
    """Its spring slackens over the first 0.6 s."""
    assert told(tmp_path, *Released(hand_s=0.6).record())["verdict"] == "none"


@pytest.mark.slow
def test_windows_with_holes_are_left_out_and_it_is_said(tmp_path: Path) -> None:
    time_s, roll = Released(loss=0.4).record()
    holes = (np.abs(time_s - 10.3) < 1.0) | (np.abs(time_s - 21.1) < 1.0)
    there = ~holes
    found = told(tmp_path, time_s[there], roll[there])
    (note,) = found["notes"]
    assert "windows have too few samples, or a hole of a sixth of a swing" in note
    assert found["said"][0].startswith("The cause: quadratic_drag")
    off = found["said"][1]
    assert "by up to 1" in off  # per cent, as without a hole, not a thousand
    assert "e+" not in off


@pytest.mark.slow
def test_memory_of_the_water_is_damping_and_stiffness(tmp_path: Path) -> None:
    """A moment that forgets over half a second is both in one decay; neither alone explains it."""
    found = told(tmp_path, *Released(memory=0.2, tau_s=0.5).record())
    assert found["classes"]["damping"] > 0.9
    assert found["classes"]["inertia or stiffness"] > 0.9
    assert found["verdict"] != "none"


@pytest.mark.slow
@pytest.mark.parametrize("more", [0.05, 0.2])
def test_a_pivots_inertia_is_found(tmp_path: Path, more: float) -> None:
    """Records that tell a number to a millionth once ended in a traceback."""
    mass, lever, stated = 10.0, 0.4, 2.0
    whole = (stated + mass * lever**2) * (1.0 + more)

    def slope(_t: float, y: FloatArray) -> list[float]:
        return [y[1], -(0.01 * y[1] + mass * lever * 9.81 * math.sin(y[0])) / whole]

    time_s = np.arange(3800) / 50.0
    kept = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-12, "t_eval": time_s}
    angle = solve_ivp(slope, (0.0, 76.0), [math.radians(12.0), 0.0], **kept).y[0]
    table = (
        "[pivot]\ngravity_m_s2 = 9.81\nresistance = { viscous = 0.01 }\n"
        f"[[pivot.parts]]\nmass_kg = {mass}\nlever_m = {lever}\ninertia_kg_m2 = {stated}\n"
    )
    found = told(tmp_path, time_s, angle, table=table, most=1, noise=5e-5)
    assert found["best"] == ["inertia"]
    share = size(found, "inertia", "share")
    assert abs(share["value"] - more) < 5.0 * share["uncertainty"]


def forced(folder: Path, cubic: float, frequencies_hz: Sequence[float]) -> Path:
    """Write runs of a body on springs that harden, under a force of 30 N."""
    mass, restoring, viscous = 70.0, 1000.0, 60.0
    text = (
        'name = "forced"\n[floating]\ninertia = 50.0\nadded_inertia = 20.0\nrestoring = 1000.0\n'
        "resistance = { viscous = 60.0 }\n[tolerances]\ninertia = 2e-3\nrestoring = 2e-3\n"
        "damping = 0.02\nforce = 2e-3\n"
    )
    rng = np.random.default_rng(3)
    for number, hz in enumerate(frequencies_hz):
        omega = 2.0 * math.pi * hz

        def slope(t: float, y: FloatArray, omega: float = omega) -> list[float]:
            spring = restoring * (y[0] + cubic * y[0] ** 3)
            return [y[1], (30.0 * math.cos(omega * t) - viscous * y[1] - spring) / mass]

        time_s = np.arange(2500) / 50.0
        kept = {"method": "DOP853", "rtol": 1e-9, "atol": 1e-11, "t_eval": time_s}
        heave = solve_ivp(slope, (0.0, 50.0), [0.0, 0.0], **kept).y[0]
        force = 30.0 * np.cos(omega * time_s)
        noise = rng.normal(0.0, (2e-2, 2e-5), (time_s.size, 2))
        rows = np.column_stack((time_s, np.column_stack((force, heave)) + noise))
        header = "time_s,force [N],heave [m]"
        np.savetxt(folder / f"{number}.csv", rows, "%.7f", ",", header=header, comments="")
        text += (
            f'[[forced]]\nname = "{hz} Hz"\n'
            f'force = {{ record = "{number}.csv", channel = "force" }}\n'
            f'measured = [{{ record = "{number}.csv", channel = "heave" }}]\nfrom_s = 20.0\n'
        )
    (folder / "forced.toml").write_text(text)
    return folder / "forced.toml"


@pytest.mark.slow
def test_springs_that_harden_a_lot_are_found(tmp_path: Path) -> None:
    file = forced(tmp_path, 8.0, (0.4, 0.5, 0.6, 0.9))
    words = ["gap", "pendulum", str(file), "--most", "1", "--json"]
    found = json.loads(CliRunner().invoke(cli, words, catch_exceptions=False).stdout)
    assert found["best"] == ["nonlinear_restoring"]
    cubic = size(found, "nonlinear_restoring", "cubic")
    assert cubic["value"] == pytest.approx(8.0, rel=0.01)


@pytest.mark.slow
def test_what_is_at_the_end_of_its_range_is_said_to_be(tmp_path: Path) -> None:
    time_s, roll = Released().record()
    found = told(tmp_path, time_s, roll + 0.15, most=1)
    assert found["verdict"] == "unknown"  # no offset is plausible that is so large
    assert "is at an end of its plausible range" in " ".join(found["notes"])
