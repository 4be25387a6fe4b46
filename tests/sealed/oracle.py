"""The oracle of a board: the diagnosis itself, told what is there, in its true form and size."""

import json
import shutil
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path

from pmm.gap.case import CASE_FILE, Case
from tests.sealed.generator.toml import as_toml
from tests.sealed.scoring.by_world import ORACLE
from tests.sealed.true_forms import write_forms

TABLE = "tolerances"
"""Table of the case's file that states tolerances."""


def told(board: Path) -> Path:
    """Write the board's cases again with what their keys tell; return their folder."""
    output = board / ORACLE
    for case in sorted((board / "cases").iterdir()):
        target = output / "cases" / case.name
        if not target.exists():
            truth = json.loads((board / "keys" / case.name / "truth.json").read_text())
            target.parent.mkdir(parents=True, exist_ok=True)
            made = output / f".{case.name}"
            shutil.rmtree(made, ignore_errors=True)
            shutil.copytree(case, made)
            file = made / CASE_FILE
            file.write_text(stating(file.read_text(), truth.get("tolerances", {})))
            write_forms(truth, made)
            made.rename(target)
    return output


def stating(text: str, tolerances: Mapping[str, float]) -> str:
    """Return a case's file that states these tolerances, of those that a case may state."""
    known = {one.name for one in fields(getattr(Case(), TABLE))}
    new = {name: value for name, value in tolerances.items() if name in known}
    lines = [line for line in text.splitlines() if line.partition(" = ")[0] not in new]
    at = lines.index(f"[{TABLE}]") + 1
    lines[at:at] = [f"{name} = {as_toml(value)}" for name, value in new.items()]
    return "\n".join(lines) + "\n"


def answered_as(board: Path, output: Path) -> int:
    """Put the answers to the cases so told among the board's rows; return how many there are."""
    room = board / f"answers-{ORACLE}"
    room.mkdir(exist_ok=True)
    found = sorted((output / "answers").glob("*.json"))
    for file in found:
        shutil.copy(file, room / file.name)
    return len(found)
