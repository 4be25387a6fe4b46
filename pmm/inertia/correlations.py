"""Values of one table that are correlated: coefficients beside their standard uncertainties."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from analysis.uncertainty.estimate import Estimate, fresh_label
from analysis.uncertainty.values import Contribution, UncertainValues
from hardware.description.arrays import FloatArray
from pmm.inertia.stated_values import unit_of


@dataclass(frozen=True)
class CorrelationTable:
    """The correlation coefficient of two keys of a table, as ``--json`` writes them."""

    between: tuple[str, str]
    coefficient: float


def correlation_rules(table: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield keys that are not there, and coefficients that no values can have."""
    rows = table.get("correlations")
    entries = [one for one in rows if isinstance(one, dict)] if isinstance(rows, list) else []
    if not entries or any(set(one) != {"between", "coefficient"} for one in entries):
        return
    for one in entries:
        for key in one["between"]:
            if not isinstance(table.get(f"u_{key}"), int | float):
                yield "correlations", f"name {key}, which has no u_{key} here"
                return
    matrix = _matrix(sorted({key for one in entries for key in one["between"]}), entries)
    if float(np.linalg.eigvalsh(matrix).min()) < -1e-9:
        yield "correlations", "cannot all be: no values are correlated like that"


def correlated(table: object, entries: Sequence[CorrelationTable]) -> dict[str, Estimate]:
    """Return the values that are correlated, by key, in the units of their keys."""
    keys = sorted({key for one in entries for key in one.between})
    if not keys:
        return {}
    rows = [{"between": one.between, "coefficient": one.coefficient} for one in entries]
    size, axes = np.linalg.eigh(_matrix(keys, rows))
    spread = np.array([getattr(table, f"u_{key}") for key in keys], dtype=np.float64)
    parts = spread[:, None] * axes * np.sqrt(size.clip(0.0))
    own = Contribution(fresh_label(), np.inf, np.arange(len(keys)), parts)
    values = np.array([getattr(table, key) for key in keys], dtype=np.float64)
    whole = UncertainValues(values, (own,))
    return {key: Estimate(whole.taken([k]), unit_of(key)[0]) for k, key in enumerate(keys)}


def _matrix(keys: Sequence[str], entries: Sequence[Mapping[str, Any]]) -> FloatArray:
    matrix = np.eye(len(keys))
    for one in entries:
        first, second = (keys.index(key) for key in one["between"])
        matrix[first, second] = matrix[second, first] = one["coefficient"]
    return matrix
