"""Fitted memories as a table of added mass and damping over frequency, which a simulation reads."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from analysis.memory.result import MeasuredMemory
from sim.model.water.table_files import hull_csv
from sim.model.water.tables import RadiationTable

_FREQUENCIES: Final = 240  # 3 % apart: a pair of poles as narrow as any that is fitted is resolved
_BEYOND: Final = 10.0  # how far the table reaches beyond what was measured, as a factor


def memory_csv(memories: Sequence[MeasuredMemory]) -> str:
    """Return the curves of all motions without the steady damping, as CSV of a hull."""
    measured = np.concatenate([memory.measured.omega_rad_s for memory in memories])
    low, high = float(measured.min()), float(measured.max())
    omega = np.geomspace(low / _BEYOND, high * _BEYOND, _FREQUENCIES)
    added = np.sum([memory.radiation.added_mass(omega) for memory in memories], axis=0)
    damping = np.sum([memory.radiation.damping(omega) for memory in memories], axis=0)
    table = RadiationTable(memories[0].measured.plane, omega, added, damping)
    head = f"fitted to values from {low:.4g} to {high:.4g} rad/s, extrapolated beyond"
    return hull_csv(table, "fitted", head)
