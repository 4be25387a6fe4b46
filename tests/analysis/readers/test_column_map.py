"""Column maps from TOML and from options, and one message for all that is wrong with one."""

import re
from pathlib import Path

import pytest

from analysis.readers import (
    ChannelColumn,
    ColumnMap,
    Edge,
    PhotocellColumn,
    TextLayout,
    TimeColumn,
    read_recording,
)
from analysis.readers.columns_options import parse_options
from analysis.readers.columns_toml import read_column_map
from hardware.description.errors import ConfigurationError

FULL = """
time = { column = "clock", unit = "ms" }
sample_rate_hz = 200
separator = ";"
decimal = ","
skip_rows = 3
missing = ["-9999", "***"]
keep_others = true

[channels]
force_fore = "-F2 [N]"
displacement_aft = "S1:mm"
force_aft = { column = "F1", unit = "kN", sign = -1, scale = 2, full_scale = 0.5 }

[photocell]
column = "PC"
threshold = 2.5
edge = "falling"
"""


def test_every_key(tmp_path: Path) -> None:
    path = tmp_path / "map.toml"
    path.write_text(FULL)
    assert read_column_map(path) == ColumnMap(
        channels=(
            ChannelColumn("force_fore", "F2 [N]", sign=-1),
            ChannelColumn("displacement_aft", "S1", "mm"),
            ChannelColumn("force_aft", "F1", "kN", -1, 2.0, 0.5),
        ),
        time=TimeColumn("clock", "ms"),
        sample_rate_hz=200.0,
        photocell=PhotocellColumn("PC", 2.5, Edge.FALLING),
        layout=TextLayout(";", ",", 3, ("-9999", "***")),
        keep_others=True,
        origin="map.toml",
    )


def test_a_unit_that_the_map_asks_for_counts_where_the_header_has_none(tmp_path: Path) -> None:
    table = tmp_path / "table.csv"
    rows = "".join(f"{20 * row},{row % 3}\n" for row in range(50))
    table.write_text(f"Time,F1\n{rows}")
    columns = ColumnMap((ChannelColumn("force_aft", "F1 [kN]"),), TimeColumn("Time [ms]"))
    read = read_recording(table, columns)
    assert read.sample_rate_hz == pytest.approx(50.0)
    assert read.channels[read.index("force_aft")].unit == "N"
    assert list(read.values("force_aft")[:3]) == [0.0, 1000.0, 2000.0]
    assert not {"unit_missing", "time_unit_assumed"} & {flag.code for flag in read.flags}


def test_options() -> None:
    found = parse_options(
        ["Fy=Fy [N]", "force_aft=-F1:kN", "Fz", "time=T:ms", "photocell=PC", "a=AI:0 [V]"]
    )
    assert found.channels == (
        ChannelColumn("Fy", "Fy [N]"),
        ChannelColumn("force_aft", "F1", "kN", -1),
        ChannelColumn("Fz", "Fz"),
        ChannelColumn("a", "AI:0 [V]"),
    )
    assert found.time == TimeColumn("T", "ms")
    assert found.photocell == PhotocellColumn("PC")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("tme = 't'", "tme is not a known key; did you mean time?"),
        ("zzz = 1", "zzz is not a known key; known: channels, time"),
        ("time = 5", "time = 5 should be a column's header or a table"),
        ("time = ''", "time = '': time: no column is named"),
        ("time = '-t'", "time has a sign"),
        ("time = 't:ticks'", "time = 't:ticks': unknown unit 'ticks'"),
        ("time = { unit = 's' }", "time needs the key column"),
        ("time = { column = 't', unt = 's' }", "time.unt is not a known key; did you mean unit?"),
        ("sample_rate_hz = 0", "sample_rate_hz = 0 should be a positive number"),
        ("sample_rate_hz = true", "sample_rate_hz = True should be a positive number"),
        ("sample_rate_hz = inf", "sample_rate_hz = inf should be a positive number"),
        ("sample_rate_hz = '5'", "sample_rate_hz = '5' should be a positive number"),
        ("separator = ''", "separator = '' should be text"),
        ("decimal = ':'", "decimal = ':' should be one of '.', ','"),
        ("skip_rows = -1", "skip_rows = -1 should be a whole number"),
        ("skip_rows = true", "skip_rows = True should be a whole number"),
        ("skip_rows = 1.5", "skip_rows = 1.5 should be a whole number"),
        ("missing = 'NA'", "missing = 'NA' should be a list of texts"),
        ("keep_others = 1", "keep_others = 1 should be true or false"),
        ("channels = 'F'", "channels = 'F' should be a table"),
        ("channels = { F = 3 }", "channels.F = 3 should be a column's header"),
        ("channels = { F = 'F1:Newton' }", "channels.F = 'F1:Newton': unknown unit 'Newton'"),
        ("channels = { F = { unit = 'N' } }", "channels.F needs the key column"),
        ("channels = { F = { column = 'F', unit = 'lb' } }", "channels.F.unit = unknown unit 'lb'"),
        ("channels = { F = { column = 'F', sign = 2 } }", "channels.F.sign = 2 should be 1 or -1"),
        ("channels = { F = { column = 'F', scale = 0 } }", "channels.F.scale = 0"),
        ("channels = { F = { column = 'F', scale = nan } }", "channels.F.scale = nan should be"),
        ("channels = { F = { column = 'F', full_scale = -1 } }", "channels.F.full_scale = -1"),
        ("channels = { F = { colum = 'F' } }", "channels.F.colum is not a known key; did you mean"),
        ("photocell = 3", "photocell = 3 should be a table"),
        ("photocell = { edge = 'rising' }", "photocell needs one of column, edges_s, edges_file"),
        ("photocell = { column = 'P', edges_s = [1.0] }", "photocell needs one of .*; it has 2"),
        ("photocell = { column = 'P', edge = 'up' }", "photocell.edge = 'up' should be one of"),
        ("photocell = { edges_s = ['a'] }", "photocell.edges_s = .'a'. should be a list of times"),
    ],
)
def test_each_fault_names_file_and_key(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "map.toml"
    path.write_text(text)
    with pytest.raises(ConfigurationError, match=message) as caught:
        read_column_map(path)
    assert str(caught.value).startswith(f"{path}: ")


def test_all_faults_of_a_file_come_at_once(tmp_path: Path) -> None:
    path = tmp_path / "map.toml"
    path.write_text("tme = 't'\nskip_rows = -1\n[channels]\nF = { colum = 'F', unit = 'lb' }\n")
    with pytest.raises(ConfigurationError) as caught:
        read_column_map(path)
    for key in ("tme is", "skip_rows =", "F.colum is", "F.unit =", "F needs"):
        assert key in str(caught.value)


def test_missing_and_unreadable_files(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match="no such column map"):
        read_column_map(tmp_path / "none.toml")
    path = tmp_path / "map.toml"
    path.write_text("time = ")
    with pytest.raises(ConfigurationError, match="not a readable TOML file: Invalid value"):
        read_column_map(path)


@pytest.mark.parametrize(
    ("pairs", "message"),
    [
        (["Fy="], "'Fy=': Fy: no column is named"),
        (["=F1"], "'=F1': no name before '='"),
        (["Fy=F1:tons"], "'Fy=F1:tons': unknown unit 'tons'"),
        (["Fy=F1", "Fy=F2"], "'Fy=F2': Fy is mapped twice"),
        (["time=-T"], "time: a sign means nothing here"),
        (["photocell=-P"], "photocell: a sign means nothing here"),
    ],
)
def test_faults_of_options(pairs: list[str], message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        parse_options(pairs)


def test_all_faults_of_options_come_at_once() -> None:
    with pytest.raises(ConfigurationError, match=r"'a='.*unknown unit 'q'"):
        parse_options(["a=", "b=c:q"])


@pytest.mark.parametrize("option", ["Tijd=Tijd:ms", "time=Tijd:ms", "t=klok:ms", "a=Time:ms"])
def test_a_column_called_time_in_a_unit_of_time_is_the_time(option: str) -> None:
    found = parse_options([option, "force_aft=F1:N"])
    assert found.time == TimeColumn(option.split("=")[1].removesuffix(":ms"), "ms")
    assert [channel.name for channel in found.channels] == ["force_aft"]


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ("Tijd:ms", "'Tijd:ms': for the time column write time=Tijd:ms"),
        ("Tijd", "'Tijd': for the time column write time=Tijd:ms"),
        ("F1:kN", "'F1:kN': write NAME=COLUMN or NAME=COLUMN:UNIT, for example F1=F1:kN"),
        ("-F1", "'-F1': write NAME=COLUMN or NAME=COLUMN:UNIT, for example F1=-F1"),
    ],
)
def test_an_option_without_a_name_shows_the_form(option: str, message: str) -> None:
    with pytest.raises(ConfigurationError, match=re.escape(message)):
        parse_options([option])


def test_a_plain_name_that_is_no_column_shows_the_form(tmp_path: Path) -> None:
    path = tmp_path / "run.csv"
    path.write_text("Time [s],F [N]\n0,1\n1,2\n")
    with pytest.raises(ConfigurationError, match=r"no column 'force'.*write NAME=COLUMN or"):
        read_recording(path, parse_options(["force"]))


def test_a_mark_before_a_map_does_not_matter(tmp_path: Path) -> None:
    path = tmp_path / "map.toml"
    path.write_bytes(b"\xef\xbb\xbftime = 'T:ms'\n")
    assert read_column_map(path).time == TimeColumn("T", "ms")


@pytest.mark.parametrize(
    ("wrong", "right"), [("kNN", "kN"), ("KN", "kN"), ("MM", "mm"), ("kg", "kgf")]
)
def test_a_misspelt_unit_is_corrected(wrong: str, right: str) -> None:
    with pytest.raises(ConfigurationError, match=f"'{wrong}'; did you mean '{right}'"):
        parse_options([f"force_aft=F1:{wrong}"])
    with pytest.raises(ConfigurationError, match="known units: "):
        parse_options(["force_aft=F1:furlong"])
