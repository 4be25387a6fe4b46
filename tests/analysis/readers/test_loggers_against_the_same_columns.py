"""Headers as small loggers and other programs write them, all of the same two columns."""

from pathlib import Path

import pytest

from analysis.readers import read_recording
from analysis.readers.columns_options import parse_options
from hardware.description.errors import DataError

HEADS = {
    "Arduino": ("millis,F\n", ",", 1e3),
    "microseconds": ("micros,F\n", ",", 1e6),
    "several words": ("Elapsed Time (ms),F\n", ",", 1e3),
    "German": ("Zeit seit Start [ms];F\n", ";", 1e3),
    "epoch": ("Epoch,F\n", ",", 1.0),
    "units in a comment": ("# made today\n#time force\n#(s) (N)\n", " ", 1.0),
    "units in a comment, bare": ("%t;F\n%ms;N\n", ";", 1e3),
    "units in brackets below": ("Time,F\n[ms],[N]\n", ",", 1e3),
}


@pytest.mark.parametrize("kind", HEADS)
def test_time_is_found_in_its_unit(tmp_path: Path, kind: str) -> None:
    head, separator, per_second = HEADS[kind]
    rows = [f"{per_second * (2.0 + 0.01 * k):.6g}{separator}{k * k}" for k in range(50)]
    path = tmp_path / "log.csv"
    path.write_text(head + "\n".join(rows) + "\n")
    found = read_recording(path)
    assert len(found.channel_names) == 1
    assert found.start_s == pytest.approx(2.0)
    assert found.sample_rate_hz == pytest.approx(100.0)
    assert found.values(found.channel_names[0])[7] == 49.0
    assert (
        not [flag for flag in found.flags if flag.code == "time_unit_assumed"] or per_second == 1.0
    )


@pytest.mark.parametrize(
    ("unit", "per_second"), [("s", 1), ("ms", 1000), ("us", 10**6), ("ns", 10**9)]
)
def test_time_since_1970_is_read_in_the_unit_that_its_size_tells(
    tmp_path: Path, unit: str, per_second: int
) -> None:
    count = [(1_732_600_000 * 100 + k) * per_second // 100 for k in range(50)]
    if per_second == 1:
        count = [1_732_600_000 + k for k in range(50)]
    path = tmp_path / "log.csv"
    path.write_text("timestamp,F [N]\n" + "".join(f"{at},{at % 7}\n" for at in count))
    found = read_recording(path)
    assert found.start_s == pytest.approx(1_732_600_000, abs=1e-3)
    assert found.sample_rate_hz == pytest.approx(1.0 if per_second == 1 else 100.0, rel=1e-6)
    (flag,) = (one for one in found.flags if one.code == "time_unit_assumed")
    assert (f"{unit}, as they count from 1970" in flag.message) is (per_second > 1)


def test_time_that_cannot_be_in_its_stated_unit_is_refused_with_the_option(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text(
        "time [s],F [N]\n" + "".join(f"{1.7326e12 + 10 * k:.0f},1\n" for k in range(50))
    )
    with pytest.raises(DataError, match=r"5\.49e\+04 years .* time=time:UNIT"):
        read_recording(path)
    columns = parse_options(["time=time:ms"])
    assert read_recording(path, columns).sample_rate_hz == pytest.approx(100.0)


@pytest.mark.parametrize(
    "titles",
    ["Decay;;\n12.3.2025;Smith;\n", "Serial;0815;\n", "Run;7;\n\nBegun;14:03:07;\n",
     "Run 12;calm water;\nModel: barge;;\n"],
)  # fmt: skip
@pytest.mark.parametrize("units", ["", "ms;N;\n"])
def test_titles_as_wide_as_the_table_are_passed_over(
    tmp_path: Path, titles: str, units: str
) -> None:
    per_second = 1e3 if units else 1.0
    rows = [f"{per_second * (2.0 + 0.01 * k):.6g};{k * k};" for k in range(50)]
    path = tmp_path / "log.csv"
    path.write_text(f"{titles}Time;F;\n{units}" + "\n".join(rows) + "\n")
    found = read_recording(path)
    assert found.channel_names == ("F",)
    assert found.start_s == pytest.approx(2.0)


def test_numbers_of_channels_over_their_units_are_their_names(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = "\n".join(f"{0.01 * k:.2f},{k},{k * k}" for k in range(50))
    path.write_text(f"Time,1,2\ns,N,N\n{rows}\n")
    assert read_recording(path).channel_names == ("1", "2")
    path.write_text(f"Time,1,2\n{rows}\n")
    assert read_recording(path).channel_names == ("1", "2")


def test_degrees_with_their_sign_are_degrees(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    rows = "\n".join(f"{10 * k},{k},{k}" for k in range(50))
    path.write_text(f"Time [ms],roll [°],rate (°/s)\n{rows}\n", encoding="latin-1")
    found = read_recording(path)
    assert [one.unit for one in found.channels] == ["rad", "rad/s"]
    assert found.values("roll")[9] == pytest.approx(0.1570796)
