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
    one = read_calibration(path)
    missing = [name for name in FORCES if name not in one.channels]
    if missing:
        raise ConfigurationError(
            f"{path}: nothing of {' and '.join(missing)} (channels: {', '.join(one.channels)})"
        )
    return one


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
    own = [campaign.as_recorded(one.name).model_uncertainty for one in campaign.runs]
    known = [one for one in (campaign.model_uncertainty, *own) if one is not None]
    return campaign.model, tuple(dict.fromkeys(known))


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
    own = recorded.model if settings.inertia in (None, MODEL) else body
    if body is None or own is None or own == body:
        return cycle.without(body, restoring)
    text = f"the model that it was recorded with is taken off ({own.mass_kg:g} kg)"
    flag = Flag(OWN_MODEL, Severity.NOTE, text, None, (cycle.name,))
    found = cycle.without(own, restoring)
    return replace(found, flags=(*found.flags, flag))


def _model_file(path: Path, own: Body | None) -> tuple[Body, tuple[ModelUncertainty, ...]]:
    """Return the file's body; what the water bears, which no swing tells, is the campaign's own."""
    original: dict[str, Any] = read_toml(path)
    table = dict(original)
    faults: list[Fault] = list(limit_faults(table))
    uncertainty = take_uncertainty(table, faults)
    model = table.get("model")
    if not isinstance(model, dict):
        faults.append(Fault(("model",), "is missing; `pmm inertia ... --output` writes it"))
        model = {}
    borne = {} if own is None or own.displaced_kg is None else {k: vars(own)[k] for k in _BORNE}
    body = validate(Body, borne | model, faults)
    if body is None or faults:
        raise as_error(path, faults, original)
    return body, () if uncertainty is None else (uncertainty,)


def restoring_of(campaign: Campaign, settings: CoefficientSettings) -> FloatArray:
    """Return the hydrostatic restoring about the midpoint, shape ``(2, 2)``."""
    given = settings.restoring
    return np.array(campaign.hull.restoring if given is None else given, dtype=np.float64)


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
    led = any(following)
    own_set = motion_asked or led
    set_points = StatedUncertainties(**(_of_set_points(campaign.runs) if own_set else {}))
    known = [
        StatedUncertainties(speed_age_s=speed_age_s),
        *([of_following(following)] if motion_asked and led else []),
        *map(of_model, models),
        *map(of_gauges, calibrations),
    ]
    by_files = largest([set_points, *known])
    own, other = settings.uncertainty, by_files
    freedom = (other if own.inertia_kg_m2 == 0.0 else own).inertia_degrees_of_freedom
    return _stated(np.where(own.vector == 0.0, other.vector, own.vector), freedom)


def largest(every: Sequence[StatedUncertainties]) -> StatedUncertainties:
    """Return the largest of each standard uncertainty."""
    inertia = max(every, key=lambda one: one.inertia_kg_m2)
    vector = np.max([one.vector for one in every], axis=0)
    return _stated(vector, inertia.inertia_degrees_of_freedom)


def with_turns(stated: StatedUncertainties, turns: Sequence[SteadyTurn]) -> StatedUncertainties:
    """Return it with what runs on a circle say of rate and radius where nothing is stated."""
    vector = np.where(stated.vector == 0.0, of_turns(turns).vector, stated.vector)
    return _stated(vector, stated.inertia_degrees_of_freedom)


def _stated(vector: FloatArray, freedom: float) -> StatedUncertainties:
    found = dict(zip(STATED, vector.tolist(), strict=True))
    return StatedUncertainties(**found, inertia_degrees_of_freedom=freedom)


def of_model(model: ModelUncertainty) -> StatedUncertainties:
    """Return what is uncertain of the body that is taken off."""
    freedom = model.inertia_degrees_of_freedom
    found = {name: getattr(model, name) for name in _BODY}
    known = freedom if np.isfinite(freedom) else 0.0
    return StatedUncertainties(**found, inertia_degrees_of_freedom=known)


def _of_set_points(runs: Sequence[Run]) -> dict[str, float]:
    relative = [one.u_eccentricity_m / one.eccentricity_m for one in runs if one.eccentricity_m > 0]
    return {
        "amplitude_relative": max(relative, default=0.0),
        "strut_phase_rad": max((one.u_strut_phase_rad for one in runs), default=0.0),
    }


def of_following(runs: Sequence[Sequence[Following]]) -> StatedUncertainties:
    """Return by how much set-points are off that stand in for struts like these."""
    every = [one for run in runs for one in run]
    return StatedUncertainties(
        amplitude_relative=max(abs(one.amplitude_relative) for one in every),
        strut_phase_rad=max(abs(run[0].phase_rad - run[-1].phase_rad) for run in runs if run),
        latency_s=max(abs(one.phase_rad) / (2.0 * np.pi * one.frequency_hz) for one in every),
    )


def of_gauges(one: Calibration) -> StatedUncertainties:
    """Return what a calibration leaves open, of the struts' gauges that it was made of."""
    rows = {name: one.channels.index(name) for name in FORCES if name in one.channels}
    spread = one.force_uncertainty
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
    refused = []
    model = campaign.as_recorded(cycle.name).model
    for one in (one for one in dry if campaign.as_recorded(one.name).model == model):
        try:
            return cycle.without_dry(one)
        except ConfigurationError as error:
            refused.append(str(error))
    amplitude = abs(cycle.motion)
    raise ConfigurationError(
        f"{cycle.name}: no dry run has its motion; run it in air at {cycle.frequency_hz:g} Hz with "
        f"{1e3 * amplitude[0]:.3g} mm and {amplitude[1]:.3g} rad, or give the inertia"
        + (f" ({refused[0]})" if len(refused) == 1 else "")
    )
