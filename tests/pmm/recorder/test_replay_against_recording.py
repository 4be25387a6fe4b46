"""A raw log through the live path again gives the recorded samples, pulses and harmonics."""

import json
import math
import shutil
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from hardware.carry_over import carry_on, opening_of
from hardware.description.errors import DataError
from hardware.lines import TICK_MODULUS, Unwrapped
from hardware.raw_log import FramePacker, container, file_header
from hardware.raw_log_reading import read_frames
from hardware.roles import SampleBlock
from pmm.recorder.header import LiveSettings
from pmm.recorder.live_path import CycleSamples, GateResolver, LivePath, as_record, joined_samples
from pmm.recorder.replay import replay
from pmm.recorder.run_recorder import RunEnd, RunRecorder
from sim.devices.bench_file import DRIVERS
from tests.pmm.recorder.recorded import fed, header, session

TWO = LiveSettings(periods=2)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two runs of a rig that lives on.

    The second begins with a tare, a count far on, and an edge count that goes on.
    """
    place = tmp_path_factory.mktemp("runs")
    with session() as rig:
        for number in (1, 2):
            for one in rig.rig.forces:
                one.tare()
            recorder, _ = rig.record(place / str(number), 600, TWO)
            with recorder:
                recorder.close(RunEnd.COMPLETE)
            for _ in range(37):
                rig.rig.cycle()
    return place


@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 2])
def test_runs_of_a_rig_that_lives_on(runs: Path, number: int) -> None:
    again = replay(runs / str(number), DRIVERS)
    assert again.same
    assert again.differing_samples == 0
    assert again.samples.shape == (3, 600)
    assert again.difference == 0.0
    assert len(again.recorded_readings) >= 3
    lines = (runs / str(number) / "pulses.jsonl").read_text().splitlines()
    told = [json.loads(one) for one in lines]
    assert [[one.number, one.time_s, one.shaft_angle_rad] for one in again.pulses] == told
    assert len(told) == 6
    assert again.faults == ()
    assert np.max(np.abs(again.samples[1])) > 10.0


@pytest.mark.slow
def test_a_rig_whose_photocell_is_on_a_serial_line(tmp_path: Path) -> None:
    parts = {"photocell": {"driver": "timestamper"}}
    with session(serial=("photocell",), **parts) as rig:
        for _ in range(500):  # marks, so that the clock's fit is worth carrying over
            rig.rig.cycle()
        recorder, _ = rig.record(tmp_path / "run", 600, TWO)
        with recorder:
            recorder.close(RunEnd.COMPLETE)
    again = replay(tmp_path / "run", DRIVERS)
    assert again.same
    assert [one.time_s for one in again.pulses] == again.recorded_pulses_s.tolist()
    assert again.difference == 0.0
    assert len(again.recorded_readings) >= 3
    lines = (tmp_path / "run" / "lines.jsonl").read_text().splitlines()
    assert len(lines) >= 10
    assert json.loads(lines[0])[1] == "photocell"


@pytest.mark.slow
def test_a_log_that_was_changed_does_not_pass(runs: Path, tmp_path: Path) -> None:
    shutil.copytree(runs / "1", tmp_path / "run")
    path = tmp_path / "run" / "bus.blf"
    frames = list(read_frames(path))
    force = [one for one in frames if one.arbitration_id == 0x184]
    force[200].data[0] ^= 1
    packer = FramePacker()
    for one in frames:
        packer.take(one)
    path.write_bytes(file_header() + b"".join(map(container, packer.drain())))
    again = replay(tmp_path / "run", DRIVERS)
    assert not again.same
    assert again.differing_samples == 1
    assert 0.0 < again.difference < 1e-2


@pytest.mark.slow
def test_a_run_that_was_cut_replays_as_far_as_it_goes(runs: Path, tmp_path: Path) -> None:
    shutil.copytree(runs / "2", tmp_path / "run")
    for name in ("bus.blf", "samples.arrows"):
        with (tmp_path / "run" / name).open("rb+") as file:
            file.truncate((tmp_path / "run" / name).stat().st_size * 2 // 3)
    again = replay(tmp_path / "run", DRIVERS)
    both = np.isfinite(again.samples).all(axis=0)
    assert np.array_equal(again.samples[:, both], again.recorded[:, both])
    assert both.sum() > 100


@pytest.mark.slow
def test_gates_that_are_armed_anew_resolve_as_they_did(tmp_path: Path) -> None:
    """Run control begins a resolver at each arming, and feeds it in blocks."""
    with session() as rig:
        recorder, taken = rig.record(tmp_path / "run", 900, LiveSettings(periods=3), readings=False)
        with recorder:
            told = _armed_by_hand(recorder, taken, at=recorder.header.first_sync + 250)
            recorder.close(RunEnd.COMPLETE)
    again = replay(tmp_path / "run", DRIVERS)
    assert len(told) >= 2
    assert again.same
    assert None not in again.readings


def _armed_by_hand(recorder, taken, at: int) -> list[dict]:
    """Resolve from a SYNC on in blocks of 50 cycles, and write it down."""
    header = recorder.header
    rate_hz, count = header.sample_rate_hz, len(header.channels)
    recorder.event(at, at / rate_hz, "armed", str(at))
    resolving = GateResolver(header.channels, rate_hz, header.live, at)
    readings = []
    for k in range(0, len(taken), 50):
        part = taken[k : k + 50]
        readings += resolving.push(CycleSamples(part[0].first, joined_samples(part, count), ()))
        for pulse in (one for each in part for one in each.pulses):
            readings += resolving.resolver.pulse(pulse.time_s) if resolving.takes(pulse) else []
    told = [as_record(one) for one in readings]
    for one in told:
        recorder.harmonic(one)
    return told


@pytest.mark.slow
def test_without_its_rig_or_its_log_a_run_is_refused(runs: Path, tmp_path: Path) -> None:
    shutil.copytree(runs / "1", tmp_path / "run")
    (tmp_path / "run" / "bus.blf").rename(tmp_path / "bus.blf")
    with pytest.raises(DataError, match=r"bus.blf is missing"):
        replay(tmp_path / "run", DRIVERS)
    with RunRecorder(tmp_path / "rigless", header()) as recorder:
        fed(recorder, range(1, 101))
    with pytest.raises(DataError, match="its header does not say what the rig was"):
        replay(tmp_path / "rigless", DRIVERS)


class Halting:
    """A device that delivers what it is told to."""

    sample_rate_hz = 100.0

    def __init__(self, name: str, *blocks) -> None:
        self.name, self.channels = name, (header().channels[1].__class__(name, "N"),)
        self._blocks = list(blocks)

    def take(self):
        return self._blocks.pop(0) if self._blocks else ()


def test_samples_wait_four_cycles_for_a_late_device() -> None:
    def one(first: int, *values: float) -> tuple[SampleBlock, ...]:
        return (SampleBlock(first, np.array([values])),)

    quick = Halting("quick", (), *(one(n, float(n)) for n in range(1, 13)))
    late = Halting("late", (), one(1, 10.0), (), (), (), one(2, 20.0), (), (), (), one(8, 80.0))
    rig = SimpleNamespace(number=0, shaft=None, forces=(quick, late), photocell=None, carriage=None)
    path = LivePath(rig)
    found, came_in = [], []
    for rig.number in range(1, 13):
        taken = path.step()
        assert taken.first == len(found) + 1
        found += taken.values.T.tolist()
        came_in += [rig.number] * taken.values.shape[1]
    assert [one for one, _ in found] == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]
    assert [found[n - 1][1] for n in (1, 2, 8)] == [10.0, 20.0, 80.0]
    assert all(math.isnan(found[n - 1][1]) for n in range(3, 8))
    assert came_in == [1, 5, 7, 8, 9, 9, 9, 9]


def test_a_device_that_counts_its_own_samples_is_put_where_they_came() -> None:
    quick = Halting("quick", (), *((SampleBlock(n, np.array([[1.0]])),) for n in range(101, 105)))
    own = Halting("own", (), *((SampleBlock(n, np.array([[float(n)]])),) for n in range(7, 11)))
    rig = SimpleNamespace(
        number=100, shaft=None, forces=(quick, own), photocell=None, carriage=None
    )
    path = LivePath(rig)
    found = []
    for rig.number in range(101, 105):
        found += path.step().values.T.tolist()
    assert found == [[1.0, 7.0], [1.0, 8.0], [1.0, 9.0], [1.0, 10.0]]


@pytest.mark.slow
def test_what_devices_carry_over_is_json_and_goes_on() -> None:
    with session() as rig:
        opening = opening_of(rig.rig)
        assert json.loads(json.dumps(opening)) == json.loads(json.dumps(opening_of(rig.rig)))
        assert set(opening) == {"shaft", "forces[0]", "forces[1]", "photocell"}
        carry_on(rig.rig, {"forces[0]": {"zero": [3.5]}})
        assert rig.rig.forces[0].carried() == {"zero": [3.5]}


def test_a_count_goes_on_where_another_stood() -> None:
    one, other = Unwrapped(TICK_MODULUS), Unwrapped(TICK_MODULUS)
    for raw in (5, 2**31, 2**32 - 1, 3):
        one.take(raw)
    other.value = one.value
    assert other.take(9) == one.take(9) == 2**32 + 9
