"""What an operator may change of runs that are planned: a set-point, the order."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from typing import Any, Final

from hardware.description.errors import ConfigurationError
from hardware.description.kinds import Motion, RunKind
from pmm.configuration import as_error
from pmm.plan.ordering import runs_of
from pmm.plan.plan import Plan, examine_plan
from pmm.plan.run_plan import RunPlan

# Of a set-point, each with its key in an entry of a plan.
_KEYS: Final = {
    "frequency_hz": "frequencies_hz",
    "eccentricity_m": "amplitudes_m",
    "strut_phase_rad": "strut_phases_rad",
    "carriage_speed_m_s": "speeds_m_s",
    "drift_rad": "drifts_rad",
}
_MOVED: Final = "moved"


def edited(run: RunPlan, settings: Mapping[str, float], plan: Plan) -> RunPlan:
    """Return an oscillation with other settings, read as an entry of its plan's file would be.

    Parameters
    ----------
    settings
        Those that change: fields of :class:`hardware.description.setpoint.SetPoint`, and
        ``periods``.

    Raises
    ------
    ConfigurationError
        If the run is no oscillation of one frequency, or a plan could not say so.
    """
    if run.kind is not RunKind.OSCILLATION or run.set_point.lines:
        raise ConfigurationError(
            f"{run.name}: only oscillations of one frequency are edited; drop the plan, edit its "
            "file and queue it anew"
        )
    before = asdict(run.set_point)
    if run.motion is not Motion.PHASE:  # the motion says it
        del before["strut_phase_rad"]
    point = {key: settings.get(key, before.get(key)) for key in _KEYS}
    entry: dict[str, Any] = {
        "motion": str(run.motion),
        "periods": settings.get("periods", run.periods),
        "settling_periods": run.settling_periods,
        **{_KEYS[k]: value for k, value in point.items() if value or k in settings},
    }
    edited_run = _read(entry, plan)
    now = replace(
        run,
        set_point=replace(
            run.set_point, **{key: getattr(edited_run.set_point, key) for key in _KEYS}
        ),
        periods=edited_run.periods,
        max_periods=max(edited_run.periods, 0 if run.target_relative is None else run.max_periods),
    )
    return replace(now, changed=(*run.changed, *_changes(run, now)))


def moved(runs: Sequence[RunPlan], name: str, by: int) -> tuple[RunPlan, ...]:
    """Return runs of which one is made later by so many places, earlier where negative.

    It is read against the zero runs that it then stands between, and waits for calm water there.

    Raises
    ------
    ConfigurationError
        If it is a zero run, which others rest on, or would have no zero run of its conditions on
        a side where it had one.
    """
    place = next(k for k, run in enumerate(runs) if run.name == name)
    run, rest = runs[place], [*runs[:place], *runs[place + 1 :]]
    if run.kind is RunKind.ZERO:
        raise ConfigurationError(f"{name}: zero runs stay; move the runs that rest on them")
    to = max(0, min(len(rest), place + by))
    before = _nearest(rest[:to][::-1], run) if run.zero_before else None
    after = _nearest(rest[to:], run) if run.zero_after else None
    now = replace(
        run,
        zero_before=before.name if before else "",
        zero_after=after.name if after else "",
        pause_before_s=max(run.pause_before_s, before.pause_before_s if before else 0.0),
    )
    if now != run:
        now = replace(
            now, changed=(*(change for change in run.changed if change != _MOVED), _MOVED)
        )
    return (*rest[:to], now, *rest[to:])


def _nearest(runs: Sequence[RunPlan], run: RunPlan) -> RunPlan:
    """Return the first zero run that was made as a run needs it."""
    like = (run.set_point.medium, run.known_mass, run.set_point.heel_rad)
    for candidate in runs:
        point = candidate.set_point
        if (
            candidate.kind is RunKind.ZERO
            and (point.medium, candidate.known_mass, point.heel_rad) == like
        ):
            return candidate
    raise ConfigurationError(
        f"{run.name}: no zero run of its conditions would stand beside it there; move it less far"
    )


def _read(entry: Mapping[str, Any], plan: Plan) -> RunPlan:
    table = {"rig": str(plan.rig_path.resolve()), "runs": [entry]}
    reading = examine_plan(table, plan.path)
    if reading.faults or reading.tables is None or reading.rig.rig is None:
        if reading.rig.error is not None:
            raise reading.rig.error
        raise as_error(plan.path, reading.faults, table)
    return runs_of(reading.tables, reading.rig.rig.oscillator, reading.channels)[0]


def _changes(before: RunPlan, now: RunPlan) -> list[str]:
    """Return what changed, in words."""
    pairs = [(key, getattr(before.set_point, key), getattr(now.set_point, key)) for key in _KEYS]
    pairs.append(("periods", before.periods, now.periods))
    return [f"{key} {old:g} -> {new:g}" for key, old, new in pairs if old != new]
