"""What a campaign's coefficients say: each table once, for the terminal, the page and programs."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Any, Final

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_budget import budget
from analysis.coefficients.campaign_records import LINEAR, ZERO_FREQUENCY
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.dry_checks import DRY
from analysis.coefficients.exchange import to_dict
from analysis.coefficients.recommendation import recommended, table
from analysis.coefficients.righting_checks import RIGHTING
from analysis.coefficients.stated_uncertainties import STATED
from analysis.coefficients.terms import load_of
from hardware.description.words import joined
from pmm.coefficients.tasks import ReadRecording
from pmm.coefficients.workflow import CampaignOutcome
from pmm.document.content import (
    Column,
    Content,
    Data,
    Document,
    Note,
    Notes,
    Section,
    Table,
    Text,
    number,
    pairs,
    word,
)
from pmm.document.flag_lines import flag_lines, flag_notes
from pmm.document.notation import NOT_KNOWN, counted, written
from pmm.report.attitude import attitude_table, heel_table
from pmm.report.attitude_figure import attitude_figures
from pmm.report.circle_figure import circle_figures
from pmm.report.circle_table import circle_table
from pmm.report.coefficient_findings import comparison_tables, findings
from pmm.report.coefficient_plots import figures
from pmm.report.coefficient_tables import (
    alternatives_tables,
    amplitudes,
    budget_table,
    frequency,
    recommended_table,
)
from pmm.report.conditions import conditions_table
from pmm.report.decays import decay_figures, decay_table
from pmm.report.following import following_figures, following_table
from pmm.report.line_sections import line_sections
from pmm.report.memory import memory_contents, memory_data
from pmm.report.memory_figure import memory_figures
from pmm.report.waves import wave_figures, wave_table

SCHEMA: Final = "pmm-coefficients-1"
_FIRST: Final = (DRY, RIGHTING)  # checks of what is stated, which touch all numbers
_ONE_AMPLITUDE: Final = (
    "one amplitude alone does not tell whether it is linear, and the values are those of that "
    "amplitude; add runs at another"
)


def coefficients_document(outcome: CampaignOutcome) -> Document:
    """Return what ``pmm coefficients`` shows; ``docs/coefficients-command.md`` has the keys."""
    coefficients = outcome.result
    run_count = counted(len(outcome.cycles), "run")
    besides = [flag for flag in outcome.noticed if flag not in outcome.implausible]
    return Document(
        ", ".join(outcome.names),
        "coefficients",
        (
            Section("", (Text((f"{run_count}, {coefficients.plane}, {coefficients.form} form",)),)),
            Section("", tuple(_doubts(outcome))),
            Section(
                "", (*conclusion(coefficients), *_conditions(outcome), Notes(flag_notes(besides)))
            ),
            Section("", (*memory_contents(outcome), memory_data(outcome))),
            Section("", (*comparison_tables(coefficients), *alternatives_tables(coefficients))),
            Section("", tuple(Data(key, value) for key, value in _data(outcome).items())),
        ),
        SCHEMA,
    )


def report_document(outcome: CampaignOutcome, stories: Sequence[Section] = ()) -> Document:
    """Return what ``pmm report`` writes: the same values, and all that they rest on.

    Parameters
    ----------
    stories
        Of campaigns that chose their runs: what was known after each.
    """
    coefficients = outcome.result
    flags: Content = Notes(flag_notes(outcome.all_flags))
    return Document(
        ", ".join(outcome.names),
        "coefficients",
        (
            Section(
                "",
                (*_doubts(outcome), pairs("Summary", _summary(outcome)), *_conditions(outcome)),
            ),
            Section(
                "Coefficients",
                (recommended_table(coefficients), *alternatives_tables(coefficients)),
            ),
            *stories,
            Section(
                "Figures",
                (
                    *figures(coefficients),
                    *circle_figures(outcome),
                    *decay_figures(outcome),
                    *wave_figures(outcome),
                    *attitude_figures(outcome),
                    *following_figures(outcome),
                    *memory_figures(outcome),
                ),
            ),
            *line_sections(outcome),
            Section("Memory of the water", tuple(memory_contents(outcome))),
            Section("What was found", tuple(findings(coefficients))),
            Section("What was flagged", (Text(("Nothing.",)) if flags.empty else flags,)),
            Section("Uncertainty", (_stated_table(outcome), budget_table(coefficients))),
            Section(
                "Runs",
                (_runs(outcome), circle_table(outcome.turns), decay_table(outcome.decays)),
            ),
        ),
        SCHEMA,
    )


def _doubts(outcome: CampaignOutcome) -> Iterator[Content]:
    """Yield what has to be settled before any number is used, where there is anything."""
    contradicted = [
        Note("warning", check.message)
        for check in outcome.result.checks
        if check.kind in _FIRST and not check.agrees
    ]
    notes = [*flag_notes(outcome.implausible), *contradicted]
    if notes:
        yield Text(("Settle this first: it touches all that is below.",))
        yield Notes(notes)


def _conditions(outcome: CampaignOutcome) -> tuple[Content, ...]:
    speeds = (entry.speed_m_s for entry in outcome.result.entries)
    conditions = conditions_table(speeds, outcome.settings.ship, outcome.water)
    return (
        conditions,
        attitude_table(outcome),
        heel_table(outcome),
        following_table(outcome),
        wave_table(outcome),
    )


def conclusion(coefficients: CampaignCoefficients) -> tuple[Content, ...]:
    """Return the values to be used first, and what was found about them."""
    forms: dict[tuple[str, str], list[str]] = {}
    for choice in coefficients.choices:
        forms.setdefault((choice.load, choice.message), []).extend(choice.runs)
    for entry in (coefficients.entries[k] for k in recommended(coefficients)):
        unjudged = entry.method in (LINEAR, ZERO_FREQUENCY)
        if unjudged and not coefficients.choices_of(entry.name, entry.runs):
            forms.setdefault((load_of(entry.name), _ONE_AMPLITUDE), []).extend(entry.runs)
    lines = [
        f"form    {load} of {joined(list(dict.fromkeys(runs)))}: {message}"
        for (load, message), runs in forms.items()
    ]
    if coefficients.checks:
        agree = sum(check.agrees for check in coefficients.checks)
        lines.append(f"checks  {agree} of {len(coefficients.checks)} between runs agree")
    warnings = [
        check.message
        for check in coefficients.checks
        if not check.agrees and check.kind not in _FIRST  # those stand at the head
    ]
    warnings += [outlier.message for outlier in coefficients.outliers]
    return (
        recommended_table(coefficients),
        Text(("", *lines)),
        Notes([Note("warning", message) for message in warnings]),
        Text([f"missing {gap.name}: {gap.message}" for gap in coefficients.missing]),
    )


def _data(outcome: CampaignOutcome) -> dict[str, Any]:
    coefficients = outcome.result
    keys = ("name", "file", "periods", "sample_rate_hz", "duration_s", "flags")
    return {
        "campaigns": outcome.names,
        "recommended": [row for row in table(coefficients) if row["recommended"]],
        "coefficients": to_dict(coefficients),
        "budgets": [budget(coefficients, k) for k in range(len(coefficients.entries))],
        "stated": outcome.stated,
        "body": outcome.body,
        "runs": [{key: getattr(run, key) for key in keys} for run in outcome.runs],
        "failed": outcome.failed,
        "not_recorded": outcome.not_recorded,
        "left_out": (*outcome.implausible, *outcome.left_out),
    }


def _summary(outcome: CampaignOutcome) -> dict[str, str]:
    coefficients = outcome.result
    agree = sum(check.agrees for check in coefficients.checks)
    outside = sum(not reference.within for reference in coefficients.references)
    rows = {
        "campaign": ", ".join(outcome.names),
        "runs": f"{len(outcome.cycles)} used, {len(outcome.failed)} could not be",
        "plane and form": f"{coefficients.plane}, {coefficients.form}",
        "system": coefficients.normalisation,
        "values": f"{len(recommended(coefficients))} recommended, "
        f"of {len(coefficients.entries)} in all",
        "repeats that stand off": str(len(coefficients.outliers)),
        "kinds of flags": str(len(flag_lines(outcome.all_flags))),
    }
    if coefficients.checks:
        rows["checks between runs"] = f"{agree} of {len(coefficients.checks)} agree"
    if coefficients.references:
        rows["beside tables"] = f"{outside} of {len(coefficients.references)} outside"
    return rows


def _runs(outcome: CampaignOutcome) -> Table[ReadRecording]:
    """Return the runs that were used, with the hash of each recording."""
    cycles = {cycle.name: cycle for cycle in outcome.cycles}

    def cycle(run: ReadRecording) -> BodyCycle | None:
        return cycles.get(run.name) or run.cycle

    def medium(run: ReadRecording) -> str:
        body_cycle = cycle(run)
        return (
            "zero"
            if body_cycle is None
            else str(body_cycle.medium)
            if run.name in cycles
            else "dry"
        )

    def motion(run: ReadRecording) -> str:
        body_cycle = cycle(run)
        moved = body_cycle is not None and body_cycle.frequency_hz > 0.0
        return amplitudes(*body_cycle.amplitude.tolist()) if moved else NOT_KNOWN  # type: ignore[union-attr]

    columns: tuple[Column[ReadRecording], ...] = (
        word("run", "name"),
        Column("medium", medium),
        Column("f", lambda run: cycle(run), unit="Hz", number=True,
               written=lambda body_cycle: frequency(body_cycle.frequency_hz) if body_cycle
               else NOT_KNOWN),
        Column("U", lambda run: cycle(run), unit="m/s", number=True,
               written=lambda body_cycle: f"{body_cycle.speed_m_s:g}" if body_cycle else NOT_KNOWN),
        Column("motion", motion, number=True),
        Column("periods", lambda run: str(run.periods or NOT_KNOWN), number=True),
        number("record", "duration_s", written(".1f"), "s"),
        number("rate", "sample_rate_hz", written("g"), "Hz"),
        Column("SHA-256 begins", lambda run: run.sha256[:16]),
    )  # fmt: skip
    return Table("Recordings", columns, outcome.runs, titled=True)


def _stated_table(outcome: CampaignOutcome) -> Table[tuple[str, str]]:
    """Return what was stated: the body that was taken off and standard uncertainties."""
    body = {} if outcome.body is None else asdict(outcome.body)
    stated = zip(STATED, outcome.stated.vector, strict=True)
    model_values = {key: value for key, value in body.items() if value is not None}
    rows = [(f"model: {key}", f"{value:.6g}") for key, value in model_values.items()]
    rows += [(f"u of {key}", f"{value:.3g}") for key, value in stated if value > 0.0]
    columns = (
        Column[tuple[str, str]]("what", lambda row: row[0]),
        Column[tuple[str, str]]("value", lambda row: row[1], number=True),
    )
    nothing = [("inertia", "taken off by dry runs")]
    return Table("Given", columns, rows or nothing, titled=True)
