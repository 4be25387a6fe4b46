"""What a command that only reads says of a campaign that another process is writing."""

from collections.abc import Iterable
from pathlib import Path

from pmm.cli.screen import messages
from pmm.recorder.campaign_owner import writer_of


def tell_writers(places: Iterable[Path]) -> None:
    """Say which campaigns are being written: of them, the runs that are closed so far are read.

    Parameters
    ----------
    places
        Campaigns' folders, or files in them.
    """
    folders = (one if one.is_dir() else one.parent for one in places)
    for folder in dict.fromkeys(folders):
        writer = writer_of(folder)
        if writer is not None:
            messages().print(
                f"{folder}: is being written by {writer}; read are the runs that are closed so far"
            )
