"""``docs/campaigns.md`` and the campaigns that come with the package, against the classes."""

import json
import re
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any, get_args

import pytest
from click.testing import CliRunner

from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.known_loads import KnownMass, LoadStep
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Oscillator
from hardware.description.setpoint import Medium, SetPoint
from pmm.campaign.campaign import Campaign, Simulation, SwitchedOn
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.runs import AtRest, Run
from pmm.cli import cli
from sim.acquisition.channels import Acquisition, Digitiser
from sim.acquisition.photocell import PhotocellStage
from sim.drive.carriage import CarriageSettings, Fluctuation
from sim.drive.prescribed_drive import DriveSettings
from sim.gauges.dynamometer import Dynamometer, Dynamometers
from sim.mechanism.linkage import Setting
from sim.model.attitude import Squat
from sim.model.hull import HullCoefficients
from sim.model.law_point import Acting
from sim.model.laws import AnyLaw
from sim.model.mounting import Mounting
from sim.model.water.force_laws import CrossFlow
from sim.model.water.radiation_file import RadiationFile
from sim.rig import vertical_rig

HOUSE = Path(__file__).parents[2]
PAGE = (HOUSE / "docs" / "campaigns.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```toml\n(.*?)^```", PAGE, flags=re.MULTILINE | re.DOTALL)
IN_CODE = set(re.findall(r"`([^`\n]+)`", re.sub(r"```.*?```", "", PAGE, flags=re.DOTALL)))
SHIPPED = HOUSE / "examples"


def _write(folder: Path, text: str) -> Path:
    path = folder / "campaign.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("text", BLOCKS)
def test_the_examples_of_the_page_are_valid(text: str, tmp_path: Path) -> None:
    assert read_campaign(_write(tmp_path, text)).runs


def test_there_are_examples() -> None:
    assert len(BLOCKS) == 3


@pytest.mark.parametrize(
    "kind",
    [
        Run,
        AtRest,
        KnownMass,
        LoadStep,
        Simulation,
        Oscillator,
        Body,
        HullCoefficients,
        DriveSettings,
        Dynamometers,
        Dynamometer,
        Acquisition,
        Digitiser,
        PhotocellStage,
        ReferenceChoice,
        ResolverSettings,
        CarriageSettings,
        Fluctuation,
        Setting,
        Mounting,
        RadiationFile,
        CrossFlow,
        Acting,
        Squat,
        SwitchedOn,
        *(law for law in get_args(AnyLaw)),
    ],
)
def test_every_key_is_documented(kind: type) -> None:
    assert is_dataclass(kind)
    assert {field.name for field in fields(kind)} <= IN_CODE


def test_every_table_is_documented() -> None:
    keys = {"[name]", "[model_name]", "[tared]", "[runs]"}
    tables = {f"[{field.name}]" for field in fields(Campaign)} - keys
    assert tables <= IN_CODE | {f"[{name}]" for name in re.findall(r"\[(\w+)\]", PAGE)}


def _keys(value: Any) -> set[str]:
    if isinstance(value, dict):
        return set(value).union(*(_keys(part) for part in value.values()))
    if isinstance(value, list):
        return set().union(*(_keys(part) for part in value))
    return set()


def test_every_key_of_the_json_documents_is_documented(tmp_path: Path) -> None:
    campaign = str(SHIPPED / "vertical" / "campaign.toml")
    arguments = ["simulate", campaign, "--run", "heave-1.20", "--output", str(tmp_path), "--json"]
    simulated = CliRunner().invoke(cli, arguments, catch_exceptions=False)
    recording = str(tmp_path / "heave-1.20.nc")
    analysed = CliRunner().invoke(cli, ["analyse", recording, "--json"], catch_exceptions=False)
    keys = _keys(json.loads(simulated.stdout)) | _keys(json.loads(analysed.stdout))
    assert {"runs", "phase_deg", "samples", "flags"} <= keys
    assert keys <= IN_CODE


@pytest.mark.parametrize("name", ["vertical", "horizontal"])
@pytest.mark.parametrize("file", ["rig.toml", "simulated.toml"])
def test_the_demo_runs_on_the_rigs_of_the_examples(name: str, file: str) -> None:
    shipped = HOUSE / "pmm" / "cli" / "demo_rigs" / name / file
    assert shipped.read_bytes() == (SHIPPED / name / file).read_bytes()


def test_the_vertical_example_is_the_nominal_rig() -> None:
    rig = read_campaign(SHIPPED / "vertical" / "campaign.toml").rig()
    nominal = vertical_rig()
    assert (rig.oscillator, rig.body, rig.water) == (
        nominal.oscillator,
        nominal.body,
        nominal.water,
    )
    assert rig.dynamometers == nominal.dynamometers
    assert rig.acquisition.force_fore == nominal.acquisition.force_fore


def test_defaults_are_those_of_the_page(tmp_path: Path) -> None:
    campaign = read_campaign(_write(tmp_path, BLOCKS[0]))
    assert campaign.name == tmp_path.name
    assert campaign.oscillator == VERTICAL_1963
    assert campaign.runs[0].set_point == SetPoint(0.8, 0.02, 0.0, 0.0, Medium.WATER)
    assert (campaign.runs[0].periods, campaign.runs[0].file) == (10, None)
    assert campaign.simulation == Simulation(200.0, 3, 1)
    assert campaign.photocell == PhotocellStage()


def test_the_columns_of_the_page_reach_the_reader(tmp_path: Path) -> None:
    columns = read_campaign(_write(tmp_path, BLOCKS[1])).columns
    assert columns is not None
    assert [channel.sign for channel in columns.channels] == [1, 1, -1]
    assert columns.origin == "campaign.toml [columns]"


def test_keys_beside_a_preset_replace_single_values(tmp_path: Path) -> None:
    text = '[oscillator]\npreset = "horizontal-1963"\nrod_length_m = 1.5\n'
    oscillator = read_campaign(_write(tmp_path, text)).oscillator
    assert oscillator is not None
    assert oscillator.rod_length_m == 1.5
    assert oscillator.frequency_hz == HORIZONTAL_1963.frequency_hz


def test_false_leaves_a_sensor_out(tmp_path: Path) -> None:
    text = (
        f"photocell = false\n{BLOCKS[0]}\n[acquisition]\nforce_fore = false\nshaft_angle = {{}}\n"
    )
    rig = read_campaign(_write(tmp_path, text)).rig()
    assert rig.photocell is None
    assert [line.channel.name for line in rig.acquisition.lines] == ["shaft_angle", "force_aft"]


def test_a_recording_is_looked_for_under_the_runs_name_first(tmp_path: Path) -> None:
    run = read_campaign(_write(tmp_path, BLOCKS[1])).runs[0]
    assert run.recording_path(tmp_path) == tmp_path / "run_017.csv.gz"
    (tmp_path / "sway-0.2.nc").touch()
    assert run.recording_path(tmp_path) == tmp_path / "sway-0.2.nc"


def test_a_campaign_without_a_model_is_no_rig(tmp_path: Path) -> None:
    campaign = read_campaign(_write(tmp_path, BLOCKS[1]))
    with pytest.raises(ConfigurationError, match=r"no table \[oscillator\] and \[model\]"):
        campaign.rig()
