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
    known = [one for one in waters if one is not None]
    if not known:
        return None
    if len(known) < len(waters):
        raise ConfigurationError("only some of the campaigns have a table [water]; give all one")
    for key in ("salinity_g_kg", "depth_m"):
        values = {getattr(one, key) for one in known}
        if len(values) > 1:
            told = " and ".join(map(str, values))
            raise ConfigurationError(
                f"the campaigns' [water] differ in {key} ({told}): analyse them one by one"
            )
    mean = sum(one.temperature_deg_c for one in known) / len(known)
    return TankWater(mean, known[0].salinity_g_kg, known[0].depth_m)
