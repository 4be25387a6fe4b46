"""What there is to see of a run now."""

from pmm.run.conduct import Conduct
from pmm.run.planned_runs import PlannedRuns
from pmm.run.status import Alarms, RunStatus


def status_of(
    conduct: Conduct, planned: PlannedRuns, alarms: Alarms, free_bytes: int | None
) -> RunStatus:
    """Return a picture of this moment of a conduct and its planned runs."""
    run, measurement = conduct.run, conduct.measurement
    return RunStatus(
        state=conduct.state,
        cycle=conduct.rig.number,
        time_s=conduct.rig.number / conduct.rate_hz,
        run=run.name if run else "",
        kind=str(run.kind) if run else "",
        run_number=planned.number(run) if run else 0,
        run_count=len(planned.runs),
        frequency_hz=run.set_point.frequency_hz if run else 0.0,
        gate=measurement.gate.state if measurement else RunStatus.gate,
        periods=measurement.gate.periods if measurement else 0,
        wanted_periods=measurement.gate.wanted if measurement else 0,
        harmonics=measurement.rows() if measurement else (),
        question=conduct.questions.present,
        alarms=alarms.latest,
        statistics=measurement.journal.statistics() if measurement else None,
        free_bytes=free_bytes,
    )
