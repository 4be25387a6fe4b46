"""The example records and the script that analyses them."""

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest

from analysis.inertia.record import analyse_record, from_runs
from analysis.inertia.series import series_from_recording
from analysis.readers import read_recording

FOLDER = Path(__file__).parents[3] / "examples" / "inertia"


def load(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_records_are_what_the_recipe_writes(tmp_path: Path) -> None:
    import gzip

    load("make").main(tmp_path)
    for path in sorted(FOLDER.glob("*.csv.gz")):
        assert gzip.decompress(path.read_bytes()) == gzip.decompress(
            (tmp_path / path.name).read_bytes()
        )


def test_swing() -> None:
    runs = []
    for path in sorted(FOLDER.glob("swing-*.csv.gz")):
        recording = read_recording(path)
        series = series_from_recording(recording, recording.channel_names[0])
        assert series.unit == "rad"
        runs.append(analyse_record(series))
    found = from_runs(runs).estimate
    low, high = found.interval()
    assert low < 7.2923 < high
    assert found.relative < 2e-3


@pytest.mark.slow
def test_bifilar() -> None:
    by_period, by_ratio = load("bifilar").analyse()
    for found in (by_period, by_ratio):
        low, high = found.interval
        assert low < 1.056 < high
        assert found.result.value == pytest.approx(1.056, rel=1e-3)
    assert by_ratio.result.uncertainty < 1e-3
