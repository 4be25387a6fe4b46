"""The four period fits F1 to F4 of each record, beside the period that a job goes on with."""

from collections.abc import Iterator
from dataclasses import dataclass

from analysis.inertia.forms import SwingForm, fit_swing_form
from pmm.inertia.outcome import Outcome
from pmm.inertia.sources import PeriodRuns


@dataclass(frozen=True)
class FormFit:
    """One record by one form.

    Attributes
    ----------
    where, record, channel
        Place in the job's file, the recording, and what of it swings.
    period_s, period_uncertainty_s
        Of the damped oscillation at the record's amplitudes, with this fit's own error alone.
    decay_1_s, offset, residual
        Decay rate, what it swings about, and the root mean square of what is left.
    """

    where: str
    record: str
    channel: str
    form: SwingForm
    period_s: float
    period_uncertainty_s: float
    decay_1_s: float
    offset: float
    residual: float


def form_fits(outcome: Outcome) -> tuple[FormFit, ...]:
    """Fit the used part of every record of one oscillation by each form.

    Raises
    ------
    DataError
        If a form does not fit a record.
    """
    return tuple(fit for runs in outcome.periods for fit in _of_period(runs))


def _of_period(runs: PeriodRuns) -> Iterator[FormFit]:
    if len(runs.periods) > 1:
        return
    for run in runs.records:
        series = run.part.series
        for form in SwingForm:
            fit = fit_swing_form(
                series.time_s, series.values, form,
                start_period_s=run.fit.modes[0].period_s, where=series.where,
            )  # fmt: skip
            mode = fit.modes[0]
            yield FormFit(
                runs.where, series.name, series.channel, form,
                mode.period_s, fit.period_uncertainty_s(), mode.decay_1_s, fit.offset,
                float((fit.residual**2).mean() ** 0.5),
            )  # fmt: skip
