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
from analysis.coefficients.reference import ReferenceTable, compared, table_of_matrices
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
    fitted: Sequence[Campaign] = (),
) -> tuple[Reference, ...]:
    """Read tables; one of several speeds becomes a table for each.

    Parameters
    ----------
    fitted
        Campaigns whose simulation has a memory of the water. Where a reference is the table that it
        was fitted to, its allowance holds the largest deviation of that memory.

    Raises
    ------
    ConfigurationError
        If there is no such file, or its system is not known.
    DataError
        If it cannot be read as a table; the message names line and column.
    """
    return tuple(found for one in files for found in _read(one, plane, form, fitted))


def beside(
    found: CampaignCoefficients, references: Sequence[Reference], system: System
) -> CampaignCoefficients:
    """Return the campaign with all tables of one system beside its own values.

    It raises what :func:`analysis.coefficients.reference.compared` raises.
    """
    for one in references:
        if one.system is system:
            found = compared(found, replace(one.table, normalisation=found.normalisation))
    return found


def check_systems(references: Sequence[Reference], system: System) -> None:
    """Refuse tables that the campaign's system cannot be held against.

    Raises
    ------
    ConfigurationError
        Naming the table and the system that would do.
    """
    for one in references:
        if one.system not in (system, System.DIMENSIONAL):
            raise ConfigurationError(
                f"{one.table.name} is in the system {one.system}; the campaign is asked for in "
                f"{system}: take --system {one.system}"
            )


def _read(
    one: ReferenceFile, plane: Plane, form: Form, fitted: Sequence[Campaign]
) -> Iterator[Reference]:
    path = Path(one.file)
    if not path.is_file():
        raise ConfigurationError(f"reference {path}: no such file")
    if path.suffix.lower() in (".nc", ".1"):
        yield _radiation(one, plane, form, fitted)
        return
    text = path.read_text(encoding="utf-8-sig")
    if "radiating_dof" in text or "a33_analytic_kg" in text:
        yield _radiation(one, plane, form, fitted)
        return
    yield from _from_csv(path, text, one)


def _radiation(
    one: ReferenceFile, plane: Plane, form: Form, fitted: Sequence[Campaign]
) -> Reference:
    """Return a table of added mass and damping over frequency as a reference."""
    from sim.model.water.radiation_file import RadiationFile
    from sim.model.water.wamit_file import FirstColumn

    found = RadiationFile(
        one.file,
        body=one.body,
        rotation_sign=one.rotation_sign,
        density_kg_m3=one.density_kg_m3,
        length_m=one.length_m,
        first_column=FirstColumn(one.first_column),
    ).table(plane)
    memory = _memory_of(one, fitted)
    allowance, flag = one.allowance_relative, None
    if memory is not None:
        allowance = math.hypot(allowance, memory.error)
        text = f"the simulation's memory of the water, {memory} Intervals beside it are wider by it"
        flag = Flag("memory_misfit", Severity.NOTE, text)
    table = table_of_matrices(
        one.name or found.name,
        plane,
        (found.omega_rad_s / (2.0 * math.pi)).tolist(),
        found.added_mass,
        found.damping,
        form=form,
        speed_m_s=one.speed_m_s,
        allowance_relative=allowance,
    )
    return Reference(System.DIMENSIONAL, table, flag)


def _memory_of(one: ReferenceFile, fitted: Sequence[Campaign]) -> "FittedMemory | None":
    """Return the memory that was fitted to this very table; ``None`` where none was."""
    for campaign in fitted:
        table = campaign.radiation
        if table is None or Path(table.file).resolve() != Path(one.file).resolve():
            continue
        if table.body == one.body and campaign.oscillator is not None:
            return campaign.memory
    return None


def _from_csv(path: Path, text: str, one: ReferenceFile) -> Iterator[Reference]:
    said = {m[1]: m[2] for line in text.splitlines() if (m := _COMMENT.match(line))}
    name = one.name or said.get("name") or path.stem
    system = _system(path, said.get("system", System.DIMENSIONAL))
    allowance = one.allowance_relative or float(said.get("allowance_relative", 0.0))
    values = _values(path, text, one.speed_m_s)
    for speed in sorted({key[0] for key in values}):
        frequencies = sorted({key[1] for key in values if key[0] == speed})
        names = list(dict.fromkeys(key[2] for key in values if key[0] == speed))
        # A coefficient that has not all of the table's frequencies gets a table of its own.
        for group in _alike(values, speed, frequencies, names):
            own = [f for f in frequencies if (speed, f, group[0]) in values]
            columns = {
                column: np.array([values[speed, f, column] for f in own]) for column in group
            }
            table = ReferenceTable(name, speed, str(system), np.array(own), columns, allowance)
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
        known = ", ".join(System)
        raise ConfigurationError(
            f"reference {path}: system {text!r} is not known (known: {known})"
        ) from None


def _values(path: Path, text: str, speed_m_s: float) -> dict[tuple[float, float, str], float]:
    """Return values by speed, frequency and coefficient, from either layout."""
    numbered = [(k, line) for k, line in enumerate(text.splitlines(), 1)]
    kept = [(k, line) for k, line in numbered if line.strip() and not line.startswith("#")]
    reader = csv.DictReader((line for _, line in kept), skipinitialspace=True)
    heads = list(reader.fieldnames or ())
    long = {"coefficient", "value"} <= set(heads)
    names = [] if long else [head for head in heads if head not in _NOT_COEFFICIENTS]
    if not long and not names:
        raise DataError(
            f"reference {path}: no column is a coefficient (columns: {', '.join(heads)}); name "
            "them a33, b33 ... or Z_wdot, Z_w ..., or use the columns coefficient and value"
        )
    found: dict[tuple[float, float, str], float] = {}
    for (line, _), row in zip(kept[1:], reader, strict=False):
        where = f"reference {path}, line {line}"
        speed = _number(where, row, "speed_m_s", speed_m_s)
        frequency = _frequency(where, row)
        pairs = [(row["coefficient"], "value")] if long else [(name, name) for name in names]
        for name, column in pairs:
            if (row[column] or "").strip():
                key = (speed, frequency, name.strip())
                if key in found:
                    raise DataError(f"{where}: {name} at {frequency:g} Hz is there twice")
                found[key] = _number(where, row, column, 0.0)
    if not found:
        raise DataError(f"reference {path}: the table has no values")
    return found


def _frequency(where: str, row: Mapping[str, str]) -> float:
    for name, factor in _FREQUENCIES.items():
        if name in row:
            return factor * _number(where, row, name, 0.0)
    return 0.0


def _number(where: str, row: Mapping[str, str], column: str, default: float) -> float:
    text = row.get(column)
    if text is None:
        return default
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise DataError(f"{where}: {column} is {text!r}, not a finite number")
    return value
