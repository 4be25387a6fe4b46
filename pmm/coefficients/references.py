"""Tables from elsewhere to hold a campaign against: strip theory, panel methods, CFD, other tanks.

A CSV has a column ``frequency_hz`` or ``omega_rad_s`` and one for each coefficient, or a row for
each value (``coefficient``, ``value``); ``speed_m_s`` may stand beside them, and comments such as
``# system = prime`` before them. Capytaine's NetCDF, the CSV of hulls and that of heave alone are
known too (:mod:`sim.model.water.table_files`).
"""

import csv
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.names import Form
from analysis.coefficients.reference import ReferenceTable, compare, table_of_matrices
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Plane
from pmm.campaign.campaign import Campaign
from pmm.coefficients.settings import ReferenceFile, System

if TYPE_CHECKING:
    from sim.model.water.fitted_memory import FittedMemory

_COMMENT = re.compile(r"#\s*(\w+)\s*[=:]\s*(.+?)\s*$")
_FREQUENCIES = {"frequency_hz": 1.0, "omega_rad_s": 1.0 / (2.0 * math.pi)}
_NOT_COEFFICIENTS = (*_FREQUENCIES, "speed_m_s")


@dataclass(frozen=True, eq=False)
class Reference:
    """A table and the system that it is in.

    Attributes
    ----------
    flag
        What the campaign's own memory leaves of the table, where it was fitted to the same file.
    """

    system: System
    table: ReferenceTable
    flag: Flag | None = None


def read_references(
    files: Sequence[ReferenceFile],
    plane: Plane,
    form: Form,
    campaigns: Sequence[Campaign] = (),
) -> tuple[Reference, ...]:
    """Read tables; one of several speeds becomes a table for each.

    Parameters
    ----------
    campaigns
        Campaigns whose simulation has a memory of the water. Where a reference is the table that it
        was fitted to, its allowance holds the largest deviation of that memory.

    Raises
    ------
    ConfigurationError
        If there is no such file, or its system is not known.
    DataError
        If it cannot be read as a table; the message names line and column.
    """
    return tuple(reference for file in files for reference in _read(file, plane, form, campaigns))


def with_references(
    coefficients: CampaignCoefficients, references: Sequence[Reference], system: System
) -> CampaignCoefficients:
    """Return the campaign with all tables of one system beside its own values.

    It raises what :func:`analysis.coefficients.reference.compare` raises.
    """
    for reference in references:
        if reference.system is system:
            coefficients = compare(
                coefficients, replace(reference.table, normalisation=coefficients.normalisation)
            )
    return coefficients


def check_systems(references: Sequence[Reference], system: System) -> None:
    """Refuse tables that the campaign's system cannot be held against.

    Raises
    ------
    ConfigurationError
        Naming the table and the system that would do.
    """
    for reference in references:
        if reference.system not in (system, System.DIMENSIONAL):
            raise ConfigurationError(
                f"{reference.table.name} is in the system {reference.system}; the campaign is "
                f"asked for in {system}: take --system {reference.system}"
            )


def _read(
    file: ReferenceFile, plane: Plane, form: Form, campaigns: Sequence[Campaign]
) -> Iterator[Reference]:
    path = Path(file.file)
    if not path.is_file():
        raise ConfigurationError(f"reference {path}: no such file")
    if path.suffix.lower() in (".nc", ".1"):
        yield _radiation(file, plane, form, campaigns)
        return
    text = path.read_text(encoding="utf-8-sig")
    if "radiating_dof" in text or "a33_analytic_kg" in text:
        yield _radiation(file, plane, form, campaigns)
        return
    yield from _from_csv(path, text, file)


def _radiation(
    file: ReferenceFile, plane: Plane, form: Form, campaigns: Sequence[Campaign]
) -> Reference:
    """Return a table of added mass and damping over frequency as a reference."""
    from sim.model.water.radiation_file import RadiationFile
    from sim.model.water.wamit_file import FirstColumn

    radiation = RadiationFile(
        file.file,
        body=file.body,
        rotation_sign=file.rotation_sign,
        density_kg_m3=file.density_kg_m3,
        length_m=file.length_m,
        first_column=FirstColumn(file.first_column),
    ).table(plane)
    memory = _memory_of(file, campaigns)
    allowance, flag = file.allowance_relative, None
    if memory is not None:
        allowance = math.hypot(allowance, memory.error)
        text = f"the simulation's memory of the water, {memory} Intervals beside it are wider by it"
        flag = Flag("memory_misfit", Severity.NOTE, text)
    table = table_of_matrices(
        file.name or radiation.name,
        plane,
        (radiation.omega_rad_s / (2.0 * math.pi)).tolist(),
        radiation.added_mass,
        radiation.damping,
        form=form,
        speed_m_s=file.speed_m_s,
        allowance_relative=allowance,
    )
    return Reference(System.DIMENSIONAL, table, flag)


def _memory_of(file: ReferenceFile, campaigns: Sequence[Campaign]) -> "FittedMemory | None":
    """Return the memory that was fitted to this very table; ``None`` where none was."""
    for campaign in campaigns:
        table = campaign.radiation
        if table is None or Path(table.file).resolve() != Path(file.file).resolve():
            continue
        if table.body == file.body and campaign.oscillator is not None:
            return campaign.memory
    return None


def _from_csv(path: Path, text: str, file: ReferenceFile) -> Iterator[Reference]:
    comment_values = {m[1]: m[2] for line in text.splitlines() if (m := _COMMENT.match(line))}
    name = file.name or comment_values.get("name") or path.stem
    system = _system(path, comment_values.get("system", System.DIMENSIONAL))
    allowance = file.allowance_relative or float(comment_values.get("allowance_relative", 0.0))
    values = _values(path, text, file.speed_m_s)
    for speed in sorted({key[0] for key in values}):
        frequencies = sorted({key[1] for key in values if key[0] == speed})
        names = list(dict.fromkeys(key[2] for key in values if key[0] == speed))
        # A coefficient that has not all of the table's frequencies gets a table of its own.
        for group in _alike(values, speed, frequencies, names):
            group_frequencies = [f for f in frequencies if (speed, f, group[0]) in values]
            columns = {
                column: np.array([values[speed, f, column] for f in group_frequencies])
                for column in group
            }
            table = ReferenceTable(
                name, speed, str(system), np.array(group_frequencies), columns, allowance
            )
            yield Reference(system, table)


def _alike(
    values: Mapping[tuple[float, float, str], float],
    speed: float,
    frequencies: Sequence[float],
    names: Sequence[str],
) -> list[list[str]]:
    """Put coefficients together that are known at the same frequencies."""
    groups: dict[tuple[float, ...], list[str]] = {}
    for name in names:
        key = tuple(f for f in frequencies if (speed, f, name) in values)
        groups.setdefault(key, []).append(name)
    return list(groups.values())


def _system(path: Path, text: str) -> System:
    try:
        return System(text.lower())
    except ValueError:
        choices = ", ".join(System)
        raise ConfigurationError(
            f"reference {path}: system {text!r} is not known (known: {choices})"
        ) from None


def _values(path: Path, text: str, speed_m_s: float) -> dict[tuple[float, float, str], float]:
    """Return values by speed, frequency and coefficient, from either layout."""
    numbered = [(k, line) for k, line in enumerate(text.splitlines(), 1)]
    lines = [(k, line) for k, line in numbered if line.strip() and not line.startswith("#")]
    reader = csv.DictReader((line for _, line in lines), skipinitialspace=True)
    heads = list(reader.fieldnames or ())
    is_long = {"coefficient", "value"} <= set(heads)
    names = [] if is_long else [head for head in heads if head not in _NOT_COEFFICIENTS]
    if not is_long and not names:
        raise DataError(
            f"reference {path}: no column is a coefficient (columns: {', '.join(heads)}); name "
            "them a33, b33 ... or Z_wdot, Z_w ..., or use the columns coefficient and value"
        )
    values: dict[tuple[float, float, str], float] = {}
    for (line, _), row in zip(lines[1:], reader, strict=False):
        place = f"reference {path}, line {line}"
        speed = _number(place, row, "speed_m_s", speed_m_s)
        frequency = _frequency(place, row)
        pairs = [(row["coefficient"], "value")] if is_long else [(name, name) for name in names]
        for name, column in pairs:
            if (row[column] or "").strip():
                key = (speed, frequency, name.strip())
                if key in values:
                    raise DataError(f"{place}: {name} at {frequency:g} Hz is there twice")
                values[key] = _number(place, row, column, 0.0)
    if not values:
        raise DataError(f"reference {path}: the table has no values")
    return values


def _frequency(place: str, row: Mapping[str, str]) -> float:
    for name, factor in _FREQUENCIES.items():
        if name in row:
            return factor * _number(place, row, name, 0.0)
    return 0.0


def _number(place: str, row: Mapping[str, str], column: str, default: float) -> float:
    text = row.get(column)
    if text is None:
        return default
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DataError(f"{place}: {column} is {text!r}, not a finite number")
    return value
