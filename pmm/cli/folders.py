"""Folders and files to write to, looked at before any work is done."""

import os
from pathlib import Path

from hardware.description.errors import ConfigurationError


def check_folder(folder: Path, option: str) -> None:
    """Refuse a folder that cannot be made or written to; nothing is made yet.

    Parameters
    ----------
    option
        What named the folder, for the message.

    Raises
    ------
    ConfigurationError
        If a file is in the way or the permission is missing.
    """
    place = folder
    while not place.exists() and place != place.parent:
        place = place.parent
    if not place.is_dir():
        raise ConfigurationError(f"{option} {folder}: {place} is a file, not a folder")
    if not os.access(place, os.W_OK | os.X_OK):
        raise ConfigurationError(f"{option} {folder}: no permission to write in {place}")


def check_writable(path: Path, option: str) -> None:
    """Refuse a file that cannot be written, as writing it would; nothing is made or changed yet.

    Raises
    ------
    ConfigurationError
        If its folder cannot be made or written to.
    OSError
        If it is a folder, or is there and may not be written to.
    """
    check_folder(path.parent, option)
    if path.is_dir() or path.is_file():  # a pipe would take this for its end
        path.open("ab").close()
