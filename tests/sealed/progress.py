"""How far a board is, and when it will be done: now and then a line on standard error."""

import time
from collections.abc import Iterable, Iterator
from typing import TypeVar

import click

T = TypeVar("T")
EVERY_S = 30.0


def told(label: str, total: int, done: Iterable[T]) -> Iterator[T]:
    """Yield what is done, and say how far it is; nothing to do says nothing."""
    started = said = time.monotonic()
    for count, one in enumerate(done, start=1):
        yield one
        now = time.monotonic()
        if now - said >= EVERY_S or count == total:
            said = now
            click.echo(line(label, count, total, now - started), err=True)


def line(label: str, count: int, total: int, seconds: float) -> str:
    """Return how far it is after so many seconds, with what is left at the pace so far."""
    if count == total:
        return f"{label}: {total} in {seconds / 60.0:.1f} min"
    left = seconds / count * (total - count)
    return f"{label}: {count} of {total}, {left / 60.0:.0f} min left"
