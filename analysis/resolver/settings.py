"""How a recording is to be analysed, and when its gate opens."""

from dataclasses import dataclass, replace

from analysis.recording import Recording
from hardware.description.dataset import GATE_OPENED, GATE_PERIODS
from hardware.description.errors import ConfigurationError


@dataclass(frozen=True)
class ResolverSettings:
    """How to analyse a recording.

    Attributes
    ----------
    channels
        Which channels, in order; if empty, all but the reference's and the shaft angle.
    gate_periods
        Periods of each gate; ``None`` takes the whole stretch as one gate.
    opens_s
        Open the first gate at this very time instead of finding where the run is steady, or of
        taking the gate that run control had.
    periods
        Number of periods from ``opens_s`` on; all that follow if ``None``.
    steady_tolerance
        See :func:`analysis.resolver.steady_stretch.find_steady`.
    delay_s
        How much later than the reference's sensor waves reach these channels: their gates open and
        close so much later, with the reference's phase carried on at its mean frequency.
    hann
        Taper each gate (:mod:`analysis.resolver.hann`): for long gates with interference.
    local_polynomials
        Take what a transient leaks off each harmonic (:mod:`analysis.resolver.local_polynomial`).
    """

    channels: tuple[str, ...] = ()
    harmonics: int = 3
    gate_periods: int | None = None
    opens_s: float | None = None
    periods: int | None = None
    steady_tolerance: float = 0.05
    take_out_drift: bool = True
    hann: bool = False
    local_polynomials: bool = False
    delay_s: float = 0.0


def check_settings(settings: ResolverSettings) -> None:
    """Refuse settings that contradict each other.

    Raises
    ------
    ConfigurationError
        If a count is less than one, or a number of periods has no time to begin at.
    """
    for name in ("harmonics", "gate_periods", "periods"):
        value = getattr(settings, name)
        if value is not None and value < 1:
            raise ConfigurationError(f"{name} = {value} makes no sense; it must be 1 or more")
    if settings.hann and settings.local_polynomials:
        raise ConfigurationError("hann and local_polynomials are two estimators; take one")
    if settings.periods is not None and settings.opens_s is None:
        raise ConfigurationError("a number of periods needs the time at which the gate opens")


def with_own_gate(recording: Recording, settings: ResolverSettings) -> ResolverSettings:
    """Take the gate that run control had, where it closed within the record."""
    provenance = recording.provenance
    if (
        settings.opens_s is not None
        or settings.delay_s
        or not {GATE_OPENED, GATE_PERIODS} <= set(provenance)
    ):
        return settings
    try:
        opened_s, periods = float(provenance[GATE_OPENED]), int(provenance[GATE_PERIODS])
    except ValueError:
        return settings
    if periods < 1 or not recording.start_s <= opened_s <= recording.end_s:
        return settings
    return replace(settings, opens_s=opened_s, periods=periods)


def check_opening(recording: Recording, settings: ResolverSettings) -> None:
    """Refuse a gate that cannot open within the record.

    Raises
    ------
    ConfigurationError
        If its time lies before the record or after it.
    """
    if settings.opens_s is None:
        return
    opens_s = settings.opens_s + settings.delay_s
    if recording.start_s <= opens_s <= recording.end_s:
        return
    raise ConfigurationError(
        f"{recording.name}: the gate cannot open at {opens_s:g} s; the record runs "
        f"from {recording.start_s:.3f} s to {recording.end_s:.3f} s"
    )
