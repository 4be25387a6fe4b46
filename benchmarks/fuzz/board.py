"""What came of a million inputs: counted, kept, and gone on with where it was left."""

import json
from collections import Counter
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any, Final

from pmm.whole_file import write_whole

PROMISES: Final = ("uncaught", "hangs over 5 s", "over 1 GB", "silent NaN")


@dataclass
class Count:
    """What came of one reader's inputs.

    Attributes
    ----------
    done, taken, refused
        Inputs so far; those that were read, and those that were refused with a sentence.
    broken
        By promise, how many broke it.
    slowest_s
        The longest that one took.
    kinds
        How many different refusals and results there were.
    """

    done: int = 0
    taken: int = 0
    refused: int = 0
    broken: dict[str, int] = field(default_factory=dict)
    slowest_s: float = 0.0
    kinds: int = 0


def read_counts(folder: Path) -> dict[str, Count]:
    """Return what is counted so far; nothing where nobody has begun."""
    path = folder / "counts.json"
    if not path.exists():
        return {}
    kept = json.loads(path.read_text(encoding="utf-8"))
    return {name: Count(**one) for name, one in kept.items()}


def keep_counts(folder: Path, counts: dict[str, Count]) -> None:
    """Keep the counts, whole at every moment."""
    write_whole(
        folder / "counts.json", json.dumps({name: asdict(one) for name, one in counts.items()})
    )


def keep_broken(folder: Path, name: str, number: int, data: bytes, said: str) -> Path:
    """Keep an input that broke a promise, and what was said."""
    place = folder / "broken"
    place.mkdir(exist_ok=True)
    path = place / f"{name.replace(':', '').replace(' ', '-')}-{number}"
    path.write_bytes(data)
    path.with_name(f"{path.name}.txt").write_text(said, encoding="utf-8")
    return path


def document(counts: dict[str, Count], machine: dict[str, str]) -> dict[str, Any]:
    """Return what is committed."""
    broken = Counter[str]()
    for one in counts.values():
        broken.update(one.broken)
    return {
        "name": "fuzz",
        "machine": machine,
        "inputs": sum(one.done for one in counts.values()),
        "broken": {promise: broken[promise] for promise in PROMISES},
        "readers": [{"reader": name, **asdict(one)} for name, one in counts.items()],
    }
