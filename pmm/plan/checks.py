"""All checks of a plan against its rig."""

import math
from collections.abc import Iterator
from datetime import date

from hardware.description.channels import HEEL_ANGLE, WAVE_PROBE
from hardware.description.kinds import RunKind
from hardware.path_shaft_settings import PathShaftSettings
from pmm.campaign.calibrated_recording import expiry_text
from pmm.plan.check_table import CALIBRATION, CHANNEL
from pmm.plan.condition_checks import condition_findings
from pmm.plan.field_checks import field_findings
from pmm.plan.findings import PlanFinding, PlanRefusedError, PlanVerdict
from pmm.plan.limits import bus_finding, limit_findings
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.simulated_rig import departure_findings


def check_plan(plan: Plan, rig: RigFile, today: date | None = None) -> tuple[PlanFinding, ...]:
    """Return what the rig cannot do, and what the field advises against.

    In the order of the runs, the whole plan first; a refusal stands before advice.

    Parameters
    ----------
    today
        On which the plan is to be run: whether the gauges' calibration is still good then.
    """
    findings = [
        *bus_finding(rig),
        *departure_findings(plan, rig),
        *_expired(rig, today),
        *_unrecorded(plan, rig),
        *_not_checked(plan, rig),
    ]
    for run in plan.runs:
        findings += [
            *limit_findings(run, rig),
            *field_findings(run, rig),
            *condition_findings(run, rig, plan.water),
        ]
    ranks = list(PlanVerdict)
    return tuple(sorted(findings, key=lambda finding: ranks.index(finding.verdict)))


def require_possible(
    plan: Plan, rig: RigFile, today: date | None = None
) -> tuple[PlanFinding, ...]:
    """Return the findings of a plan that the rig can run; ``today`` as in :func:`check_plan`.

    Raises
    ------
    PlanRefusedError
        If it cannot; the message gives every run with its value and its limit.
    """
    findings = check_plan(plan, rig, today)
    refused = [finding for finding in findings if finding.verdict is PlanVerdict.REFUSE]
    if refused:
        lines = "\n  ".join(f"{finding.run or 'plan'}: {finding.message}" for finding in refused)
        raise PlanRefusedError(f"{plan.path}: the rig cannot run this plan\n  {lines}")
    return findings


def _expired(rig: RigFile, today: date | None) -> Iterator[PlanFinding]:
    calibration = rig.calibration
    if calibration is not None and today is not None and calibration.is_expired(today):
        late = float((today - calibration.expires).days)
        text = expiry_text(calibration, today)
        yield PlanFinding(PlanVerdict.WARN, CALIBRATION.quantity, late, 0.0, "", text)


def _unrecorded(plan: Plan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield channels that runs of the plan are analysed by, and that no device records."""
    names = {
        getattr(channel, "name", "")
        for part in rig.hardware.forces
        for channel in getattr(part.settings, "channels", ())
    }
    for channel, runs in (
        (WAVE_PROBE, [run for run in plan.runs if run.set_point.wave_frequency_hz]),
        (HEEL_ANGLE, [run for run in plan.runs if run.kind is RunKind.FREE_DECAY]),
    ):
        if runs and channel.name not in names:
            message = (
                f"no device records {channel.name} [{channel.unit}], by which {runs[0].name} is "
                "analysed; give a channel of an amplifier that name"
            )
            yield PlanFinding(
                PlanVerdict.WARN, CHANNEL.quantity, math.nan, math.nan, runs[0].name, message
            )


def _leads(rig: RigFile) -> bool:
    """Tell whether the program itself leads the struts."""
    shaft = rig.hardware.shaft
    return shaft is not None and isinstance(shaft.settings, PathShaftSettings)


def _not_checked(plan: Plan, rig: RigFile) -> Iterator[PlanFinding]:
    """Yield what the rig's file does not say, and which checks are missing for it."""
    model, towed = rig.model, any(run.set_point.carriage_speed_m_s for run in plan.runs)
    if towed and plan.water is None:
        message = f"{plan.path.name} has no [water]: the Reynolds number is not checked"
        yield PlanFinding(PlanVerdict.NOTE, "not checked", math.nan, math.nan, "", message)
    turning = any(run.oscillates for run in plan.runs)
    paths = any(run.set_point.lines for run in plan.runs)
    for absent, table, subject in (
        ((turning or towed) and model is None, "[model]", "forces are"),
        (model is not None and rig.hull is None, "[hull]", "the water's part of the force is"),
        (towed and model is not None and rig.hull is None, "[hull]", "the force of tows is"),
        (
            towed and (model is None or model.length_m is None),
            "model.length_m",
            "Fn, Re, w L / U, w sqrt(L / g), turning and the reach to the walls are",
        ),
        (rig.tank is None, "[tank]", "tank length, speed, walls, depth and tank modes are"),
        (
            towed and rig.tank is not None and rig.tank.depth_m is None,
            "tank.depth_m",
            "depth Froude number and blockage are",
        ),
        (
            towed and rig.tank is not None and not (model and model.beam_m and model.draught_m),
            "model.beam_m or model.draught_m",
            "blockage and room under the keel are",
        ),
        (turning and not rig.modes, "[[modes]] (pluck test)", "structural modes are"),
        (not rig.gauges, "[[gauges]]", "the gauges' range is"),
        (
            paths and rig.oscillator.paths is None and not _leads(rig),
            "oscillator.paths",
            "whether struts can follow lines or exact paths is",
        ),
        (rig.limits.velocity_m_s is None, "limits.velocity_m_s", "strut velocity is"),
        (rig.limits.acceleration_m_s2 is None, "limits.acceleration_m_s2", "acceleration is"),
    ):
        if absent:
            message = f"{rig.path.name} has no {table}: {subject} not checked"
            yield PlanFinding(PlanVerdict.NOTE, "not checked", math.nan, math.nan, "", message)
