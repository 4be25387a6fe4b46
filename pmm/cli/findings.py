"""What a check of a plan found, in lines for people."""

import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Final

from pmm.document.notation import counted
from pmm.plan.findings import PlanFinding, PlanVerdict, largest_stated

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text

_STYLES: Final = {
    PlanVerdict.REFUSE: "bold red",
    PlanVerdict.WARN: "yellow",
    PlanVerdict.NOTE: "cyan",
}


def finding_lines(found: Sequence[PlanFinding], *, every: bool = False) -> "Iterator[Text]":
    """Yield a line for each finding; of those of one kind, unless every one is wanted, the worst.

    Parameters
    ----------
    every
        Whether all findings of a kind are wanted, and the numbers that :func:`condition_table` has.
    """
    from rich.text import Text

    for one, more in _gathered(found, every=every):
        others = f" (and {counted(more, 'other run')} so)" if more else ""
        run = f"{one.run}: " if one.run else ""
        yield Text.assemble(
            (f"{one.verdict:7s}", _STYLES[one.verdict]), f"{run}{one.message}{others}"
        )


def _gathered(found: Sequence[PlanFinding], *, every: bool) -> Iterator[tuple[PlanFinding, int]]:
    """Yield findings; of those of one kind the one furthest off, and how many there are beside."""
    if every:
        yield from ((one, 0) for one in found)
        return
    ranks = list(PlanVerdict)
    found = [one for one in found if not one.is_stated]

    def kind(one: PlanFinding) -> tuple[int, str, float]:
        what = one.quantity if one.run else one.message
        return ranks.index(one.verdict), what, 0.0 if math.isnan(one.limit) else one.limit

    for _, group in groupby(sorted(found, key=kind), kind):
        alike = list(group)
        worst = max(alike, key=lambda one: abs(one.value - kind(one)[2]))
        yield worst, len({one.run for one in alike}) - 1


def condition_table(found: Sequence[PlanFinding]) -> "Table | None":
    """Return the numbers that state the runs' conditions, each at its largest; ``None`` if none."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    largest = largest_stated(found)
    if not largest:
        return None
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    table.add_column("condition")
    table.add_column("largest", justify="right")
    table.add_column("limit", justify="right")
    table.add_column("source")
    table.add_column("in run", overflow="fold")
    for one in largest:
        limit = f"{one.limit:.4g}" if math.isfinite(one.limit) else "none"
        table.add_row(one.quantity, f"{one.value:.4g}", limit, one.source, one.run)
    return table
