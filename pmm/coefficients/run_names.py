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
        for name in [*(run.name for run in campaign.runs), *(run.name for run in campaign.at_rest)]
    ]
    counts = Counter(name for name, _ in places)
    faults = []
    for name, count in counts.items():
        if count > 1:
            folder_text = " and ".join(
                str(folder) for run_name, folder in places if run_name == name
            )
            faults.append(f"two runs are called {name!r} (in {folder_text}); rename one")
    if faults:
        raise ConfigurationError("the campaigns cannot be taken together: " + "; ".join(faults))


def check_left_out(names: Sequence[str], campaigns: Sequence[Campaign]) -> None:
    """Refuse to leave out what is not there: a slip in a name would leave the run in."""
    runs = [run.name for campaign in campaigns for run in campaign.runs]
    known_names = [*runs, *(record.name for campaign in campaigns for record in campaign.at_rest)]
    for name in names:
        if name not in known_names:
            raise ConfigurationError(
                f"leave_out: no run {name!r}; {nearest_run(name, known_names)}"
            )
