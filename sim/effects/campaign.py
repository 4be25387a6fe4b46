"""Where in its campaign a run stands: for effects that act on a whole campaign."""

from collections.abc import Sequence
from dataclasses import dataclass

from hardware.description.setpoint import SetPoint


@dataclass(frozen=True)
class CampaignRun:
    """One run's place in its campaign.

    Attributes
    ----------
    index
        Its number, from 0, in the order in which the runs are made.
    since_start_s
        From the beginning of the first run to that of this one.
    waited_s
        From the end of the run before to the beginning of this one; 0 for the first.
    before
        What the run before was set to; ``None`` for the first.
    """

    index: int = 0
    since_start_s: float = 0.0
    waited_s: float = 0.0
    before: SetPoint | None = None


def in_order(
    set_points: Sequence[SetPoint], duration_s: float, waiting_s: float
) -> tuple[CampaignRun, ...]:
    """Return the places of runs that are made in this order, equally long and equally far apart."""
    return tuple(
        CampaignRun(
            index,
            index * (duration_s + waiting_s),
            waiting_s if index else 0.0,
            set_points[index - 1] if index else None,
        )
        for index in range(len(set_points))
    )
