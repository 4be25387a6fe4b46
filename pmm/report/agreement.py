"""How data agree that are more than the unknowns: a table for people, rows for programs."""

import math
from collections.abc import Sequence
from typing import Any, Final

from analysis.inertia.result import finite_or_none
from analysis.uncertainty.redundancy import Redundancy
from pmm.document.content import Column, Table, data_only, number, word

AGREEMENT: Final[tuple[Column[Redundancy], ...]] = (
    word("data of", "what"),
    Column("data", lambda one: len(one.data), number=True),
    Column("chi²", lambda one: one.chi_squared, "chi_squared", lambda x: _written(x, ".3g"),
           number=True),
    number("dof", "degrees_of_freedom"),
    Column("by chance", lambda one: one.probability, "probability", lambda x: _written(x, ".2g"),
           number=True),
    Column("furthest off", lambda one: one.furthest, "furthest", " or ".join),
    Column("by", lambda one: _departure(one), number=True),
    Column("agree", lambda one: one.agree, "agree", lambda agree: "yes" if agree else "NO"),
    Column("without it", lambda one: _without(one)),
    Column("u widened", lambda one: _wider(one)),
    *data_only("stands_out", "widening"),
    Column(None, lambda one: one.cause, "widened_by"),
    Column(None, lambda one: [_datum(one, k) for k in range(len(one.data))], "data"),
)  # fmt: skip


def agreement_table(found: Sequence[Redundancy]) -> Table[Redundancy]:
    """Return the table; programs get it under ``redundancy``."""
    return Table("Agreement", AGREEMENT, found, "redundancy", filled=True, notes=_NOTES)


_NOTES = (
    "More data than unknowns. Furthest off: the datum that is furthest from what all others let "
    "expect, in its standard uncertainties (by).",
)


def _datum(one: Redundancy, k: int) -> dict[str, Any]:
    without = {
        name: finite_or_none(float(value))
        for name, value in zip(one.results, one.without[k], strict=True)
    }
    return {"name": one.data[k], "departure": float(one.departure[k]), "without": without}


def _departure(one: Redundancy) -> str:
    if not one.furthest:
        return ""
    return f"{one.departure[one.data.index(one.furthest[0])]:.2g}"


def _without(one: Redundancy) -> str:
    if not one.furthest:
        return ""
    answers = zip(one.results, one.without[one.data.index(one.furthest[0])], strict=True)
    return ", ".join(f"{name} {value:.5g}" for name, value in answers)


def _wider(one: Redundancy) -> str:
    return f"{one.widening:.3g} times, by {one.cause}" if one.widening > 1.0 else ""


def _written(value: float, form: str) -> str:
    return "" if math.isnan(value) else format(value, form)
