"""Thinned, resampled and cut cases: compared harmonics stay, aliases do not come."""

import json
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from tests.sealed.board import generate, jobs_of
from tests.sealed.variations import VARIATIONS, agreements, fits, resampled, varied


@pytest.fixture(scope="module")
def board(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("varied") / "board"
    assert list(generate(jobs_of(12, 0, 2, folder)))
    return folder


@pytest.mark.parametrize("ratio", [Fraction(1, 2), Fraction(1, 5), Fraction(1, 10), Fraction(5, 6)])
def test_harmonics_that_are_compared_stay(ratio: Fraction) -> None:
    rate, frequency = 300.0, 1.1
    times = np.arange(0.0, 9.0, 1.0 / rate)
    new = np.arange(len(resampled(times, ratio))) / (rate * float(ratio))
    inside = (new > 1.0) & (new < 8.0)
    for order in range(1, 7):
        turn = 2.0 * np.pi * order * frequency
        assert resampled(np.sin(turn * times), ratio)[inside] == pytest.approx(
            np.sin(turn * new)[inside], abs=2e-3
        )


def test_what_would_alias_is_gone() -> None:
    times = np.arange(0.0, 9.0, 1.0 / 300.0)
    alias = resampled(np.sin(2.0 * np.pi * 50.0 * times), Fraction(1, 10))
    assert np.abs(alias[20:-20]).max() < 2e-3


def test_white_noise_falls_with_the_root_of_the_rate() -> None:
    noise = np.random.default_rng(2).standard_normal(100_000)
    assert resampled(noise, Fraction(1, 5)).std() == pytest.approx(5.0**-0.5, rel=0.03)


def test_a_ramp_is_a_ramp() -> None:
    ramp = 3.0 + 0.2 * np.arange(1000)
    assert resampled(ramp, Fraction(1, 5), ramp=True) == pytest.approx(ramp[::5])


@pytest.mark.slow
def test_folders_say_what_they_hold(board: Path, tmp_path: Path) -> None:
    output = tmp_path / "varied"
    names = list(varied(board, output, 2))
    assert {name.split(".")[1] for name in names} >= {"thin-2", "resampled", "cut"}
    assert list(varied(board, output, 2)) == []  # what is there is kept
    for name in names:
        case, kind = name.split(".")
        variation = next(one for one in VARIATIONS if one.name == kind)
        assert fits(board / "cases" / case, variation)
        for file in sorted((output / "cases" / name).glob("*.nc"))[:2]:
            new, old = read_recording(file), read_recording(board / "cases" / case / file.name)
            rate = old.sample_rate_hz * float(variation.ratio)
            assert new.sample_rate_hz == pytest.approx(rate)
            assert new.channel_names == old.channel_names
            assert new.end_s == pytest.approx(variation.part * old.end_s, abs=2.0 / rate)


@pytest.mark.slow
def test_agreement_is_counted_by_class(board: Path, tmp_path: Path) -> None:
    output = tmp_path / "varied"
    for name in ("case-0001", "case-0002"):
        key = board / "keys" / name / "truth.json"
        key.write_text(json.dumps({**json.loads(key.read_text()), "verdict": "gap", "snr": 13.0}))
    for folder, name, shares in (
        (board, "case-0001", {"none": 0.9, "cable": 0.1}),
        (output, "case-0001.cut", {"none": 0.7, "cable": 0.3}),
        (board, "case-0002", {"none": 0.8, "cable": 0.2}),
        (output, "case-0002.cut", {"none": 0.3, "cable": 0.7}),
    ):
        (folder / "answers").mkdir(parents=True, exist_ok=True)
        text = json.dumps({"probabilities": shares})
        (folder / "answers" / f"{name}.json").write_text(text)
    (found,) = agreements(board, output)
    assert (found.name, found.count, found.same_class, found.near) == ("cut", 2, 0.5, 0.0)
