"""An outcome as JSON takes it: the same numbers as in the tables."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from analysis.inertia.amplitude import PowerDecay
from analysis.inertia.monte_carlo import Assessment
from analysis.inertia.result import budget_rows, estimate_numbers, finite_or_none
from pmm.inertia.fits import FormFit
from pmm.inertia.outcome import Finding, Outcome
from pmm.inertia.sources import PeriodRuns

JSON_SCHEMA = "pmm-inertia-1"


def document(outcome: Outcome, fits: Sequence[FormFit] = ()) -> dict[str, Any]:
    """Return what ``--json`` prints; ``docs/inertia-files.md`` describes it.

    Parameters
    ----------
    fits
        Of the records by the forms F1 to F4, where they were asked for.
    """
    text: dict[str, Any] = {
        "schema": JSON_SCHEMA,
        "job": outcome.job,
        "name": outcome.name,
        "results": {one.name: _finding(one) for one in outcome.findings},
        "periods": [_period(one) for one in outcome.periods],
        "fits": [{**asdict(one), "form": str(one.form)} for one in fits],
        "targets": [
            {
                "quantity": one.name,
                "target": one.target,
                "tolerance": one.tolerance,
                "verdict": one.verdict,
            }
            for one in outcome.comparisons
        ],
        "placements": [
            {"name": name, "mass_kg": mass, "position_m": list(place)}
            for name, mass, *place in outcome.placements
        ],
        "model": None if outcome.body is None else outcome.body.numbers(),
        "notes": list(outcome.notes),
        "next_step": outcome.next_step,
        "flags": [
            {"code": flag.code, "severity": str(flag.severity), "message": flag.message}
            for flag in outcome.flags
        ],
    }
    return text


def _finding(one: Finding) -> dict[str, Any]:
    row: dict[str, Any] = {"what": one.what, **estimate_numbers(one.estimate)}
    if one.assessment is not None:
        row["interval_95"] = list(one.assessment.interval)
        row |= _assessment(one.assessment)
    return row


def _assessment(one: Assessment) -> dict[str, Any]:
    trial = one.monte_carlo
    return {
        "budget": budget_rows(one.budget),
        "linear": {
            "value": one.budget.result.value,
            "standard_uncertainty": one.budget.result.uncertainty,
            "interval_95": list(one.budget.result.interval()),
            "good_enough": one.linear_good_enough,
        },
        "monte_carlo": {
            "trials": trial.trials,
            "mean": trial.mean,
            "standard_deviation": trial.uncertainty,
            "interval_95": [trial.low, trial.high],
        },
    }


def _period(one: PeriodRuns) -> dict[str, Any]:
    return {
        "where": one.where,
        "how": one.how,
        "periods": [estimate_numbers(period) for period in one.periods],
        "runs_s": [list(runs) for runs in one.single],
        "used": [run.part.because for run in one.records],
        "decay": [[_decay(mode.decay) for mode in run.modes] for run in one.records],
    }


def _decay(one: PowerDecay) -> dict[str, Any]:
    return {
        "amplitude": one.amplitude,
        "time_constant_s": finite_or_none(one.time_constant_s),
        "beta": one.beta,
        "beta_uncertainty": one.beta_uncertainty,
    }
