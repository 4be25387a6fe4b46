"""Which channels of a recording are analysed, and which one tells the phase."""

from dataclasses import replace
from typing import TYPE_CHECKING

from analysis.resolver.analyse import Analysis, ReferenceChoice, Settings, analyse
from analysis.resolver.reference import ReferenceSource
from hardware.description.channels import DISPLACEMENT_AFT, SHAFT_ANGLE
from hardware.description.errors import ConfigurationError, DataError

if TYPE_CHECKING:
    from analysis.recording import Recording


def analyse_recording(
    recording: "Recording", choice: ReferenceChoice, settings: Settings
) -> Analysis:
    """Analyse the channels chosen, or all but the reference and the shaft angle.

    Raises
    ------
    DataError
        As :func:`analysis.resolver.analyse.analyse` does.
    ConfigurationError
        If a photocell's latency or a mark's angle is given for a reference that has none.
    """
    if not settings.channels:
        left_out = (reference_channel(recording, choice), SHAFT_ANGLE.name)
        names = tuple(name for name in recording.channel_names if name not in left_out)
        settings = replace(settings, channels=names)
        if not names:
            raise DataError(
                f"{recording.name}: no channel is left beside the reference; name it with --channel"
            )
    analysis = analyse(recording, choice, settings)
    _check_calibration(analysis, choice)
    return analysis


def reference_channel(recording: "Recording", choice: ReferenceChoice) -> str | None:
    """Return the channel that will tell the phase, ``None`` if it is not a channel that does."""
    if choice.channel is not None or choice.frequency_hz is not None:
        return choice.channel
    edges = recording.photocell_edges_s
    if edges is not None and len(edges):
        return None
    ways = (SHAFT_ANGLE.name, DISPLACEMENT_AFT.name)
    return next((name for name in ways if name in recording.channel_names), None)


def _check_calibration(analysis: Analysis, choice: ReferenceChoice) -> None:
    source = analysis.reference.source
    if choice.latency_s and source is not ReferenceSource.PHOTOCELL:
        raise ConfigurationError(
            f"a latency is the photocell's, but the phase of {analysis.recording.name} comes from "
            f"the {source}; leave it out"
        )
    if choice.angle_offset_rad and source in (ReferenceSource.FREQUENCY, ReferenceSource.SIGNAL):
        raise ConfigurationError(
            "an angle offset is that of a photocell or an encoder, but the phase of "
            f"{analysis.recording.name} comes from the {source}; leave it out"
        )
