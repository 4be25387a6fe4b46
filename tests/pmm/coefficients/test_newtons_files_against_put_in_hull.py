"""Text files by Newton's law: the hull comes back, or it is said why it does not."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from tests.pmm.coefficients.newtons_files import (
    COLUMNS,
    HALF_M,
    HEAD,
    MASS_KG,
    PUT_IN,
    SPEED_M_S,
    SURGE,
    WITH_SURGE,
    exchanged,
    written,
)

TABLES = Path(__file__).parents[2] / "data" / "panel"
pytestmark = pytest.mark.sample(1)


def asked(folder: Path, *options: str) -> Result:
    return CliRunner().invoke(cli, ["coefficients", str(folder), *options])


def recommended(folder: Path) -> dict[str, dict[str, float]]:
    done = asked(folder, "--json")
    assert done.exit_code == 0, done.output
    return {entry["name"]: entry for entry in json.loads(done.stdout)["recommended"]}


def is_put_in(entries: dict[str, dict[str, float]]) -> None:
    for name, value in PUT_IN.items():
        off = abs(entries[name]["value"] - value)
        assert off < 2.0 * entries[name]["half_width"], (name, entries[name]["value"])


def without(*names: str) -> dict[str, str]:
    return {name: column for name, column in COLUMNS.items() if name not in names}


@pytest.mark.parametrize("missing", ["", "displacement_aft", "displacement_fore"])
def test_the_hull_comes_back_of_one_strut_too(tmp_path: Path, missing: str) -> None:
    folder = written(tmp_path, columns=without(missing))
    is_put_in(recommended(folder))
    text = asked(folder).output
    assert ("[strut_from_set_point]" in text) == bool(missing)
    assert not any(words in text for words in ("opposite", "exchanged", "one amplitude alone"))


def test_forces_alone_are_refused(tmp_path: Path) -> None:
    folder = written(tmp_path, columns=without("displacement_aft", "displacement_fore"))
    done = asked(folder)
    assert done.exit_code == 1
    assert "nothing tells where in the motion the forces are" in done.output


def test_a_channel_that_goes_with_the_motion_is_enough(tmp_path: Path) -> None:
    columns = without("displacement_aft", "displacement_fore") | {"theta": "Weg hinten [mm]"}
    is_put_in(
        recommended(written(tmp_path, columns=columns, more='[reference]\nchannel = "theta"\n'))
    )


@pytest.mark.parametrize(
    ("columns", "said"),
    [
        (exchanged("force_aft", "force_fore"), "force_aft and force_fore seem exchanged"),
        (COLUMNS | {"force_aft": "-Kraft hinten [N]"}, "force_aft: its sign is opposite"),
        (COLUMNS | {"force_fore": "-Kraft vorne [N]"}, "force_fore: its sign is opposite"),
    ],
)
def test_gauges_connected_wrongly_are_named_of_one_amplitude(
    tmp_path: Path, columns: dict[str, str], said: str
) -> None:
    text = " ".join(asked(written(tmp_path, amplitudes_m=(0.08,), columns=columns)).output.split())
    assert said in text[: text.index("Recommended values")]
    assert "one amplitude alone does not tell whether it is linear" in text
    assert text.count("opposite to expectation") + text.count("seem exchanged") == 1


@pytest.mark.parametrize("turned", ["aft", "fore"])
def test_a_gauge_turned_round_is_named_of_sway_alone(tmp_path: Path, turned: str) -> None:
    channel = f"force_{turned}"
    columns = COLUMNS | {channel: f"-{COLUMNS[channel]}"}
    output = asked(written(tmp_path, kinds=("sway",), columns=columns)).output
    assert f"{channel}: its sign is opposite" in output
    assert output.count("opposite to expectation") == 1


def test_a_run_of_one_period_is_left_out_among_whole_ones(tmp_path: Path) -> None:
    folder = written(tmp_path, lasting_s={"sway-0.25-0.1": 10.4})
    is_put_in(recommended(folder))
    text = asked(folder).output
    assert "sway-0.25-0.1: left out: a single whole period tells no scatter" in text
    assert "nan" not in text.split()
    assert "DIFFER" not in text


def test_of_runs_that_all_are_too_short_nothing_is_held_against_the_other(tmp_path: Path) -> None:
    names = [f"{k}-{f}-{a}" for k in ("sway", "yaw") for f in (0.25, 0.4) for a in (0.05, 0.1)]
    folder = written(tmp_path, lasting_s={name: 2.6 / float(name.split("-")[1]) for name in names})
    text = asked(folder).output
    assert "[no_interval]" in text
    assert "DIFFER" not in text
    assert "nan" not in text.split()


@pytest.mark.parametrize(("mass_kg", "differs"), [(48.0, False), (50.4, True)])
def test_a_mass_that_dry_runs_contradict_is_said(
    tmp_path: Path, mass_kg: float, differs: bool
) -> None:
    text = asked(written(tmp_path, dry=True, mass_kg=mass_kg)).output
    line = "m from 8 runs in air is 48.0"
    assert (line in text[: text.index("Recommended values")]) == differs
    assert (f"from [model] {mass_kg:g} kg: they DIFFER" in text) == differs


def spheroids_waves(frequency_hz: np.ndarray) -> np.ndarray:
    """Sway of the panel method's spheroid, with an added mass in slow motion of 35 kg."""
    with (TABLES / "hulls.csv").open(encoding="utf-8") as file:
        rows = [
            [float(row[key]) for key in ("freq_hz", "added_mass", "damping")]
            for row in csv.DictReader(file)
            if row["body"].startswith("spheroid") and row["dof"] == "sway"
        ]
    hertz, added_mass, damping = np.array(rows).T
    scale = -PUT_IN["Y_vdot"] / added_mass[0]
    remembered = np.interp(frequency_hz, hertz, added_mass - added_mass[0])
    omega = 2.0 * math.pi * frequency_hz
    return np.asarray(scale * (1j * omega * remembered + np.interp(frequency_hz, hertz, damping)))


def test_slow_motion_is_told_of_a_model_that_makes_waves(tmp_path: Path) -> None:
    """At speed no state space is fitted; waves add 60 % to the damping of the fastest run."""
    hertz = (0.2, 0.3, 0.4, 0.55)
    found = recommended(written(tmp_path, frequencies_hz=hertz, waves=spheroids_waves))
    for name in ("Y_v", "Y_vdot"):
        assert abs(found[name]["value"] - PUT_IN[name]) < found[name]["half_width"], found[name]
        assert found[name]["half_width"] < 0.4 * abs(PUT_IN[name]), found[name]


def test_the_surge_added_mass_does_not_pass_for_what_turns(tmp_path: Path) -> None:
    """A model that yaws on a steady carriage is hastened along itself, about as v r."""
    folder = written(tmp_path, columns=WITH_SURGE, kinds=("sway", "yaw", "mixed"))
    found = recommended(folder)
    for name, value in SURGE.items():
        off = abs(found[name]["value"] - value)
        assert off < 2.0 * found[name]["half_width"], (name, found[name])
        assert found[name]["half_width"] < 0.1 * abs(value), found[name]


AT_REST = """
[[at_rest]]
name = "{0}"
file = "{0}.csv"
kind = "{1}"
duration_s = 8.0
{2}
"""


def drift_tests(folder: Path, quartic: float) -> Path:
    """Write tows at drift angles, of a resistance at the carriage's speed and more."""
    text = HEAD.format(
        mass_kg=MASS_KG, more="", columns="\n".join(f'{a} = "{b}"' for a, b in WITH_SURGE.items())
    )
    angles = [math.radians(deg) for deg in (-20, -15, -10, -5, 0, 5, 10, 15, 20)]
    for seed, angle in enumerate([None, *angles]):
        name = "zero" if angle is None else f"drift-{math.degrees(angle):.0f}"
        loads = (0.0, 0.0, 0.0)
        if angle is not None:
            u, v = SPEED_M_S * math.cos(angle), -SPEED_M_S * math.sin(angle)
            side, turn = -62.0 * v - 210.0 * v**3, -31.0 * v
            ahead = -9.0 * (u / SPEED_M_S) ** 2 - 20.0 * v**2 + quartic * v**4
            loads = ((-side + turn / HALF_M) / 2.0, (-side - turn / HALF_M) / 2.0, -ahead)
        noise = np.random.default_rng(seed).normal(size=(800, 6)) * (0, 0, 0, 0.05, 0.05, 0.05)
        record = np.column_stack(
            (np.arange(800) / 100.0, np.zeros((800, 2)), np.tile(loads, (800, 1)))
        )
        header = ";".join(["Zeit [s]", *WITH_SURGE.values()])
        np.savetxt(folder / f"{name}.csv", record + noise, "%.6f", ";", header=header, comments="")
        towed = f'carriage_speed_m_s = {SPEED_M_S}\ndrift_rad = {angle}\nzero_before = "zero"'
        kind = "zero" if angle is None else "static-drift" if angle else "straight-tow"
        text += AT_REST.format(name, kind, "" if angle is None else towed)
    (folder / "campaign.toml").write_text(text)
    return folder


@pytest.mark.parametrize("quartic", [0.0, 150.0])
def test_a_surge_force_that_is_no_parabola_over_drift(tmp_path: Path, quartic: float) -> None:
    found = recommended(drift_tests(tmp_path, quartic))
    put_in = {"X_0": -9.0, "X_vv": -20.0} | ({"X_vvvv": quartic} if quartic else {})
    assert ("X_vvvv" in found) == bool(quartic)
    for name, value in put_in.items():
        off = abs(found[name]["value"] - value)
        assert off < 2.0 * found[name]["half_width"], (name, found[name])


def test_a_hull_whose_loads_go_with_its_own_speed_comes_back(tmp_path: Path) -> None:
    """As manoeuvring models have it; the heading swings by 20 degrees."""
    cross = {"Y_vrr": -60.0, "Y_vvr": 90.0}
    kinds, sizes = ("sway", "yaw", "mixed"), (0.08, 0.16, 0.24)
    folder = written(tmp_path, kinds=kinds, amplitudes_m=sizes, cross=cross)
    found = recommended(folder)
    for name, value in (PUT_IN | cross).items():
        off = abs(found[name]["value"] - value)
        assert off < 2.0 * found[name]["half_width"], (name, found[name])
    for name in ("Y_vrr", "Y_vvr"):
        assert found[name]["half_width"] < 0.7 * abs(cross[name]), found[name]
    assert "the square of the model's own speed" in " ".join(asked(folder).output.split())
