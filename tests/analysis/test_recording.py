"""The type for a run: times, channels by name, and some of them without reading the others."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from analysis.recording import Recording, sample_numbers
from hardware.description.channels import Channel
from hardware.description.errors import DataError

NAMES = ("displacement_aft", "force_aft", "force_fore")


def example(samples: object = None) -> Recording:
    values = np.arange(30.0).reshape(3, 10) if samples is None else samples
    channels = tuple(Channel(name, "N") for name in NAMES)
    return Recording("run", channels, values, sample_rate_hz=4.0, start_s=2.0)  # type: ignore[arg-type]


def test_times() -> None:
    recording = example()
    assert recording.sample_count == 10
    assert recording.end_s == 4.25
    assert recording.time_s(2, 4).tolist() == [2.5, 2.75]
    assert recording.time_s()[-1] == recording.end_s


@given(st.lists(st.floats(-1e3, 1e3), max_size=5))
def test_sample_numbers_are_the_inverse_of_times(numbers: list[float]) -> None:
    recording = example()
    times = recording.start_s + np.array(numbers) / recording.sample_rate_hz
    assert recording.sample_number(times) == pytest.approx(numbers, abs=1e-9)


def test_beyond_uneven_stamps_the_numbers_run_on_at_the_mean_rate() -> None:
    stamps_s = np.array([1.0, 1.2, 1.3, 2.0])  # 3 intervals in a second
    times_s = [0.5, 1.0, 1.1, 1.65, 2.0, 4.0]
    expected = [-1.5, 0.0, 0.5, 2.5, 3.0, 9.0]
    found = sample_numbers(np.array(times_s), 1.0, 3.0, stamps_s)
    assert found == pytest.approx(expected, abs=1e-12)


def test_values_by_name() -> None:
    assert example().values("force_aft").tolist() == list(range(10, 20))


def test_an_unknown_channel_is_refused_with_a_suggestion() -> None:
    with pytest.raises(DataError, match=r"run: no channel 'force_aff'; did you mean force_aft"):
        example().values("force_aff")
    with pytest.raises(DataError, match=r"no channel 'zzz' \(channels: displacement_aft, force_"):
        example().select(["zzz"])


def test_selection_keeps_the_order_asked_for() -> None:
    chosen = example().select(["force_fore", "displacement_aft"])
    assert chosen.channel_names == ("force_fore", "displacement_aft")
    assert chosen.samples.shape == (2, 10)
    assert chosen.samples[:, 1:3].tolist() == [[21.0, 22.0], [1.0, 2.0]]
    assert chosen.samples[[1], 1:3].tolist() == [[1.0, 2.0]]
    assert chosen.select(["displacement_aft"]).values("displacement_aft").tolist() == list(
        range(10)
    )


def test_selecting_everything_changes_nothing() -> None:
    recording = example()
    assert recording.select(NAMES) is recording


class Watched:
    """Samples that note which rows were asked for."""

    shape = (3, 10)

    def __init__(self) -> None:
        self.asked: list[object] = []

    def __getitem__(self, key: tuple[object, slice], /) -> np.ndarray:
        self.asked.append(key[0])
        return np.zeros((1, 10))


def test_selection_reads_only_the_rows_it_needs() -> None:
    samples = Watched()
    example(samples).select(["force_fore"]).values("force_fore")
    assert samples.asked == [[2]]
