"""What lies elsewhere (``s3://``, ``memory://`` ...): copied to this computer to be read."""

import os
import re
from collections.abc import Collection, Iterable
from pathlib import Path, PurePosixPath
from typing import Any, Final

from hardware.description.errors import ConfigurationError, DataError
from hardware.description.version import installing

_COPIES: Final = "pmm-copies"  # folder of all copies, below it the protocol and the rest of the URL
# A path that was made of a URL has lost one of its slashes; one letter is a disk of Windows.
_URL: Final = re.compile(r"([a-z][a-z0-9+.-]+):/+(.+)")
_SAME_S: Final = 1e-5  # times of change: systems of files keep them to 1e-7 s or finer


def here(place: str | Path) -> Path:
    """Return where a file or folder can be read on this computer; a plain path is itself.

    What a URL of ``fsspec`` names is copied; of a copy that is there, only files whose size or time
    of change differ, and files that are gone from there go here too. The path of a copy stands for
    its URL, on whatever computer it was made: so tasks carry paths, and each worker has its own.

    Raises
    ------
    ConfigurationError
        If nothing is there, or the protocol is not known or its package not installed.
    DataError
        If it cannot be read.
    """
    url = url_of(place)
    if url is None:
        return Path(place)
    protocol, _, rest = url.partition("://")
    system, there = _system(url)
    if "file" in _protocols(system):
        return Path(there)
    target = _copies() / protocol / rest
    try:
        found = _files(system, there)
        _check_names([rest, *found])
        copies = {_below(target, there, name): info for name, info in found.items()}
        _bring(system, copies)
    except Exception as error:  # each protocol's package raises its own
        raise DataError(f"{url}: cannot be read: {error}") from error
    _forget(target, copies)
    if not found:
        raise ConfigurationError(f"{url}: no such file or folder")
    return target


def url_of(place: str | Path) -> str | None:
    """Return the URL of what lies elsewhere, or of its copy's path; ``None`` for a plain path."""
    parts = Path(place).parts
    if _COPIES in parts[:-2]:
        protocol, *rest = parts[parts.index(_COPIES) + 1 :]
        return f"{protocol}://{'/'.join(rest)}"
    found = _URL.fullmatch(str(place).replace(os.sep, "/"))
    if found is None:
        return None
    root = "/" if found[1] == "file" else ""
    return f"{found[1]}://{root}{found[2].rstrip('/')}"


def _system(url: str) -> tuple[Any, str]:
    from fsspec.core import url_to_fs

    try:
        found: tuple[Any, str] = url_to_fs(url)
    except ImportError as error:
        remedy = f": {installing('s3')}" if url.startswith("s3:") else ""
        raise ConfigurationError(f"{url}: {error}{remedy}") from None
    except ValueError as error:
        raise ConfigurationError(f"{url}: {error}") from None
    return found


def _protocols(system: Any) -> tuple[str, ...]:
    found = system.protocol
    return (found,) if isinstance(found, str) else tuple(found)


def _copies() -> Path:
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / _COPIES


def _files(system: Any, there: str) -> dict[str, dict[str, Any]]:
    """Return what is known of each file below a place, or of the file that it is."""
    system.invalidate_cache()
    try:
        found: dict[str, dict[str, Any]] = system.find(there, detail=True)
    except FileNotFoundError:
        return {}
    return found


def _check_names(names: Iterable[str]) -> None:
    if any(".." in PurePosixPath(name).parts for name in names):
        raise ValueError("a name has '..' in it")


def _below(target: Path, there: str, name: str) -> Path:
    """Return where a file's copy lies; the place itself where it is a file."""
    return target / name.removeprefix(there).lstrip("/") if name != there else target


def _bring(system: Any, found: dict[Path, dict[str, Any]]) -> None:
    for path, info in found.items():
        changed = _changed_s(system, info["name"])
        if changed is not None and _is_copied(path, info["size"], changed):
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_name(f".{path.name}.{os.getpid()}.part")
        try:
            system.get_file(info["name"], str(part))
            if changed is not None:
                os.utime(part, (changed, changed))
            part.replace(path)
        finally:
            part.unlink(missing_ok=True)


def _changed_s(system: Any, name: str) -> float | None:
    try:
        return float(system.modified(name).timestamp())
    except NotImplementedError:  # as over HTTP: it is copied anew each time
        return None


def _is_copied(path: Path, size: int, changed_s: float) -> bool:
    if not path.is_file():
        return False
    mine = path.stat()
    return mine.st_size == size and abs(mine.st_mtime - changed_s) < _SAME_S


def _forget(target: Path, kept: Collection[Path]) -> None:
    """Remove the copies of files that are gone, but for those that are just being made."""
    for path in (target,) if target.is_file() else tuple(target.rglob("*")):
        if path.is_file() and path not in kept and path.suffix != ".part":
            path.unlink()
