"""Every bad text file gets its own clear word, and no number."""

import gzip
import re
from pathlib import Path

import pytest

from analysis.readers import ColumnMap, read_recording
from analysis.readers.columns_options import parse_options
from analysis.readers.columns_toml import parse_column_map
from hardware.description.errors import ConfigurationError, DataError, PmmError

GOOD = "Time [s],F [N]\n" + "".join(f"{n / 100:.2f},{n % 7}.5\n" for n in range(200))


def written(folder: Path, text: str, name: str = "run.csv") -> Path:
    path = folder / name
    path.write_text(text, encoding="utf-8")
    return path


def refused(
    path: Path,
    message: str,
    columns: ColumnMap | None = None,
    kind: type[PmmError] = DataError,
) -> None:
    with pytest.raises(kind, match=message) as caught:
        read_recording(path, columns)
    assert str(path) in str(caught.value)


def test_missing_file(tmp_path: Path) -> None:
    refused(tmp_path / "no.csv", "no such file$")
    refused(tmp_path / "run_1", "no such file or folder$")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("Time [s],F [N],G [N]\n0,1,2\n1,2\n2,3,4\n", "line 3 has 2 cells, the header has 3"),
        ("Time [s],F [N],G [N]\n0,1\n1,2,3\n2,3,4\n", "line 2 has 2 cells, the header has 3"),
        ('Time [s],F [N],"G, a [N]"\n0,1,2\n1,"2"\n2,3,4\n', "line 3 has 2 cells"),
        ("Time [s];F [N];G [N]\n0;1,5;2\n\n1;2,5\n2;3;4\n", "line 4 has 2 cells"),
        ("Time[s] F[N] G[N]\n0 1 2\n1 2\n2 3 4\n", "line 3 has 2 cells"),
    ],
)
def test_short_row(tmp_path: Path, text: str, message: str) -> None:
    refused(written(tmp_path, text), message)


def test_empty_last_cells_are_missing_values_and_no_short_rows(tmp_path: Path) -> None:
    rows = [f"{n},{n % 5},{'' if n == 7 else n % 3}" for n in range(20)]
    text = "\n".join(["Time [s],F [N],G [N]", *rows]) + "\n"
    assert {flag.code for flag in read_recording(written(tmp_path, text)).flags} == {"repaired"}


def test_separators_that_end_the_header_ask_for_no_cells(tmp_path: Path) -> None:
    text = "Time [s],F [N],\n" + "".join(f"{n},{n % 5}\n" for n in range(20))
    assert read_recording(written(tmp_path, text)).sample_count == 20


def test_a_short_last_row_is_left_out(tmp_path: Path) -> None:
    recording = read_recording(written(tmp_path, f"{GOOD}2.00\n"))
    assert recording.sample_count == 200
    assert [flag.code for flag in recording.flags] == ["row_cut"]


def test_folder(tmp_path: Path) -> None:
    (tmp_path / "run.csv").mkdir()
    refused(tmp_path / "run.csv", "a folder, not a recording")


@pytest.mark.parametrize("name", ["run.csv", "run.csv.gz", "run.nc"])
def test_empty_file(tmp_path: Path, name: str) -> None:
    refused(written(tmp_path, "", name), "the file is empty")


def test_blank_file(tmp_path: Path) -> None:
    refused(written(tmp_path, " \n\n"), "the file is empty")


def test_gzip_of_nothing(tmp_path: Path) -> None:
    path = tmp_path / "run.csv.gz"
    path.write_bytes(gzip.compress(b""))
    refused(path, "the file is empty")


@pytest.mark.parametrize("name", ["run.xls", "run", "run.nc.gz"])
def test_unknown_kind(tmp_path: Path, name: str) -> None:
    refused(written(tmp_path, GOOD, name), r"kind of file is not known.*\.csv")


def test_truncated_gzip(tmp_path: Path) -> None:
    path = tmp_path / "run.csv.gz"
    path.write_bytes(gzip.compress(GOOD.encode())[:-40])
    refused(path, "gzip file is cut short; copy it again")


def test_not_gzip(tmp_path: Path) -> None:
    refused(written(tmp_path, GOOD, "run.csv.gz"), "not a gzip file, whatever its name says$")


def test_damaged_gzip(tmp_path: Path) -> None:
    data = bytearray(gzip.compress(GOOD.encode()))
    data[len(data) // 2] ^= 0xFF
    path = tmp_path / "run.csv.gz"
    path.write_bytes(bytes(data))
    refused(path, "gzip file")


def test_binary_file(tmp_path: Path) -> None:
    path = tmp_path / "run.dat"
    path.write_bytes(b"\x01\x00\x02\x00" * 50)
    refused(path, "not a text file")


def test_header_alone(tmp_path: Path) -> None:
    refused(written(tmp_path, "Time [s],F [N]\n"), "no rows of data")


def test_nothing_after_the_skipped_lines(tmp_path: Path) -> None:
    columns = parse_column_map({"skip_rows": 500}, "map")
    refused(written(tmp_path, GOOD), "no data in the file after the 500 skipped lines", columns)


def test_text_where_numbers_belong_names_line_column_and_text(tmp_path: Path) -> None:
    text = GOOD.replace("1.50,3.5", "1.50,overload")
    line = text.split("\n").index("1.50,overload") + 1
    refused(written(tmp_path, text), rf"line {line}, column 'F \[N\]': 'overload' is not a number")


def test_line_number_counts_blank_lines_and_preamble(tmp_path: Path) -> None:
    text = "# lab\n\n" + GOOD.replace("0.05,5.5", "\n0.05,5.5x")
    line = text.split("\n").index("0.05,5.5x") + 1
    refused(written(tmp_path, text), f"line {line}, .*'5.5x'")


def test_decimal_commas_behind_whole_numbers_name_the_remedy(tmp_path: Path) -> None:
    rows = [f"{n};{n % 3}{',5' if n > 30 else ''}" for n in range(50)]
    text = "\n".join(["Zeit [s];Kraft [N]", *rows, ""])
    refused(written(tmp_path, text), "line 33, .*'1,5' is not a number; with decimal = ','")
    columns = parse_column_map({"decimal": ","}, "map")
    assert read_recording(written(tmp_path, text), columns).values("Kraft")[31] == 1.5


def test_too_many_cells(tmp_path: Path) -> None:
    text = GOOD.replace("1.50,3.5", "1.50,3.5,9")
    refused(written(tmp_path, text), "line 152 has 3 cells, the header has 2")


def test_decimal_commas_between_comma_separators(tmp_path: Path) -> None:
    rows = "".join(f"0,{n:02d},1,5\n" for n in range(50))
    refused(written(tmp_path, "Time [s],F [N]\n" + rows), "line 2 has 4 cells.*decimal")


def test_preamble_that_nobody_skipped(tmp_path: Path) -> None:
    text = "Run 17, of the campaign\n" + GOOD.replace("Time [s]", "Column 1")
    refused(written(tmp_path, text), "no column is named as time .*Run 17, of the.*skip_rows")


def test_time_runs_backwards(tmp_path: Path) -> None:
    text = GOOD.replace("1.00,2.5", "0.50,2.5")
    refused(written(tmp_path, text), r"time runs backwards at data row 101: 0\.5 s after 0\.99 s")


def test_time_repeats(tmp_path: Path) -> None:
    text = GOOD.replace("1.00,2.5", "0.99,2.5")
    refused(written(tmp_path, text), r"time repeats at data row 101: 0\.99 s after 0\.99 s")


def test_missing_time_stamp(tmp_path: Path) -> None:
    refused(written(tmp_path, GOOD.replace("1.00,", ",")), "time stamp.*data row 101")


def test_one_row(tmp_path: Path) -> None:
    refused(written(tmp_path, "Time [s],F [N]\n0,1\n"), "1 row.*at least 2")


def test_everything_missing(tmp_path: Path) -> None:
    text = re.sub(r",\d\.5", ",NaN", GOOD)
    refused(written(tmp_path, text), r"no channel has any value, all are missing \(F\)")


def test_no_time_column(tmp_path: Path) -> None:
    text = GOOD.replace("Time [s]", "when [s]")
    refused(written(tmp_path, text), r"no column is named as time.*when \[s\], F \[N\].*rate")


def test_time_in_a_unit_of_length(tmp_path: Path) -> None:
    refused(written(tmp_path, GOOD.replace("[s]", "[mm]")), "'mm', which is no unit of time")


def test_time_in_an_unknown_unit(tmp_path: Path) -> None:
    refused(written(tmp_path, GOOD.replace("[s]", "[ticks]")), "unknown unit 'ticks'")


def test_no_channel_beside_time(tmp_path: Path) -> None:
    refused(written(tmp_path, "Time [s]\n0\n1\n2\n"), "no column is left to be a channel")


def test_two_channels_of_one_name(tmp_path: Path) -> None:
    text = "Time [s],F [N],F [kN]\n0,1,2\n1,2,3\n"
    refused(written(tmp_path, text), "column_2 and column_3 would both be called 'F'")


def test_mapped_column_is_not_there(tmp_path: Path) -> None:
    columns = parse_options(["force_aft=Fx:N"])
    message = r"no column 'Fx'.*did you mean 'F \[N\]'"
    refused(written(tmp_path, GOOD), message, columns, ConfigurationError)


def test_mapped_column_is_there_twice(tmp_path: Path) -> None:
    text = "Time [s],F,F\n0,1,2\n1,2,3\n"
    columns = parse_options(["force_aft=F:N"])
    message = "2 columns are 'F'; ask for column_2 or column_3"
    refused(written(tmp_path, text), message, columns, ConfigurationError)


@pytest.mark.parametrize("rate", [0.0, -5.0, float("nan"), float("inf")])
def test_impossible_sample_rate(tmp_path: Path, rate: float) -> None:
    with pytest.raises(ConfigurationError, match="a sample rate of"):
        read_recording(written(tmp_path, GOOD), sample_rate_hz=rate)


def test_edges_that_do_not_increase(tmp_path: Path) -> None:
    columns = parse_column_map({"photocell": {"edges_s": [0.1, 0.9, 0.8]}}, "map")
    refused(written(tmp_path, GOOD), "photocell edge 3 does not come after", columns)


def test_missing_edges_file(tmp_path: Path) -> None:
    columns = parse_column_map({"photocell": {"edges_file": "{stem}_edges.csv"}}, "map")
    with pytest.raises(DataError, match=r"run_edges\.csv: cannot be read: No such file"):
        read_recording(written(tmp_path, GOOD), columns)


def test_edges_file_without_a_time_column(tmp_path: Path) -> None:
    written(tmp_path, "A [s],B [s]\n0.1,0.2\n", "edges.csv")
    columns = parse_column_map({"photocell": {"edges_file": "edges.csv"}}, "map")
    with pytest.raises(DataError, match="name the column of edge times 'time'"):
        read_recording(written(tmp_path, GOOD), columns)


def test_edges_file_in_a_unit_of_length(tmp_path: Path) -> None:
    written(tmp_path, "edge [mm]\n0.1\n", "edges.csv")
    columns = parse_column_map({"photocell": {"edges_file": "edges.csv"}}, "map")
    with pytest.raises(DataError, match="edge times in 'mm'; give them in seconds"):
        read_recording(written(tmp_path, GOOD), columns)
