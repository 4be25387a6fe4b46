"""The push test of a run: what the gauges read at rest and pushed, and whether that is right."""

from collections.abc import Sequence

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.channels import Channel
from hardware.description.known_loads import LoadStep
from pmm.devices.push_test import PushError, faults, judge
from pmm.run.errors import PushRefusedError

_FORCE_UNITS = ("N", "N m")


class PushRecord:
    """Collects the samples of a push test."""

    def __init__(self, channels: Sequence[Channel]) -> None:
        self._rows = [i for i, channel in enumerate(channels) if channel.unit in _FORCE_UNITS]
        self._channels = tuple(channels[i] for i in self._rows)
        self._parts: tuple[list[FloatArray], ...] = ([], [], [])  # before, during, after the push
        self._part = 0

    def take(self, values: FloatArray) -> None:
        """Take samples, shape ``(channels, n)``; what comes after the push is let go."""
        if self._part < 2:
            self._parts[self._part].append(values[self._rows])

    def begin(self) -> None:
        """The push begins."""
        self._part = 1

    def end(self) -> None:
        """The push is over."""
        self._part = 2

    def verdict(self, asked: LoadStep) -> str:
        """Return what was found, if it is what was asked for.

        Raises
        ------
        PushRefusedError
            If it is not; the message names the fix.
        """
        rest, pushed = (np.hstack(part) if part else np.empty((0, 0)) for part in self._parts[:2])
        names = [channel.name for channel in self._channels]
        try:
            push = judge(
                self._channels,
                dict(zip(names, rest, strict=True)),
                dict(zip(names, pushed, strict=True)),
            )
        except (PushError, ValueError) as error:
            raise PushRefusedError(asked.channel, f"push test: {error}") from error
        wrong = faults(push, asked.channel, 1 if asked.force_n >= 0.0 else -1)
        if wrong:
            raise PushRefusedError(asked.channel, f"push test: {'; '.join(wrong)}")
        return f"{push.channel} {push.change:+.4g} {push.unit}, as asked for"
