"""The sensors that tell how a model sinks and trims, and whether it may."""

from dataclasses import dataclass
from enum import StrEnum

from hardware.description.errors import ConfigurationError


class HeaveAndPitch(StrEnum):
    """Whether the model may heave and pitch on its guides."""

    FREE = "free"
    FIXED = "fixed"


@dataclass(frozen=True)
class AttitudeSensors:
    """Two sensors of position on the model.

    Attributes
    ----------
    aft_x_m, fore_x_m
        Their places ahead of the reference point, along the model.
    heave_and_pitch
        Whether the model is free in both, or the rig holds or moves it.
    sinkage_x_m
        Of which point ahead of the reference point the sinkage is told.

    Raises
    ------
    ConfigurationError
        If the fore sensor does not stand ahead of the aft one.
    """

    aft_x_m: float
    fore_x_m: float
    heave_and_pitch: HeaveAndPitch
    sinkage_x_m: float = 0.0

    def __post_init__(self) -> None:
        if not self.fore_x_m > self.aft_x_m:
            raise ConfigurationError(
                f"attitude: fore_x_m = {self.fore_x_m:g} m is not ahead of aft_x_m = "
                f"{self.aft_x_m:g} m; give both as metres ahead of the reference point"
            )
