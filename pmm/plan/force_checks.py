"""The struts' forces that a run is expected to ask for, each held against its strut's gauge."""

from collections.abc import Iterator

from hardware.description.channels import FORCES
from pmm.plan import check_table as table
from pmm.plan.check import Peak
from pmm.plan.findings import PlanFinding, PlanVerdict
from pmm.plan.force_estimate import force_peaks_n
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan


def force_peaks(run: RunPlan, rig: RigFile) -> Iterator[Peak]:
    """Yield each strut's largest force against the oscillator's limit and the gauge's range."""
    peaks, limit = force_peaks_n(run, rig), rig.oscillator.force_per_strut_n
    if peaks is not None and limit is not None:
        yield table.STRUT_FORCE, float(peaks.max()), 0.0, limit, "of a strut"
    for channel, force_n, range_n in _at_gauges(run, rig):
        yield table.GAUGE_FORCE, force_n, 0.0, range_n, f"full scale of {channel}"


def near_full_scale(run: RunPlan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield forces that come near the end of their gauge's range."""
    (share,) = table.GAUGE_FORCE.numbers
    for channel, force_n, range_n in _at_gauges(run, rig):
        if share * range_n < force_n <= range_n:
            text = (
                f"an estimated force of {force_n:.4g} N is above {share:.0%} of the {range_n:g} N "
                f"of {channel}: {table.GAUGE_FORCE.reason}"
            )
            quantity = table.GAUGE_FORCE.quantity
            yield PlanFinding(PlanVerdict.WARN, quantity, force_n, share * range_n, run.name, text)


def _at_gauges(run: RunPlan, rig: RigFile) -> Iterator[tuple[str, float, float]]:
    """Yield the struts' gauges, what each is expected to bear, and its range, in N."""
    peaks = force_peaks_n(run, rig)
    if peaks is None:
        return
    for gauge in rig.gauges:
        if gauge.channel in FORCES:
            force_n = float(peaks[FORCES.index(gauge.channel)])
            yield gauge.channel, force_n, gauge.full_scale_n
