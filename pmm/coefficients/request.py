"""What is asked of campaigns: their settings, with a command's options in their place."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

from analysis.coefficients.campaign_quoting import QuotedMass, quote
from analysis.coefficients.names import Form
from analysis.coefficients.quoting import Names
from hardware.description.errors import ConfigurationError
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.coefficients import DEFAULT_TRIALS
from pmm.coefficients.references import check_systems, read_references, with_references
from pmm.coefficients.settings import (
    DRY,
    MODEL,
    CoefficientSettings,
    ReferenceFile,
    System,
    check_trials,
    settings_of,
)
from pmm.coefficients.systems import check_dimensions, in_system, system_of
from pmm.coefficients.workflow import CampaignOutcome
from pmm.remote import local_path

_PLAIN: Final = ("with_mass", "form", "level", "seed", "system", "inertia", "wanted", "leave_out")


def requested(folder: Path, options: Mapping[str, Any]) -> tuple[CoefficientSettings, Path | None]:
    """Return the settings of campaigns with a command's options in their place, and their file.

    Parameters
    ----------
    folder
        Of the first campaign.
    options
        Of ``pmm coefficients``, by their names.

    Raises
    ------
    ConfigurationError
        If the file is wrong, or something that is asked cannot be.
    """
    base, path = settings_of(folder, options["settings"])
    settings = _merged(base, options)
    check_trials(settings.trials)
    check_dimensions(settings.system, settings.ship)
    return settings, path


def _merged(base: CoefficientSettings, options: Mapping[str, Any]) -> CoefficientSettings:
    """Return the settings with what the command line says in their place."""
    arguments: dict[str, Any] = {name: options[name] for name in _PLAIN if options[name]}
    if "form" in arguments:
        arguments["form"] = Form(arguments["form"])
    if "system" in arguments:
        arguments["system"] = System(arguments["system"])
    if options["names"]:
        arguments["names"] = Names(options["names"])
    inertia = arguments.get("inertia", MODEL)
    if inertia not in (MODEL, DRY) and not Path(inertia).is_file():
        raise ConfigurationError(
            f"--inertia {inertia}: no such file; name one that `pmm inertia --output` wrote, or "
            f"say {MODEL} or {DRY}"
        )
    if options["references"]:
        added_references = tuple(ReferenceFile(name) for name in options["references"])
        arguments["references"] = (*base.references, *added_references)
    return replace(base, **arguments, trials=_trials(base, options))


def _trials(base: CoefficientSettings, options: Mapping[str, Any]) -> int:
    method, trials = options["uncertainty"], options["trials"]
    if method == "linear" and trials is not None:
        raise ConfigurationError("--trials belongs to --uncertainty monte-carlo")
    if method == "linear":
        return 0
    if method is None and trials is None:
        return base.trials
    return int(trials or base.trials or DEFAULT_TRIALS)


def campaign_folder(text: str) -> Path:
    """Return the folder of a campaign that is named, or whose file is.

    Raises
    ------
    ConfigurationError
        If there is none, or no campaign file in it; or as :func:`pmm.remote.local_path`.
    DataError
        As :func:`pmm.remote.local_path`.
    """
    path = local_path(text)
    if path.name == CAMPAIGN_FILE and path.is_file():
        return path.parent
    if not path.is_dir():
        raise ConfigurationError(f"{path}: no such folder; name one that holds a {CAMPAIGN_FILE}")
    if not (path / CAMPAIGN_FILE).exists():
        raise ConfigurationError(
            f"{path}: a folder without a {CAMPAIGN_FILE}; write one (docs/campaigns.md)"
        )
    return path


def finished(outcome: CampaignOutcome, settings: CoefficientSettings) -> CampaignOutcome:
    """Put reference tables beside the values, and bring both to the system asked for."""
    coefficients = outcome.result
    references = read_references(
        settings.references, coefficients.plane, coefficients.form, outcome.with_memory
    )
    check_systems(references, settings.system)
    reference_flags = [reference.flag for reference in references if reference.flag is not None]
    coefficients = with_references(coefficients, references, System.DIMENSIONAL)
    coefficients, flags = in_system(
        coefficients, settings.system, outcome.settings.ship, outcome.body, outcome.stated
    )
    if settings.system is not System.DIMENSIONAL:
        coefficients = with_references(coefficients, references, settings.system)
    coefficients = quote(coefficients, settings.quoting, _carried(outcome, settings))
    return replace(
        outcome, result=coefficients, left_out=(*outcome.left_out, *flags, *reference_flags)
    )


def _carried(outcome: CampaignOutcome, settings: CoefficientSettings) -> QuotedMass:
    """Return the mass that is quoted with the coefficients, and the table's system.

    Raises
    ------
    ConfigurationError
        If the mass is asked for and not known.
    """
    if not settings.with_mass:
        return QuotedMass()
    if outcome.body is None:
        raise ConfigurationError(
            "--with-mass needs the model's mass, which dry runs do not tell; take --inertia model"
        )
    plain = settings.system is System.DIMENSIONAL
    system = None if plain else system_of(settings.system, outcome.settings.ship, outcome.body)
    arm = outcome.body.cg_x_m - settings.point_ahead_m
    return QuotedMass(outcome.body.mass_kg, arm, system, outcome.stated)
