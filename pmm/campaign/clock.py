"""When a campaign's recordings were made, by the clock of the computer that wrote them."""

from datetime import datetime
from itertools import pairwise
from pathlib import Path

from hardware.description.errors import PmmError
from pmm.campaign.campaign import Campaign
from pmm.campaign.order import Clock
from pmm.remote import local_path


def clock_of(campaign: Campaign, folder: Path) -> Clock:
    """Return when each recording began and ended; only their headers are read.

    Nothing unless all say so, and none begins before the one before it has ended: a rig that is
    simulated faster than time has a clock that its records do not fit into.
    """
    from analysis.readers.netcdf import read_span

    times: dict[str, tuple[float, float]] = {}
    paths = {run.name: run.recording_path(folder) for run in campaign.runs}
    paths |= {record.name: record.recording_path(folder) for record in campaign.at_rest}
    for name, path in paths.items():
        if path.suffix != ".nc":  # no other file says so
            return {}
        try:
            started_utc, length_s = read_span(local_path(path))
            began_s = datetime.fromisoformat(started_utc).timestamp()
        except (PmmError, OSError, ValueError, TypeError, LookupError):  # or is no recording
            return {}
        times[name] = began_s, began_s + length_s
    fits = all(after[0] >= before[1] for before, after in pairwise(sorted(times.values())))
    return times if fits else {}
