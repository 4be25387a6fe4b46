"""What ``pmm inertia`` shows of a job: said once, for the terminal, files and programs."""

import math
from collections.abc import Iterator, Sequence
from typing import Any, Final

from analysis.inertia.amplitude import PowerDecay
from analysis.inertia.forms import SwingForm
from analysis.inertia.parts import NAMES, BodyPart
from analysis.inertia.result import budget_rows, estimate_numbers
from analysis.uncertainty.budget import BudgetShare
from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.monte_carlo import Assessment
from pmm.document.content import (
    ABSENT,
    Column,
    Content,
    Data,
    Document,
    Note,
    Notes,
    Section,
    Table,
    Text,
    data_only,
    number,
    word,
)
from pmm.document.flag_lines import flag_notes
from pmm.document.notation import rounded, written
from pmm.inertia.fits import FormFit
from pmm.inertia.outcome import Finding, Outcome
from pmm.inertia.sources import PeriodRuns
from pmm.report.agreement import agreement_table
from pmm.report.inertia_figures import figures

SCHEMA: Final = "pmm-inertia-1"
_NOTHING: Final = 1e-9  # metres, kilograms: what rounding leaves of zero
_MOST_LINES: Final = 8  # of a budget; the rest together
_FORMS: Final = {
    SwingForm.F1: "undamped",
    SwingForm.F2: "damped",
    SwingForm.F3: "damped, whole periods",
    SwingForm.F4: "damped, with an offset",
}

# The period of one source and mode, and the single runs' periods, for people.
_Period = tuple[str, str, Estimate, tuple[float, ...]]
PERIODS: Final[tuple[Column[_Period], ...]] = (
    Column("period from", lambda row: row[0]),
    Column("how", lambda row: row[1]),
    Column("T ± u", lambda row: _value(row[2]), unit="s", number=True),
    Column("dof", lambda row: _freedom(row[2]), number=True),
    Column("runs", lambda row: _first_runs(row[3]), unit="s", number=True),
)
FITS: Final[tuple[Column[FormFit], ...]] = (
    word("fit of", "record"),
    Column("form", lambda fit: fit.form, "form", lambda form: f"{form} {_FORMS[form]}"),
    Column("T ± u of this fit", lambda fit: rounded(fit.period_s, fit.period_uncertainty_s),
           unit="s", number=True),
    number("decay", "decay_1_s", written(".3g"), "1/s"),
    number("offset", "offset", written(".3g")),
    number("residual", "residual", written(".3g")),
    *data_only("where", "channel", "period_s", "period_uncertainty_s"),
)  # fmt: skip
FINDINGS: Final[tuple[Column[Finding], ...]] = (
    word("result", "what"),
    Column("name", lambda row: row.name),
    Column("value ± u", lambda row: _value(row.estimate), number=True),
    Column("dof", lambda row: _freedom(row.estimate) if row.estimate.uncertainty else "",
           number=True),
    Column("95 % interval", lambda row: _interval(row), "interval_95",
           lambda pair: f"{pair[0]:.5g} to {pair[1]:.5g}" if pair[0] < pair[1] else "",
           number=True),
    Column("unit", lambda row: row.estimate.unit, "unit"),
    *(
        Column(None, lambda row, key=key: estimate_numbers(row.estimate)[key], key)  # type: ignore[misc]
        for key in ("value", "standard_uncertainty", "degrees_of_freedom")
    ),
    *(
        Column(None, lambda row, key=key: _assessment(row.assessment).get(key, ABSENT), key)  # type: ignore[misc]
        for key in ("budget", "linear", "monte_carlo")
    ),
)  # fmt: skip
BUDGET: Final[tuple[Column[BudgetShare], ...]] = (
    Column("value ± u", lambda line: _value(line.input), number=True),
    Column("unit", lambda line: line.input.unit),
    Column("dof", lambda line: _freedom(line.input), number=True),
    Column("contribution", lambda line: f"{line.contribution:.2g}", number=True),
    Column("share", lambda line: f"{100.0 * line.share:.1f} %", number=True),
)
MODEL: Final[tuple[Column[tuple[str, Estimate]], ...]] = (
    Column("model", lambda row: row[0]),
    Column("value ± u", lambda row: _value(row[1]), number=True),
    Column("dof", lambda row: _freedom(row[1]), number=True),
    Column("unit", lambda row: row[1].unit),
)
PLACEMENTS: Final[tuple[Column[tuple[str, float, float, float, float]], ...]] = (
    Column("weight", lambda row: row[0], "name"),
    Column("mass", lambda row: row[1], "mass_kg", written("g"), "kg", number=True),
    *(
        Column(axis, lambda row, k=k: row[k], written=written(".4f"), unit="m", number=True)  # type: ignore[misc]
        for k, axis in enumerate("xyz", 2)
    ),
    Column(None, lambda row: row[2:], "position_m"),
)


def document(outcome: Outcome, fits: Sequence[FormFit] | None = None) -> Document:
    """Return what is shown of a job; ``docs/inertia-files.md`` describes what programs get.

    Parameters
    ----------
    fits
        Of the records by the forms F1 to F4; ``None`` where they were not asked for.
    """
    results = Table("Results", FINDINGS, outcome.findings, "results", by=lambda row: row.name)
    return Document(
        f"{outcome.job}: {outcome.name}",
        "mass properties",
        (
            Section("Periods", tuple(_periods(outcome.periods))),
            Section("Fits", tuple(_fit_contents(fits))),
            Section("Results", (results, *_numbers(outcome))),
            Section("Agreement", (agreement_table(outcome.agreements),)),
            Section("Budgets", tuple(_budgets(outcome))),
            Section("Model", tuple(_model(outcome))),
            Section("Checks", tuple(_checks(outcome))),
            Section("Figures", tuple(figures(outcome))),
        ),
        SCHEMA,
    )


def _fit_contents(fits: Sequence[FormFit] | None) -> Iterator[Content]:
    yield Table("Fits", FITS, fits or (), "fits")
    if fits is not None and not fits:
        yield Text(["F1 to F4 are forms of one oscillation; no record here has just one"])


def _periods(periods: Sequence[PeriodRuns]) -> Iterator[Content]:
    rows = tuple(
        ("", "", period, runs) if number else (group.where, group.how, period, runs)
        for group in periods
        for number, period in enumerate(group.periods)
        for runs in (group.single[number] if number < len(group.single) else (),)
    )
    yield Table("Periods", PERIODS, rows)
    yield Text([_use_text(run) for runs in periods for run in runs.records], faint=True)
    yield Data("periods", [_period(runs) for runs in periods])


def _use_text(run: Any) -> str:
    decays = ", ".join(
        f"time constant {mode.decay.time_constant_s:.4g} s, beta {mode.decay.beta:z.2f} ± "
        f"{mode.decay.beta_uncertainty:.1g}"
        for mode in run.modes
    )
    return f"used {run.part.series.name}: {run.part.reason}; {decays}"


def _period(runs: PeriodRuns) -> dict[str, Any]:
    return {
        "where": runs.where,
        "how": runs.how,
        "periods": [estimate_numbers(period) for period in runs.periods],
        "runs_s": runs.single,
        "used": [run.part.reason for run in runs.records],
        "decay": [[_decay(mode.decay) for mode in run.modes] for run in runs.records],
    }


def _decay(decay: PowerDecay) -> dict[str, Any]:
    return {
        "amplitude": decay.amplitude,
        "time_constant_s": decay.time_constant_s,
        "beta": decay.beta,
        "beta_uncertainty": decay.beta_uncertainty,
    }


def _numbers(outcome: Outcome) -> Iterator[Data]:
    """Yield what programs alone get."""
    yield Data("job", outcome.job)
    yield Data("name", outcome.name)
    yield Data("model", None if outcome.body is None else outcome.body.numbers())
    yield Data("tensor", None if outcome.tensor is None else _tensor(outcome.tensor))
    yield Data("next_step", outcome.next_step)
    flags = ({"code": f.code, "severity": f.severity, "message": f.message} for f in outcome.flags)
    yield Data("flags", list(flags))


def _tensor(part: BodyPart) -> dict[str, Any]:
    x = part.uncertain
    return {"names": NAMES, "values": x.values.tolist(), "covariance": x.covariance().tolist()}


def _budgets(outcome: Outcome) -> Iterator[Content]:
    for finding, assessment in outcome.budgeted:
        lines = [line for line in assessment.budget.shares if line.input.uncertainty > 0.0]
        rest = lines[_MOST_LINES:]
        more = f"{len(rest)} more: {100.0 * sum(line.share for line in rest):.1f} %"
        title = f"budget of {finding.name}"
        columns: tuple[Column[BudgetShare], ...] = (Column(title, lambda line: line.name), *BUDGET)
        yield Table(title, columns, lines, most=_MOST_LINES)
        yield Text([*([more] if rest else []), *_intervals(assessment)], faint=True)


def _intervals(assessment: Assessment) -> Iterator[str]:
    linear, trial = assessment.budget.result, assessment.monte_carlo
    low, high = linear.interval()
    yield (
        f"budget      {low:.6g} to {high:.6g}, u = {linear.uncertainty:#.2g}, "
        f"{_freedom(linear)} degrees of freedom"
    )
    verdict = (
        "good enough" if assessment.linear_good_enough else "not good enough, this interval holds"
    )
    yield (
        f"Monte Carlo {trial.low:.6g} to {trial.high:.6g}, {trial.trials} trials: "
        f"the budget is {verdict}"
    )


def _assessment(assessment: Assessment | None) -> dict[str, Any]:
    if assessment is None:
        return {}
    linear, trial = assessment.budget.result, assessment.monte_carlo
    return {
        "budget": budget_rows(assessment.budget),
        "linear": {
            "value": linear.value,
            "standard_uncertainty": linear.uncertainty,
            "interval_95": linear.interval(),
            "good_enough": assessment.linear_good_enough,
        },
        "monte_carlo": {
            "trials": trial.trials,
            "mean": trial.mean,
            "standard_deviation": trial.uncertainty,
            "interval_95": (trial.low, trial.high),
        },
    }


def _model(outcome: Outcome) -> Iterator[Content]:
    rows: dict[str, Estimate] = {}
    body = outcome.body
    if body is not None and outcome.job not in ("combine", "ballast"):
        rows = {
            "mass": body.mass,
            "CG forward of the midpoint": body.cg_x,
            "CG below it": body.cg_z,
        }
        for axis, gyradius in body.gyradii.items():
            rows[f"{axis} gyradius"] = gyradius
            rows[f"{axis} inertia about the CG"] = body.inertia(axis)
        axis = "pitch" if outcome.plane == "vertical" else "yaw"
        if outcome.plane is not None and axis in body.gyradii:
            rows[f"{axis} inertia about the midpoint"] = body.about_midpoint(outcome.plane)
    yield Table("Model", MODEL, tuple(rows.items()))
    yield Table("Placements", PLACEMENTS, outcome.placements, "placements")


def _checks(outcome: Outcome) -> Iterator[Content]:
    yield Notes(
        [Note(comparison.verdict, comparison.message) for comparison in outcome.comparisons]
    )
    targets = (("quantity", "name"), ("target", "target"), ("tolerance", "tolerance"),
               ("verdict", "verdict"))  # fmt: skip
    rows = [
        {key: getattr(comparison, attribute) for key, attribute in targets}
        for comparison in outcome.comparisons
    ]
    yield Data("targets", rows)
    yield Text(outcome.notes, "notes")
    yield Notes(flag_notes(outcome.flags))
    yield Notes([] if outcome.next_step is None else [Note("next step", outcome.next_step)])


def _value(estimate: Estimate) -> str:
    value = estimate.value if abs(estimate.value) > _NOTHING else 0.0
    return rounded(value, estimate.uncertainty)


def _freedom(estimate: Estimate) -> str:
    value = estimate.degrees_of_freedom
    return "∞" if math.isinf(value) or value > 1e4 else f"{value:.3g}"


def _interval(finding: Finding) -> tuple[float, float]:
    return finding.assessment.interval if finding.assessment else finding.estimate.interval()


def _first_runs(runs: tuple[float, ...]) -> str:
    text = " ".join(f"{run:.5g}" for run in runs[:4])
    return f"{text} ..." if len(runs) > 4 else text
