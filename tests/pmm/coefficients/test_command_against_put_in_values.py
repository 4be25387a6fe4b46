"""``pmm coefficients`` gives back what the simulator was given, in every output, on any engine."""

import csv
import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

from analysis.coefficients.exchange import from_dataset, from_dict
from analysis.coefficients.normalisation import prime
from analysis.exchange.simman_files import read_simman
from analysis.readers import write_recording
from hardware.description.setpoint import SetPoint
from pmm.cli import cli
from sim.rig import SimulatedRig, vertical_rig
from tests.pmm.coefficients.campaigns import at_rest, head, record, vertical_campaign

NAMES = ("Z_wdot", "Z_w", "M_wdot", "M_w", "Z_qdot", "Z_q", "M_qdot", "M_q")


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder: Path = tmp_path_factory.mktemp("campaign") / "trial"
    vertical_campaign(folder, dry=True)
    return folder


def run(*words: object) -> Result:
    return CliRunner().invoke(cli, ["coefficients", *map(str, words)])


def done(*words: object) -> dict[str, Any]:
    result = run(*words, "--json")
    assert result.exit_code == 0, result.output
    found: dict[str, Any] = json.loads(result.stdout)
    return found


def truth(rig: SimulatedRig) -> dict[str, float]:
    """Derivatives that the hull was given: minus added mass and damping, by name."""
    found = {}
    for kind, matrix in (("dot", rig.water.added_mass), ("", rig.water.damping)):
        for row, load in enumerate("ZM"):
            for column, velocity in enumerate("wq"):
                found[f"{load}_{velocity}{kind}"] = -matrix[row][column]
    return found


def linear(document: dict[str, Any]) -> list[dict[str, Any]]:
    return [row for row in document["coefficients"]["table"] if row["method"] == "linear"]


def check_truth(rows: list[dict[str, Any]], factor: float = 1.0) -> None:
    expected = truth(vertical_rig())
    assert {row["name"] for row in rows} == set(NAMES)
    for row in rows:
        off = abs(row["value"] - expected[row["name"]])
        assert off <= max(factor * 1.5 * row["half_width"], 2e-3 * abs(expected[row["name"]])), row


@pytest.mark.slow
def test_with_the_models_inertia(campaign: Path) -> None:
    found = done(campaign)
    assert found["schema"] == "pmm-coefficients-1"
    assert len(linear(found)) == 16
    check_truth(linear(found))
    assert found["stated"]["mass_kg"] == 0.02
    budgets = {(one["name"], line["source"]) for one in found["budgets"] for line in one["lines"]}
    assert ("Z_wdot", "mass") in budgets
    assert ("M_qdot", "moment of inertia") in budgets


@pytest.mark.slow
def test_with_dry_runs(campaign: Path) -> None:
    found = done(campaign, "--inertia", "dry")
    assert found["body"] is None
    check_truth(linear(found))
    codes = {flag["code"] for one in found["coefficients"]["flags"] for flag in [one]}
    assert "dry_run_taken_off" in codes


@pytest.mark.slow
def test_with_a_file_of_pmm_inertia(campaign: Path, tmp_path: Path) -> None:
    body = vertical_rig().body
    path = tmp_path / "model.toml"
    path.write_text(
        f"[model]\nmass_kg = {body.mass_kg + 1.0}\ninertia_kg_m2 = {body.inertia_kg_m2}\n"
        f"cg_x_m = {body.cg_x_m}\ncg_z_m = {body.cg_z_m}\n"
    )
    heavier = {row["name"]: row["value"] for row in linear(done(campaign, "--inertia", path))}
    own = {row["name"]: row["value"] for row in linear(done(campaign))}
    assert heavier["Z_wdot"] - own["Z_wdot"] == pytest.approx(1.0, abs=1e-9)


@pytest.mark.slow
def test_repeats_behind_the_inertia_count(campaign: Path, tmp_path: Path) -> None:
    body = vertical_rig().body
    path = tmp_path / "model.toml"
    path.write_text(
        f"[model]\nmass_kg = {body.mass_kg}\ninertia_kg_m2 = {body.inertia_kg_m2}\n"
        f"cg_x_m = {body.cg_x_m}\ncg_z_m = {body.cg_z_m}\n"
        "[model_uncertainty]\ninertia_kg_m2 = 0.5\ninertia_degrees_of_freedom = 4.0\n"
    )
    found = done(campaign, "--inertia", path)
    rows = [row for row in linear(found) if row["name"] == "M_qdot"]
    for row in rows:
        assert row["half_width"] == pytest.approx(2.776445 * 0.5, rel=0.01)
    assert len(rows) == 2
    assert found["stated"]["inertia_degrees_of_freedom"] == 4.0


@pytest.mark.slow
def test_several_processes_and_trials_give_the_same_numbers(campaign: Path) -> None:
    options = ("--uncertainty", "monte-carlo", "--trials", 6000, "--seed", 4)
    one = done(campaign, *options, "--jobs", 1)
    two = done(campaign, *options, "--jobs", 2)
    assert one == two
    for row in linear(one):
        width = (row["trials_high"] - row["trials_low"]) / 2.0
        # Drawn Student's t of five degrees beside stated normal ones is wider than the budget's
        # effective degrees of freedom say, by 16 % at most where both are as large.
        assert width == pytest.approx(row["half_width"], rel=0.2)
        assert row["trials_low"] < row["value"] < row["trials_high"]


@pytest.mark.slow
def test_trials_are_those_of_the_analysis(campaign: Path) -> None:
    from analysis.coefficients.campaign import campaign_coefficients
    from pmm.coefficients.settings import CoefficientSettings
    from pmm.coefficients.workflow import coefficients_of, request_of
    from pmm.parallel import InThisProcess

    settings = CoefficientSettings(trials=6000, seed=2)
    found = coefficients_of([campaign], settings, InThisProcess(), lambda *_: None)
    own = campaign_coefficients(found.cycles, request_of(settings, found.stated))
    np.testing.assert_array_equal(found.result.values, own.values)
    np.testing.assert_array_equal(found.result.trials.low, own.trials.low)
    np.testing.assert_array_equal(found.result.trials.high, own.trials.high)


@pytest.mark.slow
def test_prime_system_is_that_of_the_definition(campaign: Path, tmp_path: Path) -> None:
    settings = tmp_path / "coefficients.toml"
    settings.write_text("[ship]\nlength_m = 2.5\ndensity_kg_m3 = 1000.0\n")
    plain = linear(done(campaign))
    scaled = linear(done(campaign, "--system", "prime", "--settings", settings))
    system = prime(2.5, 1.2, 1000.0)
    for one, other in zip(plain, scaled, strict=True):
        mass = system.mass_kg if "dot" in one["name"] else system.mass_per_second
        levers = (one["name"][0] == "M") + ("q" in one["name"])
        assert other["value"] == pytest.approx(one["value"] / (mass * 2.5**levers), rel=1e-12)
        assert other["unit"] == "1"


@pytest.mark.slow
def test_files_hold_the_same_numbers(campaign: Path, tmp_path: Path) -> None:
    import xarray as xr

    table, kept, folder = tmp_path / "t.csv", tmp_path / "t.nc", tmp_path / "simman"
    found = done(campaign, "--csv", table, "--netcdf", kept, "--simman", folder)
    rows = found["coefficients"]["table"]
    lines = table.read_text().splitlines()
    assert lines[:2] == ["# system = dimensional", "# level = 0.95"]
    read = list(csv.DictReader(lines[2:]))
    assert [float(row["value"]) for row in read] == [row["value"] for row in rows]
    assert [row["name"] for row in read] == [row["name"] for row in rows]
    with xr.open_dataset(kept, engine="h5netcdf") as dataset:
        from_file = from_dataset(dataset.load())
        assert json.loads(dataset.attrs["provenance"])["program"].startswith("pmm ")
    again = from_dict(found["coefficients"])
    np.testing.assert_array_equal(from_file.values, again.values)
    np.testing.assert_allclose(from_file.half_widths, again.half_widths, rtol=1e-12)
    one = read_simman(folder / "one-0.6-20")
    assert one.frequency_hz == pytest.approx(0.6, rel=1e-6)
    assert one.description.mass_kg == vertical_rig().body.mass_kg
    assert one.description.logging_rate_hz == 100.0
    assert one.description.density_kg_m3 is None, "nobody states it"
    assert run(campaign, "--csv", table).exit_code == 2  # never over a file that is there


@pytest.mark.slow
def test_tables_for_people_name_their_system(campaign: Path) -> None:
    result = run(campaign)
    assert result.exit_code == 0
    assert "Recommended values: dimensional" in result.output
    assert "Alternatives, linear: dimensional" in result.output
    assert "Intervals hold the value with 95 %" in result.output
    assert "Z_wdot" in result.output


@pytest.mark.slow
def test_a_hull_table_beside_the_values(campaign: Path, tmp_path: Path) -> None:
    expected = truth(vertical_rig())
    path = tmp_path / "strip.csv"
    rows = "".join(
        f"{name},{f},1.2,{value * (1.1 if name == 'Z_w' else 1.0)}\n"
        for name, value in expected.items()
        for f in (0.5, 1.0)
    )
    path.write_text(f"# name = strip theory\ncoefficient,frequency_hz,speed_m_s,value\n{rows}")
    path.write_text("# allowance_relative = 0.004\n" + path.read_text())
    found = done(campaign, "--reference", path)["coefficients"]["references"]
    assert {one["reference"] for one in found} == {"strip theory"}
    assert {one["name"] for one in found if not one["within"]} == {"Z_w"}
    off = [one["difference"] / one["expected"] for one in found if one["name"] == "Z_w"]
    assert off == pytest.approx([-1.0 / 11.0] * len(off), abs=2e-3)


def test_offsets_and_their_drift_are_taken_off_the_means(tmp_path: Path) -> None:
    from pmm.coefficients.settings import CoefficientSettings
    from pmm.coefficients.workflow import coefficients_of
    from pmm.parallel import InThisProcess

    rig, point = vertical_rig(), SetPoint(0.6, 0.02, 0.0, 1.2)
    text = head(rig)
    table = record(tmp_path, rig, "heave", point)
    text += table + 'zero_before = "z1"\nzero_after = "z2"\nnumber = 2\n'
    for number, (name, mean) in enumerate((("z1", (1.0, 4.0)), ("z2", (5.0, 8.0)))):
        write_recording(at_rest(name, mean), tmp_path / f"{name}.nc")
        text += (
            f'\n[[at_rest]]\nname = "{name}"\nkind = "zero"\nfile = "{name}.nc"\n'
            f"duration_s = 10.0\nnumber = {1 + 3 * number}\n"
        )
    (tmp_path / "campaign.toml").write_text(text)
    settings = CoefficientSettings(wanted=("Z_wdot",))
    found = coefficients_of([tmp_path], settings, InThisProcess(), lambda *_: None)
    bare = (tmp_path / "campaign.toml").read_text()
    (tmp_path / "campaign.toml").write_text(
        bare.replace("zero_before", "# ").replace("zero_after", "# ")
    )
    plain = coefficients_of([tmp_path], settings, InThisProcess(), lambda *_: None)
    off = [
        (before.phasors["force 0"] - after.phasors["force 0"]).real
        for before, after in zip(plain.cycles, found.cycles, strict=True)
    ]
    # A third of the way from 1 + 4 to 5 + 8 N.
    assert off == pytest.approx([5.0 + 8.0 / 3.0], abs=0.01)
    assert found.cycles[0].mean_known
    np.testing.assert_allclose(found.cycles[0].loads, plain.cycles[0].loads, rtol=1e-12)


@pytest.mark.slow
def test_known_lag_and_gain_are_taken_out(tmp_path: Path) -> None:
    """A chain that reads 3 % too much and 2 ms late gives the truth once it is named."""
    from analysis.coefficients.corrections import Delay
    from pmm.coefficients.reading import response_of
    from pmm.coefficients.settings import AmplifierTable

    one = response_of(AmplifierTable(lag_s=2e-3, gain=1.03))
    omega = 2.0 * np.pi * 0.6
    assert one(1j * omega) == pytest.approx(Delay(2e-3, 1.03)(1j * omega))
    filtered = response_of(AmplifierTable(cutoff_hz=10.0, order=2))
    assert abs(filtered(2j * np.pi * 10.0)) == pytest.approx(2.0**-0.5)

    folder = tmp_path / "c"
    vertical_campaign(folder, (0.6,))
    for path in sorted(folder.glob("*.nc")):
        _spoil(path, gain=1.03)
    settings = tmp_path / "s.toml"
    settings.write_text(
        "[amplifiers.force_aft]\ngain = 1.03\n[amplifiers.force_fore]\ngain = 1.03\n"
    )
    check_truth(linear(done(folder, "--settings", settings)))
    settings.write_text(
        "calibration_matrix = [[0.970873786407767, 0.0], [0.0, 0.970873786407767]]\n"
    )
    check_truth(linear(done(folder, "--settings", settings)))


def _spoil(path: Path, gain: float) -> None:
    from analysis.readers import read_recording

    own = read_recording(path)
    samples = own.samples[:, 0 : own.sample_count].copy()
    for row, name in enumerate(own.channel_names):
        if name.startswith("force"):
            samples[row] *= gain
    write_recording(replace(own, samples=samples), path, overwrite=True)


@pytest.mark.slow
def test_figures_are_written_for_what_there_is(campaign: Path, tmp_path: Path) -> None:
    assert run(campaign, "--plot", tmp_path / "plots").exit_code == 0
    names = {path.name for path in (tmp_path / "plots").iterdir()}
    assert names == {
        f"coefficients-{kind}-1.{end}" for kind in ("frequency", "budget") for end in ("svg", "png")
    }
    text = (tmp_path / "plots" / "coefficients-frequency-1.svg").read_text()
    for said in ("frequency (Hz)", "Z_wdot", "(kg)", "linear, 20 mm", "dimensional"):
        assert said in text
