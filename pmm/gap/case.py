"""``case.toml``: what the staff of a rig tell beside its campaign. ``docs/sealed.md`` has the keys.

Any campaign may have one: tolerances, runs whose outcome is to be foretold, what the rig can do.
"""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from analysis.gap.design.proposals import Choices
from analysis.gap.forward.tolerances import Tolerances
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Range
from hardware.description.setpoint import Medium
from pmm.campaign.campaign import Campaign
from pmm.campaign.runs import Asked
from pmm.configuration import STRICT_TABLE, Fault, as_error, read_toml, validate
from sim.effects.effect import FurtherMeasurement

CASE_FILE = "case.toml"


@dataclass(frozen=True)
class HeldOut(Asked):
    """A run whose outcome is to be foretold; keys as those of a campaign's runs."""

    regime: str = ""


@dataclass(frozen=True)
class RigChoices:
    """What a further run may be."""

    frequency_hz: Range
    eccentricity_m: Range
    carriage_speed_m_s: Range = field(default_factory=lambda: Range(0.0, 0.0))
    strut_phase_rad: tuple[float, ...] = (0.0,)
    media: tuple[Medium, ...] = (Medium.WATER,)
    special: tuple[FurtherMeasurement, ...] = ()
    drift_rad: tuple[float, ...] = (0.0,)


@dataclass(frozen=True)
class Case:
    """What is told beside a campaign.

    Attributes
    ----------
    sensors
        Channels that were recorded, ``"photocell"`` among them where there is one.
    """

    schema: str = "sealed-case-1"
    sensors: tuple[str, ...] = ()
    tolerances: Tolerances = field(default_factory=Tolerances)
    held_out: tuple[HeldOut, ...] = ()
    rig: RigChoices | None = None

    __pydantic_config__ = STRICT_TABLE

    def choices(self, campaign: Campaign) -> Choices | None:
        """Return what the rig can do next.

        Where nothing is said, what the oscillator can, without the carriage and at the highest
        speed of the campaign, straight and at its largest drift.
        """
        oscillator = campaign.oscillator
        if oscillator is None:
            return None
        limit_n = oscillator.force_per_strut_n
        if self.rig is None:
            fastest_m_s = max((run.carriage_speed_m_s for run in campaign.runs), default=0.0)
            widest_rad = max((run.drift_rad for run in campaign.runs), key=abs, default=0.0)
            return Choices(
                oscillator.frequency_hz,
                oscillator.eccentricity_m,
                carriage_speed_m_s=tuple(sorted({0.0, fastest_m_s})),
                drift_rad=tuple(sorted({0.0, widest_rad}, key=abs)),
                force_limit_n=limit_n,
            )
        speeds = self.rig.carriage_speed_m_s
        return Choices(
            self.rig.frequency_hz,
            self.rig.eccentricity_m,
            self.rig.strut_phase_rad,
            tuple(sorted({speeds.low, speeds.high})),
            self.rig.media,
            self.rig.drift_rad,
            self.rig.special,
            limit_n,
        )


def read_case(file: Path) -> Case:
    """Read the ``case.toml`` beside a campaign file; without one everything is as usual.

    Tolerances that the campaign file states hold too.

    Raises
    ------
    ConfigurationError
        With every error of the file, or with the tolerances that both files state differently.
    """
    path = file.parent / CASE_FILE
    table: dict[str, Any] = read_toml(path) if path.exists() else {}
    faults: list[Fault] = []
    case = validate(Case, table, faults)
    if case is None or faults:
        raise as_error(path, faults, table)
    tolerances = {name: value for name, (value, _) in stated_tolerances(file).items()}
    return replace(case, tolerances=Tolerances(**tolerances))


def stated_tolerances(file: Path) -> dict[str, tuple[float, str]]:
    """Return the tolerances that are stated, by key, each with the file that states it.

    Parameters
    ----------
    file
        The campaign file; it and the ``case.toml`` beside it have been checked.

    Raises
    ------
    ConfigurationError
        If both state a key, with other values.
    """
    case_file, beside = file.parent / CASE_FILE, (file, file.parent / CASE_FILE)
    tables = {path.name: _tolerances_of(path) for path in beside if path.exists()}
    tolerances: dict[str, tuple[float, str]] = {}
    for name, table in tables.items():
        for key, value in table.items():
            before, where = tolerances.get(key, (value, name))
            if before != value:
                raise ConfigurationError(
                    f"{case_file}: tolerances.{key} = {value:g}, and {before:g} in {where}; "
                    "state it in one of the two"
                )
            tolerances[key] = value, name
    return tolerances


def _tolerances_of(path: Path) -> dict[str, float]:
    table: dict[str, float] = read_toml(path).get("tolerances", {})
    return table
