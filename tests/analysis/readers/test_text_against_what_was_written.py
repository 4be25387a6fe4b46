"""Text of many shapes comes back as the numbers that were written, with what was noticed."""

import gzip
import hashlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from analysis.readers import ColumnMap, read_recording
from analysis.readers.columns_options import parse_options
from analysis.readers.columns_toml import parse_column_map
from analysis.recording import Recording
from hardware.description.channels import Channel
from hardware.description.flags import Severity

COUNT = 100


def signal(count: int = COUNT) -> np.ndarray:
    n = np.arange(count)
    return np.asarray(np.round(np.sin(0.1 * n) + 0.001 * n, 6))


def table(header: str, separator: str = ",", decimal: str = ".", time: str = "{:.2f}") -> str:
    rows = [
        separator.join((time.format(n / 100), repr(float(f)))).replace(".", decimal)
        for n, f in enumerate(signal())
    ]
    return "\n".join([header, *rows, ""])


def read(folder: Path, text: str, columns: ColumnMap | None = None, **options: float) -> Recording:
    path = folder / "run.csv"
    path.write_text(text, encoding="utf-8")
    return read_recording(path, columns, **options)


def codes(recording: Recording) -> list[str]:
    return [flag.code for flag in recording.flags]


def test_plain(tmp_path: Path) -> None:
    recording = read(tmp_path, table("Time [s],F [N]"))
    assert recording.name == "run"
    assert recording.channels == (Channel("F", "N"),)
    assert recording.sample_rate_hz == 100.0
    assert recording.start_s == 0.0
    assert recording.flags == ()
    assert np.array_equal(recording.values("F"), signal())


def test_gzip_has_the_same_numbers_and_its_own_fingerprint(tmp_path: Path) -> None:
    data = gzip.compress(table("Time [s],F [N]").encode())
    path = tmp_path / "2091_1.csv.gz"
    path.write_bytes(data)
    recording = read_recording(path)
    assert recording.name == "2091_1"
    assert np.array_equal(recording.values("F"), signal())
    assert recording.provenance["sha256"] == hashlib.sha256(data).hexdigest()
    assert recording.provenance["source_file"] == "2091_1.csv.gz"
    assert recording.provenance["reader"] == "csv"


@pytest.mark.parametrize("suffix", [".txt", ".dat", ".asc", ".tsv", ".CSV"])
def test_other_names_of_text(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"run{suffix}"
    path.write_text(table("Time [s],F [N]"))
    assert np.array_equal(read_recording(path).values("F"), signal())


@pytest.mark.parametrize(
    ("separator", "decimal"),
    [(",", "."), (";", "."), (";", ","), ("\t", "."), ("\t", ","), (" ", "."), ("   ", ",")],
)
def test_separators_and_decimal_signs_are_found(
    tmp_path: Path, separator: str, decimal: str
) -> None:
    recording = read(tmp_path, table(f"Time [s]{separator}F [N]", separator, decimal))
    assert recording.channels == (Channel("F", "N"),)
    assert np.array_equal(recording.values("F"), signal())


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
def test_encodings_and_line_ends(tmp_path: Path, encoding: str, line_end: str) -> None:
    path = tmp_path / "run.csv"
    path.write_bytes(table("Zeit [s],Kräfte [N]").replace("\n", line_end).encode(encoding))
    recording = read_recording(path)
    assert recording.channel_names == ("Kräfte",)
    assert np.array_equal(recording.values("Kräfte"), signal())


@pytest.mark.parametrize(
    ("header", "unit", "factor", "flags"),
    [
        ("F [kN]", "N", 1e3, []),
        ("F (kN)", "N", 1e3, []),
        ("F(mm)", "m", 1e-3, []),
        ("F_mm", "m", 1e-3, ["unit_from_suffix"]),
        ("F mm", "m", 1e-3, ["unit_from_suffix"]),
        ("F / kN", "N", 1e3, ["unit_from_suffix"]),
        ("F N m", "N m", 1.0, ["unit_from_suffix"]),
        ("F in mm/s", "m/s", 1e-3, ["unit_from_suffix"]),
        ("F [deg]", "rad", np.pi / 180, []),
        ("F", "", 1.0, ["unit_missing"]),
        ("F []", "", 1.0, ["unit_missing"]),
        ("F [bar]", "", 1.0, ["unit_unknown"]),
    ],
)
def test_units_of_headers(
    tmp_path: Path, header: str, unit: str, factor: float, flags: list[str]
) -> None:
    recording = read(tmp_path, table(f"Time [s],{header}"))
    assert recording.channels == (Channel("F", unit),)
    assert np.array_equal(recording.values("F"), signal() * factor)
    assert codes(recording) == flags
    assert all(flag.channel == "F" for flag in recording.flags)


def test_a_number_at_the_end_of_a_name_is_no_unit(tmp_path: Path) -> None:
    assert read(tmp_path, table("Time [s],WP_1")).channel_names == ("WP_1",)


def test_a_line_of_units_under_the_header(tmp_path: Path) -> None:
    recording = read(tmp_path, table("Time,F\nms,kN", time="{:.3f}"))
    assert recording.channels == (Channel("F", "N"),)
    assert recording.sample_rate_hz == pytest.approx(100e3, rel=1e-12)


@pytest.mark.parametrize(
    ("written", "kept"), [("m/s2", "m/s2"), ("m/s^2", "m/s2"), ("m/s²", "m/s2"), ("(1)", "1")]
)
def test_a_line_of_units_that_end_in_a_digit(tmp_path: Path, written: str, kept: str) -> None:
    recording = read(tmp_path, table(f"Time,a\ns,{written}"))
    assert recording.channels == (Channel("a", kept),)
    assert recording.sample_count == COUNT


def test_a_first_row_of_ones_is_no_line_of_units(tmp_path: Path) -> None:
    rows = [f"{n},{n % 3}" for n in range(1, 31)]
    recording = read(tmp_path, "\n".join(["Time [s],F [N]", *rows, ""]))
    assert recording.values("F")[0] == 1.0
    assert recording.sample_count == 30


@pytest.mark.parametrize("header", ["time", "Time", "t", "T (s)", "time_s", "Zeit [s]"])
def test_time_is_found_by_its_name(tmp_path: Path, header: str) -> None:
    recording = read(tmp_path, table(f"{header},F [N]"))
    assert recording.channel_names == ("F",)
    assumed = "s" not in header.replace("times", "")
    assert (codes(recording) == ["time_unit_assumed"]) is assumed


def test_leading_index_column_is_dropped_and_said(tmp_path: Path) -> None:
    lines = table("Time [s],F [N]").splitlines()
    text = "\n".join([f",{lines[0]}", *(f"{n},{row}" for n, row in enumerate(lines[1:])), ""])
    recording = read(tmp_path, text)
    assert recording.channel_names == ("F",)
    assert codes(recording) == ["index_column"]
    assert recording.flags[0].severity is Severity.NOTE


def test_unnamed_first_column_that_does_not_count_is_kept(tmp_path: Path) -> None:
    lines = table("Time [s],F [N]").splitlines()
    text = "\n".join([f",{lines[0]}", *(f"{n % 5},{row}" for n, row in enumerate(lines[1:])), ""])
    assert read(tmp_path, text).channel_names == ("column_1", "F")


def test_separator_at_the_end_of_every_row(tmp_path: Path) -> None:
    lines = table("Time [s];F [N]", ";").splitlines()
    text = "\n".join([lines[0], *(f"{row};" for row in lines[1:]), ""])
    recording = read(tmp_path, text)
    assert recording.channel_names == ("F",)
    assert codes(recording) == ["empty_column"]


def test_header_written_by_numpy(tmp_path: Path) -> None:
    path = tmp_path / "run.txt"
    np.savetxt(path, np.c_[np.arange(COUNT) / 100, signal()], header="Time [s] F [N]")
    recording = read_recording(path)
    assert recording.channels == (Channel("F", "N"),)
    assert np.array_equal(recording.values("F"), signal())


def test_no_header_and_no_time(tmp_path: Path) -> None:
    text = "\n".join(f"{f!r}" for f in signal().tolist()) + "\n"
    recording = read(tmp_path, text, sample_rate_hz=50.0)
    assert recording.channel_names == ("column_1",)
    assert recording.sample_rate_hz == 50.0
    assert np.array_equal(recording.values("column_1"), signal())


def test_given_rate_takes_the_place_of_the_time_column(tmp_path: Path) -> None:
    text = table("Time [s],F [N]").replace("0.50,", "0.10,")
    recording = read(tmp_path, text, sample_rate_hz=64.0)
    assert (recording.sample_rate_hz, recording.start_s) == (64.0, 0.0)
    assert codes(recording) == ["time_not_used"]


def test_last_row_cut_short_is_left_out_and_said(tmp_path: Path) -> None:
    recording = read(tmp_path, table("Time [s],F [N]")[:-1].rsplit(",", 1)[0])
    assert recording.sample_count == COUNT - 1
    assert codes(recording) == ["row_cut"]


def test_no_line_end_at_the_end_is_said(tmp_path: Path) -> None:
    recording = read(tmp_path, table("Time [s],F [N]")[:-1])
    assert recording.sample_count == COUNT
    assert codes(recording) == ["no_final_newline"]


def test_short_gap_is_filled_and_long_gap_stays_empty(tmp_path: Path) -> None:
    lines = table("Time [s],F [N]").splitlines()
    kept = lines[:21] + lines[23:51] + lines[60:]
    recording = read(tmp_path, "\n".join([*kept, ""]))
    values = recording.values("F")
    assert recording.sample_count == COUNT
    assert np.flatnonzero(np.isnan(values)).tolist() == list(range(50, 59))
    assert values[20:22] == pytest.approx(signal()[20:22], abs=6e-5)
    gap, repaired, missing = recording.flags
    assert (gap.code, repaired.code, missing.code) == ("gap", "repaired", "missing")
    assert "11 sample(s) are missing in 2 gap(s), the most 9" in gap.message
    assert "2 missing sample(s)" in repaired.message
    assert "9 sample(s) are missing" in missing.message
    assert missing.severity is Severity.VOID


def test_missing_cells_and_own_marks_of_missing(tmp_path: Path) -> None:
    text = table("Time [s],F [N]")
    lines = text.splitlines()
    for row, mark in ((30, "NaN"), (50, ""), (70, "-9999"), (80, " nan ")):
        lines[row + 1] = f"{lines[row + 1].split(',')[0]},{mark}"
    columns = parse_column_map({"missing": ["-9999"]}, "map")
    recording = read(tmp_path, "\n".join([*lines, ""]), columns)
    assert codes(recording) == ["repaired"]
    assert "4 missing sample(s)" in recording.flags[0].message
    assert recording.values("F") == pytest.approx(signal(), abs=2e-5)


@pytest.mark.parametrize("odd", ["", "  ", "\t"])
def test_an_empty_line_of_a_single_column_is_a_missing_value(tmp_path: Path, odd: str) -> None:
    """Within the data, that is: those above and below are no rows."""
    values = signal()
    cells = [repr(float(value)) for value in values]
    cells[30:32], cells[60:65] = [odd] * 2, [odd] * 5
    recording = read(tmp_path, "\n".join(["F [N]", "", *cells, "", "", ""]), sample_rate_hz=100.0)
    assert sorted(codes(recording)) == ["missing", "repaired"]
    found = recording.values("F")
    lost = np.isnan(found)
    assert np.flatnonzero(lost).tolist() == [60, 61, 62, 63, 64]
    assert found[~lost] == pytest.approx(values[~lost], abs=2e-5)


def test_decimal_commas_beside_a_column_of_text(tmp_path: Path) -> None:
    rows = [f"{n / 100:.2f};{value};OK".replace(".", ",") for n, value in enumerate(signal())]
    columns = parse_column_map({"time": "Zeit:s", "channels": {"F": "Kraft:N"}}, "map")
    recording = read(tmp_path, "\n".join(["Zeit;Kraft;Status", *rows, ""]), columns)
    np.testing.assert_array_equal(recording.values("F"), signal())


def test_one_empty_channel_beside_a_good_one(tmp_path: Path) -> None:
    text = "\n".join(
        ["Time [s],F [N],G [N]", *(f"{n / 100},{f}," for n, f in enumerate(signal())), ""]
    )
    recording = read(tmp_path, text)
    assert [(flag.code, flag.channel) for flag in recording.flags] == [("channel_empty", "G")]
    assert np.isnan(recording.values("G")).all()


def test_infinite_values_count_as_missing(tmp_path: Path) -> None:
    lines = table("Time [s],F [N]").splitlines()
    for row in range(30, 40):
        lines[row] = lines[row].split(",")[0] + ",inf"
    recording = read(tmp_path, "\n".join([*lines, ""]))
    assert codes(recording) == ["beyond_range", "missing"]


def test_map_renames_turns_scales_and_converts(tmp_path: Path) -> None:
    text = table("Time [s],U [V]")
    channel = {"column": "U", "unit": "kN", "sign": -1, "scale": 0.2, "full_scale": 0.5}
    columns = parse_column_map({"channels": {"force_aft": channel}}, "map.toml")
    recording = read(tmp_path, text, columns)
    assert recording.channels == (Channel("force_aft", "N", 500.0),)
    assert recording.values("force_aft") == pytest.approx(-0.2 * 1e3 * signal(), rel=1e-15)
    assert codes(recording) == ["unit_overridden"]
    assert recording.provenance["column_map"] == "map.toml"


def test_unmapped_text_columns_do_no_harm(tmp_path: Path) -> None:
    rows = [f"{n / 100},{f},note {n}" for n, f in enumerate(signal())]
    text = "\n".join(["Time [s],F [N],Comment", *rows, ""])
    recording = read(tmp_path, text, parse_options(["force_aft=F"]))
    assert np.array_equal(recording.values("force_aft"), signal())


def test_other_columns_are_kept_on_request(tmp_path: Path) -> None:
    text = "Time [s],A [N],B [mm]\n0,1,2\n1,2,3\n2,3,4\n"
    columns = parse_column_map({"keep_others": True, "channels": {"x": "A"}}, "map")
    assert read(tmp_path, text, columns).channels == (Channel("x", "N"), Channel("B", "m"))


def test_columns_can_be_asked_for_by_number(tmp_path: Path) -> None:
    text = "Time [s],F,F\n0,1,2\n1,2,3\n"
    recording = read(tmp_path, text, parse_options(["b=column_3:N"]))
    assert recording.values("b").tolist() == [2.0, 3.0]


def test_mapped_time_in_milliseconds(tmp_path: Path) -> None:
    text = "clock,F [N]\n" + "".join(f"{1000 + 5 * n},{n}\n" for n in range(50))
    recording = read(tmp_path, text, parse_options(["time=clock:ms", "F"]))
    assert (recording.sample_rate_hz, recording.start_s) == (200.0, 1.0)


def test_photocell_level_becomes_edges(tmp_path: Path) -> None:
    level = [5.0 if (n + 20) % 50 < 10 else 0.0 for n in range(200)]
    rows = [f"{2 + n / 100:.2f},{n},{value}" for n, value in enumerate(level)]
    text = "\n".join(["Time [s],F [N],PC [V]", *rows, ""])
    recording = read(tmp_path, text, parse_options(["F", "photocell=PC"]))
    assert recording.channel_names == ("F",)
    assert recording.photocell_edges_s == pytest.approx([2.295, 2.795, 3.295, 3.795])
    assert codes(recording) == ["photocell_sampled"]


def test_photocell_times_from_a_file_beside(tmp_path: Path) -> None:
    (tmp_path / "run_edges.csv").write_text("edge [ms]\n100.25\n\n500.5\n\n")
    columns = parse_column_map({"photocell": {"edges_file": "{stem}_edges.csv"}}, "map")
    recording = read(tmp_path, table("Time [s],F [N]"), columns)
    assert recording.photocell_edges_s == pytest.approx([0.10025, 0.5005], abs=1e-15)


def test_photocell_times_from_the_map(tmp_path: Path) -> None:
    columns = parse_column_map({"photocell": {"edges_s": [0.1, 0.6]}}, "map")
    recording = read(tmp_path, table("Time [s],F [N]"), columns)
    assert recording.photocell_edges_s is not None
    assert recording.photocell_edges_s.tolist() == [0.1, 0.6]


def test_photocell_without_an_edge_is_said(tmp_path: Path) -> None:
    text = "Time [s],F [N],PC [V]\n" + "".join(f"{n},{n},0\n" for n in range(50))
    recording = read(tmp_path, text, parse_options(["F", "photocell=PC"]))
    assert recording.photocell_edges_s is not None
    assert recording.photocell_edges_s.size == 0
    assert codes(recording) == ["no_photocell_edges"]


finite = st.floats(-1e12, 1e12, width=64)  # beyond it is no measurement


@given(values=arrays(np.float64, (40,), elements=finite), separator=st.sampled_from([",", ";"]))
def test_every_number_comes_back_to_the_last_bit(
    tmp_path_factory: pytest.TempPathFactory, values: np.ndarray, separator: str
) -> None:
    rows = [f"{n / 8}{separator}{value!r}" for n, value in enumerate(values.tolist())]
    text = "\n".join([f"t [s]{separator}F [N]", *rows, ""])
    recording = read(tmp_path_factory.mktemp("bits"), text)
    assume("spike" not in codes(recording))
    assert np.array_equal(recording.values("F"), values)
