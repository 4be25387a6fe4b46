"""What has to be known of a pendulum's diagnosis besides its three sentences."""

from collections.abc import Iterator

import numpy as np

from analysis.gap.locate.walk import FAR
from analysis.gap.pendulum.diagnose import PendulumDiagnosis
from pmm.gap.pendulum_conclusion import parameters
from pmm.gap.words import something_besides


def notes(diagnosis: PendulumDiagnosis) -> Iterator[str]:
    """Yield what the records lack, what is there besides, and what is at the end of its range."""
    yield from _left_out(diagnosis)
    best = diagnosis.best
    if best.candidates:
        yield from something_besides(
            best.answer, diagnosis.weighed.answers.besides.get(best.answer, 0.0)
        )
        yield from _at_an_end(diagnosis)
    yield from _out_of_tolerance(diagnosis)


def _left_out(diagnosis: PendulumDiagnosis) -> Iterator[str]:
    for trial in diagnosis.problem.trials:
        missing = int(np.isnan(trial.observed).all(axis=0).sum())
        if missing:
            yield (
                f"{trial.name}: {missing} of {trial.windows.count} windows have too few samples, "
                "or a hole of a sixth of a swing, and are left out"
            )


def _at_an_end(diagnosis: PendulumDiagnosis) -> Iterator[str]:
    best = diagnosis.settled.best
    for at, axis in enumerate(best.axes):
        value, name = axis.value(float(best.units[at])), best.names[best.effect_index[at]]
        if value in axis.range and value:
            declared = axis.parameter
            yield (
                f"{name}: {declared.name} = {value:.4g} is at an end of its plausible range, "
                f"{declared.plausible} {declared.unit}: it may be larger, or another cause"
            )


def _out_of_tolerance(diagnosis: PendulumDiagnosis) -> Iterator[str]:
    """Yield which tolerances are stretched beside the best causes, or without any."""
    problem, best = diagnosis.problem, diagnosis.best
    units = problem.nuisances.fitted(problem.residual - best.signature)
    pulled = [
        f"{name} {unit:+.1f}"
        for name, unit in zip(problem.tolerance_names, units, strict=True)
        if name and abs(unit) > FAR
    ]
    if pulled:
        beside = " and ".join(parameters(best)) or "no cause"
        yield f"off by so many tolerances, beside {beside}: {', '.join(pulled)}"
