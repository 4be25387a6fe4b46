"""In which order a campaign was made, and what time that takes: runs and records at rest."""

from collections.abc import Mapping, Sequence

from hardware.description.errors import ConfigurationError
from pmm.campaign.campaign import Campaign
from pmm.campaign.runs import AtRest, Run
from sim.effects.campaign import CampaignRun

Record = Run | AtRest
Clock = Mapping[str, tuple[float, float]]
"""Beginning and end of each record by its name, on one clock, in seconds."""


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


def place_in(campaign: Campaign, record: Record, clock: Clock | None = None) -> CampaignRun:
    """Return where a run or a record at rest stands in its campaign.

    Parameters
    ----------
    clock
        When all of them were made, if that is known (:func:`pmm.campaign.clock.clock_of`); else
        their order and the campaign's ``waiting_s`` tell.

    Raises
    ------
    ConfigurationError
        If nothing says when a record at rest was made.
    """
    if not clock:
        clock = _stated_clock(campaign)
    if record.name not in clock:
        raise ConfigurationError(
            f"nothing says when {record.name!r} was made; number all runs and records at rest, or "
            "name it as zero_before or zero_after of a run"
        )
    first_s, began_s = min(clock.values())[0], clock[record.name][0]
    earlier = [run for run in campaign.runs if clock[run.name][0] < began_s]
    if not earlier:
        return CampaignRun(0, began_s - first_s, 0.0, None)
    last = max(earlier, key=lambda run: clock[run.name][0])
    waited_s = began_s - clock[last.name][1]
    return CampaignRun(len(earlier), began_s - first_s, waited_s, last.set_point)


def _stated_clock(campaign: Campaign) -> Clock:
    """Return when records begin and end that are made in their order, equally far apart."""
    clock: dict[str, tuple[float, float]] = {}
    began_s = 0.0
    for record in made_in_order(campaign):
        ended_s = began_s + _duration_s(campaign, record)
        clock[record.name] = began_s, ended_s
        began_s = ended_s + campaign.simulation.waiting_s
    return clock


def _duration_s(campaign: Campaign, record: Record) -> float:
    """Return how long a run or a record at rest takes."""
    if isinstance(record, AtRest):
        return record.duration_s
    # A record is one period longer than the periods that are wanted.
    return (campaign.simulation.settling_periods + record.periods + 1) / record.frequency_hz
