"""The system without dimensions that a table is asked for in, by the model's own dimensions."""

from dataclasses import replace
from typing import NoReturn

from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.campaign_systems import System as BySpeed
from analysis.coefficients.campaign_systems import without_dimensions
from analysis.coefficients.normalisation import mmg, prime, seakeeping
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity
from pmm.coefficients.settings import SETTINGS_FILE, ShipTable, System

_NEEDS = {
    System.PRIME: ("length_m",),
    System.MMG: ("length_m", "draught_m"),
    System.SEAKEEPING: ("length_m",),
    System.BIS: ("length_m",),
}

BY_GRAVITY = (System.SEAKEEPING, System.BIS)


def in_system(
    coefficients: CampaignCoefficients,
    system: System,
    ship: ShipTable,
    body: Body | None,
    stated: StatedUncertainties,
) -> tuple[CampaignCoefficients, tuple[Flag, ...]]:
    """Return the campaign in a system; what has no meaning there is left out, and said.

    Raises
    ------
    ConfigurationError
        If a dimension of the model is missing, or nothing was measured at speed.
    """
    if system is System.DIMENSIONAL:
        return coefficients, ()
    by_speed, flags = system_of(system, ship, body), _assumed(ship)
    if system in BY_GRAVITY:
        # rho V is the model's mass where no volume is stated, whatever the density.
        known = stated if ship.volume_m3 is not None else replace(stated, density_relative=0.0)
        return without_dimensions(coefficients, by_speed, known), flags
    moving = [k for k, entry in enumerate(coefficients.entries) if entry.speed_m_s > 0.0]
    if not moving:
        raise ConfigurationError(
            f"--system {system} divides by the speed, and nothing was measured at a speed above 0 "
            "m/s; take --system seakeeping or dimensional"
        )
    rest_count = len(coefficients.entries) - len(moving)
    if rest_count:
        text = (
            f"{rest_count} values at rest have no meaning in the system {system} and are left out"
        )
        flags = (*flags, Flag("at_rest_left_out", Severity.NOTE, text))
    return without_dimensions(coefficients.select(moving), by_speed, stated), flags


def _assumed(ship: ShipTable) -> tuple[Flag, ...]:
    """Return what is said where nobody stated the water's density."""
    if ship.density_kg_m3 is not None:
        return ()
    text = (
        f"the water's density is not stated and taken as {ship.density:g} kg/m3: write [water] in "
        f"the campaign file, or density_kg_m3 in the table [ship] of {SETTINGS_FILE}"
    )
    return (Flag("density_assumed", Severity.WARNING, text),)


def check_dimensions(system: System, ship: ShipTable) -> None:
    """Refuse a system whose lengths are not given, before any work is done.

    Raises
    ------
    ConfigurationError
        Naming what is missing and where it is written.
    """
    missing = [name for name in _NEEDS.get(system, ()) if getattr(ship, name) is None]
    if missing:
        _refuse(system, missing)


def _refuse(system: System, missing: list[str]) -> NoReturn:
    raise ConfigurationError(
        f"--system {system} needs {' and '.join(missing)}: write it in the table [ship] of "
        f"{SETTINGS_FILE}"
    )


def system_of(system: System, ship: ShipTable, body: Body | None) -> BySpeed:
    """Return what a table is divided by at each speed; ``system`` is not the dimensional one.

    Raises
    ------
    ConfigurationError
        If a dimension of the model is missing.
    """
    check_dimensions(system, ship)
    volume = ship.volume_m3
    if volume is None and body is not None:
        volume = body.mass_kg / ship.density
    if system in BY_GRAVITY and volume is None:
        _refuse(system, ["volume_m3"])
    length, density = ship.length_m or 0.0, ship.density
    if system is System.PRIME:
        return lambda speed: prime(length, speed, density)
    if system is System.MMG:
        return lambda speed: mmg(length, ship.draught_m or 0.0, speed, density)
    by_gravity = seakeeping(length, volume or 0.0, density, ship.gravity_m_s2, str(system))
    return lambda _: by_gravity
