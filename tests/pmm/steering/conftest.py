"""Recordings of a campaign that many tests look at."""

from collections.abc import Callable, Hashable, Iterator
from pathlib import Path
from typing import Any

import pytest

from analysis import readers
from analysis.readers import read_recording
from pmm.coefficients.tasks import Task
from pmm.steering import workflow


@pytest.fixture(scope="module")
def reads_once() -> Iterator[None]:
    """Open each recording once, and read it once for all tests that ask the same of it."""

    def remembering(
        work: Callable[..., Any], key_of: Callable[[Any], Hashable]
    ) -> Callable[..., Any]:
        kept: dict[Hashable, Any] = {}

        def once(first: Any, *more: Any, **named: Any) -> Any:
            key = key_of(first)
            if key not in kept:
                kept[key] = work(first, *more, **named)
            return kept[key]

        return once

    def asked(task: Task) -> Hashable:
        return task.source.path.resolve(), task.set_point, task.zero_names, task.tared

    with pytest.MonkeyPatch.context() as patch:
        for name in ("read_steered", "read_zero", "read_gauge_zeros"):
            patch.setattr(workflow, name, remembering(getattr(workflow, name), asked))
        patch.setattr(readers, "read_recording", remembering(read_recording, Path.resolve))
        yield
