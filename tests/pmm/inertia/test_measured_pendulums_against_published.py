"""A bicycle's published inertias and a tanker's roll decay, through the command itself.

The published values were made from the published periods and geometry; each of ours lies within
their uncertainty.
"""

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner

from pmm.cli import cli

DATA = Path(__file__).parents[3].parent / "shared" / "data"
BICYCLE = DATA / "compound_pendulum"
pytestmark = pytest.mark.skipif(not DATA.is_dir(), reason="the measured data are not beside it")


@cache
def rows(name: str) -> dict[str, tuple[float, float]]:
    found = {}
    for line in (BICYCLE / f"Browser{name}.txt").read_text().splitlines():
        key, _, text = line.partition("=")
        numbers = [float(part) for part in text.split("+/-")]
        found[key.strip()] = (numbers[0], numbers[1] if len(numbers) > 1 else 0.0)
    return found


def run(folder: Path, text: str) -> dict[str, Any]:
    path = folder / "job.toml"
    path.write_text(text)
    command = ["inertia", "pendulum", str(path), "--json"]
    result = CliRunner().invoke(cli, command, catch_exceptions=False)
    assert result.exit_code == 0, result.stderr
    document: dict[str, Any] = json.loads(result.stdout)
    return document


def key(name: str, symbol: str, where: str = "Measured") -> str:
    value, spread = rows(where)[symbol]
    return f"{name} = {value}\nu_{name} = {spread}\n"


def period(symbol: str) -> str:
    value, spread = rows("Measured")[symbol]
    return f"{{ period_s = {value}, u_period_s = {spread} }}\n"


def holds(document: dict[str, Any], name: str, symbol: str, sign: float = 1.0) -> None:
    (value, spread), found = rows("Benchmark")[symbol], document["results"][name]
    assert abs(sign * found["value"] - value) <= spread, (symbol, found["value"], value, spread)


ROD = "[torsion.bar]\n" + "{mass}{length}{diameter}period = {period}"


def rod() -> str:
    return ROD.format(
        mass=key("mass_kg", "mP"),
        length=key("length_m", "lP"),
        diameter=key("diameter_m", "dP"),
        period=period("TtP1"),
    )


def model(part: str) -> str:
    return f"[model]\n{key('mass_kg', f'm{part}')}"


@pytest.mark.parametrize("wheel", ["F", "R"])
def test_wheels(wheel: str, tmp_path: Path) -> None:
    head = key("gravity_m_s2", "g")
    swung = f"period = {period(f'Tc{wheel}1')}{key('depth_m', f'l{wheel}')}{model(wheel)}"
    holds(run(tmp_path, head + swung), "i_pitch_kg_m2", f"I{wheel}yy")
    twisted = f'axis = "roll"\nperiod = {period(f"Tt{wheel}1")}{model(wheel)}{rod()}'
    document = run(tmp_path, head + twisted)
    holds(document, "i_roll_kg_m2", f"I{wheel}xx")
    spread = document["results"]["i_roll_kg_m2"]["standard_uncertainty"]
    assert spread == pytest.approx(rows("Benchmark")[f"I{wheel}xx"][1], rel=0.05)


def _depth(part: str) -> str:
    """Of the centre of gravity below the axle from which the part hung."""
    known = rows("Benchmark")
    foot, wheel = (0.0, "rR") if part == "B" else (known["w"][0], "rF")
    x, z = known[f"x{part}"], known[f"z{part}"]
    across, down = x[0] - foot, z[0] + known[wheel][0]
    depth = math.hypot(across, down)
    spread = math.hypot(across * x[1], down * z[1]) / depth
    return f"depth_m = {depth}\nu_depth_m = {spread}\n"


@pytest.mark.parametrize("part", ["B", "H"])
def test_frame_and_fork(part: str, tmp_path: Path) -> None:
    head = key("gravity_m_s2", "g")
    swung = f"period = {period(f'Tc{part}1')}{_depth(part)}{model(part)}"
    holds(run(tmp_path, head + swung), "i_pitch_kg_m2", f"I{part}yy")
    lean, axes = rows("Benchmark")["lam"][0], ""
    for number in (1, 2, 3):
        leaned, spread = rows("Measured")[f"alpha{part}{number}"]
        angle = lean - math.radians(leaned) + 0.5 * math.pi
        time, error = rows("Measured")[f"Tt{part}{number}"]
        axes += (
            f"[[torsion.axes]]\nangle_rad = {angle}\nu_angle_rad = {math.radians(spread)}\n"
            f"period_s = {time}\nu_period_s = {error}\n"
        )
    document = run(tmp_path, head + model(part) + rod() + axes)
    holds(document, "ixx_kg_m2", f"I{part}xx")
    holds(document, "izz_kg_m2", f"I{part}zz")
    holds(document, "ixz_kg_m2", f"I{part}xz", sign=-1.0)  # published as the tensor's element


def test_raw_trace(tmp_path: Path) -> None:
    from scipy.io import loadmat

    trace = loadmat(BICYCLE / "BrowserForkCompoundFirst1.mat", squeeze_me=True)
    values = np.asarray(trace["data"], dtype=np.float64)
    times = np.arange(values.size) / float(trace["ActualRate"])
    header = "Time [s],Rate [V]"
    table = np.column_stack([times, values])
    np.savetxt(tmp_path / "1.csv", table, delimiter=",", header=header, comments="", fmt="%.9g")
    document = run(tmp_path, '[period]\nrecords = ["1.csv"]\n')
    found = document["results"]
    assert found["damped_period_s"]["value"] == pytest.approx(1.59020, abs=1e-4)
    assert found["damping_ratio"]["value"] == pytest.approx(0.0090, abs=2e-4)
    apart = found["period_s"]["value"] - 1.59020
    assert abs(apart) < 2.0 * found["period_s"]["standard_uncertainty"]


ROLL = (("model_test_21337.csv.gz", "time"), ("fnpf_kvlcc2_rolldecay_0kn.csv.gz", "Time"))


@pytest.mark.slow
def test_roll_decay_of_test_and_simulation(tmp_path: Path) -> None:
    """The periods agree, the decay does not; GM gives the inertia, the water's included."""
    periods, damping, inertias = [], [], []
    for name, time in ROLL:
        (tmp_path / name).symlink_to(DATA / "roll_decay" / name)
        columns = f'[columns]\ntime = {{ column = "{time}", unit = "s" }}\n'
        columns += '[columns.channels]\nroll = { column = "phi", unit = "rad" }\n'
        source = f'period = {{ records = ["{name}"] }}\n'
        found = run(tmp_path, source + columns)["results"]
        periods.append(found["period_s"])
        damping.append(found["damping_ratio"]["value"])
        stiff = "[torsion]\nstiffness_n_m_rad = 821.0\nu_stiffness_n_m_rad = 8.0\n"
        on_rod = run(tmp_path, f'axis = "roll"\n{source}{stiff}{columns}')["results"]
        inertias.append(on_rod["i_roll_kg_m2"]["value"])
    apart = abs(periods[0]["value"] - periods[1]["value"])
    assert apart < 2.0 * math.hypot(*(one["standard_uncertainty"] for one in periods))
    assert all(one["value"] == pytest.approx(2.55, abs=0.01) for one in periods)
    assert damping[0] > 3.0 * damping[1]
    assert inertias == pytest.approx([821.0 * (2.55 / (2.0 * math.pi)) ** 2] * 2, rel=0.01)
