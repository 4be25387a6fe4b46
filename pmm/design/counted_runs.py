"""Which runs count in a design: those that `pmm coefficients` takes, as far as it can foresee."""

from collections.abc import Iterator, Sequence
from typing import Final

from hardware.description.kinds import RunKind
from hardware.description.setpoint import Medium
from pmm.coefficients.steered_runs import usual_rate_hz, why_steered
from pmm.configuration import Fault
from pmm.plan.run_plan import RunPlan

MANY_LINES: Final = "a design goes on from single sines; runs of many lines are not among them"


def oscillates_in_water(run: RunPlan) -> bool:
    """Tell whether a run is one of those that coefficients are fitted to."""
    kinds = (RunKind.OSCILLATION, RunKind.CONTROL)
    return run.kind in kinds and run.set_point.medium is Medium.WATER


def uncounted_runs(runs: Sequence[RunPlan], usual_hz: float) -> dict[str, str]:
    """Say why oscillations are not counted: the analysis leaves them out, or nobody foresees them.

    Parameters
    ----------
    usual_hz
        Rate of the propeller in most runs of the grid.
    """
    reasons = {
        run.name: MANY_LINES if run.set_point.own_orders else why_steered(run, usual_hz)
        for run in runs
        if oscillates_in_water(run)
    }
    return {name: reason for name, reason in reasons.items() if reason is not None}


def grid_faults(runs: Sequence[RunPlan]) -> Iterator[Fault]:
    """Yield what a grid holds and runs cannot be chosen from."""
    kinds = sorted({str(run.kind) for run in runs if run.kind is not RunKind.OSCILLATION})
    if kinds:
        yield Fault(
            ("grid",),
            f"holds runs of the kind {', '.join(kinds)}; only oscillations in water are chosen "
            "from, others belong to [[runs]]",
        )
    if any(run.set_point.own_orders for run in runs):
        yield Fault(
            ("grid",), "holds motions of many lines; single sines are chosen from, others belong "
            "to [[runs]], where they are made and not counted",
        )  # fmt: skip
    usual_hz = usual_rate_hz(runs)
    steered = sorted({why for run in runs if (why := why_steered(run, usual_hz)) is not None})
    if steered:
        yield Fault(
            ("grid",), f"holds runs that `pmm coefficients` leaves out: {'; '.join(steered)}; give "
            "them in [[runs]], where they are made and not counted",
        )  # fmt: skip
