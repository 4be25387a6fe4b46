"""Names of runs, of several campaigns taken together."""

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from hardware.description.errors import ConfigurationError
from pmm.campaign.campaign import Campaign
from pmm.campaign.runs import nearest_run


def check_names(campaigns: Sequence[tuple[Path, Campaign]]) -> None:
    """Refuse runs of one name before anything is read."""
    places = [
        (name, folder)
        for folder, campaign in campaigns
        for name in [*(one.name for one in campaign.runs), *(one.name for one in campaign.at_rest)]
    ]
    counts = Counter(name for name, _ in places)
    faults = []
    for name, count in counts.items():
        if count > 1:
            where = " and ".join(str(folder) for own, folder in places if own == name)
            faults.append(f"two runs are called {name!r} (in {where}); rename one")
    if faults:
        raise ConfigurationError("the campaigns cannot be taken together: " + "; ".join(faults))


def check_left_out(names: Sequence[str], campaigns: Sequence[Campaign]) -> None:
    """Refuse to leave out what is not there: a slip in a name would leave the run in."""
    runs = [one.name for campaign in campaigns for one in campaign.runs]
    known = [*runs, *(one.name for campaign in campaigns for one in campaign.at_rest)]
    for name in names:
        if name not in known:
            raise ConfigurationError(f"leave_out: no run {name!r}; {nearest_run(name, known)}")
