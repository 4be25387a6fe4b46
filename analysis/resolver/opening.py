"""When the gate opens: as asked for, as run control had it, or nowhere in the record."""

from dataclasses import replace

from analysis.recording import Recording
from analysis.resolver.settings import ResolverSettings
from hardware.description.dataset import GATE_OPENED, GATE_PERIODS
from hardware.description.errors import ConfigurationError


def with_own_gate(recording: Recording, settings: ResolverSettings) -> ResolverSettings:
    """Take the gate that run control had, where it closed within the record."""
    told = recording.provenance
    if settings.opens_s is not None or not {GATE_OPENED, GATE_PERIODS} <= set(told):
        return settings
    try:
        opened_s, periods = float(told[GATE_OPENED]), int(told[GATE_PERIODS])
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
    if settings.opens_s is None or recording.start_s <= settings.opens_s <= recording.end_s:
        return
    raise ConfigurationError(
        f"{recording.name}: the gate cannot open at {settings.opens_s:g} s; the record runs "
        f"from {recording.start_s:.3f} s to {recording.end_s:.3f} s"
    )
