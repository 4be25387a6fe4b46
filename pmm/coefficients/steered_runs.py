"""Which runs `pmm coefficients` takes by their rudder and propeller; a design asks it too."""

from collections import Counter
from collections.abc import Iterable
from typing import Final, Protocol

from hardware.description.kinds import RunKind
from hardware.description.setpoint import SetPoint

_BY_STEERING: Final = "`pmm steering FOLDER` takes such runs"
_LAID: Final = f"it oscillates with a laid rudder; {_BY_STEERING}"
_OTHER_RATE: Final = f"its propeller turns at another rate than in most runs; {_BY_STEERING}"


class SetRun(Protocol):
    """A run that was made, or is planned."""

    @property
    def kind(self) -> RunKind:
        """What it is for."""

    @property
    def set_point(self) -> SetPoint:
        """What it is told to do."""


def usual_rate_hz(runs: Iterable[SetRun]) -> float:
    """Return the rate of the propeller in most of the runs that oscillate or are towed."""
    rates = Counter(
        run.set_point.revolutions_hz for run in runs if run.kind.oscillates or run.kind.towed
    )
    return rates.most_common(1)[0][0] if rates else 0.0


def why_steered(run: SetRun, usual_hz: float) -> str | None:
    """Say why a run tells of the ship otherwise than as it mostly runs; ``None`` where it does not.

    Parameters
    ----------
    usual_hz
        The propeller's rate in most runs.
    """
    if run.set_point.rudder_angle_rad and run.kind.oscillates:
        return _LAID
    return _OTHER_RATE if run.set_point.revolutions_hz != usual_hz else None
