"""What is said of a recording that cannot be what it says."""

from dataclasses import dataclass
from typing import Final

UNIT_NEAR: Final = 0.2  # of a unit's factor, in the logarithm
SAY_UNIT: Final = "say the column's unit in the campaign"


@dataclass(frozen=True)
class Doubt:
    """A recording, or a channel of all recordings, that cannot be what it says.

    Attributes
    ----------
    run
        ``""`` for all runs.
    channel
        ``""`` for the whole run.
    """

    run: str
    channel: str
    reason: str
