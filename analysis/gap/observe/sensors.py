"""The simulated rig's sensors are those that the recordings hold."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import fields, replace

import numpy as np

from analysis.gap.observe.components import GapRun, Observation
from analysis.gap.observe.spectrum import loudness
from sim.acquisition.channels import Acquisition, Digitiser
from sim.acquisition.photocell import PhotocellStage
from sim.rig import SimulatedRig


def as_recorded(
    rig: SimulatedRig, runs: Sequence[GapRun], reference_channel: str | None
) -> SimulatedRig:
    """Return a rig that records what was recorded, and tells the phase by what told it.

    What the rig is believed to have stays as it is stated. A channel that was recorded without a
    word of it is a perfect one. Its noise, white and coloured, is what the lines between the
    harmonics of all runs show, where there are enough of them.
    """
    recorded = {component.channel for run in runs for component in run.observed.components}
    if reference_channel is not None:
        recorded.add(reference_channel)
    lines = {
        field.name: getattr(rig.acquisition, field.name) or Digitiser()
        for field in fields(Acquisition)
        if field.name in recorded
    }
    heard = {name: _as_loud(digitiser, runs, name) for name, digitiser in lines.items()}
    pulses = None if reference_channel is not None else rig.photocell or PhotocellStage()
    return replace(rig, acquisition=replace(rig.acquisition, **heard), photocell=pulses)


def with_resolution(
    rig: SimulatedRig, runs: Sequence[GapRun]
) -> tuple[tuple[GapRun, ...], dict[str, str]]:
    """Return the runs, each channel that does not move as uncertain as its resolution leaves it.

    That is the step over the root of twelve: of the step that is stated, else of the smallest that
    other runs show. Where neither is known the channel is left out of the run; the second part says
    so, by the run's name.
    """
    resolved_runs, said = [], {}
    for run in runs:
        still = [name for name, step in run.observed.steps.items() if math.isnan(step)]
        steps = {name: _resolution(rig, runs, name) for name in still}
        resolved_runs.append(replace(run, observed=_at_rest(run.observed, steps)))
        unknown = [name for name, step in steps.items() if not step]
        if unknown:
            said[run.name] = (
                f"{', '.join(unknown)} left out: never changes, and nothing tells the resolution; "
                f"state it as [acquisition] {unknown[0]} = {{ resolution = ... }}"
            )
    return tuple(resolved_runs), said


def heard_rms(runs: Sequence[GapRun], channel: str) -> float:
    """Return the white noise as loud as a channel is where its lines end; 0 with too few lines.

    Drift and wander are quiet there. A pole that hardly falls within the lines is not told apart
    from white noise, so the two terms count together.
    """
    quiet_runs = [run for run in runs if channel in run.observed.quiet]
    lines = [run.observed.quiet[channel] for run in quiet_runs]
    loud = loudness(lines)
    if loud is None:
        return 0.0
    rate_hz = float(np.median([run.sample_rate_hz for run in quiet_runs]))
    # Short runs have none.
    ends_hz = float(np.concatenate([record.frequency_hz for record in lines]).max())
    return math.sqrt(loud.at(ends_hz) * rate_hz)


def _at_rest(observation: Observation, steps: Mapping[str, float]) -> Observation:
    rows = [
        at
        for at, component in enumerate(observation.components)
        if steps.get(component.channel, 1.0)
    ]
    resolutions = np.array([steps.get(observation.components[at].channel, 0.0) for at in rows])
    return replace(
        observation,
        components=tuple(observation.components[at] for at in rows),
        values=observation.values[rows],
        uncertainty=np.hypot(observation.uncertainty[rows], resolutions / math.sqrt(12.0)),
    )


def _resolution(rig: SimulatedRig, runs: Sequence[GapRun], channel: str) -> float:
    stated = getattr(rig.acquisition, channel, None)
    if stated is not None and stated.resolution:
        return float(stated.resolution)
    steps = [run.observed.steps.get(channel, math.nan) for run in runs]
    return min((step for step in steps if math.isfinite(step)), default=0.0)


def _as_loud(digitiser: Digitiser, runs: Sequence[GapRun], channel: str) -> Digitiser:
    """Return a channel with the noise that is heard: white, and behind one pole."""
    quiet_runs = [run for run in runs if channel in run.observed.quiet]
    loud = loudness(run.observed.quiet[channel] for run in quiet_runs)
    if loud is None:
        return digitiser
    rate_hz = float(np.median([run.sample_rate_hz for run in quiet_runs]))
    corner = 2.0 * math.pi * loud.corner_hz
    return replace(
        digitiser,
        noise_rms=math.sqrt(loud.white * rate_hz),
        walk_per_sqrt_s=math.sqrt(loud.coloured) * corner,
        walk_corner_hz=loud.corner_hz,
    )
