"""Every example of docs/formats.md is read, and its tables say what the code does."""

import json
import os
import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from analysis.coefficients.campaign_plan import OWN_MODEL
from analysis.readers import from_dataset, read_recording
from analysis.readers.columns_options import parse_options
from analysis.readers.columns_toml import read_column_map
from analysis.readers.photocell import read_edges
from hardware.description import dataset as schema
from hardware.description.channels import Channel
from hardware.description.flags import DAMAGED
from hardware.description.setpoint import SetPoint
from hardware.description.units import unit
from pmm.plan.simulated_rig import CODE as SIMULATED_DIFFERS

ROOT = Path(__file__).parents[3]
TEXT = (ROOT / "docs" / "formats.md").read_text(encoding="utf-8")


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)


def cells(heading: str, tables: int = 1) -> list[list[str]]:
    """The rows of the tables under a heading, without their heads."""
    section = TEXT.split(f" {heading}\n", 1)[1].split("\n#", 1)[0]
    rows = re.findall(r"^\|(.*)\|$", section, re.MULTILINE)
    heads = [k for k, row in enumerate(rows) if set(row) <= set("-|")]
    assert len(heads) <= tables
    kept = [row for k, row in enumerate(rows) if k not in heads and k + 1 not in heads]
    return [[cell.strip() for cell in row.split("|")] for row in kept]


def test_every_block_is_of_a_kind_that_a_test_reads() -> None:
    kinds = set(re.findall(r"^```(\w+)$", TEXT, re.MULTILINE))
    assert kinds == {"csv", "toml", "options", "json", "python", "sh"}


@pytest.mark.parametrize("text", blocks("csv"))
def test_text_examples_are_read(tmp_path: Path, text: str) -> None:
    path = tmp_path / "run.csv"
    path.write_text(text, encoding="utf-8")
    if text.startswith("edge"):
        assert read_edges(path) == pytest.approx([1.01625, 2.221071, 3.425893])
        return
    recording = read_recording(path)
    assert recording.sample_rate_hz == pytest.approx(200.0, rel=1e-7)
    assert all(channel.unit for channel in recording.channels)
    assert {flag.code for flag in recording.flags} <= {"index_column", "time_single_precision"}


@pytest.mark.parametrize("text", blocks("toml"))
def test_column_maps_are_read(tmp_path: Path, text: str) -> None:
    path = tmp_path / "map.toml"
    path.write_text(text, encoding="utf-8")
    assert read_column_map(path).photocell is not None


@pytest.mark.parametrize("text", blocks("options"))
def test_options_are_read(text: str) -> None:
    assert parse_options(text.splitlines()).channels


@pytest.mark.parametrize("text", blocks("json"))
def test_attributes_are_read(text: str) -> None:
    variables = {"F": ("time", np.arange(5.0), {"units": "N"})}
    dataset = xr.Dataset(variables, {"time": np.arange(5) / 200.0}, json.loads(text))
    recording = from_dataset(dataset)
    assert recording.set_point == SetPoint(0.83, 0.02, 0.0, 1.2)
    assert [flag.code for flag in recording.flags] == ["gap"]


@pytest.mark.parametrize("text", blocks("python"))
def test_python_examples_run(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    exec(compile(text, "formats.md", "exec"), {})  # noqa: S102


def test_units_of_the_table_are_known_and_become_what_it_says() -> None:
    for _, names, si in cells("Units"):
        for name in re.findall(r"`([^`]+)`", names):
            assert unit(name).si == si, name


def test_flag_codes_are_those_of_the_code() -> None:
    sources = (ROOT / "analysis" / "readers").glob("*.py")
    text = "".join(path.read_text(encoding="utf-8") for path in sources)
    severity = r"Severity\.(?:NOTE|WARNING|VOID)"
    used = set(re.findall(rf'Flag\(\s*"(\w+)",\s*{severity}', text)) | {
        "time_rounded",
        "time_jitter",
        DAMAGED,
    }
    assert {row[0].strip("`") for row in cells("Flags")} == used


def test_flag_codes_of_reference_and_gate_are_those_of_the_code() -> None:
    """Every code of the resolver and of a recorded run is in a table, and no other."""
    sources = [*(ROOT / "analysis" / "resolver").glob("*.py"), ROOT / "sim" / "run.py"]
    text = "".join(path.read_text(encoding="utf-8") for path in sources)
    used = set(re.findall(r'Flag\(\s*"([\w-]+)"', text))
    assert len(re.findall(r"\bFlag\(", text)) == len(re.findall(r'\bFlag\(\s*"', text))
    recorded = (ROOT / "pmm" / "run" / "measurement.py").read_text(encoding="utf-8")
    assert "force_far" in re.findall(r'note\("([\w-]+)"', recorded)
    door = (ROOT / "pmm" / "campaign" / "recording_source.py").read_text(encoding="utf-8")
    used |= {"force_far", SIMULATED_DIFFERS, OWN_MODEL}
    used |= set(re.findall(r'Flag\(\s*"([\w-]+)"', door))
    assert {row[0].strip("`") for row in cells("Flags of reference and gate", 5)} == used


def test_attributes_of_the_schema_are_documented() -> None:
    names = [value for key, value in vars(schema).items() if key.isupper()]
    assert len(names) >= 12
    missing = [name for name in names if f"`{name}`" not in TEXT]
    assert not missing


def test_keys_of_the_map_are_documented(tmp_path: Path) -> None:
    path = tmp_path / "map.toml"
    path.write_text("zzzzzz = 1\n", encoding="utf-8")
    with pytest.raises(Exception, match="known: ") as caught:
        read_column_map(path)
    known = str(caught.value).split("known: ")[1].split(", ")
    documented = {row[0].strip("`").split(".")[0] for row in cells("Column map")}
    assert set(known) == documented


def test_standard_channels_are_documented() -> None:
    import hardware.description.channels as channels

    standard = [item.name for item in vars(channels).values() if isinstance(item, Channel)]
    assert standard
    assert all(f"`{name}`" in TEXT for name in standard)


def test_no_path_of_a_machine() -> None:
    assert str(ROOT) not in TEXT
    assert os.path.expanduser("~") + "/" not in TEXT  # noqa: PTH111
