"""Recordings in which nothing is wrong but what every rig has: nothing may be named."""

import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording, write_recording
from analysis.recording import Recording
from hardware.description.channels import CARRIAGE_SPEED
from pmm.gap.examination import Examined, Options, examine
from pmm.gap.run_notes import noise_notes
from tests.pmm.gap.rigs import made, run

EXAMPLE = Path("examples/gap/campaign.toml")
# What noise, steps and levels of that kind could be taken for. The whole catalogue is asked where
# noise differs between the runs, which is the easiest to mistake.
NEAR = Options(
    effects=(
        "carriage-speed", "carriage-fluctuation", "residual-waves", "vortex-shedding", "zero-drift",
        "hum", "trigger-jitter", "speed-ripple", "free-play", "coulomb-friction", "gain-error",
        "amplifier-lag",
    )
)  # fmt: skip
Change = Callable[[Recording, np.random.Generator, int], Recording]


@pytest.fixture(scope="module")
def null(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the example's campaign as it is believed to be, simulated once."""
    folder = tmp_path_factory.mktemp("null") / "rig"
    result = run("simulate", EXAMPLE, "--output", folder)
    assert result.exit_code == 0, result.output
    return folder


def changed(null: Path, folder: Path, change: Change, seed: int = 5) -> Path:
    """Return a copy of a campaign whose recordings were changed, each with noise of its own."""
    copy = shutil.copytree(null, folder / "changed")
    rng = np.random.default_rng(seed)
    for number, path in enumerate(sorted(copy.glob("*.nc"))):
        recording = read_recording(path)
        whole = np.array(recording.samples[:, 0 : recording.sample_count])
        found = change(with_samples(recording, whole), rng, number)
        path.unlink()
        write_recording(found, path)
    return copy


def with_samples(recording: Recording, samples: np.ndarray) -> Recording:
    return replace(recording, samples=samples)


def with_carriage(recording: Recording, values: np.ndarray) -> Recording:
    samples = np.vstack([np.asarray(recording.samples), values[np.newaxis]])
    return replace(recording, channels=(*recording.channels, CARRIAGE_SPEED), samples=samples)


def named(examined: Examined) -> str:
    """Return the most probable answer."""
    return next(iter(examined.shares))


def speed(recording: Recording) -> float:
    assert recording.set_point is not None
    return recording.set_point.carriage_speed_m_s


@pytest.mark.slow
def test_a_channel_that_nobody_mentions_is_no_gap(null: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(null, tmp_path / "unsaid")
    path = copy / "campaign.toml"
    lines = path.read_text().splitlines(keepends=True)
    first = next(at for at, one in enumerate(lines) if one.startswith("[acquisition]"))
    last = next(at for at in range(first + 1, len(lines)) if lines[at].startswith("["))
    path.write_text("".join(lines[:first] + lines[last:]))
    assert "noise_rms" not in path.read_text()
    assert named(examine(copy, NEAR)) == "none"


@pytest.mark.slow
def test_a_carriage_that_is_noisier_at_speed_is_no_gap(null: Path, tmp_path: Path) -> None:
    def noisy(recording: Recording, rng: np.random.Generator, number: int) -> Recording:
        loud = 2e-4 + 2e-3 * speed(recording)
        noise = loud * rng.standard_normal(recording.sample_count)
        return with_carriage(recording, speed(recording) + noise)

    assert named(examine(changed(null, tmp_path, noisy), NEAR)) == "none"


@pytest.mark.slow
def test_a_carriage_that_stands_at_exactly_nothing_is_no_gap(null: Path, tmp_path: Path) -> None:
    def stepped(recording: Recording, rng: np.random.Generator, number: int) -> Recording:
        noise = 5e-4 * rng.standard_normal(recording.sample_count) if speed(recording) else 0.0
        steps = np.round((speed(recording) + noise) / 1e-3) * 1e-3
        return with_carriage(recording, steps + np.zeros(recording.sample_count))

    assert named(examine(changed(null, tmp_path, stepped), NEAR)) == "none"


@pytest.mark.slow
def test_a_channel_of_unknown_steps_is_left_out_and_said(null: Path, tmp_path: Path) -> None:
    def constant(recording: Recording, rng: np.random.Generator, number: int) -> Recording:
        return with_carriage(recording, np.full(recording.sample_count, speed(recording)))

    found = examine(changed(null, tmp_path, constant), NEAR)
    assert named(found) == "none"
    said = found.ready.cut_short.values()
    assert said
    assert all("state it as [acquisition] carriage_speed" in one for one in said)


@pytest.mark.slow
def test_forces_that_are_louder_in_some_runs_are_no_gap(null: Path, tmp_path: Path) -> None:
    def louder(recording: Recording, rng: np.random.Generator, number: int) -> Recording:
        samples = np.array(recording.samples)
        rows = [recording.index(name) for name in ("force_aft", "force_fore")]
        noise = rng.standard_normal((2, recording.sample_count))
        samples[rows] += (0.2 if number % 2 else 0.02) * noise
        return with_samples(recording, samples)

    assert named(examine(changed(null, tmp_path, louder))) == "none"


def test_noise_that_is_not_as_stated_is_said_and_no_gap(tmp_path: Path) -> None:
    def louder(recording: Recording, rng: np.random.Generator, number: int) -> Recording:
        samples = np.array(recording.samples)
        noise = 0.2 * rng.standard_normal(recording.sample_count)
        samples[recording.index("force_fore")] += noise
        return with_samples(recording, samples)

    few = Options(effects=("zero-drift", "hum", "trigger-jitter", "coulomb-friction"))
    found = examine(changed(made(tmp_path), tmp_path, louder), few)
    assert named(found) == "none"
    (note,) = noise_notes(found)
    said = re.match(r"force_fore: white noise of ([0-9.]+) N is heard, 0.05 N are stated", note)
    assert said is not None
    # Some of it passes for coloured noise in lines that end at the seventh harmonic.
    assert float(said[1]) == pytest.approx(np.hypot(0.2, 0.05), rel=0.2)
