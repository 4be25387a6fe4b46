"""A run that is thrown away, so that nothing is slow for the first time while a rig moves."""

from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

import numpy as np

from analysis.resolver.live_resolver import LiveResolver
from hardware.description.channels import Channel
from hardware.description.errors import PmmError
from pmm.recorder.header import RunHeader
from pmm.recorder.run_recorder import RunEnd, RunRecorder
from pmm.run.readings import needles

_CHANNELS: Final = (Channel("nothing", "1"),)
_RATE_HZ: Final = 100.0
_PERIODS: Final = 4  # of a second: enough for a reading with an interval


def rehearse() -> None:
    """Resolve, record and close a run of some seconds, in a folder that is gone afterwards.

    Arrow, HDF5 and SciPy are loaded with it. Where that happens in a run, 500 modules hold the
    interpreter, and with it the loop, for 0.1 to 0.2 s each: while the recorder opens, with the
    first interval in the gate, and while the recorder closes.
    """
    time_s = np.arange(_PERIODS * _RATE_HZ) / _RATE_HZ
    values = np.sin(2.0 * np.pi * time_s)[None, :]
    _resolve(values)
    about = RunHeader(
        run_name="rehearsal",
        channels=_CHANNELS,
        sample_rate_hz=_RATE_HZ,
        started_utc="",
        kind="zero",
    )
    with (
        suppress(PmmError, OSError),  # the disk of the run may do better
        TemporaryDirectory() as folder,
        RunRecorder(Path(folder) / about.run_name, about) as recorder,
    ):
        recorder.samples(1, values)
        recorder.close(RunEnd.COMPLETE)


def _resolve(values: np.ndarray) -> None:
    """Resolve a sine, and show it as needles."""
    resolver = LiveResolver(_CHANNELS, _RATE_HZ, periods=_PERIODS)
    for second in range(_PERIODS):
        first = round(second * _RATE_HZ)
        resolver.push(values[:, first : first + round(_RATE_HZ)])
        resolver.pulse(second + 0.5)
    needles(_CHANNELS, resolver.provisional(), resolver.so_far())
