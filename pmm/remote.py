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


def local_path(place: str | Path) -> Path:
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
    system, location = _system(url)
    if "file" in _protocols(system):
        return Path(location)
    target = _copies() / protocol / rest
    try:
        files = _files(system, location)
        _check_names([rest, *files])
        if not files:
            system.info(location)  # it says why
        copies = {_below(target, location, name): info for name, info in files.items()}
        _bring(system, copies)
    except Exception as error:  # each protocol's package raises its own
        reason = error.__cause__ or error
        if not isinstance(reason, FileNotFoundError):
            raise DataError(f"{url}: cannot be read: {reason}") from error
        files, copies = {}, {}
    _forget(target, copies)
    if not files:
        raise ConfigurationError(f"{url}: no such file or folder")
    return target


def url_of(place: str | Path) -> str | None:
    """Return the URL of what lies elsewhere, or of its copy's path; ``None`` for a plain path."""
    parts = Path(place).parts
    if _COPIES in parts[:-2]:
        protocol, *rest = parts[parts.index(_COPIES) + 1 :]
        return f"{protocol}://{'/'.join(rest)}"
    match = _URL.fullmatch(str(place).replace(os.sep, "/"))
    if match is None:
        return None
    root = "/" if match[1] == "file" else ""
    return f"{match[1]}://{root}{match[2].rstrip('/')}"


def _system(url: str) -> tuple[Any, str]:
    from fsspec.core import url_to_fs

    try:
        system_path: tuple[Any, str] = url_to_fs(url)
    except ImportError as error:
        remedy = f": {installing('s3')}" if url.startswith("s3:") else ""
        raise ConfigurationError(f"{url}: {error}{remedy}") from None
    except ValueError as error:
        raise ConfigurationError(f"{url}: {error}") from None
    return system_path


def _protocols(system: Any) -> tuple[str, ...]:
    protocols = system.protocol
    return (protocols,) if isinstance(protocols, str) else tuple(protocols)


def _copies() -> Path:
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / _COPIES


def _files(system: Any, location: str) -> dict[str, dict[str, Any]]:
    """Return what is known of each file below a place, or of the file that it is."""
    system.invalidate_cache()
    try:
        files: dict[str, dict[str, Any]] = system.find(location, detail=True)
    except FileNotFoundError:
        return {}
    return files


def _check_names(names: Iterable[str]) -> None:
    if any(".." in PurePosixPath(name).parts for name in names):
        raise ValueError("a name has '..' in it")


def _below(target: Path, location: str, name: str) -> Path:
    """Return where a file's copy lies; the place itself where it is a file."""
    return target / name.removeprefix(location).lstrip("/") if name != location else target


def _bring(system: Any, copies: dict[Path, dict[str, Any]]) -> None:
    for path, info in copies.items():
        changed_s = _changed_s(system, info["name"])
        if changed_s is not None and _is_copied(path, info["size"], changed_s):
            continue
        path.parent.mkdir(parents=True, exist_ok=True)
        part = path.with_name(f".{path.name}.{os.getpid()}.part")
        try:
            system.get_file(info["name"], str(part))
            if changed_s is not None:
                os.utime(part, (changed_s, changed_s))
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
    status = path.stat()
    return status.st_size == size and abs(status.st_mtime - changed_s) < _SAME_S


def _forget(target: Path, copies: Collection[Path]) -> None:
    """Remove the copies of files that are gone, but for those that are just being made."""
    for path in (target,) if target.is_file() else tuple(target.rglob("*")):
        if path.is_file() and path not in copies and path.suffix != ".part":
            path.unlink()
