"""``[water]`` of a campaign: what the model was tested in."""

from collections.abc import Sequence
from dataclasses import dataclass

from analysis.water import Water
from hardware.description.errors import ConfigurationError


@dataclass(frozen=True)
class TankWater(Water):
    """Water of a tank; ``depth_m`` is ``None`` where it is deep or nobody says."""

    depth_m: float | None = None


def common_water(waters: Sequence[TankWater | None]) -> TankWater | None:
    """Return the water of campaigns that are taken as one, at their mean temperature.

    ``None`` where no campaign says.

    Raises
    ------
    ConfigurationError
        If only some say, or salinity or depth differ.
    """
    tank_waters = [water for water in waters if water is not None]
    if not tank_waters:
        return None
    if len(tank_waters) < len(waters):
        raise ConfigurationError("only some of the campaigns have a table [water]; give all one")
    for key in ("salinity_g_kg", "depth_m"):
        values = {getattr(water, key) for water in tank_waters}
        if len(values) > 1:
            values_text = " and ".join(map(str, values))
            raise ConfigurationError(
                f"the campaigns' [water] differ in {key} ({values_text}): analyse them one by one"
            )
    mean = sum(water.temperature_deg_c for water in tank_waters) / len(tank_waters)
    return TankWater(mean, tank_waters[0].salinity_g_kg, tank_waters[0].depth_m)
