"""The runs that were chosen as a plan that ``pmm plan check`` and ``pmm run`` take."""

import os
from collections.abc import Iterator, Mapping
from dataclasses import fields
from enum import Enum
from pathlib import Path
from typing import Any, Final

from pmm.design.design_file import DesignFile
from pmm.design.run_selection import Design
from pmm.document.notation import clock
from pmm.plan.plan_tables import PlanEntry
from pmm.plan.run_plan import RunPlan
from pmm.toml_text import toml_table, toml_value

_TABLES: Final = ("water", "defaults", "order", "zero", "control")


def plan_text(file: DesignFile, design: Design, target: Path) -> str:
    """Return the plan: what the design says of order and zeros, its own runs, and those chosen.

    Parameters
    ----------
    target
        Where it is to lie: the rig is named from there.
    """
    entries = [toml_table("runs", run, array=True) for run in file.plan_table.get("runs", [])]
    for number, step in enumerate(design.steps, 1 + len(file.cycles)):
        table = run_entry(file.grid.entry_of[step.run], step.run, number, step.repeats)
        entries.append(f"# until {clock(step.time_s)}\n" + toml_table("runs", table, array=True))
    return "\n".join([*plan_head(file, target), *entries])


def plan_head(file: DesignFile, target: Path, *, grows: bool = False) -> Iterator[str]:
    """Yield what stands before the runs of a plan that is to lie at ``target``."""
    table = file.plan_table
    rig = os.path.relpath(file.rig_path.resolve(), target.resolve().parent)
    head = {
        "name": file.name,
        "rig": Path(rig).as_posix(),
        "operator": table.get("operator"),
        "grows": grows or None,
    }
    yield f"# Written from {file.path.name}: docs/plan-design.md\n" + "".join(
        f"{key} = {toml_value(value)}\n" for key, value in head.items() if value is not None
    )
    yield from (toml_table(name, table[name]) for name in _TABLES if name in table)


def run_entry(entry: PlanEntry, run: RunPlan, number: int, repeats: int = 1) -> Mapping[str, Any]:
    """Return a run that was chosen, the ``number``-th, as an entry of a plan.

    Parameters
    ----------
    entry
        The one that makes this run alone.
    """
    table = {"motion": str(run.motion), "name": f"{run.entry}-{number:02d}"}
    own = {
        field.name: _plain(getattr(entry, field.name))
        for field in fields(entry)
        if getattr(entry, field.name) != field.default and field.name not in table
    }
    return {
        **table,
        **own,
        "periods": run.periods,
        "settling_periods": run.settling_periods,
        "pause_s": run.pause_before_s,
        "repeats": repeats,
    }


def _plain(value: Any) -> Any:
    """Return a value as a file has it: a list of one is written without brackets."""
    if isinstance(value, tuple):
        return value[0] if len(value) == 1 else list(value)
    return str(value) if isinstance(value, Enum) else value
