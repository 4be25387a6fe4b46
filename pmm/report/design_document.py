"""What ``pmm plan design`` shows: what each run buys, and how well each coefficient is known."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Final

from analysis.design.expectation import ExpectedCoefficient
from pmm.design.design_file import DesignFile
from pmm.design.run_selection import Design, DesignStep
from pmm.document.content import (
    Column,
    Data,
    Document,
    Figure,
    Note,
    Notes,
    Section,
    Table,
    Text,
    number,
    word,
)
from pmm.document.notation import clock, counted, percent, written
from pmm.report.design_figure import design_figure

SCHEMA: Final = "pmm-plan-design-1"
_FROM_NOTHING: Final = 1e3  # times as well known: the run determines it, and not the one before
_CAPTION: Final = (
    "Standard uncertainty that is expected of each coefficient over what is asked for (without "
    "targets, over its value), against tank time; a target is met below 1."
)


@dataclass(frozen=True)
class _Row:
    """A step in its place, with what it buys."""

    number: int
    step: DesignStep
    buys: str

    @property
    def run(self) -> str:
        """Motion and settings in words."""
        point = self.step.run.set_point
        words = [str(self.step.run.motion), f"{point.frequency_hz:g} Hz"]
        words.append(f"{1e3 * point.eccentricity_m:.4g} mm")
        if self.step.run.motion == "phase":
            words.append(f"phase {math.degrees(point.strut_phase_rad):.4g} deg")
        if point.carriage_speed_m_s:
            words.append(f"{point.carriage_speed_m_s:g} m/s")
        if point.drift_rad:
            words.append(f"drift {math.degrees(point.drift_rad):.3g} deg")
        return ", ".join(words)


_STEPS: Final[tuple[Column[_Row], ...]] = (
    number("", "number"),
    word("run", "run"),
    Column("periods", lambda row: row.step.run.periods, number=True),
    Column("times", lambda row: row.step.repeats, number=True),
    Column("ends at", lambda row: row.step.time_s, written=clock, number=True),
    word("buys most of", "buys"),
)
_KNOWN: Final[tuple[Column[ExpectedCoefficient], ...]] = (
    word("coefficient", "name"),
    word("at", "where"),
    number("believed", "believed", written(".4g")),
    word("unit", "unit"),
    number("asked for", "wanted", written(".3g")),
    number("expected", "standard_uncertainty", written(".3g")),
    Column("of the value", lambda row: _relative(row), written=percent(".3g"), number=True),
    Column("most of it from", lambda row: next(iter(row.shares), "")),
    Column("met", lambda row: "" if math.isnan(row.wanted) else "yes" if row.met else "no"),
)
_MEASURED: Final[tuple[Column[ExpectedCoefficient], ...]] = (
    word("coefficient", "name"),
    word("at", "where"),
    number("measured", "value", written(".4g")),
    number("standard uncertainty", "standard_uncertainty", written(".3g")),
    *_KNOWN[2:5],
    _KNOWN[-1],
)


def design_document(file: DesignFile, design: Design, target: Path | None) -> Document:
    """Return what a design found.

    Parameters
    ----------
    target
        Where the plan is written; nowhere if ``None``.
    """
    rows = [
        _Row(place, step, _buys(before, step.expected_coefficients))
        for place, (before, step) in enumerate(
            zip(
                (design.expected_now, *(step.expected_coefficients for step in design.steps)),
                design.steps,
                strict=False,
            ),
            1,
        )
    ]
    is_complete = bool(file.cycles) and not design.steps
    contents = (
        Text((_summary(file, design), "")),
        Table("Known so far", _MEASURED, design.expected_now if file.cycles else (), titled=True),
        Table("Runs", _STEPS, rows),
        Table(
            "Coefficients", _KNOWN, () if is_complete else design.expected_coefficients, titled=True
        ),
        Notes([Note("warning", message) for message in design.why], key="unmet"),
        Notes(
            [
                Note("note", message)
                for message in (*_left_out(file), *_uncounted(file), *_unwritten(file, design))
            ]
        ),
        Figure("uncertainty", _CAPTION, partial(design_figure, file.name, design)),
        Data("plan", target),
        Data("rig", file.rig_path),
        Data("possible", design.met),
        Data("candidates", len(file.grid.runs)),
        Data("left_out", file.grid.left_out),
        Data("uncounted", file.uncounted),
        Data("runs_made", len(file.cycles)),
        Data("known", [_known_data(coefficient) for coefficient in design.expected_now]),
        Data("steps", [_step_data(step) for step in design.steps]),
        Data(
            "coefficients",
            [_known_data(coefficient) for coefficient in design.expected_coefficients],
        ),
    )
    return Document("", "design of a plan", (Section("", contents),), SCHEMA)


def _unwritten(file: DesignFile, design: Design) -> tuple[str, ...]:
    to_make = design.steps or file.tables.runs
    return () if to_make else ("no run is to be made, so there is no plan to be written",)


def _uncounted(file: DesignFile) -> Iterator[str]:
    """Yield the runs that are made in any case and meet no target, a reason at a time."""
    for reason in dict.fromkeys(file.uncounted.values()):
        names = ", ".join(name for name, why in file.uncounted.items() if why == reason)
        yield f"not counted: {names}: {reason}"


def _summary(file: DesignFile, design: Design) -> str:
    runs = sum(step.repeats for step in design.steps)
    time = clock(design.steps[-1].time_s if design.steps else file.tank_time_s())
    ends = (
        "no target was given: all coefficients together, in the time"
        if not file.targets
        else "all targets are expected to be met"
        if design.met
        else f"{counted(len(design.why), 'target')} cannot be met"
    )
    if file.cycles and not design.steps and design.met:
        return f"{file.name}: {counted(len(file.cycles), 'run')} made; all targets are met by them"
    return (
        f"{file.name}: {counted(runs, 'run')} of {counted(len(file.grid.runs), 'candidate')}, "
        f"{time} in all, without handwork; {ends}"
    )


def _left_out(file: DesignFile) -> list[str]:
    """Return how many runs of the grid are no candidates, by what they are left out for."""
    return [
        f"{counted(count, 'run')} of the grid left out for the {reason}"
        for reason, count in sorted(file.grid.left_out.items(), key=lambda item: -item[1])
    ]


def _relative(coefficient: ExpectedCoefficient) -> float:
    return (
        coefficient.standard_uncertainty / abs(coefficient.believed)
        if coefficient.believed
        else math.inf
    )


def _buys(before: Sequence[ExpectedCoefficient], after: Sequence[ExpectedCoefficient]) -> str:
    """Return the coefficient whose uncertainty a step lowers most, and from what to what."""
    uncertainties = {(row.name, row.where): row.standard_uncertainty for row in before}
    best, gain = "", 0.0
    for row in after:
        old, new = uncertainties.get((row.name, row.where), math.inf), row.standard_uncertainty
        if not math.isfinite(new) or (row.met and old <= row.wanted):
            continue
        log_ratio = math.log(old / new) if math.isfinite(old) else math.log(_FROM_NOTHING)
        if log_ratio > gain:
            start = f"{old:.3g}" if math.isfinite(old) else "unknown"
            where = f" at {row.where}" if row.where else ""
            best, gain = f"{row.name}{where}: {start} to {new:.3g} {row.unit}", log_ratio
    return best


def _step_data(step: DesignStep) -> dict[str, Any]:
    point = step.run.set_point
    return {
        "motion": str(step.run.motion),
        "frequency_hz": point.frequency_hz,
        "eccentricity_m": point.eccentricity_m,
        "strut_phase_rad": point.strut_phase_rad,
        "carriage_speed_m_s": point.carriage_speed_m_s,
        "drift_rad": point.drift_rad,
        "periods": step.run.periods,
        "repeats": step.repeats,
        "time_s": step.time_s,
        "standard_uncertainties": [
            _finite(coefficient.standard_uncertainty) for coefficient in step.expected_coefficients
        ],
    }


def _known_data(coefficient: ExpectedCoefficient) -> dict[str, Any]:
    return {
        "name": coefficient.name,
        "where": coefficient.where,
        "unit": coefficient.unit,
        "believed": coefficient.believed,
        "value": _finite(coefficient.value),
        "wanted": _finite(coefficient.wanted),
        "standard_uncertainty": _finite(coefficient.standard_uncertainty),
        "shares": dict(coefficient.shares),
        "met": coefficient.met,
        "message": coefficient.message,
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
