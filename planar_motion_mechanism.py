"""The distribution's name, and a check that its four packages are its own.

The packages have common names. Another distribution may put a package of such a name over ours, and
a user's own file beside a script hides it. Each of our packages therefore calls
:func:`refuse_intruders` when it is imported, and the command ``pmm`` enters by
:mod:`planar_motion_mechanism_command`: both names are nobody else's.
"""

import os
from collections.abc import Collection, Iterator
from functools import cache
from importlib.util import find_spec
from typing import Final

DISTRIBUTION: Final = "planar-motion-mechanism"
PACKAGES: Final = ("pmm", "analysis", "sim", "hardware")

# Start-up does without pathlib.
_HOUSE: Final = os.path.dirname(os.path.realpath(__file__))  # noqa: PTH120
_FIRST_FILES: Final = tuple(f"{name}/__init__.py" for name in PACKAGES)


@cache
def refuse_intruders() -> None:
    """Check that Python finds our four packages beside this file, as they were installed.

    Raises
    ------
    ImportError
        A package is missing, hidden by another of its name, or overwritten; the message names the
        file, and the distribution that it belongs to where one says so.
    """
    for name, file in zip(PACKAGES, _FIRST_FILES, strict=True):
        spec = find_spec(name)
        _refuse_elsewhere(name, _path(file), spec.origin if spec else None)
    for file in changed_files(_FIRST_FILES):
        path = _path(file)
        raise ImportError(f"{path} is not the file that {DISTRIBUTION} installed; {_way(path)}")


def _refuse_elsewhere(name: str, ours: str, found: str | None) -> None:
    """Refuse a package that Python finds anywhere but beside this file."""
    if found is None or not os.path.exists(ours):  # noqa: PTH110
        raise ImportError(
            f"the package {name!r} is not there beside {__file__}; {_anew('install it anew')}"
        )
    if os.path.realpath(found) != ours:
        raise ImportError(f"{found} hides the package {name!r} of {DISTRIBUTION}; {_way(found)}")


def changed_files(wanted: Collection[str] | None = None) -> Iterator[str]:
    """Yield the files that are missing or differ from the record of the installation.

    Parameters
    ----------
    wanted
        Which of our files to look at, relative to the folder of this one; all if not given.

    Yields
    ------
    str
        A file of the record; none in a source tree or an editable installation, which have no
        record of their sources.
    """
    for line in _record():
        file, _, told = line.rstrip().partition(",")
        ours = file.startswith(PACKAGES) if wanted is None else file in wanted
        if ours and told.startswith("sha256=") and told.split(",")[0] != _checksum(_path(file)):
            yield file


def _record() -> list[str]:
    """Return the lines of the record (*Recording installed projects*, PyPA specifications)."""
    prefix = f"{DISTRIBUTION.replace('-', '_')}-"
    for name in os.listdir(_HOUSE):  # noqa: PTH208
        if name.startswith(prefix) and name.endswith(".dist-info"):
            with open(_path(f"{name}/RECORD"), encoding="utf-8") as lines:  # noqa: PTH123
                return lines.readlines()
    return []


def _checksum(path: str) -> str | None:
    """Return a file's checksum as a record has it; ``None`` where there is no file."""
    import hashlib
    from base64 import urlsafe_b64encode

    try:
        with open(path, "rb") as file:  # noqa: PTH123
            digest = hashlib.sha256(file.read()).digest()
    except FileNotFoundError:
        return None
    return "sha256=" + urlsafe_b64encode(digest).rstrip(b"=").decode()


def _way(path: str) -> str:
    """Return what to do about a file that is not ours, by who put it there."""
    owner = _owner(path)
    if owner:
        return f"it belongs to {owner!r}: pip uninstall {owner}, then {_anew('install anew')}"
    if path.startswith(_HOUSE + os.sep):
        return _anew("install anew")
    return "rename that file"


def _owner(path: str) -> str | None:
    """Return the other distribution whose record has a file."""
    from importlib.metadata import distributions

    wanted = os.path.realpath(path)
    for one in distributions():
        if one.name != DISTRIBUTION and any(
            file.name == "__init__.py" and os.path.realpath(str(one.locate_file(file))) == wanted
            for file in one.files or ()
        ):
            return str(one.name)
    return None


def _anew(what: str) -> str:
    return f"{what}: pip install --force-reinstall --no-deps {DISTRIBUTION}"


def _path(file: str) -> str:
    return os.path.join(_HOUSE, *file.split("/"))  # noqa: PTH118
