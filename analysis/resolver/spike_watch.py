"""Spikes of a run that is still being recorded: judged by what has come so far."""

from dataclasses import dataclass

import numpy as np

from analysis.spikes import Pulses, Spike, curvature_of_chunks, find_pulses, most_of, switches
from hardware.description.arrays import FloatArray


@dataclass(frozen=True, eq=False)
class LiveSpike:
    """A spike that was taken out of a live reading: the channel's row, and its first sample.

    ``spike`` counts samples as the window it was found in; ``number`` counts them from the run's
    first one.
    """

    row: int
    number: int
    spike: Spike


class SpikeWatch:
    """Take spikes out of a run's periods, one after the other.

    The rule is the recording's, :func:`analysis.spikes.find_spikes`, on all that has come by the
    end of the period. What only later turns out to recur, or to be no more than the run itself does
    later, was taken out here until then; the recording's analysis leaves it in.
    """

    def __init__(self, channels: int) -> None:
        self._known = [Pulses((), 0.0)] * channels
        self._numbers: list[list[int]] = [[] for _ in range(channels)]

    def take_out(self, values: FloatArray, first: int, until: int) -> list[LiveSpike]:
        """Put the cubic in the place of spikes, and return those.

        Parameters
        ----------
        values
            A period and what its edges need, shape ``(channels, samples)``; changed in place.
        first
            Number of their first sample; all before and in it count as what has come.
        until
            Which of them belongs to a later period alone. What lies there may be half a spike, and
            is judged when its surroundings have come.
        """
        taken: list[LiveSpike] = []
        with np.errstate(over="ignore", invalid="ignore"):
            bends = curvature_of_chunks(values[:, : until + 1])
            for row, bend in enumerate(bends):
                taken += self._of_channel(values, row, bend, first, until)
        for spike in taken:
            values[spike.row, spike.spike.start : spike.spike.stop] = spike.spike.replacement
        return taken

    def _of_channel(
        self, values: FloatArray, row: int, bend: FloatArray, first: int, until: int
    ) -> list[LiveSpike]:
        pulses_before, numbers = self._known[row], self._numbers[row]
        if not bend.max(initial=0.0) > pulses_before.rest:
            return []
        most = most_of(first + values.shape[1])
        pulses_now = find_pulses(values, row, bend, most, until)
        new = [pulse for pulse in pulses_now.candidates if pulse.start + first not in numbers]
        numbers += [pulse.start + first for pulse in new]
        pulses = tuple(pulse.moved(first) for pulse in new)
        now = Pulses(pulses_before.candidates + pulses, max(pulses_before.rest, pulses_now.rest))
        if np.isfinite(now.rest):
            self._known[row] = now
        spikes = [spike for spike in now.spikes() if spike in pulses]
        if not spikes or switches(values, row):
            return []
        return [LiveSpike(row, spike.start, spike.moved(-first)) for spike in spikes]
