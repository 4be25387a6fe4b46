"""What is said of files besides their content: damaged, unchecked, or still being written."""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from pmm.cli.screen import error_line, messages
from pmm.document.flag_lines import joined
from pmm.recorder.campaign_owner import writer_of

if TYPE_CHECKING:
    from hardware.description.flags import Flag


def tell_damaged(found: "Iterable[tuple[str, Iterable[Flag]]]") -> list[int]:
    """Say what of files is damaged, each given with its name and flags.

    Returns
    -------
    list of int
        An exit status for each thing that was said.
    """
    told = [(name, flag.message) for name, flags in found for flag in flags if flag.damaged]
    for name, message in told:
        error_line(f"{name}: {message}")
    return [1] * len(told)


def tell_unchecked(paths: Iterable[Path | str]) -> None:
    """Say, in one line, which recordings carry no checksums: those of other systems do not."""
    from analysis.readers.damage import carries_checksums

    names = [Path(one).name for one in dict.fromkeys(paths) if not carries_checksums(Path(one))]
    if names:
        messages().print(f"without checksums, so that no change would be seen: {joined(names)}")


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
