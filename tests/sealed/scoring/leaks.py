"""Keys that lie where whoever answers can read them."""

import hashlib
from collections.abc import Iterator
from pathlib import Path

from tests.sealed.scoring.keys import TRUTH_SCHEMA

_LOOKED_AT = 1 << 20  # bytes of each file


def leaks(case: Path, key: Path) -> Iterator[str]:
    """Yield what in a case's folder leads to its key.

    That is a copy of any file of the key under any name, a file that holds the schema of a key or
    is called like one, and a link that leads out of the folder.
    """
    withheld = {path.stat().st_size: path for path in key.rglob("*") if path.is_file()}
    sizes = set(withheld)
    for path in sorted(case.rglob("*")):
        if path.is_symlink() and not path.resolve().is_relative_to(case.resolve()):
            yield f"{path}: the link leads out of the case's folder"
        elif path.is_file() and _tells(path, sizes, key):
            yield f"{path}: the key is readable in the case's folder; take it out"


def _tells(path: Path, sizes: set[int], key: Path) -> bool:
    if path.name == "truth.json":
        return True
    with path.open("rb") as file:
        if TRUTH_SCHEMA.encode() in file.read(_LOOKED_AT):
            return True
    if path.stat().st_size not in sizes:
        return False
    own = _digest(path)
    return any(own == _digest(other) for other in key.rglob("*") if other.is_file())


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
