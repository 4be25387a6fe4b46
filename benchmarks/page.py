"""Outcomes as JSON, on the screen, and as ``docs/benchmarks.md``."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table

from benchmarks.outcome import Benchmark, Outcome, Row, Verdict, judge

_VERDICT_COLUMNS = ("what", "limit", "measured", "verdict")


def keep(
    folder: Path, benchmark: Benchmark, outcome: Outcome, machine: Mapping[str, str], *, quick: bool
) -> Path:
    """Write an outcome as ``<folder>/<name>.json``."""
    folder.mkdir(parents=True, exist_ok=True)
    stored = {
        "name": benchmark.name,
        "title": benchmark.title,
        "quick": quick,
        "machine": dict(machine),
        "thresholds": _verdict_rows(judge(benchmark.name, outcome.measured)),
        "tables": dict(outcome.tables),
        "notes": list(outcome.notes),
    }
    path = folder / f"{benchmark.name}.json"
    path.write_text(json.dumps(stored, indent=1) + "\n", encoding="utf-8")
    return path


def show(console: Console, benchmark: Benchmark, outcome: Outcome) -> None:
    """Print an outcome as tables."""
    console.rule(benchmark.title)
    for caption, rows in outcome.tables.items():
        console.print(_table(caption, rows))
    verdicts = _verdict_rows(judge(benchmark.name, outcome.measured))
    console.print(_table("Thresholds", verdicts))
    for note in outcome.notes:
        console.print(f"- {note}", markup=False)


def _table(caption: str, rows: list[Row]) -> Table:
    table = Table(title=caption, title_justify="left")
    for column in rows[0]:
        right = not isinstance(rows[0][column], str)
        table.add_column(column, justify="right" if right else "left")
    for row in rows:
        table.add_row(*(figure(value) for value in row.values()))
    return table


def _verdict_rows(verdicts: list[Verdict]) -> list[Row]:
    values: list[tuple[str | float, ...]] = [
        (v.what, v.limit, "" if v.measured is None else v.measured, v.word) for v in verdicts
    ]
    return [dict(zip(_VERDICT_COLUMNS, row, strict=True)) for row in values]


def figure(value: str | float) -> str:
    """Return a value with three figures."""
    if isinstance(value, float):
        return f"{value:.0f}" if 1e3 <= abs(value) < 1e6 else f"{value:.3g}"
    return str(value)


def write_page(folder: Path, page: Path, order: list[str]) -> None:
    """Write the page anew from the outcomes that lie in a folder."""
    parts = [_HEAD]
    for name in order:
        path = folder / f"{name}.json"
        if path.exists():
            parts.append(_section(json.loads(path.read_text(encoding="utf-8"))))
    page.parent.mkdir(parents=True, exist_ok=True)
    page.write_text("\n".join(parts), encoding="utf-8")


_HEAD = """# Benchmarks

Written by `python -m benchmarks` (`make bench`) from `benchmarks/results/*.json`; do not edit. The
thresholds stand in `benchmarks/thresholds.toml` and were set before anything was measured; those
added since are marked there. Times are ratios to a rival named in the table, measured in the same
run, one thread each; rivals take turns and the best time of each counts.
"""


def _section(stored: Mapping[str, Any]) -> str:
    verdicts = [row["verdict"] for row in stored["thresholds"]]
    missed = [row["what"] for row in stored["thresholds"] if row["verdict"] == "MISSED"]
    verdict = "All thresholds are met."
    if "not measured" in verdicts:
        measured = len(verdicts) - verdicts.count("not measured")
        verdict = f"Measured here, and met: {measured} of {len(verdicts)} thresholds."
    if missed:
        verdict = f"**Missed: {'; '.join(missed)}.**"
    lines = [f"## {stored['title']}", "", verdict, "", *_markdown(stored["thresholds"]), ""]
    for caption, rows in stored["tables"].items():
        lines += [f"### {caption}", "", *_markdown(rows), ""]
    lines += [f"- {note}" for note in stored["notes"]]
    lines += ["", _measured_on(stored["machine"]), ""]
    return "\n".join(lines)


def _markdown(rows: list[Row]) -> list[str]:
    align = ("--" if isinstance(value, str) else "--:" for value in rows[0].values())
    head = [f"| {' | '.join(rows[0])} |", f"|{'|'.join(align)}|"]
    return head + [f"| {' | '.join(figure(value) for value in row.values())} |" for row in rows]


def _measured_on(machine: Mapping[str, str]) -> str:
    return (
        f"Measured {machine['date']} at commit {machine['commit']} on {machine['cpu']}, "
        f"{machine['cores']} cores (load {machine['load_at_start']} at the start), "
        f"{machine['os']}; Python {machine['python']}, NumPy {machine['numpy']}, "
        f"BLAS {machine['blas']} ({machine['blas_threads']} thread), SciPy {machine['scipy']}, "
        f"numba {machine['numba']}, ulia {machine['ulia']}, rota-order {machine['rota-order']}."
    )
