"""Sinkage and trim of a model, from the positions of two of its points.

Both points lie on a line along the model. One that stands ``x`` ahead of the reference point is at
``z = z_0 - x sin(theta)`` below its place at rest, with z down and the trim theta positive bow up
(ITTC 7.5-02-02-01). So, exactly at any trim, ``sin(theta) = (z_aft - z_fore) / (x_fore - x_aft)``.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.recording import Recording
from analysis.resolver.harmonics import Harmonics
from hardware.description.attitude import AttitudeSensors
from hardware.description.channels import POSITIONS, Channel
from hardware.description.errors import DataError

SINKAGE: Final = Channel("sinkage", "m")
TRIM: Final = Channel("trim", "rad")
NAMES: Final = (SINKAGE.name, TRIM.name)
HARMONICS: Final = 2


@dataclass(frozen=True)
class RestPosition:
    """Means of both sensors at rest, aft first, with their standard uncertainties, in metres."""

    mean_m: tuple[float, float]
    uncertainty_m: tuple[float, float]


@dataclass(frozen=True)
class AttitudeChannel:
    """A mean and the amplitudes of the first harmonics, with standard uncertainties.

    The uncertainties of amplitudes are those along the phasor. Tows have no harmonics.
    """

    mean: float
    mean_u: float
    amplitude: tuple[float, ...] = ()
    amplitude_u: tuple[float, ...] = ()


@dataclass(frozen=True)
class Attitude:
    """Sinkage in metres, positive down, and trim in radians, positive bow up, of one run."""

    sensors: AttitudeSensors
    sinkage: AttitudeChannel
    trim: AttitudeChannel


def common_rest(rests: Sequence[RestPosition]) -> RestPosition:
    """Return the mean of what was read before and after a run."""
    means = np.mean([rest.mean_m for rest in rests], axis=0)
    uncertainty_m = np.linalg.norm([rest.uncertainty_m for rest in rests], axis=0) / len(rests)
    return RestPosition(
        (float(means[0]), float(means[1])), (float(uncertainty_m[0]), float(uncertainty_m[1]))
    )


def with_attitude(recording: Recording, sensors: AttitudeSensors, rest: RestPosition) -> Recording:
    """Return the recording with the channels ``sinkage`` and ``trim`` behind its own.

    Raises
    ------
    DataError
        If the positions differ by more than the sensors' distance, which no trim can make.
    """
    aft, fore = (
        recording.values(name) - mean_m for name, mean_m in zip(POSITIONS, rest.mean_m, strict=True)
    )
    distance = sensors.fore_x_m - sensors.aft_x_m
    sine = (aft - fore) / distance
    if (most := float(np.nanmax(np.abs(sine)))) > 1.0:
        raise DataError(
            f"{recording.name}: {' and '.join(POSITIONS)} differ by {most * distance:.4g} m, more "
            f"than the {distance:g} m between the sensors; check their units and [attitude]"
        )
    sinkage = aft - (sensors.sinkage_x_m - sensors.aft_x_m) * sine
    samples = recording.samples[0 : len(recording.channels), 0 : recording.sample_count]
    return replace(
        recording,
        channels=(*recording.channels, SINKAGE, TRIM),
        samples=np.vstack([samples, sinkage, np.arcsin(sine)]),
    )


def attitude(
    sensors: AttitudeSensors, rest: RestPosition, sinkage: AttitudeChannel, trim: AttitudeChannel
) -> Attitude:
    """Return what was measured, with the rest's uncertainty in both means."""
    distance = sensors.fore_x_m - sensors.aft_x_m
    share = (sensors.sinkage_x_m - sensors.aft_x_m) / distance
    aft_u, fore_u = rest.uncertainty_m
    angle_u = math.hypot(aft_u, fore_u) / (distance * math.cos(trim.mean))
    height_u = math.hypot((1.0 - share) * aft_u, share * fore_u)
    return Attitude(
        sensors,
        replace(sinkage, mean_u=math.hypot(sinkage.mean_u, height_u)),
        replace(trim, mean_u=math.hypot(trim.mean_u, angle_u)),
    )


def measured(harmonics: Harmonics, name: str) -> AttitudeChannel:
    """Return a channel's mean and amplitudes with the resolver's own uncertainties."""
    row = harmonics.channel_names.index(name)
    sizes, deviations = harmonics.amplitude[row], harmonics.deviations[row]
    projections = [
        (
            harmonics.in_phase[row, k] * deviations[2 * k + 1]
            + harmonics.quadrature[row, k] * deviations[2 * k + 2]
        )
        / max(sizes[k], np.finfo(float).tiny)
        for k in range(harmonics.order)
    ]
    return AttitudeChannel(
        float(harmonics.mean[row]),
        float(harmonics.standard_uncertainty[row, 0]),
        tuple(map(float, sizes)),
        tuple(float(np.linalg.norm(part)) for part in projections),
    )
