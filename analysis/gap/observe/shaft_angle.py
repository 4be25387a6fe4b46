"""The shaft's angle as it is recorded: whether it is wrapped, and by how much it goes on."""

from dataclasses import replace

import numpy as np

from analysis.recording import Recording
from hardware.description.channels import SHAFT_ANGLE


def unwrapped(recording: Recording) -> Recording:
    """Return a recording whose shaft angle, where there is one, goes on from turn to turn.

    Many encoders begin anew at each turn; the harmonics of that saw are none of the shaft's.
    """
    if SHAFT_ANGLE.name not in recording.channel_names:
        return recording
    angle = recording.values(SHAFT_ANGLE.name)
    is_finite = np.isfinite(angle)
    if not float(np.abs(np.diff(angle[is_finite])).max(initial=0.0)) > np.pi:
        return recording
    samples = np.array(recording.samples[:, 0 : recording.sample_count])
    samples[recording.index(SHAFT_ANGLE.name), is_finite] = np.unwrap(angle[is_finite])
    return replace(recording, samples=samples)


def turns_per_period(recording: Recording, frequency_hz: float) -> float:
    """Return by how many turns the angle goes on each period, if it is in rad; NaN without one.

    Jumps by more than half of all that it covers are those of an angle that begins anew.
    """
    if SHAFT_ANGLE.name not in recording.channel_names:
        return float("nan")
    angle = recording.values(SHAFT_ANGLE.name)
    steps, taken_s = np.diff(angle), np.diff(recording.time_s())
    is_smooth = np.abs(steps) <= 0.5 * np.ptp(angle)
    if not is_smooth.any():
        return float("nan")
    return float(steps[is_smooth].sum() / taken_s[is_smooth].sum()) / frequency_hz / (2.0 * np.pi)
