"""A replay of the raw log writes the very file of samples that the run wrote, byte for byte."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.response.multisine import multisine
from hardware.description.kinds import RunKind
from pmm.recorder.batches import read_batches
from pmm.recorder.decoding import decode
from pmm.recorder.files import SAMPLES
from pmm.recorder.live_path import joined_samples
from pmm.recorder.recording import RunData, read_run
from pmm.recorder.replay import replay
from pmm.recorder.samples import SampleWriter
from pmm.run.states import Command, State
from sim.devices.bench_file import DRIVERS
from sim.devices.faults import inject
from tests.pmm.run.harness import TABLES, Bench, at_rest, bench, oscillation
from tests.sim.devices.test_paths_against_exact_struts import BARE, PATHS

FORCES = 0x184, 0x185


def written_again(run: RunData) -> bytes:
    """Return the file of samples as a replay writes it, cut into the run's own batches."""
    values = joined_samples(decode(run, DRIVERS)[0], len(run.header.channels))
    writer = SampleWriter(run.header)
    head, first = writer.head(), run.header.first_sync
    schema = run.samples.batches[0].schema.with_metadata(None)
    found = [head]
    for one in read_batches(run.folder / SAMPLES, schema, len(head)):
        begin, end = int(one.sync[0]) - first, int(one.sync[-1]) + 1 - first
        found.append(writer.batch([(begin + first, values[:, begin:end])]))
    return b"".join(found)


def hold_back(one: Bench, cycles: Callable[[int], int]) -> None:
    """Let the amplifiers' frames come later by so many cycles, as a slow adapter does."""
    receiver = one.rig.master._receiver
    receive, held = receiver.receive, []

    def late(timeout_s: float):
        for k, (due, frame) in enumerate(held):
            if due <= one.rig.number:
                del held[k]
                return frame
        frame = receive(timeout_s)
        while frame is not None and frame.arbitration_id in FORCES:
            more = cycles(frame.arbitration_id)
            if not more:
                return frame
            held.append((one.rig.number + more, frame))
            frame = receive(timeout_s)
        return frame

    receiver.receive = late


@pytest.mark.slow
def test_of_two_runs_of_a_rig_that_lives_on(tmp_path: Path) -> None:
    with bench(tmp_path, [oscillation("heave"), at_rest("zero", RunKind.ZERO)]) as one:
        one.finish()
    for name in ("heave", "zero"):
        run = read_run(tmp_path / name)
        assert run.samples.sample_count > 100
        assert written_again(run) == (tmp_path / name / SAMPLES).read_bytes()


@pytest.mark.slow
def test_with_a_photocell_on_a_serial_line(tmp_path: Path) -> None:
    tables = {**TABLES, "photocell": {"driver": "timestamper"}}
    with bench(tmp_path, [oscillation()], tables=tables, serial=("photocell",)) as one:
        one.finish()
    run = read_run(tmp_path / "heave")
    assert written_again(run) == (tmp_path / "heave" / SAMPLES).read_bytes()


@pytest.mark.slow
def test_where_frames_come_late_and_some_not_in_time(tmp_path: Path) -> None:
    random = np.random.default_rng(31)
    with bench(tmp_path, [oscillation()]) as one:
        one.until(State.SETTLING)
        hold_back(one, lambda _: int(random.choice([0, 0, 0, 0, 1, 2, 3])))
        for _ in range(400):
            one.control.step()
        one.control.request(Command.STOP)
        one.finish()
    run = read_run(tmp_path / "heave")
    assert np.isnan(run.samples[:, :]).any()
    assert written_again(run) == (tmp_path / "heave" / SAMPLES).read_bytes()


@pytest.mark.slow
def test_of_led_struts_angle_and_commands_too(tmp_path: Path) -> None:
    """Two runs of another path each: what the first one left is carried over to the other."""
    lines = multisine((1, 3), np.array([1.0, 0.3]))
    sway = oscillation("sway", 1.9, periods=1, max_periods=1)
    point = replace(sway.set_point, eccentricity_m=0.006)
    runs = [
        replace(sway, set_point=point),
        replace(sway, name="other", set_point=replace(point, lines=lines)),
    ]
    with bench(tmp_path, runs, tables=PATHS, simulated=BARE) as one:
        one.finish(20000)
        assert one.control.state is State.DONE, one.control.status().alarms
    run = read_run(tmp_path / "other")
    assert np.ptp(run.samples[:, :], axis=1).min() > 0.01  # all of its channels move
    assert written_again(run) == (tmp_path / "other" / SAMPLES).read_bytes()
    assert replay(tmp_path / "sway", DRIVERS).same


@pytest.mark.parametrize("words", ["silence forces[0]", "bus-off", "heartbeat phase"])
def test_of_a_run_that_a_fault_ended(tmp_path: Path, words: str) -> None:
    with bench(tmp_path, [oscillation()]) as one:
        one.until(State.GATE_OPEN)
        inject(one.world, words)
        one.finish()
    run = read_run(tmp_path / "heave")
    assert run.marker["outcome"] == "fault"
    assert written_again(run) == (tmp_path / "heave" / SAMPLES).read_bytes()
