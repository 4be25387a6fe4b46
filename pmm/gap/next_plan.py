"""Proposed runs as a plan that ``pmm plan check`` and ``pmm run`` take (docs/plans.md)."""

from collections.abc import Sequence
from typing import Any, Final

from analysis.gap.design.measurements import REST_S
from analysis.gap.design.proposals import Proposal, dead_weight
from hardware.description.kinds import Motion, RunKind
from hardware.description.setpoint import Medium
from pmm.toml_text import toml_table, toml_value
from sim.effects.effect import FurtherMeasurement

RIG_FILE: Final = "rig.toml"


def plan_text(name: str, proposals: Sequence[Proposal], prefix: str = "next") -> str:
    """Return a plan of the proposed runs, most telling first.

    Each is an entry of its own under a comment with what it is expected to be worth. What no plan
    can do, a signal in place of the bridges, is a comment alone.

    Parameters
    ----------
    name
        Of the campaign that is to be made.
    prefix
        What the runs' names begin with.
    """
    parts = [
        "# What pmm gap proposes next. The rig's file is named here; docs/plans.md has every key.\n"
        f"name = {toml_value(name)}\nrig = {toml_value(RIG_FILE)}\n"
    ]
    for number, proposal in enumerate(proposals, 1):
        table = _entry(proposal, f"{prefix}-{number}")
        worth = f"# {proposal.gain:.1f} expected log odds between the leading answers\n"
        comment = f"# by hand: {proposal}\n"
        parts.append(worth + (toml_table("runs", table, array=True) if table else comment))
    return "\n".join(parts)


def _entry(proposal: Proposal, name: str) -> dict[str, Any]:
    """Return a proposal as an entry of a plan; empty where a plan has no such run."""
    if proposal.set_point is None:
        return _special(proposal, name)
    point = proposal.set_point
    dry = point.medium is Medium.AIR
    return {
        "kind": str(RunKind.DRY if dry else RunKind.OSCILLATION),
        "motion": str(Motion.PHASE),
        "name": name,
        "frequencies_hz": point.frequency_hz,
        "amplitudes_m": point.eccentricity_m,
        "strut_phases_rad": point.strut_phase_rad,
        "speeds_m_s": point.carriage_speed_m_s or None,
        "drifts_rad": point.drift_rad or None,
        "prompt": f"Put {dead_weight(proposal.force_n)}" if proposal.force_n else None,
    }


def _special(proposal: Proposal, name: str) -> dict[str, Any]:
    if proposal.kind == FurtherMeasurement.REST:
        return {"kind": str(RunKind.ZERO), "name": name, "duration_s": REST_S}
    if proposal.kind == FurtherMeasurement.CHECK_WEIGHT:
        loads_n = [0.0, 0.5 * proposal.force_n, proposal.force_n]
        return {
            "kind": str(RunKind.CHECK_WEIGHT),
            "name": name,
            "channels": [f"force_{proposal.strut}"],
            "loads_n": loads_n,
        }
    return {}
