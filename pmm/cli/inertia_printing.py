"""An inertia job's outcome as tables for people."""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from analysis.inertia.forms import SwingForm
from pmm.cli.screen import print_flags
from pmm.inertia.fits import FormFit
from pmm.inertia.outcome import Finding, Outcome
from pmm.inertia.sources import PeriodRuns
from pmm.report.rounding import rounded

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from analysis.inertia.estimate import Estimate
    from analysis.inertia.monte_carlo import Assessment

_NOTHING = 1e-9  # metres, kilograms: what rounding leaves of zero
_MOST_LINES = 8  # of a budget; the rest together
_FORMS = {
    SwingForm.F1: "undamped",
    SwingForm.F2: "damped",
    SwingForm.F3: "damped, whole periods",
    SwingForm.F4: "damped, with an offset",
}
_STYLES = {"pass": "green", "fail": "bold red", "undecided": "yellow"}


def print_outcome(console: "Console", outcome: Outcome, fits: Sequence[FormFit] = ()) -> None:
    """Print everything about one outcome, and the fits by form that were asked for."""
    from rich.rule import Rule
    from rich.text import Text

    title = Text(f"{outcome.job}: {outcome.name}", style="bold")
    console.print(Rule(title, align="left", style="dim"))
    _print_periods(console, outcome.periods)
    _print_fits(console, fits)
    _print_findings(console, outcome.findings)
    _print_budgets(console, outcome)
    _print_model(console, outcome)
    _print_placements(console, outcome)
    for one in outcome.comparisons:
        console.print(Text.assemble((f"{one.verdict:9s} ", _STYLES[one.verdict]), one.message))
    for note in outcome.notes:
        console.print(note, soft_wrap=True)
    print_flags(console, outcome.flags)
    if outcome.next_step is not None:
        console.print(Text.assemble(("next step ", "bold"), outcome.next_step), soft_wrap=True)


def _table(*headings: str, left: int = 1) -> "Table":
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for number, heading in enumerate(headings):
        if number < left:
            table.add_column(heading, overflow="fold")
        else:
            table.add_column(heading, justify="right", no_wrap=True)
    return table


def _print_periods(console: "Console", periods: tuple[PeriodRuns, ...]) -> None:
    if not periods:
        return
    table = _table("period from", "how", "T ± u [s]", "dof", "runs [s]", left=2)
    for one in periods:
        for number, period in enumerate(one.periods):
            runs = one.single[number] if number < len(one.single) else ()
            table.add_row(
                one.where if number == 0 else "",
                one.how if number == 0 else "",
                rounded(period.value, period.uncertainty),
                _freedom(period),
                _few(runs),
            )
    console.print(table)
    for one in periods:
        for run in one.records:
            decays = ", ".join(
                f"time constant {mode.decay.time_constant_s:.4g} s, beta {mode.decay.beta:z.2f} +- "
                f"{mode.decay.beta_uncertainty:.1g}"
                for mode in run.modes
            )
            text = f"used {run.part.series.name}: {run.part.because}; {decays}"
            console.print(text, style="dim", soft_wrap=True)
    console.print()


def _print_fits(console: "Console", fits: Sequence[FormFit]) -> None:
    if not fits:
        return
    table = _table(
        "fit of", "form", "T ± u of this fit [s]", "decay [1/s]", "offset", "residual", left=2
    )
    for one in fits:
        first = one.form is SwingForm.F1
        table.add_row(
            one.record if first else "",
            f"{one.form} {_FORMS[one.form]}",
            rounded(one.period_s, one.period_uncertainty_s),
            f"{one.decay_1_s:.3g}",
            f"{one.offset:.3g}",
            f"{one.residual:.3g}",
        )
    console.print(table)
    console.print()


def _few(runs: tuple[float, ...]) -> str:
    shown = " ".join(f"{run:.5g}" for run in runs[:4])
    return f"{shown} ..." if len(runs) > 4 else shown


def _print_findings(console: "Console", findings: tuple[Finding, ...]) -> None:
    table = _table("result", "name", "value ± u", "dof", "95 % interval", "unit", left=2)
    for one in findings:
        low, high = one.assessment.interval if one.assessment else one.estimate.interval()
        exact = one.estimate.uncertainty == 0.0
        table.add_row(
            one.what,
            one.name,
            _shown(one.estimate),
            "" if exact else _freedom(one.estimate),
            "" if exact else f"{low:.5g} to {high:.5g}",
            one.estimate.unit,
        )
    console.print(table)


def _shown(estimate: "Estimate") -> str:
    value = estimate.value if abs(estimate.value) > _NOTHING else 0.0
    return rounded(value, estimate.uncertainty)


def _freedom(estimate: "Estimate") -> str:
    value = estimate.degrees_of_freedom
    return "∞" if math.isinf(value) or value > 1e4 else f"{value:.3g}"


def _print_budgets(console: "Console", outcome: Outcome) -> None:
    for one, assessment in outcome.budgeted:
        console.print()
        _print_budget(console, one.name, assessment)


def _print_budget(console: "Console", name: str, one: "Assessment") -> None:
    table = _table(f"budget of {name}", "value ± u", "unit", "dof", "contribution", "share")
    lines = [line for line in one.budget.shares if line.input.uncertainty > 0.0]
    for line in lines[:_MOST_LINES]:
        table.add_row(
            line.name,
            rounded(line.input.value, line.input.uncertainty),
            line.input.unit,
            _freedom(line.input),
            f"{line.contribution:.2g}",
            f"{100.0 * line.share:.1f} %",
        )
    rest = lines[_MOST_LINES:]
    if rest:
        share = 100.0 * sum(line.share for line in rest)
        table.add_row(f"{len(rest)} more", "", "", "", "", f"{share:.1f} %")
    console.print(table)
    linear, trial = one.budget.result, one.monte_carlo
    low, high = linear.interval()
    console.print(
        f"budget      {low:.6g} to {high:.6g}, u = {linear.uncertainty:#.2g}, "
        f"{_freedom(linear)} degrees of freedom",
        style="dim",
    )
    verdict = "good enough" if one.linear_good_enough else "not good enough, this interval holds"
    console.print(
        f"Monte Carlo {trial.low:.6g} to {trial.high:.6g}, {trial.trials} trials: "
        f"the budget is {verdict}",
        style="dim",
    )


def _print_model(console: "Console", outcome: Outcome) -> None:
    if outcome.body is None or outcome.job in ("combine", "ballast"):
        return
    body = outcome.body
    table = _table("model", "value ± u", "dof", "unit")
    rows = {"mass": body.mass, "CG forward of the midpoint": body.cg_x, "CG below it": body.cg_z}
    for axis, gyradius in body.gyradii.items():
        rows[f"{axis} gyradius"] = gyradius
        rows[f"{axis} inertia about the CG"] = body.inertia(axis)
    if outcome.plane is not None:
        axis = "pitch" if outcome.plane == "vertical" else "yaw"
        if axis in body.gyradii:
            rows[f"{axis} inertia about the midpoint"] = body.about_midpoint(outcome.plane)
    for what, value in rows.items():
        table.add_row(what, rounded(value.value, value.uncertainty), _freedom(value), value.unit)
    console.print()
    console.print(table)


def _print_placements(console: "Console", outcome: Outcome) -> None:
    if not outcome.placements:
        return
    table = _table("weight", "mass [kg]", "x [m]", "y [m]", "z [m]")
    for name, mass, *place in outcome.placements:
        table.add_row(name, f"{mass:g}", *(f"{value:.4f}" for value in place))
    console.print()
    console.print(table)
