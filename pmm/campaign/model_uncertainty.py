"""The table ``[model_uncertainty]``: what ``pmm inertia`` knows of ``[model]``'s numbers."""

import math
from dataclasses import dataclass
from typing import Any

from pmm.configuration import STRICT_TABLE, Fault, validate


@dataclass(frozen=True)
class ModelUncertainty:
    """Standard uncertainties of the model's mass properties, under the same keys.

    Attributes
    ----------
    inertia_degrees_of_freedom
        Behind the inertia's; infinite where it does not rest on repeats.
    """

    mass_kg: float = 0.0
    inertia_kg_m2: float = 0.0
    cg_x_m: float = 0.0
    cg_z_m: float = 0.0
    inertia_degrees_of_freedom: float = math.inf

    __pydantic_config__ = STRICT_TABLE


def take_uncertainty(table: dict[str, Any], faults: list[Fault]) -> ModelUncertainty | None:
    """Take the table out of a campaign's; what is wrong with it is noted."""
    given = table.pop("model_uncertainty", None)
    if given is None:
        return None
    place = "model_uncertainty"
    if not isinstance(given, dict):
        faults.append(Fault((place,), "should be a table"))
        return None
    finite = {key: value for key, value in given.items() if value != math.inf or key != _FREEDOM}
    own: list[Fault] = []
    found = validate(ModelUncertainty, finite, own)
    faults += [Fault((place, *one.place), one.message) for one in own]
    for key, value in finite.items():
        if isinstance(value, int | float) and value < 0.0:
            faults.append(Fault((place, key), f"= {value:g} should be 0 or more"))
    return found


_FREEDOM = "inertia_degrees_of_freedom"
