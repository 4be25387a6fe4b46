"""How each strut follows the position that its drive was commanded to, in one recording."""

import math
from collections.abc import Mapping
from typing import Final

from analysis.comparison.compare import compare
from analysis.comparison.result import ChannelComparison
from analysis.recording import Recording
from hardware.description.channels import COMMANDS, DISPLACEMENTS
from hardware.description.errors import DataError

Following = Mapping[str, ChannelComparison]

_APART: Final = 1.25  # factor of gain beyond which nothing follows, but units differ


def following(recording: Recording) -> tuple[Following, str]:
    """Compare each displacement with its command, where both were recorded; by displacement.

    The second part says why one was not compared; it is empty where each was.
    """
    comparisons, said = {}, []
    for command, channel in zip(COMMANDS, DISPLACEMENTS, strict=True):
        if not {command, channel} <= {*recording.channel_names}:
            continue
        try:
            comparison = compare(recording, command, recording, channel)
        except DataError as error:
            said.append(f"{channel} is not compared with its command: {error}")
            continue
        gain, lag_s = comparison.gain.value, comparison.lag_s.value
        quarter_s = math.inf if comparison.modulo_s is None else comparison.modulo_s / 4.0
        if 1.0 / _APART < gain < _APART and abs(lag_s) < quarter_s:
            comparisons[channel] = comparison
        else:
            said.append(
                f"{command} is not used: {channel} is {gain:.3g} times as large, {lag_s:.3g} s "
                "later; are units and sign those of the other?"
            )
    return comparisons, "; ".join(said)
