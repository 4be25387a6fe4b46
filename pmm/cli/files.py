"""Folders and files of a command: looked at before any work, and what is said of them after."""

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hardware.description.errors import ConfigurationError
from pmm.cli.screen import error_line, messages, pasted

if TYPE_CHECKING:
    from hardware.description.flags import Flag
    from pmm.document.content import Document, Figure


def check_folder(path: Path | str | None, option: str) -> None:
    """Refuse a folder that cannot be made or written to; nothing is made yet.

    Parameters
    ----------
    path
        The folder; ``None`` where the option is not given.
    option
        What named the folder, for the message.

    Raises
    ------
    ConfigurationError
        If a file is in the way, the permission is missing, or the folder lies elsewhere.
    """
    from pmm.remote import url_of

    if path is None:
        return
    folder = Path(path)
    if url_of(folder):
        raise ConfigurationError(f"{option} {folder}: only a folder of this computer is written to")
    place = folder
    while not place.exists() and place != place.parent:
        place = place.parent
    if not place.is_dir():
        raise ConfigurationError(f"{option} {folder}: {place} is a file, not a folder")
    if not os.access(place, os.W_OK | os.X_OK):
        raise ConfigurationError(
            f"{option} {folder}: no permission to write in {place}; name another"
        )


def check_file(path: Path, option: str, *, overwrite: bool = True) -> None:
    """Refuse a file that would be lost or cannot be written; nothing is made or changed yet.

    Parameters
    ----------
    overwrite
        Whether one that is there may be replaced.

    Raises
    ------
    ConfigurationError
        If it is a folder, its folder cannot be made or written to, or it is there and may not be
        replaced or cannot be written to.
    """
    check_folder(path.parent, option)
    if path.is_dir():
        raise ConfigurationError(f"{option} {path}: a folder; name a file")
    if path.exists() and not overwrite:
        raise ConfigurationError(
            f"{option} {path}: there already; choose another name, or --overwrite"
        )
    if path.exists() and not os.access(path, os.W_OK):
        raise ConfigurationError(f"{option} {path}: cannot be written to")


def check_files(
    outputs: Mapping[str, str | None],
    inputs: Iterable[tuple[str, Path]] = (),
    *,
    overwrite: bool = True,
) -> None:
    """Refuse files to be written, as :func:`check_file`, or two that are one.

    Parameters
    ----------
    outputs
        What each option names; ``None`` where it is not given.
    inputs
        Files that the command reads and must not lose, each with what named it.

    Raises
    ------
    ConfigurationError
        As :func:`check_file`; or an option names a file that is read, or that another one names.
    """
    readers = {path.resolve(): name for name, path in inputs}
    writers: dict[Path, str] = {}
    for option, name in outputs.items():
        if name is None:
            continue
        path, label = Path(name), f"{option} {name}"
        check_file(path, option, overwrite=overwrite)
        if (real_path := path.resolve()) in readers:
            raise ConfigurationError(
                f"{label}: {readers[real_path]} is read from it; name another file"
            )
        if real_path in writers:
            raise ConfigurationError(f"{writers[real_path]} and {label}: the same file; name two")
        writers[real_path] = label


def write_asked_page(
    content: "Document", page: str | None, command: Sequence[str], read: Sequence[Path] = ()
) -> None:
    """Write a document as the page that ``--page`` names, if it was given.

    Parameters
    ----------
    command
        Words that make the page again, without ``--page``.
    read
        Files that the page quotes.
    """
    from pmm.document.page import write_page

    if page is not None:
        write_page(content, Path(page), command=pasted(*command, "--page", page), read=read)
        messages().print(f"page: {page}")


def write_asked_figures(figures: "Iterable[Figure]", plot: str | None, stem: str) -> None:
    """Write figures of a document into the folder that ``--plot`` names, if it was given."""
    from pmm.document.style import write_figures

    if plot is not None:
        paths = write_figures(figures, Path(plot), stem)
        messages().print(f"written: {len(paths)} figures in {plot}")


def tell_damaged(file_flags: "Iterable[tuple[str, Iterable[Flag]]]") -> list[int]:
    """Say what of files is damaged, each given with its name and flags.

    Returns
    -------
    list of int
        An exit status for each thing that was said.
    """
    damages = [(name, flag.message) for name, flags in file_flags for flag in flags if flag.damaged]
    for name, message in damages:
        error_line(f"{name}: {message}")
    return [1] * len(damages)


def tell_unchecked(paths: Iterable[Path | str]) -> None:
    """Say, in one line, which recordings carry no checksums: those of other systems do not."""
    from analysis.readers.damage import carries_checksums
    from hardware.description.words import joined

    names = [Path(path).name for path in dict.fromkeys(paths) if not carries_checksums(Path(path))]
    if names:
        messages().print(f"without checksums, so that no change would be seen: {joined(names)}")


def tell_writers(places: Iterable[Path]) -> None:
    """Say which campaigns are being written: of them, the runs that are closed so far are read.

    Parameters
    ----------
    places
        Campaigns' folders, or files in them.
    """
    from pmm.recorder.campaign_owner import writer_of

    folders = (place if place.is_dir() else place.parent for place in places)
    for folder in dict.fromkeys(folders):
        writer = writer_of(folder)
        if writer is not None:
            messages().print(
                f"{folder}: is being written by {writer}; read are the runs that are closed so far"
            )
