"""What the browser is told, as JSON: NaN becomes ``null``, numbers keep six digits."""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from hardware.description.arrays import FloatArray
from pmm.console.messages import CampaignLook, Frame, Hello, Needles, Notice, SignalTrace
from pmm.document.notation import clock
from pmm.run.status import ChannelReading, RunOutcome
from pmm.sequential.look import in_words

_DIGITS = 6


class EncodedText(str):
    """JSON that is made already."""


def encode(message: object) -> str:
    """Return a message for the browser, or a part of one, as JSON; raises ValueError for NaN."""
    return json.dumps(message, allow_nan=False, separators=(",", ":"))


def encode_answer(parts: Mapping[str, Any]) -> str:
    """Return a message of which some parts are made already."""
    texts = (
        f"{encode(k)}:{v if isinstance(v, EncodedText) else encode(v)}" for k, v in parts.items()
    )
    return f"{{{','.join(texts)}}}"


def number(value: float) -> float | None:
    """Return a number with as many digits as a screen shows; ``None`` if it is none."""
    return float(f"{value:.{_DIGITS}g}") if math.isfinite(value) else None


def table(values: FloatArray) -> list[list[float | None]]:
    """Return the rows of a table of numbers for JSON, ``None`` for what is not finite."""
    return [[number(value) for value in row] for row in values.tolist()]


def hello_picture(hello: Hello) -> dict[str, Any]:
    """Return what does not change."""
    return {
        "rig": hello.rig,
        "simulated": hello.simulated,
        "speed": hello.speed,
        "priority": hello.priority,
        "sample_rate_hz": hello.sample_rate_hz,
        "trace_rate_hz": hello.trace_rate_hz,
        "harmonics": hello.harmonics,
        "channels": [
            {"name": channel.name, "unit": channel.unit, "full_scale": number(channel.full_scale)}
            for channel in hello.channels
        ],
    }


def frame_picture(frame: Frame) -> dict[str, Any]:
    """Return one tick, without its traces."""
    status, point = frame.status, frame.set_point
    return {
        "type": "frame",
        "n": frame.number,
        "cycle": status.cycle,
        "time_s": round(status.time_s, 4),
        "state": str(status.state),
        "run": status.run,
        "kind": status.kind,
        "run_number": status.run_number,
        "run_count": status.run_count,
        "gate": str(status.gate),
        "periods": status.periods,
        "wanted": status.wanted_periods,
        "opened_s": number_of_time(frame.opened_s),
        "closed_s": number_of_time(frame.closed_s),
        "shaft_hz": number(frame.shaft_hz),
        "set": None if point is None else {k: _plain(v) for k, v in asdict(point).items()},
        "axes": [[name, unit, number(value)] for name, unit, value in frame.axes],
        "allowed": frame.allowed,
        "question": frame.question,
        "plan": frame.plan,
        "queue": frame.queue,
        "next": frame.following,
        "free_bytes": status.free_bytes,
        "bus": asdict(frame.bus),
        "loop": {key: _plain(value) for key, value in asdict(frame.loop).items()},
        "needles": needles_picture(frame.needles),
    }


def campaign_picture(campaign: CampaignLook) -> dict[str, Any]:
    """Return what a campaign that chooses its runs knows, and what it proposes."""
    look = campaign.look
    keys = ("name", "unit", "value", "standard_uncertainty", "wanted", "met", "mostly")
    return {
        "plan": campaign.plan,
        "runs": len(look.runs),
        "time": clock(look.time_s),
        "known": [
            {key: _plain(getattr(coefficient, key)) for key in keys}
            for coefficient in look.known_targets
        ],
        "causes": [{**asdict(cause), "met": cause.met} for cause in look.causes],
        "proposed": [
            {"what": in_words(run), "time": clock(cost_s), "why": why}
            for run, cost_s, why in zip(look.proposed, look.costs_s, look.whys, strict=True)
        ],
        "kept": [run.name for run in look.kept_runs],
        "left": clock(look.left_s),
        "remark": look.remark,
        "ending": "" if look.ending is None else str(look.ending),
        "notes": list(look.notes),
    }


def trace_picture(trace: SignalTrace) -> dict[str, Any]:
    """Return the points of a trace."""
    return {"first": trace.first, "start_s": trace.start_s, "values": table(trace.values)}


def notice_picture(notice: Notice, number_of_notice: int, at: str) -> dict[str, Any]:
    """Return something that happened; ``at`` is when the server heard of it."""
    return {
        "type": "notice",
        "id": number_of_notice,
        "at": at,
        "kind": notice.kind,
        "time_s": round(notice.time_s, 2),
        "text": notice.text,
    }


def outcome_picture(
    outcome: RunOutcome, needles: Needles | None, plan: int, folder: str, at: str
) -> dict[str, Any]:
    """Return how a run of a plan ended as the page shows it, ``at`` being its time."""
    return {
        "run": outcome.run,
        "kind": outcome.kind,
        "outcome": outcome.outcome,
        "periods": outcome.periods,
        "reason": outcome.reason,
        "plan": plan,
        "folder": folder,
        "at": at,
        "flags": [flag.message for flag in outcome.flags],
        "rows": [_row(harmonic) for harmonic in outcome.harmonics],
        "needles": needles_picture(needles),
    }


def number_of_time(value: float) -> float | None:
    """Return a time in seconds, to the microsecond."""
    return round(value, 6) if math.isfinite(value) else None


def needles_picture(needles: Needles | None) -> dict[str, Any] | None:
    """Return readings; ``None`` where there are none."""
    if needles is None:
        return None
    return {
        "values": table(np.asarray(needles.coefficients)),
        "widths": table(needles.half_widths),
        "final": needles.final,
    }


def _row(row: ChannelReading) -> dict[str, Any]:
    return {
        "channel": row.channel,
        "unit": row.unit,
        "mean": number(row.mean),
        "in_phase": number(row.in_phase),
        "quadrature": number(row.quadrature),
        "half_width": number(row.half_width),
    }


def _plain(value: Any) -> Any:
    return number(value) if isinstance(value, float) else value
