"""A campaign's tows with propeller and rudder, read and identified."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from analysis.steering.identification import SteeringParameters, identified
from analysis.steering.observations import Particulars, SteeringRuns
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.flags import Flag, Severity
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.water import TankWater
from pmm.coefficients.reading import read_zero
from pmm.coefficients.settings import settings_of
from pmm.coefficients.stated_inputs import chain_of, oscillator_of
from pmm.coefficients.tasks import FailedRecording, Task
from pmm.coefficients.work import Work, work_of
from pmm.steering.instants import HARMONICS, only_sways
from pmm.steering.reading import GAUGES, SteeredRun, read_gauge_zeros, read_steered, zeroed_names
from pmm.steering.settings import SETTINGS_FILE, SteeringSettings, read_steering_settings

_SMALLEST: Final = 1e-9  # of the largest mean: the scatter of a record without any noise


@dataclass(frozen=True, eq=False)
class CampaignSteering:
    """What a campaign tells of propeller and rudder.

    Attributes
    ----------
    tows, runs
        As they were read, in their order; the same as the equations take them.
    failed, left_out
        Runs that could not be used, and those that are none of propeller and rudder, and why.
    water
        Of the campaign, where its file says.
    """

    name: str
    settings: SteeringSettings
    particulars: Particulars
    tows: tuple[SteeredRun, ...]
    runs: SteeringRuns
    parameters: SteeringParameters
    failed: tuple[FailedRecording, ...]
    left_out: tuple[Flag, ...] = ()
    water: TankWater | None = None


def steering_of(folder: Path, settings_path: Path | None = None) -> CampaignSteering:
    """Read a campaign's tows with a turning propeller and identify the parameters.

    Parameters
    ----------
    folder
        With the campaign file, and ``steering.toml`` where ``settings_path`` is ``None``.

    Raises
    ------
    ConfigurationError
        If a file is wrong, or none states the water's density.
    DataError
        If there is no such run, or the runs do not tell the parameters.
    """
    campaign = read_campaign(folder / CAMPAIGN_FILE)
    settings = read_steering_settings(
        folder / SETTINGS_FILE if settings_path is None else settings_path
    )
    density = _density_kg_m3(campaign, settings)
    work = _work(campaign, folder)
    tows, failed = _tows(work)
    if not tows:
        messages = "; ".join(failure.message for failure in failed)
        raise DataError(messages or _no_runs_message(folder))
    particulars, runs = settings.particulars(density), steering_runs(tows)
    parameters = identified(runs, particulars, settings.towing_force_n)
    return CampaignSteering(
        campaign.name,
        settings,
        particulars,
        tuple(tows),
        runs,
        parameters,
        tuple(failed),
        (*work.left_out, *map(_sways, filter(only_sways, work.runs))),
        campaign.water,
    )


def _density_kg_m3(campaign: Campaign, settings: SteeringSettings) -> float:
    if settings.density_kg_m3 is not None:
        return settings.density_kg_m3
    if campaign.water is None:
        raise ConfigurationError(
            f"the water's density is not stated: write [water] in {CAMPAIGN_FILE}, or "
            f"density_kg_m3 in {SETTINGS_FILE}"
        )
    return campaign.water.density_kg_m3


def _sways(task: Task) -> Flag:
    why = "left out: it sways without a turn; of oscillations with propeller and rudder take yaw"
    return Flag("run_left_out", Severity.NOTE, why, None, (task.name,))


def _no_runs_message(folder: Path) -> str:
    return (
        f"{folder / CAMPAIGN_FILE}: no recorded tow has a turning propeller or a laid rudder; give "
        "revolutions_hz and rudder_angle_deg of the runs in [[at_rest]]"
    )


def _work(campaign: Campaign, folder: Path) -> Work:
    oscillator = oscillator_of(campaign, folder)
    if oscillator.plane != "horizontal":
        raise ConfigurationError(
            f"{folder / CAMPAIGN_FILE}: oscillator.plane is {oscillator.plane}; rudder and "
            "propeller are measured in the horizontal plane"
        )
    coefficients, _ = settings_of(folder, None)
    return work_of(
        campaign,
        folder,
        oscillator,
        chain_of(coefficients),
        harmonics=HARMONICS,
        with_steering=True,
    )


def _tows(work: Work) -> tuple[list[SteeredRun], list[FailedRecording]]:
    wanted = [task for task in work.runs if not only_sways(task)]
    names = zeroed_names(wanted)
    failed: list[FailedRecording] = []
    strut_zeros, gauge_zeros = {}, {}
    for task in work.zeros:
        if task.name not in names:
            continue
        struts, gauges = read_zero(task), read_gauge_zeros(task)
        failed += [reading for reading in (struts, gauges) if isinstance(reading, FailedRecording)][
            :1
        ]
        if not isinstance(struts, FailedRecording) and struts.zero is not None:
            strut_zeros[task.name] = struts.zero
        if not isinstance(gauges, FailedRecording):
            gauge_zeros[task.name] = gauges
    runs: list[SteeredRun] = []
    for task in wanted:
        result = read_steered(task.with_zeros(strut_zeros), gauge_zeros)
        if isinstance(result, FailedRecording):
            failed.append(result)
        else:
            runs += result
    return runs, failed


def steering_runs(runs: Sequence[SteeredRun]) -> SteeringRuns:
    """Return runs as the equations take them: loads about the midpoint, X ahead."""
    values = np.array([(*run.loads, run.thrust_n, run.normal_n) for run in runs]).T
    spread = np.array([(*run.loads_u, run.thrust_u, run.normal_u) for run in runs]).T
    least = _SMALLEST * np.abs(values).max(axis=1, keepdims=True)
    return SteeringRuns(
        tuple(run.run for run in runs),
        np.array([run.motion for run in runs]).T,
        np.array([run.rudder_rad for run in runs]),
        np.array([run.rate_hz for run in runs]),
        values,
        np.maximum(spread, least),
        _shared(runs),
        tuple(run.course for run in runs),
    )


def _shared(tows: Sequence[SteeredRun]) -> FloatArray:
    """Return what the zeros' readings add to thrust and normal force of the runs they serve."""
    keys = sorted({key for tow in tows for key in tow.zero_u})
    shared = np.zeros((5, len(tows), len(keys)))
    for k, key in enumerate(keys):
        shared[3 + GAUGES.index(key[1]), :, k] = [tow.zero_u.get(key, 0.0) for tow in tows]
    return shared
