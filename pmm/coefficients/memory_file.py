"""The water's memory of a campaign as a simulation takes it: ``[hull]``, ``[radiation]``, a table.

The fitted curves go into a table of added mass and damping over frequency, as those of panel
methods are, and the damping that does not depend on the frequency into ``[hull]``.
"""

import math
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from analysis.memory.measured_matrices import motions_of
from hardware.description.errors import ConfigurationError, DataError
from pmm.coefficients.workflow import CampaignOutcome
from pmm.toml_text import toml_table
from pmm.whole_file import write_whole

if TYPE_CHECKING:
    from analysis.memory.result import MeasuredMemory
    from hardware.description.arrays import FloatArray


def curves_file(path: Path) -> Path:
    """Return the file of the curves, beside that of the tables.

    Raises
    ------
    ConfigurationError
        If that of the tables ends in ``.csv`` itself: both would be one file.
    """
    if path.suffix.lower() == ".csv":
        raise ConfigurationError(
            f"--memory {path}: the curves go into that CSV; name the file of the tables, which "
            f"lies beside it: {path.with_suffix('.toml')}"
        )
    return path.parent / f"{path.stem}.csv"


def write_memory(outcome: CampaignOutcome, path: Path) -> None:
    """Write ``[hull]`` and ``[radiation]`` for a campaign file, and the curves beside them.

    Raises
    ------
    ConfigurationError
        If the coefficients are about another point than the midpoint, where the hull is stated.
    DataError
        If too little was measured at rest.
    """
    from analysis.memory.table import memory_csv

    if outcome.settings.point_ahead_m:
        raise ConfigurationError(
            "--memory: a simulation states its hull about the midpoint between the struts; leave "
            "point_ahead_m out of coefficients.toml"
        )
    memories = outcome.memories
    if not memories:
        motions = " or ".join(motions_of(outcome.result.plane))
        raise DataError(
            f"--memory: added mass and damping of {motions} are not known at four frequencies or "
            "more without carriage speed; add runs at carriage_speed_m_s = 0, single sines or "
            "many lines"
        )
    path.parent.mkdir(parents=True, exist_ok=True)
    curves = curves_file(path)
    remembers = any(memory.chosen.states for memory in memories)
    if remembers:
        write_whole(curves, memory_csv(memories))
    tables = _tables(memories, outcome.cycles[0].restoring, curves.name if remembers else None)
    write_whole(path, "\n".join(tables))


def _tables(
    memories: "Sequence[MeasuredMemory]", restoring: "FloatArray", curves: str | None
) -> Iterator[str]:
    omega = np.concatenate([memory.measured.omega_rad_s for memory in memories])
    low, high = (float(limit) / (2.0 * math.pi) for limit in (omega.min(), omega.max()))
    yield f"# Of what was measured at rest from {low:.4g} to {high:.4g} Hz; beyond, extrapolated."
    added_mass = np.sum([memory.radiation.added_mass_infinite for memory in memories], axis=0)
    damping = np.sum([memory.damping_matrix() for memory in memories], axis=0)
    hull = {"damping": damping.tolist(), "restoring": restoring.tolist()}
    if curves is None:
        yield toml_table("hull", {"added_mass": added_mass.tolist(), **hull})
        return
    yield toml_table("hull", hull)
    states = max(memory.chosen.states for memory in memories)
    yield toml_table("radiation", {"file": curves, "states": states})
