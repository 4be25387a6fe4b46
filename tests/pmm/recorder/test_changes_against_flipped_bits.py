"""Files of a run that were changed from outside: named, made again or counted as missing."""

import json
import shutil
from pathlib import Path

import h5py
import numpy as np
import pyarrow as pa
import pytest
from click.testing import CliRunner, Result

from analysis.readers import read_recording
from pmm.campaign.recording_source import RecordingSource, open_recording
from pmm.cli import cli
from pmm.recorder.files import STREAMS
from pmm.recorder.header import LiveSettings, RunHeader
from pmm.recorder.run_recorder import RunEnd
from pmm.recorder.samples import JournalSamples, read_samples
from tests.pmm.recorder.recorded import session

FLIPS = 100
BATCHES = 12
BEGIN = b"\xff\xff\xff\xff"


@pytest.fixture(scope="module")
def closed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A closed run of a rig, 600 samples in a dozen batches."""
    folder = tmp_path_factory.mktemp("runs") / "heave"
    with session() as rig:
        recorder, _ = rig.record(folder, 600, LiveSettings(periods=2))
        with recorder:
            recorder.close(RunEnd.COMPLETE)
    return folder


@pytest.fixture
def run(closed: Path, tmp_path: Path) -> Path:
    shutil.copytree(closed, tmp_path / closed.name)
    return tmp_path / closed.name


def pmm(*words: str | Path) -> Result:
    return CliRunner().invoke(cli, [str(one) for one in words])


def values(of: JournalSamples) -> np.ndarray:
    return of[:, 0 : of.sample_count]


def recorded(run: Path) -> np.ndarray:
    recording = read_recording(run / "run.nc")
    return recording.samples[:, 0 : recording.sample_count]


def codes(run: Path) -> list[str]:
    return [flag.code for flag in read_recording(run / "run.nc").flags]


def flip(path: Path, at: int, bit: int = 3) -> None:
    data = bytearray(path.read_bytes())
    data[at] ^= 1 << bit
    path.write_bytes(data)


def messages(data: bytes) -> list[bytes]:
    """Return the messages of a stream, its schema first, as pyarrow reads them."""
    source, found, at = pa.BufferReader(data), [], 0
    while at < len(data):
        pa.ipc.read_message(source)
        found.append(data[at : source.tell()])
        at = source.tell()
    return found


def spoil_sample(run: Path) -> tuple[int, int]:
    """Flip a bit in the exponent of a shaft angle; return the SYNCs of its batch."""
    data = (run / "samples.arrows").read_bytes()
    samples = read_samples(run / "samples.arrows")
    batch = samples.batches[BATCHES // 2]
    angle = np.float64(batch.column("shaft_angle").to_numpy()[7]).tobytes()
    assert data.count(angle) == 1
    flip(run / "samples.arrows", data.index(angle) + 6)
    syncs = batch.column("sync").to_numpy()
    return int(syncs[0]), int(syncs[-1])


@pytest.mark.slow
def test_a_flipped_bit_anywhere_in_the_samples_is_said_or_harmless(run: Path) -> None:
    path = run / "samples.arrows"
    whole, truth, silent = path.read_bytes(), values(read_samples(path)), 0
    first = read_samples(path).first_sync
    for at, bit in np.random.default_rng(23).integers((0, 0), (len(whole), 8), (FLIPS, 2)):
        flip(path, int(at), int(bit))
        found = read_samples(path)
        path.write_bytes(whole)
        if found is None:
            continue
        there = values(found)
        expected = truth[:, found.first_sync - first :][:, : found.sample_count]
        assert np.array_equal(there[~np.isnan(there)], expected[~np.isnan(there)])
        is_short = found.whole_bytes < len(whole)
        silent += not found.changes and not is_short
        assert found.changes or is_short or there.shape == truth.shape
    assert silent < FLIPS / 10  # padding: of each of few and small arrays up to the 64th byte


@pytest.mark.parametrize("lost", [1, 2, BATCHES // 2, BATCHES - 1])
def test_a_batch_that_is_missing_is_named(run: Path, lost: int) -> None:
    path = run / "samples.arrows"
    whole, pieces = read_samples(path), messages(path.read_bytes())
    syncs = whole.syncs[lost - 1].copy()
    path.write_bytes(b"".join(pieces[:lost] + pieces[lost + 1 :]))
    found = read_samples(path)
    (said,) = found.changes
    expected = "beginning" if lost == 1 else f"SYNC {syncs[0]} to {syncs[-1]} "
    assert expected in said
    assert found.sample_count == whole.sample_count - (len(syncs) if lost == 1 else 0)


def test_batches_in_another_order_are_all_there(run: Path) -> None:
    path = run / "samples.arrows"
    truth, pieces = values(read_samples(path)), messages(path.read_bytes())
    pieces[3], pieces[5] = pieces[5], pieces[3]
    path.write_bytes(b"".join(pieces))
    found = read_samples(path)
    assert np.array_equal(values(found), truth)
    assert found.changes == ("its batches are not in the order in which they were written",)


def test_junk_amid_the_batches_costs_none(run: Path) -> None:
    path = run / "samples.arrows"
    truth, pieces = values(read_samples(path)), messages(path.read_bytes())
    path.write_bytes(b"".join([*pieces[:4], BEGIN + b"junk" * 7, *pieces[4:]]))
    assert np.array_equal(values(read_samples(path)), truth)


def test_a_stream_without_checksums_is_read(run: Path) -> None:
    path = run / "samples.arrows"
    truth = values(read_samples(path))
    table = pa.ipc.open_stream(path).read_all()
    about = {b"run_header": table.schema.metadata[b"run_header"]}
    table = table.replace_schema_metadata(about)
    with pa.ipc.new_stream(run / "foreign.arrows", table.schema) as stream:
        stream.write_table(table)
    found = read_samples(run / "foreign.arrows")
    assert np.array_equal(values(found), truth)
    assert found.changes == ()


def test_a_changed_sample_is_decoded_again(run: Path) -> None:
    truth = recorded(run)
    first, last = spoil_sample(run)
    spoilt = (run / "samples.arrows").read_bytes()
    (run / "run.nc").unlink()
    said = pmm("recover", run)
    assert said.exit_code == 1
    assert "samples.arrows: not what was written" in said.stderr.replace("\n", "")
    assert f"SYNC {first} to {last}" in said.stdout.replace("\n", "")
    assert np.array_equal(recorded(run), truth)
    assert codes(run) == ["journal_changed", "samples_rebuilt"]
    assert (run / "samples.arrows.damaged-1").read_bytes() == spoilt
    assert pmm("recover", run).exit_code == 0


def test_without_a_raw_log_a_changed_sample_costs_its_batch(run: Path) -> None:
    truth = recorded(run)
    first, last = spoil_sample(run)
    start = read_samples(run / "samples.arrows").first_sync
    for name in ("run.nc", "bus.blf"):
        (run / name).unlink()
    assert pmm("recover", run).exit_code == 1
    found, lost = recorded(run), slice(first - start, last + 1 - start)
    assert np.isnan(found[:, lost]).all()
    kept = np.delete(found, lost, axis=1)
    assert np.array_equal(kept, np.delete(truth, lost, axis=1))
    assert {"journal_changed", "samples_lost", "gap"} <= set(codes(run))


@pytest.mark.slow
def test_a_changed_recording_is_made_again(run: Path) -> None:
    truth = recorded(run)
    with h5py.File(run / "run.nc", "r+") as file:
        file["shaft_angle"][77] *= 2.0
    edited = (run / "run.nc").read_bytes()
    again = pmm("replay", run)
    assert again.exit_code == 1
    assert "run.nc was changed" in again.stderr.replace("\n", "")
    said = pmm("recover", run, "--json")
    assert said.exit_code == 1
    assert json.loads(said.stdout)[0]["changed"] == ["run.nc"]
    assert np.array_equal(recorded(run), truth)
    assert codes(run) == []
    assert (run / "run.nc.damaged-1").read_bytes() == edited
    assert pmm("recover", run).exit_code == 0


@pytest.mark.parametrize("name", [*STREAMS, "header.json", "complete.json"])
def test_a_flipped_bit_in_any_file_is_named(run: Path, name: str) -> None:
    size = (run / name).stat().st_size
    if not size:
        pytest.skip("nothing was written into it")
    flip(run / name, size // 2, 0)
    said = pmm("recover", run)
    assert said.exit_code == 1, said.output
    assert name in said.stderr


def test_a_flipped_bit_among_the_pulses_is_said_by_who_analyses_the_recording(run: Path) -> None:
    assert pmm("analyse", run / "run.nc").exit_code == 0
    flip(run / "pulses.jsonl", (run / "pulses.jsonl").stat().st_size // 2, 0)
    said = pmm("analyse", run / "run.nc")
    assert said.exit_code == 1, said.output
    assert "pulses.jsonl: its bytes are not those that were written" in said.stderr
    assert said.stdout  # what could be done was done


@pytest.mark.parametrize("at_rest", [False, True])
def test_a_text_that_was_cut_is_damage_to_whoever_opens_the_recording(
    run: Path, at_rest: bool
) -> None:
    source = RecordingSource(run / "run.nc", at_rest=at_rest)
    assert not any(flag.damaged for flag in open_recording(source).flags)
    data = (run / "pulses.jsonl").read_bytes()
    (run / "pulses.jsonl").write_bytes(data[:-1])
    (said,) = (flag.message for flag in open_recording(source).flags if flag.damaged)
    assert (
        said == f"pulses.jsonl: has {len(data) - 1} of {len(data)} bytes; it was cut after the run"
    )


@pytest.mark.parametrize("command", ["recover", "replay"])
def test_an_unharmed_run_is_no_matter(run: Path, command: str) -> None:
    assert pmm(command, run).exit_code == 0


@pytest.mark.slow
@pytest.mark.parametrize("command", ["recover", "replay"])
def test_a_run_of_a_version_that_knew_fewer_keys_is_no_matter(tmp_path: Path, command: str) -> None:
    of_today = RunHeader.to_json

    def of_then(header: RunHeader) -> str:
        known = json.loads(of_today(header))
        del known["set_point"]["drift_rad"]
        return json.dumps(known, indent=1)

    with pytest.MonkeyPatch.context() as then, session() as rig:
        then.setattr(RunHeader, "to_json", of_then)
        recorder, _ = rig.record(tmp_path / "heave", 200, LiveSettings(periods=2))
        with recorder:
            recorder.close(RunEnd.COMPLETE)
    assert "drift_rad" not in (tmp_path / "heave" / "header.json").read_text(encoding="utf-8")
    found = pmm(command, tmp_path / "heave")
    assert found.exit_code == 0, found.output
