"""Clipped channels are named where the clipping lies in the periods used, and only there."""

import numpy as np

from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.channels import Channel
from hardware.description.flags import Flag, Severity

TIMES_S = np.arange(0.0, 10.0, 0.01)
SINE = np.sin(2.0 * np.pi * TIMES_S)


def run(values: np.ndarray, full_scale: float | None, flags: tuple[Flag, ...] = ()) -> list[Flag]:
    recording = Recording(
        "run", (Channel("force", "N", full_scale),), values[None], 100.0, flags=flags
    )
    result = analyse(
        recording, ReferenceChoice(frequency_hz=1.0), ResolverSettings(opens_s=2.0, periods=5)
    )
    return [flag for flag in result.flags if flag.code == "saturated"]


def test_clipped_peaks_are_counted() -> None:
    (flag,) = run(np.clip(SINE, -0.9, 0.9), 0.9)
    clipped = int((np.abs(np.clip(SINE, -0.9, 0.9))[200:701] >= 0.9).sum())
    assert (flag.severity, flag.channel) == (Severity.VOID, "force")
    assert flag.message.startswith(f"{clipped} samples")


def test_a_signal_within_the_range_is_not_flagged() -> None:
    assert run(SINE, 1.1) == []


def test_without_a_known_range_nothing_is_claimed() -> None:
    assert run(np.clip(SINE, -0.9, 0.9), None) == []


def test_clipping_outside_the_periods_used_does_not_matter() -> None:
    assert run(np.where(TIMES_S < 1.9, np.clip(SINE, -0.9, 0.9), 0.8 * SINE), 0.9) == []


def test_what_the_reader_flagged_is_not_flagged_again() -> None:
    known = Flag("saturated", Severity.VOID, "by the reader", "force")
    assert run(np.clip(SINE, -0.9, 0.9), 0.9, (known,)) == [known]
