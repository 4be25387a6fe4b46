"""A record at rest as one more run: its blocks take the place of periods, its means are compared.

What acts on motion alone is not in it: a zero that is off stays, friction and what else has a mean
only while the model moves does not. What drifts goes on.
"""

from dataclasses import replace

from analysis.coefficients.corrections import ZERO_BLOCKS, zero_reading
from analysis.gap.observe.components import Component, GapRun, Observation, Part
from analysis.gap.observe.plateau import steps_of
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.channels import DISPLACEMENTS, FORCES
from hardware.description.errors import DataError
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.rest import rig_at_rest, state_at_rest
from sim.rig import SimulatedRig
from sim.run import simulate


def run_at_rest(recording: Recording, place: CampaignRun, set_point: SetPoint) -> GapRun:
    """Return a record at rest as the diagnosis sees it.

    Where its struts stand is taken from the record; from the middle where nothing tells.

    Parameters
    ----------
    set_point
        Carriage speed, medium and drift count.

    Raises
    ------
    DataError
        If the recording has no force, too few samples, or some are missing.
    """
    duration_s = recording.sample_count / recording.sample_rate_hz
    point = replace(set_point, frequency_hz=ZERO_BLOCKS / duration_s, eccentricity_m=0.0)
    aft_m, fore_m = (
        float(recording.values(channel).mean()) if channel in recording.channel_names else 0.0
        for channel in DISPLACEMENTS
    )
    return GapRun(
        recording.name,
        point,
        place,
        observe_at_rest(recording),
        ZERO_BLOCKS,
        recording.sample_rate_hz,
        stands_at_m=(aft_m, fore_m),
    )


def observe_at_rest(recording: Recording) -> Observation:
    """Return each gauge's mean, with the scatter between the blocks.

    Raises
    ------
    DataError
        As :func:`run_at_rest`.
    """
    names = tuple(channel for channel in FORCES if channel in recording.channel_names)
    if not names:
        raise DataError(
            f"{recording.name}: no channel {' or '.join(FORCES)}; the diagnosis compares forces"
        )
    means = zero_reading(recording, names)
    parts = tuple(Component(name, Part.MEAN) for name in names)
    steps = steps_of(recording.select(names))
    return Observation(parts, means.values.real, means.standard_uncertainty.real, steps=steps)


def steady_at_rest(rig: SimulatedRig, set_point: SetPoint, run: GapRun) -> FloatArray:
    """Return the components of a standing rig in the order of a run's: means, and what is done."""
    state = state_at_rest(rig, set_point, run.stands_at_m or (0.0, 0.0), run.applied)
    return run.observed.layout.read(state.spectra)


def record_at_rest(rig: SimulatedRig, set_point: SetPoint, run: GapRun, seed: int) -> Observation:
    """Return what a simulated record at rest shows, of the same length, at the struts' middle."""
    from analysis.readers.dataset import from_dataset

    dataset = simulate(
        rig_at_rest(rig),
        set_point,
        periods=run.periods - 1,  # a simulated record is one longer
        settling_periods=0,
        sample_rate_hz=run.sample_rate_hz,
        seed=seed,
        name=run.name,
    )
    return observe_at_rest(from_dataset(dataset))
