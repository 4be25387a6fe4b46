"""What one command found of a campaign is given to the next: a diagnosis takes seconds."""

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import lru_cache
from hashlib import sha256
from pathlib import Path

import pytest

from pmm.gap.examination import Examined, Options, examine


@dataclass(frozen=True)
class Folder:
    """A campaign's folder, the same as another with the same name and bytes."""

    name: str
    contents: str
    asked: Path = field(compare=False)


@pytest.fixture(autouse=True, scope="module")
def _one_diagnosis_of_one_campaign() -> Iterator[None]:
    """Let commands in this process share what is found of the same campaign, asked the same."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("pmm.gap.examination.examine", _shared)
        yield
    _once.cache_clear()  # another file may have another catalogue


def _shared(
    asked: Path,
    options: Options,
    executor: Executor | None = None,
    progress: Callable[[str], None] = lambda _: None,
) -> Examined:
    own = any(one.endswith(".py") for one in options.effects)  # may have changed
    if executor is not None or own or not asked.exists():
        return examine(asked, options, executor, progress)
    return _once(Folder(asked.name, _contents(asked), asked), options)


@lru_cache(maxsize=4)
def _once(folder: Folder, options: Options) -> Examined:
    return examine(folder.asked, options)


def _contents(asked: Path) -> str:
    folder = asked if asked.is_dir() else asked.parent
    found = sha256()
    for path in sorted(one for one in folder.rglob("*") if one.is_file()):
        found.update(str(path.relative_to(folder)).encode() + b"\0" + path.read_bytes())
    return found.hexdigest()
