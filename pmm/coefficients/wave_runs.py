"""A campaign's runs in waves, each beside the same run in calm water."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from analysis.coefficients.body_cycle import BodyCycle
from analysis.response.waves import InWaves
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign import Campaign
from pmm.coefficients.tasks import ReadRecording


@dataclass(frozen=True, eq=False)
class WaveRun:
    """One run in waves.

    Attributes
    ----------
    cycle
        Without the waves' lines, the mean as it was in waves.
    calm
        That of the same set-point in calm water; ``None`` where it was not made.
    """

    waves: InWaves
    cycle: BodyCycle
    calm: BodyCycle | None


def wave_runs(campaign: Campaign, recordings: Sequence[ReadRecording]) -> Iterator[WaveRun]:
    """Yield the runs in waves that were read."""
    points = {run.name: run.set_point for run in campaign.runs}
    cycles = {
        recording.name: recording.cycle for recording in recordings if recording.cycle is not None
    }
    calm = {
        points[name]: cycle
        for name, cycle in cycles.items()
        if name in points and not points[name].wave_frequency_hz
    }
    for recording in recordings:
        if recording.waves is not None and recording.cycle is not None:
            yield WaveRun(recording.waves, recording.cycle, calm.get(_calm(recording.waves.point)))


def _calm(point: SetPoint) -> SetPoint:
    default = SetPoint(0.0, 0.0)
    return replace(
        point,
        wave_frequency_hz=default.wave_frequency_hz,
        wave_amplitude_m=default.wave_amplitude_m,
        wave_heading_rad=default.wave_heading_rad,
    )
