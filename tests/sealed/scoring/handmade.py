"""The board that docs/sealed-scoring.md works out by hand, as folders."""

import json
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

PAGE = Path(__file__).parents[3] / "docs" / "sealed-scoring.md"
Row = dict[str, str]
ORDERS = 6
SEED = "7"


def page_table(first: str, second: str) -> list[Row]:
    """Return the page's table whose head begins with these two columns."""
    lines = PAGE.read_text().splitlines()
    start = next(i for i, line in enumerate(lines) if line.startswith(f"| {first} | {second} |"))
    head = _cells(lines[start])
    rows = []
    for line in lines[start + 2 :]:
        if not line.startswith("|"):
            break
        rows.append(dict(zip(head, _cells(line), strict=True)))
    return rows


def _cells(line: str) -> list[str]:
    return [cell.strip().strip("`") for cell in line.strip().strip("|").split("|")]


def _list(text: str) -> list[str]:
    return [part.strip() for part in text.split(",") if part.strip()]


def _channel(off: float) -> dict[str, Any]:
    """Return a channel whose every component is off by that many sigma; sigma is 0.5."""
    return {"mean": 0.5 * off / math.sqrt(2.0), "in_phase": [0.5 * off] * ORDERS,
            "quadrature": [-0.5 * off] * ORDERS}  # fmt: skip


def _forecast(off: str, sign: float = 1.0) -> dict[str, Any]:
    """Return a forecast of the withheld run; none without a number."""
    return {"withheld-1": {"force_aft": _channel(sign * float(off))}} if off else {}


def _effects(row: Row) -> Iterator[dict[str, Any]]:
    known = {"coulomb-friction": {"force_n": 2.0}, "cable": {"stiffness_n_m": 10.0}}
    for name in (_list(row["right"]) or [""])[0].split("+"):
        if name:
            yield {"name": name, "stage": "any", "snr": 20.0, "alone": 20.0,
                   "equivalent": known.get(name, {})}  # fmt: skip


def truth(row: Row) -> dict[str, Any]:
    """Return the key that a row of the first table stands for."""
    reached = (
        {"top_1_by_class": float(row["ceiling by class"])} if row["ceiling by class"] else None
    )
    right = [name.split("+") for name in _list(row["right"])]
    angle = row["angle (deg)"]
    there = {**_channel(0.0), "sigma": [0.5] * ORDERS}
    return {
        "schema": "sealed-truth-1",
        "case": row["case"],
        "seed": SEED,
        "kind": row["kind"],
        "null": row["kind"] == "none",
        "verdict": row["verdict"],
        "snr": float(row["SNR"]),
        "right": [[]] if row["verdict"] == "none" else right,
        "stages": _list(row["stages"]),
        "classes": {name: row["class"].split() for one in right for name in one},
        "held_out": {"withheld-1": {"channels": {"force_aft": there}}},
        "effects": list(_effects(row)),
        "angle_deg": float(angle) if angle else None,
        "separated_by": "injection" if row["kind"] == "twin" else None,
        "ceiling": reached,
    }  # fmt: skip


def _named(case: str) -> list[dict[str, Any]]:
    """Return the effects with intervals that the page states in words."""
    if case == "case-0007":
        interval = {"value": 2.0, "low": 1.5, "high": 2.5}
        return [{"name": "coulomb-friction", "parameters": {"force_n": interval}}]
    if case == "case-0008":
        interval = {"value": 13.0, "low": 12.0, "high": 14.0}
        return [{"name": "cable", "parameters": {"stiffness_n_m": interval}}]
    return []


def answer(row: Row) -> dict[str, Any]:
    """Return the answer that a row of the second table stands for."""
    shares = {name: float(p) for name, p in (one.split() for one in _list(row["probabilities"]))}
    low, high = (float(end) for end in re.split(" to ", row["shrinkage"]))
    proposed = {"kind": "injection", "frequency_hz": 1.0, "force_n": 20.0}
    return {
        "schema": "sealed-answer-1",
        "case": row["case"],
        "probabilities": shares,
        "stages": {row["stage"]: 1.0} if row["stage"] else {},
        "classes": [row["own class"].split()] if row["own class"] else [],
        "effects": _named(row["case"]),
        "before": _forecast(row["off before"]),
        "after": _forecast(row["off after"], -1.0),
        "after_rival": _forecast(row["off second"], -1.0),
        "after_polynomial": _forecast(row["off polynomial"]),
        "shrinkage": {"value": low, "low": low, "high": high},
        "next_run": proposed if row["case"] == "case-0011" else None,
        "seconds": 2.0,
    }


def write(folder: Path) -> Path:
    """Write the board below ``folder``."""
    rows = page_table("case", "kind")
    names = ", ".join(f'"{row["case"]}"' for row in rows)
    folder.mkdir()
    (folder / "board.toml").write_text(
        f'schema = "sealed-board-1"\nseed = "{SEED}"\ncases = [{names}]\n'
    )
    (folder / "answers").mkdir()
    for row, said in zip(rows, page_table("case", "probabilities"), strict=True):
        case, key = folder / "cases" / row["case"], folder / "keys" / row["case"]
        case.mkdir(parents=True)
        key.mkdir(parents=True)
        (case / "campaign.toml").write_text('name = "anything"\n')
        (key / "truth.json").write_text(json.dumps(truth(row)))
        (folder / "answers" / f"{row['case']}.json").write_text(json.dumps(answer(said)))
    return folder
