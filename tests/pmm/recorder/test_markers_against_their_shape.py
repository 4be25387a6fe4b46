"""A completion marker of another shape is damage: said, and never the end of a command."""

import json
from pathlib import Path

import pytest

from hardware.description.errors import DataError
from pmm.recorder.files import HEADER, MARKER, RECORDING, RECOVERED
from pmm.recorder.header import RunHeader
from pmm.recorder.line_shapes import read_marker, read_recovered
from pmm.recorder.recovery import recover
from pmm.recorder.run_recorder import RunEnd, RunRecorder
from tests.pmm.recorder.recorded import fed, header

SHAPES = [None, True, 1, -1, 1e400, "text", [], {}, [[]], {"a": []}, {"a": {"bytes": []}}]
KEYS = ["outcome", "files", "flags", "first_sync", "last_sync", "noise_rms"]
MADE = 100


@pytest.fixture(scope="module")
def closed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("markers") / "run"
    with RunRecorder(folder, header()) as recorder:
        fed(recorder, range(1, MADE + 1))
        recorder.close(RunEnd.COMPLETE)
    return folder


@pytest.mark.sample(2)
@pytest.mark.parametrize("key", KEYS)
def test_a_value_of_any_shape_costs_no_sample(closed: Path, tmp_path: Path, key: str) -> None:
    good = json.loads((closed / MARKER).read_text(encoding="utf-8"))
    others = [one for one in SHAPES if json.dumps(one) != json.dumps(good.get(key, "none"))]
    for number, value in enumerate(others):
        place = tmp_path / str(number)
        place.mkdir()
        for path in closed.iterdir():
            if path.name != RECORDING:
                (place / path.name).write_bytes(path.read_bytes())
        text = json.dumps({**good, key: value})
        (place / MARKER).write_text(text, encoding="utf-8")
        found = recover(place)
        assert found.samples == MADE
        assert any(MARKER in flag.message for flag in found.flags)
        assert (place / RECORDING).exists()


@pytest.mark.parametrize("text", ["", "[]", "{", "7", '{"flags": 1}', "[" * 100_000, "\udcff"])
def test_what_is_no_table_is_no_marker(tmp_path: Path, text: str) -> None:
    for name in (MARKER, RECOVERED):
        (tmp_path / name).write_bytes(text.encode("utf-8", "surrogateescape"))
    assert read_marker(tmp_path) is None
    assert read_recovered(tmp_path) == {}


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("number", "1"), ("number", 1e400), ("first_sync", None), ("run_name", 7),
        ("sample_rate_hz", float("nan")), ("sample_rate_hz", 0), ("plan_json", []),
        ("started_utc", 0), ("provenance", {"calibration": 1}), ("configuration_sha256", []),
    ],
)  # fmt: skip
def test_a_header_with_a_value_of_another_kind_is_refused(
    closed: Path, tmp_path: Path, key: str, value: object
) -> None:
    good = json.loads((closed / HEADER).read_text(encoding="utf-8"))
    path = tmp_path / HEADER
    path.write_text(json.dumps(good), encoding="utf-8")
    assert RunHeader.read(path).run_name == good["run_name"]
    path.write_text(json.dumps({**good, key: value}), encoding="utf-8")
    with pytest.raises(DataError, match=f"{HEADER}: damaged run header"):
        RunHeader.read(path)
    path.write_bytes(path.read_bytes() + b"\xff")
    with pytest.raises(DataError, match=f"{HEADER}: damaged run header"):
        RunHeader.read(path)
