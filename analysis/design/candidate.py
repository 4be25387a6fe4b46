"""A run that could be made, and what it costs."""

from dataclasses import dataclass

from hardware.description.setpoint import SetPoint


@dataclass(frozen=True)
class CandidateRun:
    """A run that could be made.

    Attributes
    ----------
    periods
        That are measured; what settles is not among them.
    cost_s
        Of tank time: waiting, settling and the carriage's way back in it; infinite for a run that
        is made already, or is none to choose.
    setting_s
        Of tank time besides, for the first run with this eccentricity and phase: runs with the same
        are made one after the other.
    """

    point: SetPoint
    periods: int
    cost_s: float
    setting_s: float = 0.0

    @property
    def measured_s(self) -> float:
        """Time that is measured."""
        return self.periods / self.point.frequency_hz

    @property
    def freedom(self) -> float:
        """Degrees of freedom of the periods' own scatter."""
        return max(self.periods - 1.0, 1.0)
