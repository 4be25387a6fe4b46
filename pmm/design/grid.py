"""The runs that could be made: of a grid's combinations those that rig and field allow.

A candidate is judged by the checks of ``pmm plan check``, one by one: what is refused, or warned
of, is no candidate, and neither is what the design's own limits exclude.
"""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain

from analysis.design.candidate import CandidateRun
from pmm.design.design_tables import DesignLimits
from pmm.plan import check_table as table
from pmm.plan.condition_checks import condition_findings
from pmm.plan.duration import run_s, setting_s
from pmm.plan.expansion import all_of, expand
from pmm.plan.field_checks import field_findings
from pmm.plan.findings import PlanFinding, PlanVerdict
from pmm.plan.limits import limit_findings
from pmm.plan.plan_tables import PlanEntry, PlanTables
from pmm.plan.rig_file import RigFile
from pmm.plan.run_plan import RunPlan


@dataclass(frozen=True)
class RunGrid:
    """Candidates and the runs that they are.

    Attributes
    ----------
    runs, entries, candidates
        Of the same places: each run, and the entry of a plan that makes it alone.
    left_out
        How many runs each check left out, the first that did counting, by its quantity.
    """

    runs: tuple[RunPlan, ...]
    entries: tuple[PlanEntry, ...]
    candidates: tuple[CandidateRun, ...]
    left_out: dict[str, int]

    @cached_property
    def entry_of(self) -> Mapping[RunPlan, PlanEntry]:
        """The entry of each run."""
        return dict(zip(self.runs, self.entries, strict=True))

    def among(self, places: Sequence[int]) -> "RunGrid":
        """Return the grid with some of its runs alone."""
        return RunGrid(
            tuple(self.runs[k] for k in places),
            tuple(self.entries[k] for k in places),
            tuple(self.candidates[k] for k in places),
            self.left_out,
        )


def grid_of(
    runs: Sequence[tuple[PlanEntry, RunPlan]], rig: RigFile, limits: DesignLimits, between_s: float
) -> RunGrid:
    """Return the candidates among some runs.

    Parameters
    ----------
    runs
        Each with the entry that makes it alone.
    between_s
        What each adds to the time of zero and control runs.
    """
    left: list[tuple[PlanEntry, RunPlan]] = []
    left_out: Counter[str] = Counter()
    conditions: dict[object, str] = {}
    for entry, run in runs:
        if run.set_point not in conditions:
            conditions[run.set_point] = next(_excluding(condition_findings(run, rig), limits), "")
        findings = chain(limit_findings(run, rig), field_findings(run, rig))
        reason = conditions[run.set_point] or next(_excluding(findings, limits), "")
        if reason:
            left_out[reason] += 1
        else:
            left.append((entry, run))
    candidate_runs = tuple(run for _, run in left)
    candidates = tuple(_candidates(candidate_runs, rig, between_s))
    return RunGrid(candidate_runs, tuple(entry for entry, _ in left), candidates, dict(left_out))


def _candidates(runs: Sequence[RunPlan], rig: RigFile, between_s: float) -> Iterator[CandidateRun]:
    """Yield each run with what it costs; its axes come from the farthest settings."""
    firsts = {_settings(run): run for run in runs}
    moves_s = {
        settings: max(setting_s(run, start, rig) for start in (None, *firsts.values()))
        for settings, run in firsts.items()
    }
    for run in runs:
        cost_s = run_s(run, run, rig) + between_s
        yield CandidateRun(run.set_point, run.periods, cost_s, moves_s[_settings(run)])


def _settings(run: RunPlan) -> tuple[float, float]:
    return run.set_point.eccentricity_m, run.set_point.strut_phase_rad


def between_s(tables: PlanTables, rig: RigFile, channels: Sequence[str]) -> float:
    """Return what a run adds to the time of zero and control runs, its share of them."""
    zero, control = tables.zero, tables.control
    share_s = 0.0 if zero is None else zero.duration_s / zero.every
    if control is not None:
        entry = control.entry()
        (run,) = expand(entry, tables.defaults, rig.oscillator, channels, all_of)
        share_s += run_s(run, None, rig) / control.every
    return share_s


def _excluding(findings: Iterable[PlanFinding], limits: DesignLimits) -> Iterator[str]:
    """Yield the quantities for which a run is no candidate."""
    for finding in findings:
        warned = finding.verdict is PlanVerdict.WARN and limits.advised
        if finding.verdict is PlanVerdict.REFUSE or warned or _is_beyond_limit(finding, limits):
            yield finding.quantity


def _is_beyond_limit(finding: PlanFinding, limits: DesignLimits) -> bool:
    """Whether a run's number is beyond the design's own limit."""
    limited = {
        table.ANGLE_TO_FLOW.quantity: limits.angle_to_flow_deg,
        table.REDUCED.quantity: limits.w_l_u,
        table.TAU_SWAY.quantity: limits.w_u_g,
        table.TAU_HEAVE.quantity: limits.w_u_g,
    }
    limited |= {
        table.ROTATION.quantity.format(rotation=word): limits.rotation_deg
        for word in ("yaw", "pitch")
    }
    limit = limited.get(finding.quantity)
    return limit is not None and finding.value > limit
