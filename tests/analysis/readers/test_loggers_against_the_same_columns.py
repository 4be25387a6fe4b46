"""Headers as small loggers and other programs write them, all of the same two columns."""

from pathlib import Path

import pytest

from analysis.readers import read_recording

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
