"""What a campaign's files say beside its recordings: rig, measuring chain, uncertainties."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from analysis.coefficients.stated_uncertainties import STATED, StatedUncertainties
from analysis.coefficients.steady_turns import SteadyTurn, of_turns
from analysis.response.following import Following
from hardware.description.arrays import FloatArray
from hardware.description.channels import FORCE_X, FORCES
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Oscillator
from pmm.campaign.calibration import Calibration, read_calibration
from pmm.campaign.campaign import Campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.model_uncertainty import ModelUncertainty
from pmm.campaign.runs import Run
from pmm.coefficients.settings import CoefficientSettings
from pmm.coefficients.tasks import MeasuringChain

_BODY = ("mass_kg", "inertia_kg_m2", "cg_x_m", "cg_z_m")
_GAUGES = {
    (FORCES[0], FORCES[0]): "gauge_aft_relative",
    (FORCES[0], FORCES[1]): "cross_talk_aft",
    (FORCES[1], FORCES[0]): "cross_talk_fore",
    (FORCES[1], FORCES[1]): "gauge_fore_relative",
    (FORCE_X.name, FORCE_X.name): "surge_gauge_relative",
}


def oscillator_of(campaign: Campaign, folder: Path) -> Oscillator:
    """Return the campaign's oscillator.

    Raises
    ------
    ConfigurationError
        If the file has none.
    """
    if campaign.oscillator is None:
        raise ConfigurationError(
            f"{folder / CAMPAIGN_FILE}: no table [oscillator]; the struts' plane and spacing are "
            "needed to make motion and loads of them"
        )
    return campaign.oscillator


def chain_of(settings: CoefficientSettings) -> MeasuringChain:
    """Return what is known of the measuring chain.

    Raises
    ------
    ConfigurationError
        If the calibration file is none, or both a file and a matrix are given.
    """
    if settings.calibration is not None and settings.calibration_matrix is not None:
        raise ConfigurationError("calibration and calibration_matrix are both given; one is enough")
    by_hand = settings.calibration_matrix
    return MeasuringChain(
        None if settings.calibration is None else _of_both(Path(settings.calibration)),
        None if by_hand is None else np.array(by_hand),
        settings.amplifiers,
    )


def _of_both(path: Path) -> Calibration:
    """Read a calibration of both struts' gauges."""
    calibration = read_calibration(path)
    missing = [name for name in FORCES if name not in calibration.channels]
    if missing:
        raise ConfigurationError(
            f"{path}: nothing of {' and '.join(missing)} (channels: "
            f"{', '.join(calibration.channels)})"
        )
    return calibration


def stated_of(
    campaign: Campaign,
    settings: CoefficientSettings,
    models: Sequence[ModelUncertainty],
    calibrations: Sequence[Calibration],
    *,
    motion_asked: bool,
    following: Sequence[Sequence[Following]] = (),
    speed_age_s: float = 0.0,
) -> StatedUncertainties:
    """Return the standard uncertainties: the settings', else those of inertia, gauges, set-points.

    Parameters
    ----------
    models, calibrations
        Of the bodies that are taken off, and that made readings forces; of several the larger
        counts.
    motion_asked
        Whether set-points stand in for displacements that were not measured: then it matters how
        well eccentricity and phase were set.
    following
        How the struts of each run followed that were led by set-points. What is not known of their
        displacements is then what the runs state of eccentricity and phase, since no other
        sensor's uncertainty is; and where set-points stand in for the displacements of other runs,
        those are off by as much.
    speed_age_s
        What the records leave open of the age of a led carriage's speed.
    """
    is_led = any(following)
    uses_set_points = motion_asked or is_led
    set_points = StatedUncertainties(**(_of_set_points(campaign.runs) if uses_set_points else {}))
    uncertainties = [
        StatedUncertainties(speed_age_s=speed_age_s),
        *([of_following(following)] if motion_asked and is_led else []),
        *map(of_model, models),
        *map(of_gauges, calibrations),
    ]
    by_files = largest([set_points, *uncertainties])
    in_settings, from_files = settings.uncertainty, by_files
    freedom = (
        from_files if in_settings.inertia_kg_m2 == 0.0 else in_settings
    ).inertia_degrees_of_freedom
    return _stated(
        np.where(in_settings.vector == 0.0, from_files.vector, in_settings.vector), freedom
    )


def largest(uncertainties: Sequence[StatedUncertainties]) -> StatedUncertainties:
    """Return the largest of each standard uncertainty."""
    inertia = max(uncertainties, key=lambda uncertainty: uncertainty.inertia_kg_m2)
    vector = np.max([uncertainty.vector for uncertainty in uncertainties], axis=0)
    return _stated(vector, inertia.inertia_degrees_of_freedom)


def with_turns(stated: StatedUncertainties, turns: Sequence[SteadyTurn]) -> StatedUncertainties:
    """Return it with what runs on a circle say of rate and radius where nothing is stated."""
    vector = np.where(stated.vector == 0.0, of_turns(turns).vector, stated.vector)
    return _stated(vector, stated.inertia_degrees_of_freedom)


def _stated(vector: FloatArray, freedom: float) -> StatedUncertainties:
    values = dict(zip(STATED, vector.tolist(), strict=True))
    return StatedUncertainties(**values, inertia_degrees_of_freedom=freedom)


def of_model(model: ModelUncertainty) -> StatedUncertainties:
    """Return what is uncertain of the body that is taken off."""
    freedom = model.inertia_degrees_of_freedom
    values = {name: getattr(model, name) for name in _BODY}
    stated_freedom = freedom if np.isfinite(freedom) else 0.0
    return StatedUncertainties(**values, inertia_degrees_of_freedom=stated_freedom)


def _of_set_points(runs: Sequence[Run]) -> dict[str, float]:
    relative = [run.u_eccentricity_m / run.eccentricity_m for run in runs if run.eccentricity_m > 0]
    return {
        "amplitude_relative": max(relative, default=0.0),
        "strut_phase_rad": max((run.u_strut_phase_rad for run in runs), default=0.0),
    }


def of_following(runs: Sequence[Sequence[Following]]) -> StatedUncertainties:
    """Return by how much set-points are off that stand in for struts like these."""
    followings = [following for run in runs for following in run]
    return StatedUncertainties(
        amplitude_relative=max(abs(following.amplitude_relative) for following in followings),
        strut_phase_rad=max(abs(run[0].phase_rad - run[-1].phase_rad) for run in runs if run),
        latency_s=max(
            abs(following.phase_rad) / (2.0 * np.pi * following.frequency_hz)
            for following in followings
        ),
    )


def of_gauges(calibration: Calibration) -> StatedUncertainties:
    """Return what a calibration leaves open, of the gauges that it was made of."""
    spread, channels = calibration.force_uncertainty, calibration.channels
    return StatedUncertainties(
        **{
            key: float(spread[channels.index(force), channels.index(loaded)])
            for (force, loaded), key in _GAUGES.items()
            if force in channels and loaded in channels
        }
    )
