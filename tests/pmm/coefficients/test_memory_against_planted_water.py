"""What is said and written of a planted memory, and what a simulation makes of it again."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from analysis.coefficients.campaign import campaign_coefficients
from analysis.coefficients.campaign_plan import Request
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.memory.measured_matrices import measured_matrices
from analysis.readers import read_recording
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign_file import read_campaign
from pmm.cli import cli
from pmm.coefficients.memory_file import write_memory
from pmm.coefficients.settings import CoefficientSettings
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.data import as_data
from pmm.report.coefficients_document import coefficients_document
from pmm.report.memory_figure import memory_figures
from sim.model.water.table_files import hull_csv
from sim.model.water.tables import RadiationTable
from tests.analysis.memory import planted

HEAD = (
    '[oscillator]\npreset = "horizontal-1963"\n\n[model]\nmass_kg = 70.0\ninertia_kg_m2 = 27.5\n\n'
)
EXAMPLE = Path(__file__).parents[3] / "examples" / "lines" / "campaign.toml"
OMEGA = np.geomspace(0.15, 120.0, 200)
IN_BAND = np.linspace(2.0 * np.pi * 0.3, 2.0 * np.pi * 1.7, 41)


@cache
def outcome(remembers: bool = True) -> CampaignOutcome:
    cycles = planted.single_sines(2, remembers=remembers)
    result = campaign_coefficients(cycles, Request(nonlinear=False))
    return CampaignOutcome(
        (), result, tuple(cycles), (), StatedUncertainties(), CoefficientSettings(),
        at_rest=measured_matrices(result),
    )  # fmt: skip


@pytest.mark.slow
def test_a_simulation_reads_what_is_written_and_gives_the_harmonics_again(tmp_path: Path) -> None:
    write_memory(outcome(), tmp_path / "hull.toml")
    (tmp_path / "campaign.toml").write_text(HEAD + (tmp_path / "hull.toml").read_text())
    own = read_campaign(tmp_path / "campaign.toml").rig()
    assert own.radiation is not None
    (one,) = outcome().memories
    for told, fitted in (
        (own.radiation.added_mass(IN_BAND), one.radiation.added_mass(IN_BAND)),
        (own.radiation.damping(IN_BAND), one.radiation.damping(IN_BAND)),
    ):
        assert told == pytest.approx(fitted, abs=1e-4 * np.abs(fitted).max())
    again = replace(planted.rig(), water=own.water, radiation=own.radiation)
    for frequency_hz, phase in ((0.4, 0.0), (0.8, 1.2), (1.2, np.pi)):
        point = SetPoint(frequency_hz, 0.02, phase)
        before, after = planted.steady(planted.rig(), point), planted.steady(again, point)
        assert np.abs(after - before)[2:].max() < 5e-3 * np.abs(before)[2:].max()


def test_document_holds_poles_curves_and_state_space() -> None:
    told = as_data(coefficients_document(outcome()))
    (one,) = told["memory"]
    assert (one["motions"], one["states"], one["doubts"]) == ("sway and yaw", 4, [])
    assert one["band_hz"] == pytest.approx([0.3, 1.7])
    for pole in one["poles"]:
        assert pole["real_1_s"] < 0.0
    value, half = one["elements"][0]["added_mass_infinite"]
    assert abs(value - planted.INFINITE[0, 0]) < 2.0 * half
    slow, half = one["elements"][0]["added_mass_slow"]
    strength, (_, square) = planted.STRENGTH[0, 0]
    assert abs(slow - (planted.INFINITE[0, 0] + strength / square)) < 2.0 * half
    space = {key: np.array(matrix) for key, matrix in one["state_space"].items()}
    omega = 2.0 * np.pi * np.array(one["frequencies_hz"])
    resolvent = (
        1j * omega[:, None, None] * np.eye(len(space["state_matrix"])) - space["state_matrix"]
    )
    memory = space["output_matrix"] @ np.linalg.solve(
        resolvent,
        np.broadcast_to(space["input_matrix"], (omega.size, *space["input_matrix"].shape)),
    )
    assert memory[:, 0, 0].real + space["steady_damping"][0, 0] == pytest.approx(
        np.array(one["curves"]["b22"]["fitted"]), rel=1e-9
    )
    (figure,) = memory_figures(outcome())
    assert len(figure.draw().axes) == 6


def test_no_memory_is_said_and_the_hull_written_without_one(tmp_path: Path) -> None:
    document = coefficients_document(outcome(False))
    said = [line for one in document.contents for line in getattr(one, "lines", ())]
    assert any("do not change with the frequency: no memory" in str(line) for line in said)
    write_memory(outcome(False), tmp_path / "hull.toml")
    assert not (tmp_path / "hull.csv").exists()
    (tmp_path / "campaign.toml").write_text(HEAD + (tmp_path / "hull.toml").read_text())
    campaign = read_campaign(tmp_path / "campaign.toml")
    assert campaign.radiation is None
    assert campaign.hull.added_mass[0][0] == pytest.approx(60.0, rel=1e-3)
    assert campaign.hull.damping[0][0] == pytest.approx(20.0, rel=1e-2)


def test_too_few_frequencies_and_another_point_are_refused(tmp_path: Path) -> None:
    few = replace(outcome(), at_rest=())
    with pytest.raises(DataError, match="sway or yaw are not known at four frequencies or more"):
        write_memory(few, tmp_path / "hull.toml")
    settings = replace(outcome().settings, point_ahead_m=0.1)
    with pytest.raises(ConfigurationError, match="about the midpoint"):
        write_memory(replace(outcome(), settings=settings), tmp_path / "hull.toml")


def test_three_frequencies_tell_no_memory() -> None:
    runs = [one for one in outcome().cycles if one.frequency_hz < 0.8]
    assert measured_matrices(campaign_coefficients(runs, Request(nonlinear=False))) == ()


@pytest.mark.slow
def test_the_commands_give_the_records_again(tmp_path: Path) -> None:
    """Recorded, fitted, written and recorded again with the same noise: forces within 0.5 %."""
    table = RadiationTable(
        Plane.HORIZONTAL, OMEGA, planted.water().added_mass(OMEGA), planted.water().damping(OMEGA)
    )
    text = EXAMPLE.read_text(encoding="utf-8")
    start, end = text.index("[hull]"), text.index("[acquisition]")
    hull = "[hull]\ndamping = [[20.0, 9.0], [-3.0, 8.0]]\n\n"
    hull += '[radiation]\nfile = "water.csv"\nstates = 4\n\n'
    (tmp_path / "water.csv").write_text(hull_csv(table, "planted", "closed form"))
    (tmp_path / "campaign.toml").write_text(text[:start] + hull + text[end:])
    _done("simulate", tmp_path / "campaign.toml", "--output", tmp_path / "first")
    _done(
        "coefficients",
        tmp_path / "first",
        "--jobs",
        1,
        "--memory",
        tmp_path / "again" / "hull.toml",
    )
    written = (tmp_path / "again" / "hull.toml").read_text()
    (tmp_path / "again" / "campaign.toml").write_text(text[:start] + written + "\n" + text[end:])
    _done("simulate", tmp_path / "again" / "campaign.toml", "--output", tmp_path / "second")
    for run in ("sway", "yaw"):
        before, after = (read_recording(tmp_path / k / f"{run}.nc") for k in ("first", "second"))
        for name in ("force_aft", "force_fore"):
            own, other = before.values(name), after.values(name)
            assert np.std(other - own) < 5e-3 * np.std(own)


def _done(*words: object) -> None:
    result = CliRunner().invoke(cli, list(map(str, words)))
    assert result.exit_code == 0, result.output
