"""``steering.toml``: propeller and rudder as they are drawn, beside a campaign's file."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

from analysis.steering.observations import Particulars
from pmm.configuration import STRICT_TABLE, Fault, as_error, limit_faults, read_toml, validate

SETTINGS_FILE: Final = "steering.toml"


@dataclass(frozen=True)
class PropellerDrawn:
    """The propeller: ``thrust`` has k_0, k_1, k_2 of ``K_T = k_0 + k_1 J + k_2 J^2``."""

    diameter_m: float
    thrust: tuple[float, float, float]


@dataclass(frozen=True)
class RudderDrawn:
    """The rudder: A_R, H_R, f_alpha, and its axis ahead of the midpoint between the struts."""

    area_m2: float
    height_m: float
    slope: float
    x_m: float


@dataclass(frozen=True)
class SteeringSettings:
    """The whole file.

    Attributes
    ----------
    length_m
        Of the model, by which places are divided.
    density_kg_m3
        ``None`` takes that of the campaign's ``[water]``.
    towing_force_n
        F_D of the self-propulsion point: what the ship's friction is less than the model's.
    """

    length_m: float
    propeller: PropellerDrawn
    rudder: RudderDrawn
    density_kg_m3: float | None = None
    towing_force_n: float = 0.0

    __pydantic_config__ = STRICT_TABLE

    def particulars(self, density_kg_m3: float) -> Particulars:
        """Return what the equations need, in a water."""
        return Particulars(
            self.length_m,
            density_kg_m3,
            self.propeller.diameter_m,
            self.propeller.thrust,
            self.rudder.area_m2,
            self.rudder.height_m,
            self.rudder.slope,
            self.rudder.x_m,
        )


def read_steering_settings(path: Path) -> SteeringSettings:
    """Read the file.

    Raises
    ------
    ConfigurationError
        For unknown keys, wrong types and sizes that are not above 0: all errors in one message.
    """
    table = read_toml(path)
    faults: list[Fault] = list(limit_faults(table))
    settings = validate(SteeringSettings, table, faults)
    if settings is not None:
        sizes = {
            ("length_m",): settings.length_m,
            ("propeller", "diameter_m"): settings.propeller.diameter_m,
            ("rudder", "area_m2"): settings.rudder.area_m2,
            ("rudder", "height_m"): settings.rudder.height_m,
            ("rudder", "slope"): settings.rudder.slope,
        }
        for place, value in sizes.items():
            if not value > 0.0:
                faults.append(Fault(place, f"= {value:g} should be above 0"))
        diameter_m, height_m = settings.propeller.diameter_m, settings.rudder.height_m
        if diameter_m > height_m > 0.0:
            text = (
                f"= {diameter_m:g} is above rudder.height_m = {height_m:g}: the race would be "
                "wider than the rudder is high; are both in metres?"
            )
            faults.append(Fault(("propeller", "diameter_m"), text))
    if settings is None or faults:
        raise as_error(path, faults, table)
    return settings
