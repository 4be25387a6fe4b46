"""Budgets of bodies put together: which part's mass, place or gyradius the doubt comes from."""

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from analysis.inertia.elementary_functions import sqrt
from analysis.inertia.parts import MADE_OF, PRODUCTS, combined
from analysis.uncertainty.budget import Formula, sensitivities
from analysis.uncertainty.monte_carlo import Assessment, assess
from hardware.description.arrays import FloatArray
from pmm.inertia.properties import AXES, PartTable
from pmm.inertia.stated_values import unit_of

if TYPE_CHECKING:
    from analysis.uncertainty.estimate import Estimate

_TRIALS = 50_000  # of up to seven inputs a part
_ROWS = {"cg_x_m": 1, "cg_y_m": 2, "cg_z_m": 3} | {key: k for k, key in enumerate(PRODUCTS, 7)}
_GYRADII = {f"k_{axis}_m": 4 + k for k, axis in enumerate(AXES)}

Put = Callable[[Mapping[str, Any]], FloatArray]


def combined_budgets(
    parts: Sequence[PartTable], without: Sequence[PartTable] = ()
) -> dict[str, Assessment]:
    """Return the budget, with a Monte Carlo, of each result that an input's doubt reaches.

    They go by the result's name: ``cg_x_m`` ... ``k_yaw_m``, ``ixy_kg_m2`` and so on. The inputs
    are called ``part.key``, those of what is taken off ``less part.key``.
    """
    tables = [*parts, *without]
    labels = _labels([part.name for part in parts], [f"less {part.name}" for part in without])
    inputs: dict[str, Estimate] = {}
    for label, table in zip(labels, tables, strict=True):
        measured = table.measured().items()
        inputs |= {f"{label}.{key}": value for key, value in measured if value.uncertainty > 0.0}
    if not inputs:
        return {}
    put = _putting(tables, labels, np.array([1.0] * len(parts) + [-1.0] * len(without)))
    total = put({})
    reached = [*_ROWS, *(key for key, row in _GYRADII.items() if total[row] > 0.0)]
    assessments = {key: _assessed(key, _reading(put, key), inputs) for key in reached}
    return {key: assessment for key, assessment in assessments.items() if assessment is not None}


def _assessed(key: str, formula: Formula, inputs: "Mapping[str, Estimate]") -> Assessment | None:
    """Assess one result by the inputs that it depends on; None where there is none."""
    _, slopes = sensitivities(key, formula, inputs)
    felt = {name: inputs[name] for name, slope in zip(inputs, slopes, strict=True) if slope != 0.0}
    if not felt:
        return None
    return assess(key, formula, felt, unit=unit_of(key)[0], trials=_TRIALS)


def _labels(parts: list[str], without: list[str]) -> list[str]:
    """Return a name for each part that no other has."""
    names = [*parts, *without]
    return [
        f"{name} ({k})" if names.count(name) > 1 else name for k, name in enumerate(names, start=1)
    ]


def _putting(tables: Sequence[PartTable], labels: Sequence[str], signs: FloatArray) -> Put:
    """Return what puts the parts together for some inputs, numbers or trials; the rest as read."""
    read = [{key: estimate.value for key, estimate in table.measured().items()} for table in tables]

    def combine(inputs: Mapping[str, Any]) -> FloatArray:
        shape = np.broadcast_shapes(*(np.shape(value) for value in inputs.values()))
        rows = np.empty((len(tables), 10, *shape))
        for row, label, numbers in zip(rows, labels, read, strict=True):
            values = [inputs.get(f"{label}.{key}", numbers[key]) for key in MADE_OF]
            row[:4] = np.broadcast_arrays(*values[:4], row[0])[:4]
            for k, gyradius in enumerate(values[4:7], start=4):
                row[k] = values[0] * gyradius**2
            for k, product in enumerate(values[7:], start=7):
                row[k] = product
        return combined(rows, signs)

    return combine


def _reading(put: Put, key: str) -> Formula:
    """Return the formula of one result."""

    def formula(**inputs: Any) -> Any:
        total = put(inputs)
        if key in _ROWS:
            return total[_ROWS[key]]
        return sqrt(total[_GYRADII[key]] / total[0])

    return formula
