"""What tells the phase of a run in the diagnosis: the simulation has to be able to tell it too."""

from dataclasses import replace

import numpy as np

from analysis.recording import Recording
from analysis.resolver.reference import from_encoder
from analysis.resolver.reference_choice import ReferenceChoice
from hardware.description.channels import DISPLACEMENTS, FORCES, SHAFT_ANGLE
from hardware.description.errors import DataError


def choose_phase(
    recording: Recording, reference: ReferenceChoice = ReferenceChoice()
) -> tuple[Recording, ReferenceChoice]:
    """Return what the phase comes from, and the recording with the pulses that this takes.

    What the campaign names comes first, then the photocell, a strut's displacement, the encoder,
    and a force. The encoder counts as a photocell whose pulses are its whole turns: so its own
    harmonics are still compared. A channel that the rig does not have, such as a synchro signal,
    tells the phase as a photocell would.

    Raises
    ------
    DataError
        If nothing in the recording tells the phase.
    """
    names, edges = recording.channel_names, recording.photocell_edges_s
    has_pulses = edges is not None and len(edges) > 1
    if reference.channel is not None and reference.channel != SHAFT_ANGLE.name:
        recording.index(reference.channel)
        return recording, ReferenceChoice(channel=reference.channel)
    if has_pulses and reference.channel is None:
        return recording, replace(reference, channel=None, frequency_hz=None)
    encoder = SHAFT_ANGLE.name in names
    for name in DISPLACEMENTS if reference.channel is None or not encoder else ():
        if name in names:
            return recording, ReferenceChoice(channel=name)
    if encoder:
        return _turns(recording, reference.angle_offset_rad), ReferenceChoice()
    for name in FORCES:
        if name in names:
            return recording, ReferenceChoice(channel=name)
    raise DataError(f"{recording.name}: nothing in it tells the phase")


def _turns(recording: Recording, angle_offset_rad: float) -> Recording:
    """Return a recording with a pulse at each whole turn of its encoder."""
    times_s, angle_rad = recording.time_s(), recording.values(SHAFT_ANGLE.name)
    is_finite = np.isfinite(angle_rad)
    encoder = from_encoder(times_s[is_finite], angle_rad[is_finite], angle_offset_rad)
    first, last = encoder.cycles[0], encoder.cycles[-1]
    pulses = encoder.times_at(np.arange(np.ceil(first), np.floor(last) + 1.0))
    return replace(recording, photocell_edges_s=pulses)
