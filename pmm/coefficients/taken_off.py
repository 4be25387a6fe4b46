"""What is taken off the gross loads: the model as a body, its restoring, or a dry run."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.campaign_plan import OWN_MODEL
from analysis.coefficients.dry_run import without_dry as less_dry_run
from analysis.ideal_rig import weight_matrix
from hardware.description.arrays import FloatArray
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from pmm.campaign.campaign import Campaign
from pmm.campaign.model_uncertainty import ModelUncertainty, take_uncertainty
from pmm.coefficients.settings import DRY, MODEL, CoefficientSettings
from pmm.configuration import Fault, as_error, limit_faults, read_toml, validate

_BORNE = ("displaced_kg", "buoyancy_x_m", "buoyancy_z_m")


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
            return less_dry_run(cycle, dry_run)
        except ConfigurationError as error:
            refusals.append(str(error))
    amplitude = abs(cycle.motion)
    raise ConfigurationError(
        f"{cycle.name}: no dry run has its motion; run it in air at {cycle.frequency_hz:g} Hz with "
        f"{1e3 * amplitude[0]:.3g} mm and {amplitude[1]:.3g} rad, or give the inertia"
        + (f" ({min(refusals, key=len)})" if refusals else "")
    )


def restoring_of(campaign: Campaign, settings: CoefficientSettings) -> FloatArray:
    """Return the hydrostatic restoring about the midpoint, shape ``(2, 2)``."""
    restoring = settings.restoring
    return np.array(campaign.hull.restoring if restoring is None else restoring, dtype=np.float64)


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
