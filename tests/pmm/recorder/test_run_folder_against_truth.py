"""A closed run holds what was handed in, bit by bit, and says what has to be known of it."""

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.readers import read_recording
from hardware.description.channels import Channel
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from hardware.roles import Pulse, Reading
from pmm.recorder.files import HEADER, MARKER, RECORDING, RECOVERED, STREAMS, RunExistsError
from pmm.recorder.header import LiveSettings, RunHeader
from pmm.recorder.lateness import Lateness
from pmm.recorder.recovery import recover, runs_in
from pmm.recorder.run_recorder import RunEnd, RunRecorder
from tests.pmm.recorder.recorded import CHANNELS, fed, header, truth
from tests.sim.devices.benches import ROOT


def test_a_closed_run_is_the_samples_handed_in(tmp_path: Path) -> None:
    with RunRecorder(tmp_path / "run", header()) as recorder:
        true = fed(recorder, range(1, 1001))
        note = Flag("hand", Severity.NOTE, "somebody leaned on the carriage")
        path = recorder.close(RunEnd.STOPPED, (note,))
    found = read_recording(path)
    assert np.array_equal(found.samples[:, 0:1000], true)
    assert found.start_s == 0.01
    assert found.sample_rate_hz == 100.0
    assert found.channels == CHANNELS
    assert found.set_point == header().set_point
    assert found.flags == (note,)
    assert found.photocell_edges_s.tolist() == []  # SYNCs 1, 11, ... never are a hundred
    about = found.provenance
    assert (about["outcome"], about["kind"]) == ("stopped", "oscillation")
    assert json.loads(about["readings"])["eccentricity"]["value"] == 0.02
    assert json.loads(about["configuration_sha256"]) == {"rig.toml": "12ab"}
    assert about["cycles"] == "100"
    assert float(about["cycle_lateness_worst_s"]) == 1e-4
    assert about["cycles_late"] == "0"


def test_the_journal_carries_units_calibration_and_hashes(tmp_path: Path) -> None:
    import pyarrow as pa

    calibration = {"force_aft": {"scale": 0.01, "tare": 1.5}}
    with RunRecorder(tmp_path, header(calibration=calibration)) as recorder:
        fed(recorder, range(1, 21))
        recorder.close(RunEnd.COMPLETE)
    with pa.ipc.open_stream(tmp_path / "samples.arrows") as stream:
        schema = stream.schema
        table = stream.read_all()
    assert schema.field("force_aft").metadata == {
        b"units": b"N", b"source": b"", b"full_scale": b"490.0", b"scale": b"0.01", b"tare": b"1.5",
    }  # fmt: skip
    assert b"12ab" in schema.metadata[b"run_header"]
    assert table.column("sync").to_pylist() == list(range(1, 21))


def test_the_marker_counts_and_hashes_what_is_there(tmp_path: Path) -> None:
    import hashlib

    with RunRecorder(tmp_path, header()) as recorder:
        fed(recorder, range(100, 300))
        recorder.event(120, 1.2, "state", "gate open")
        reading = {"opened_s": 1.0, "closed_s": 2.0, "periods": 1, "channels": ["force_aft"]}
        recorder.harmonic({**reading, "coefficients": [[float("nan")]]})
        recorder.close(RunEnd.COMPLETE)
    marker = json.loads((tmp_path / "complete.json").read_text())
    assert [marker[key] for key in ("samples", "missing", "first_sync", "last_sync")] == [
        200, 0, 100, 299,
    ]  # fmt: skip
    assert [marker[key] for key in ("frames", "pulses", "lines", "events", "harmonics")] == [
        20, 2, 20, 1, 1,
    ]  # fmt: skip
    for name, about in marker["files"].items():
        data = (tmp_path / name).read_bytes()
        assert about == {"bytes": len(data), "sha256": hashlib.sha256(data).hexdigest()}


def test_a_gap_in_the_sync_counter_becomes_nan_and_a_flag(tmp_path: Path) -> None:
    with RunRecorder(tmp_path, header()) as recorder:
        fed(recorder, range(1, 101))
        fed(recorder, range(108, 151))
        found = read_recording(recorder.close(RunEnd.COMPLETE))
    missing = np.isnan(found.samples[0:1, 0 : found.sample_count][0])
    assert np.flatnonzero(missing).tolist() == list(range(100, 107))
    (flag,) = found.flags
    assert flag.code == "gap"
    assert "7 sample(s) are missing in 1 gap(s), the longest 7 from 1.010 s (SYNC 101)" in (
        flag.message
    )


def test_what_a_device_did_not_deliver_stays_nan(tmp_path: Path) -> None:
    with RunRecorder(tmp_path, header()) as recorder:
        recorder.samples(1, np.array([[1.0, 2.0], [np.nan, 4.0]]))
        found = read_recording(recorder.close(RunEnd.COMPLETE))
    assert np.array_equal(found.samples[:, 0:2], [[1.0, 2.0], [np.nan, 4.0]], equal_nan=True)


def test_a_sync_that_comes_twice_and_a_wrong_shape_are_refused(tmp_path: Path) -> None:
    with RunRecorder(tmp_path, header()) as recorder:
        fed(recorder, range(1, 11))
        with pytest.raises(DataError, match="SYNC 10 comes again; the next one is 11"):
            recorder.samples(10, np.zeros((2, 1)))
        with pytest.raises(DataError, match=r"shape \(3, 1\) do not fit 2 channels"):
            recorder.samples(11, np.zeros((3, 1)))


def test_pulses_that_come_late_are_left_out_with_a_flag(tmp_path: Path) -> None:
    with RunRecorder(tmp_path, header()) as recorder:
        fed(recorder, range(1, 11))
        for number, time_s in enumerate((0.02, 0.05, 0.05, 0.04, 0.09)):
            recorder.pulse(Pulse(number, time_s))
        found = read_recording(recorder.close(RunEnd.COMPLETE))
    assert found.photocell_edges_s.tolist() == [0.02, 0.05, 0.09]
    assert [one.code for one in found.flags] == ["pulse_order"]


def test_without_a_photocell_there_are_no_edges(tmp_path: Path) -> None:
    with RunRecorder(tmp_path, header(photocell=False)) as recorder:
        fed(recorder, range(1, 11))
        assert read_recording(recorder.close(RunEnd.COMPLETE)).photocell_edges_s is None


@pytest.mark.parametrize("leftover", ["header.json", "bus.blf", "samples.arrows", "run.nc"])
def test_a_folder_that_holds_a_run_is_never_written_to(tmp_path: Path, leftover: str) -> None:
    (tmp_path / leftover).write_bytes(b"precious")
    with pytest.raises(RunExistsError, match=leftover), RunRecorder(tmp_path, header()):
        raise AssertionError("it opened")
    assert [one.name for one in tmp_path.iterdir()] == [leftover]
    assert (tmp_path / leftover).read_bytes() == b"precious"


def test_a_block_left_by_an_error_leaves_a_run_to_recover(tmp_path: Path) -> None:
    def fails() -> None:
        with RunRecorder(tmp_path, header()) as recorder:
            fed(recorder, range(1, 151))
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fails()
    assert not (tmp_path / "complete.json").exists()
    found = recover(tmp_path)
    assert (found.samples, found.frames) == (150, 15)
    recording = read_recording(found.path)
    assert np.array_equal(recording.samples[:, 0:150], truth(range(1, 151)))
    assert [one.code for one in recording.flags] == ["recovered"]


def test_a_run_without_samples_closes_with_a_clear_word(tmp_path: Path) -> None:
    with RunRecorder(tmp_path, header()) as recorder:
        recorder.event(1, 0.01, "fault", "heartbeat lost")
        with pytest.raises(DataError, match="holds no whole sample"):
            recorder.close(RunEnd.FAULT)
    assert json.loads((tmp_path / "complete.json").read_text())["events"] == 1


def test_headers_come_back_as_they_were() -> None:
    one = header(
        opening={"shaft": {"counts": 3, "track": [[1, 2]]}},
        rig_tables={"shaft": {"driver": "cia402-shaft"}},
        live=LiveSettings(periods=4, latency_s=1e-3),
        calibration={"force_aft": {"scale": 1 / 3}},
    )
    assert RunHeader.from_json(one.to_json(), "here") == one
    assert header(set_point=None) == RunHeader.from_json(header(set_point=None).to_json(), "here")


@given(at=st.integers(0, len(header().to_json()) - 2))
def test_a_cut_header_is_an_error_that_names_its_file(at: int) -> None:
    with pytest.raises(DataError, match=r"run/header.json: damaged run header"):
        RunHeader.from_json(header().to_json()[:at], "run/header.json")


@given(st.lists(st.floats(0.0, 50.0), min_size=1, max_size=300))
def test_lateness_against_sorted_values(values: list[float]) -> None:
    late = Lateness(0.01)
    for one in values:
        late.add(one)
    found = late.statistics()
    for share, bound in ((0.5, found.p50_s), (0.99, found.p99_s)):
        exact = float(np.quantile(values, share, method="inverted_cdf"))
        assert exact <= bound * (1 + 1e-12) + 1e-7
        assert bound <= exact * 1.024 + 1.1e-7
    assert found.worst_s == pytest.approx(max(values), abs=1e-7)
    assert (found.cycles, found.late) == (len(values), sum(one > 0.001 for one in values))


def test_runs_of_a_campaign_are_found_by_name(tmp_path: Path) -> None:
    for name in ("b", "a"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "header.json").write_text("{}")
    (tmp_path / "figures").mkdir()
    assert [one.name for one in runs_in(tmp_path)] == ["a", "b"]
    assert runs_in(tmp_path / "a") == (tmp_path / "a",)
    with pytest.raises(DataError, match="holds no run"):
        runs_in(tmp_path / "figures")


def test_the_page_names_every_file_of_a_run() -> None:
    page = (ROOT / "docs" / "recording-safety.md").read_text()
    for name in (HEADER, *STREAMS, MARKER, RECORDING, RECOVERED):
        assert f"| `{name}` |" in page


def test_channels_and_readings_are_the_vocabularys() -> None:
    back = RunHeader.from_json(header().to_json(), "here")
    assert back.channels[1] == Channel("force_aft", "N", 490.0)
    assert back.readings["eccentricity"] == Reading(0.02, 1e-5, "encoder")
