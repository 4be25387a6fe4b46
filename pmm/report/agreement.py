"""How data agree that are more than the unknowns: a table for people, rows for programs."""

import math
from collections.abc import Sequence
from typing import Any, Final

from analysis.inertia.result import finite_or_none
from analysis.uncertainty.redundancy import Redundancy
from pmm.document.content import Column, Table, data_only, number, word

AGREEMENT: Final[tuple[Column[Redundancy], ...]] = (
    word("data of", "what"),
    Column("data", lambda row: len(row.data), number=True),
    Column("chi²", lambda row: row.chi_squared, "chi_squared", lambda x: _written(x, ".3g"),
           number=True),
    number("dof", "degrees_of_freedom"),
    Column("by chance", lambda row: row.probability, "probability", lambda x: _written(x, ".2g"),
           number=True),
    Column("furthest off", lambda row: row.furthest, "furthest", " or ".join),
    Column("by", lambda row: _departure(row), number=True),
    Column("agree", lambda row: row.agree, "agree", lambda agree: "yes" if agree else "NO"),
    Column("without it", lambda row: _without(row)),
    Column("u widened", lambda row: _wider(row)),
    *data_only("stands_out", "widening"),
    Column(None, lambda row: row.cause, "widened_by"),
    Column(None, lambda row: [_datum(row, k) for k in range(len(row.data))], "data"),
)  # fmt: skip


def agreement_table(redundancies: Sequence[Redundancy]) -> Table[Redundancy]:
    """Return the table; programs get it under ``redundancy``."""
    return Table("Agreement", AGREEMENT, redundancies, "redundancy", filled=True, notes=_NOTES)


_NOTES = (
    "More data than unknowns. Furthest off: the datum that is furthest from what all others let "
    "expect, in its standard uncertainties (by).",
)


def _datum(redundancy: Redundancy, k: int) -> dict[str, Any]:
    without = {
        name: finite_or_none(float(value))
        for name, value in zip(redundancy.results, redundancy.without[k], strict=True)
    }
    return {
        "name": redundancy.data[k],
        "departure": float(redundancy.departure[k]),
        "without": without,
    }


def _departure(redundancy: Redundancy) -> str:
    if not redundancy.furthest:
        return ""
    return f"{redundancy.departure[redundancy.data.index(redundancy.furthest[0])]:.2g}"


def _without(redundancy: Redundancy) -> str:
    if not redundancy.furthest:
        return ""
    answers = zip(
        redundancy.results,
        redundancy.without[redundancy.data.index(redundancy.furthest[0])],
        strict=True,
    )
    return ", ".join(f"{name} {value:.5g}" for name, value in answers)


def _wider(redundancy: Redundancy) -> str:
    return (
        f"{redundancy.widening:.3g} times, by {redundancy.cause}"
        if redundancy.widening > 1.0
        else ""
    )


def _written(value: float, form: str) -> str:
    return "" if math.isnan(value) else format(value, form)
