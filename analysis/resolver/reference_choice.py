"""Choice of the phase reference: the one asked for, or the best that the recording has."""

from dataclasses import dataclass, replace

from analysis.recording import Recording
from analysis.resolver.gaps import gap_in_words, without_gaps
from analysis.resolver.photocell import from_photocell
from analysis.resolver.reference import (
    NoReferenceError,
    PhaseReference,
    ReferenceSource,
    from_encoder,
    from_frequency,
)
from analysis.resolver.signal_reference import from_signal
from hardware.description.channels import DISPLACEMENTS, SHAFT_ANGLE
from hardware.description.errors import ConfigurationError, DataError

_MARKED = (ReferenceSource.PHOTOCELL, ReferenceSource.ENCODER)  # what has a mark on the shaft


@dataclass(frozen=True)
class ReferenceChoice:
    """Where the phase comes from: at most one of the first two, else the best of the recording.

    The order is photocell, encoder (channel ``shaft_angle``), displacement of the aft strut, of the
    fore strut, the set-point's frequency.

    Attributes
    ----------
    channel
        A channel whose fundamental is the reference; ``shaft_angle`` is read as an encoder.
    frequency_hz
        A known frequency, with phase 0 at the first sample.
    latency_s, angle_offset_rad
        Calibration of the photocell, or the offset of the encoder.
    """

    channel: str | None = None
    frequency_hz: float | None = None
    latency_s: float = 0.0
    angle_offset_rad: float = 0.0


def choose_reference(
    recording: Recording, choice: ReferenceChoice, holds_s: float | None = None
) -> PhaseReference:
    """Build the reference that was asked for, or the best one that the recording has.

    Parameters
    ----------
    holds_s
        A time at which the phase is needed: where samples of a signal or an encoder are missing,
        the stretch around it is used, and not the longest.

    Raises
    ------
    NoReferenceError
        If it cannot be had; the message says what was looked for.
    ConfigurationError
        If two are asked for, or a calibration is given that the reference does not have.
    """
    if choice.channel is not None and choice.frequency_hz is not None:
        raise ConfigurationError("give a reference channel or a frequency, not both")
    reference = _build(recording, choice, holds_s)
    _check_calibration(recording, reference, choice)
    return reference


def _build(recording: Recording, choice: ReferenceChoice, holds_s: float | None) -> PhaseReference:
    if choice.channel is not None:
        return _from_channel(recording, choice.channel, choice.angle_offset_rad, holds_s)
    if choice.frequency_hz is not None:
        return _from_frequency(recording, choice.frequency_hz)
    if recording.photocell_edges_s is not None and len(recording.photocell_edges_s):
        return from_photocell(
            recording.photocell_edges_s,
            latency_s=choice.latency_s,
            angle_offset_rad=choice.angle_offset_rad,
        )
    for name in (SHAFT_ANGLE.name, *DISPLACEMENTS):
        if name in recording.channel_names:
            return _from_channel(recording, name, choice.angle_offset_rad, holds_s)
    if recording.set_point is not None:
        reference = _from_frequency(recording, recording.set_point.frequency_hz)
        return replace(reference, source=ReferenceSource.SET_POINT)
    raise NoReferenceError(
        f"{recording.name}: no reference found: no photocell edges, no channel "
        f"{', '.join(map(repr, (SHAFT_ANGLE.name, *DISPLACEMENTS)))}, no set-point; give the "
        f"frequency or name a reference channel (channels: {', '.join(recording.channel_names)})"
    )


def _from_channel(
    recording: Recording, name: str, angle_offset_rad: float, holds_s: float | None
) -> PhaseReference:
    if name != SHAFT_ANGLE.name:
        return from_signal(recording, name, holds_s)
    complete, flags = without_gaps(recording.select([name]), name, holds_s)
    try:
        encoder = from_encoder(complete.time_s(), complete.values(name), angle_offset_rad)
    except DataError as error:
        raise NoReferenceError(f"{recording.name}: {error}{gap_in_words(flags)}") from None
    return replace(encoder, channel=name, flags=flags + encoder.flags)


def _from_frequency(recording: Recording, frequency_hz: float) -> PhaseReference:
    return from_frequency(frequency_hz, recording.start_s, recording.end_s)


def _check_calibration(
    recording: Recording, reference: PhaseReference, choice: ReferenceChoice
) -> None:
    source = reference.source
    if choice.latency_s and source is not ReferenceSource.PHOTOCELL:
        raise ConfigurationError(
            f"a latency is the photocell's, but the phase of {recording.name} comes from the "
            f"{source}; leave it out"
        )
    if choice.angle_offset_rad and source not in _MARKED:
        raise ConfigurationError(
            "an angle offset is that of a photocell or an encoder, but the phase of "
            f"{recording.name} comes from the {source}; leave it out"
        )
