"""In which order a campaign was made, and what time that takes: runs and records at rest."""

from collections.abc import Sequence

from hardware.description.errors import ConfigurationError
from pmm.campaign.campaign import Campaign
from pmm.campaign.runs import AtRest, Run
from sim.effects.campaign import CampaignRun

Record = Run | AtRest


def made_in_order(campaign: Campaign) -> tuple[Record, ...]:
    """Return runs and records at rest in the order in which they were made.

    By their numbers where all have one. Otherwise the runs are in the file's order, and a zero run
    stands before the first run that names it as ``zero_before``, or behind the last that names it
    as ``zero_after``; records at rest of which nothing says when they were made are left out.
    """
    if not campaign.at_rest:
        return campaign.runs
    records: tuple[Record, ...] = (*campaign.runs, *campaign.at_rest)
    numbered = [(record.number, record) for record in records if record.number is not None]
    if len(numbered) == len(records):
        return tuple(record for _, record in sorted(numbered, key=lambda pair: pair[0]))
    order: list[Record] = list(campaign.runs)
    for record in campaign.at_rest:
        place = _place_by_name(order, record.name)
        if place is not None:
            order.insert(place, record)
    return tuple(order)


def _place_by_name(order: Sequence[Record], name: str) -> int | None:
    before = [place for place, record in enumerate(order) if record.zero_before == name]
    after = [place + 1 for place, record in enumerate(order) if record.zero_after == name]
    return min(before) if before else max(after, default=None)


def place_in(campaign: Campaign, record: Record) -> CampaignRun:
    """Return where a run or a record at rest stands in its campaign.

    Raises
    ------
    ConfigurationError
        If nothing says when a record at rest was made.
    """
    order = made_in_order(campaign)
    if record not in order:
        raise ConfigurationError(
            f"nothing says when {record.name!r} was made; number all runs and records at rest, or "
            "name it as zero_before or zero_after of a run"
        )
    earlier = order[: order.index(record)]
    waiting_s = campaign.simulation.waiting_s
    since_s = sum(_duration_s(campaign, entry) for entry in earlier) + len(earlier) * waiting_s
    runs = [place for place, entry in enumerate(earlier) if isinstance(entry, Run)]
    if not runs:
        return CampaignRun(0, since_s, 0.0, None)
    last = earlier[runs[-1]]
    between = earlier[runs[-1] + 1 :]
    waited_s = (
        sum(_duration_s(campaign, entry) for entry in between) + (len(between) + 1) * waiting_s
    )
    before = last.set_point if isinstance(last, Run) else None
    return CampaignRun(len(runs), since_s, waited_s, before)


def _duration_s(campaign: Campaign, record: Record) -> float:
    """Return how long a run or a record at rest takes."""
    if isinstance(record, AtRest):
        return record.duration_s
    # A record is one period longer than the periods that are wanted.
    return (campaign.simulation.settling_periods + record.periods + 1) / record.frequency_hz
