"""What a campaign's coefficients say: each table once, for the terminal, the page and programs."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, Final

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_budget import budget
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.exchange import to_dict
from analysis.coefficients.recommendation import recommended, table
from analysis.coefficients.stated_uncertainties import STATED
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
from pmm.document.notation import NOT_KNOWN, counted, joined, written
from pmm.report.attitude import attitude_table, heel_table
from pmm.report.attitude_figure import attitude_figures
from pmm.report.circle_figure import circle_figures
from pmm.report.circle_table import circle_table
from pmm.report.coefficient_findings import beside, findings
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


def coefficients_document(outcome: CampaignOutcome) -> Document:
    """Return what ``pmm coefficients`` shows; ``docs/coefficients-command.md`` has the keys."""
    found = outcome.result
    used, noticed = counted(len(outcome.cycles), "run"), Notes(flag_notes(outcome.noticed))
    return Document(
        ", ".join(outcome.names),
        "coefficients",
        (
            Section("", (Text((f"{used}, {found.plane}, {found.form} form",)),)),
            Section("", (*conclusion(found), *_conditions(outcome), noticed)),
            Section("", (*memory_contents(outcome), memory_data(outcome))),
            Section("", (*beside(found), *alternatives_tables(found))),
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
    found = outcome.result
    flags: Content = Notes(flag_notes(outcome.all_flags))
    return Document(
        ", ".join(outcome.names),
        "coefficients",
        (
            Section("", (pairs("Summary", _summary(outcome)), *_conditions(outcome))),
            Section("Coefficients", (recommended_table(found), *alternatives_tables(found))),
            *stories,
            Section(
                "Figures",
                (
                    *figures(found),
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
            Section("What was found", tuple(findings(found))),
            Section("What was flagged", (Text(("Nothing.",)) if flags.empty else flags,)),
            Section("Uncertainty", (_given(outcome), budget_table(found))),
            Section(
                "Runs",
                (_runs(outcome), circle_table(outcome.turns), decay_table(outcome.decays)),
            ),
        ),
        SCHEMA,
    )


def _conditions(outcome: CampaignOutcome) -> tuple[Content, ...]:
    speeds = (one.speed_m_s for one in outcome.result.entries)
    conditions = conditions_table(speeds, outcome.settings.ship, outcome.water)
    return (
        conditions,
        attitude_table(outcome),
        heel_table(outcome),
        following_table(outcome),
        wave_table(outcome),
    )


def conclusion(found: CampaignCoefficients) -> tuple[Content, ...]:
    """Return the values to be used first, and what was found about them."""
    forms: dict[tuple[str, str], list[str]] = {}
    for choice in found.choices:
        forms.setdefault((choice.load, choice.message), []).extend(choice.runs)
    lines = [f"form    {load} of {joined(runs)}: {said}" for (load, said), runs in forms.items()]
    if found.checks:
        agree = sum(check.agrees for check in found.checks)
        lines.append(f"checks  {agree} of {len(found.checks)} between runs agree")
    apart = [check.message for check in found.checks if not check.agrees]
    apart += [outlier.message for outlier in found.outliers]
    return (
        recommended_table(found),
        Text(("", *lines)),
        Notes([Note("warning", said) for said in apart]),
        Text([f"missing {one.name}: {one.message}" for one in found.missing]),
    )


def _data(outcome: CampaignOutcome) -> dict[str, Any]:
    found = outcome.result
    told = ("name", "file", "periods", "sample_rate_hz", "duration_s", "flags")
    return {
        "campaigns": outcome.names,
        "recommended": [row for row in table(found) if row["recommended"]],
        "coefficients": to_dict(found),
        "budgets": [budget(found, k) for k in range(len(found.entries))],
        "stated": outcome.stated,
        "body": outcome.body,
        "runs": [{key: getattr(run, key) for key in told} for run in outcome.runs],
        "failed": outcome.failed,
        "not_recorded": outcome.not_recorded,
        "left_out": outcome.left_out,
    }


def _summary(outcome: CampaignOutcome) -> dict[str, str]:
    found = outcome.result
    agree = sum(check.agrees for check in found.checks)
    outside = sum(not reference.within for reference in found.references)
    rows = {
        "campaign": ", ".join(outcome.names),
        "runs": f"{len(outcome.cycles)} used, {len(outcome.failed)} could not be",
        "plane and form": f"{found.plane}, {found.form}",
        "system": found.normalisation,
        "values": f"{len(recommended(found))} recommended, of {len(found.entries)} in all",
        "repeats that stand off": str(len(found.outliers)),
        "kinds of flags": str(len(flag_lines(outcome.all_flags))),
    }
    if found.checks:
        rows["checks between runs"] = f"{agree} of {len(found.checks)} agree"
    if found.references:
        rows["beside tables"] = f"{outside} of {len(found.references)} outside"
    return rows


def _runs(outcome: CampaignOutcome) -> Table[ReadRecording]:
    """Return the runs that were used, with the hash of each recording."""
    used = {cycle.name: cycle for cycle in outcome.cycles}

    def cycle(one: ReadRecording) -> BodyCycle | None:
        return used.get(one.name) or one.cycle

    def medium(one: ReadRecording) -> str:
        known = cycle(one)
        return "zero" if known is None else str(known.medium) if one.name in used else "dry"

    def motion(one: ReadRecording) -> str:
        known = cycle(one)
        moved = known is not None and known.frequency_hz > 0.0
        return amplitudes(*known.amplitude.tolist()) if moved else NOT_KNOWN  # type: ignore[union-attr]

    columns: tuple[Column[ReadRecording], ...] = (
        word("run", "name"),
        Column("medium", medium),
        Column("f", lambda one: cycle(one), unit="Hz", number=True,
               written=lambda one: frequency(one.frequency_hz) if one else NOT_KNOWN),
        Column("U", lambda one: cycle(one), unit="m/s", number=True,
               written=lambda one: f"{one.speed_m_s:g}" if one else NOT_KNOWN),
        Column("motion", motion, number=True),
        Column("periods", lambda one: str(one.periods or NOT_KNOWN), number=True),
        number("record", "duration_s", written(".1f"), "s"),
        number("rate", "sample_rate_hz", written("g"), "Hz"),
        Column("SHA-256 begins", lambda one: one.sha256[:16]),
    )  # fmt: skip
    return Table("Recordings", columns, outcome.runs, titled=True)


def _given(outcome: CampaignOutcome) -> Table[tuple[str, str]]:
    """Return what was stated: the body that was taken off and standard uncertainties."""
    body = {} if outcome.body is None else asdict(outcome.body)
    stated = zip(STATED, outcome.stated.vector, strict=True)
    known = {key: value for key, value in body.items() if value is not None}
    rows = [(f"model: {key}", f"{value:.6g}") for key, value in known.items()]
    rows += [(f"u of {key}", f"{value:.3g}") for key, value in stated if value > 0.0]
    columns = (
        Column[tuple[str, str]]("what", lambda row: row[0]),
        Column[tuple[str, str]]("value", lambda row: row[1], number=True),
    )
    nothing = [("inertia", "taken off by dry runs")]
    return Table("Given", columns, rows or nothing, titled=True)
