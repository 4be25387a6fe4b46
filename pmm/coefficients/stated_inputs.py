"""What a campaign's files say beside its recordings: inertia, restoring, chain, uncertainties."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_plan import OWN_MODEL
from analysis.coefficients.stated_uncertainties import STATED, StatedUncertainties
from analysis.coefficients.steady_turns import SteadyTurn, of_turns
from analysis.ideal_rig import weight_matrix
from analysis.response.following import Following
from hardware.description.arrays import FloatArray
from hardware.description.body import Body
from hardware.description.channels import FORCES
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from hardware.description.oscillator import Oscillator
from pmm.campaign.calibration import Calibration, read_calibration
from pmm.campaign.campaign import Campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.model_uncertainty import ModelUncertainty, take_uncertainty
from pmm.campaign.runs import Run
from pmm.coefficients.settings import DRY, MODEL, CoefficientSettings
from pmm.coefficients.tasks import MeasuringChain
from pmm.configuration import Fault, as_error, limit_faults, read_toml, validate

_BODY = ("mass_kg", "inertia_kg_m2", "cg_x_m", "cg_z_m")
_BORNE = ("displaced_kg", "buoyancy_x_m", "buoyancy_z_m")
_GAUGES = {
    (FORCES[0], FORCES[0]): "gauge_aft_relative",
    (FORCES[0], FORCES[1]): "cross_talk_aft",
    (FORCES[1], FORCES[0]): "cross_talk_fore",
    (FORCES[1], FORCES[1]): "gauge_fore_relative",
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


def body_of(
    campaign: Campaign, inertia: str | None, *, has_dry: bool
) -> tuple[Body | None, tuple[ModelUncertainty, ...]]:
    """Return the body that is taken off, ``None`` where dry runs are, and what is uncertain of it.

    Raises
    ------
    ConfigurationError
        If there is no such table, file or run: the message says what would do it.
    """
    if inertia == DRY or (inertia is None and campaign.model is None and has_dry):
        if not has_dry:
            raise ConfigurationError(
                f"campaign {campaign.name!r}: no dry run to take off; run the same set-points in "
                'air (kind = "dry"), or give the inertia'
            )
        return None, ()
    if inertia is not None and inertia != MODEL:
        return _model_file(Path(inertia), campaign.model)
    if campaign.model is None:
        raise ConfigurationError(
            f"campaign {campaign.name!r}: no inertia to take off: copy [model] of `pmm inertia "
            "... --output model.toml` (a swing or a bifilar test) into the campaign file, name "
            'that file with --inertia, or add a dry run (kind = "dry") at each set-point'
        )
    run_uncertainties = [campaign.as_recorded(run.name).model_uncertainty for run in campaign.runs]
    uncertainties = [
        uncertainty
        for uncertainty in (campaign.model_uncertainty, *run_uncertainties)
        if uncertainty is not None
    ]
    return campaign.model, tuple(dict.fromkeys(uncertainties))


def with_own_body(
    cycle: BodyCycle, campaign: Campaign, settings: CoefficientSettings, body: Body | None
) -> BodyCycle:
    """Return a cycle with what is to be taken off: the body, or the one it was recorded with.

    Parameters
    ----------
    body
        Of the campaign; ``None`` where dry runs are taken off.
    """
    recorded = campaign.as_recorded(cycle.name)
    restoring = restoring_of(recorded, settings)
    if body is None and recorded.model is not None:  # a dry run has the weight, not the buoyancy
        borne = replace(recorded.model, mass_kg=0.0)
        restoring = restoring + weight_matrix(borne, cycle.plane, cycle.medium)
    cycle_body = recorded.model if settings.inertia in (None, MODEL) else body
    if body is None or cycle_body is None or cycle_body == body:
        return cycle.without(body, restoring)
    text = f"the model that it was recorded with is taken off ({cycle_body.mass_kg:g} kg)"
    flag = Flag(OWN_MODEL, Severity.NOTE, text, None, (cycle.name,))
    bare_cycle = cycle.without(cycle_body, restoring)
    return replace(bare_cycle, flags=(*bare_cycle.flags, flag))


def in_still_air(
    cycle: BodyCycle, campaign: Campaign, settings: CoefficientSettings, body: Body
) -> BodyCycle:
    """Return a dry run with the body that is to be taken off; nothing restores it."""
    return replace(with_own_body(cycle, campaign, settings, body), restoring=np.zeros((2, 2)))


def _model_file(
    path: Path, campaign_body: Body | None
) -> tuple[Body, tuple[ModelUncertainty, ...]]:
    """Return the file's body; what the water bears, which no swing tells, is the campaign's own."""
    original: dict[str, Any] = read_toml(path)
    table = dict(original)
    faults: list[Fault] = list(limit_faults(table))
    uncertainty = take_uncertainty(table, faults)
    model = table.get("model")
    if not isinstance(model, dict):
        faults.append(Fault(("model",), "is missing; `pmm inertia ... --output` writes it"))
        model = {}
    water_values = (
        {}
        if campaign_body is None or campaign_body.displaced_kg is None
        else {k: vars(campaign_body)[k] for k in _BORNE}
    )
    body = validate(Body, water_values | model, faults)
    if body is None or faults:
        raise as_error(path, faults, original)
    return body, () if uncertainty is None else (uncertainty,)


def restoring_of(campaign: Campaign, settings: CoefficientSettings) -> FloatArray:
    """Return the hydrostatic restoring about the midpoint, shape ``(2, 2)``."""
    restoring = settings.restoring
    return np.array(campaign.hull.restoring if restoring is None else restoring, dtype=np.float64)


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
    """Return what a calibration leaves open, of the struts' gauges that it was made of."""
    rows = {
        name: calibration.channels.index(name) for name in FORCES if name in calibration.channels
    }
    spread = calibration.force_uncertainty
    return StatedUncertainties(
        **{
            _GAUGES[force, loaded]: float(spread[i, j])
            for force, i in rows.items()
            for loaded, j in rows.items()
        }
    )


def without_dry(cycle: BodyCycle, dry: Sequence[BodyCycle], campaign: Campaign) -> BodyCycle:
    """Return a cycle less the dry run of its motion, made with its model.

    Raises
    ------
    ConfigurationError
        If none of them has it; the message says which would do.
    """
    refusals = []
    model = campaign.as_recorded(cycle.name).model
    for dry_run in (run for run in dry if campaign.as_recorded(run.name).model == model):
        try:
            return cycle.without_dry(dry_run)
        except ConfigurationError as error:
            refusals.append(str(error))
    amplitude = abs(cycle.motion)
    raise ConfigurationError(
        f"{cycle.name}: no dry run has its motion; run it in air at {cycle.frequency_hz:g} Hz with "
        f"{1e3 * amplitude[0]:.3g} mm and {amplitude[1]:.3g} rad, or give the inertia"
        + (f" ({refusals[0]})" if len(refusals) == 1 else "")
    )
