"""What ``pmm analyse`` was asked to do."""

import math
from dataclasses import dataclass, replace
from typing import Any

from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings


@dataclass(frozen=True)
class AnalyseOptions:
    """The options of ``pmm analyse``, by their names there; ``None`` where one is not given."""

    files: tuple[str, ...]
    reference: str | None
    frequency: float | None
    edges: str | None
    latency: float | None
    angle_offset: float | None
    channels: tuple[str, ...]
    harmonics: int | None
    gate: int | None
    opens_at: float | None
    periods: int | None
    steady_tolerance: float | None
    let_through: tuple[float, ...]
    classic: bool
    carrier: float | None
    bandwidth: float | None
    hann: bool
    no_drift: bool
    column_map: str | None
    columns: tuple[str, ...]
    sample_rate: float | None
    calibration: str | None
    level: float
    plot: str | None
    save: str | None
    as_json: bool

    def choice(self, base: ReferenceChoice) -> ReferenceChoice:
        """Return the reference wanted, on top of what a campaign says."""
        given: dict[str, Any] = {}
        if self.reference is not None or self.frequency is not None or self.edges is not None:
            given = {"channel": self.reference, "frequency_hz": self.frequency}
        if self.latency is not None:
            given["latency_s"] = self.latency
        if self.angle_offset is not None:
            given["angle_offset_rad"] = math.radians(self.angle_offset)
        return replace(base, **given)

    def settings(self, base: ResolverSettings) -> ResolverSettings:
        """Return the settings wanted, on top of what a campaign says."""
        given: dict[str, Any] = {
            "channels": tuple(dict.fromkeys(self.channels)) or None,
            "harmonics": self.harmonics,
            "gate_periods": self.gate,
            "opens_s": self.opens_at,
            "periods": self.periods,
            "steady_tolerance": self.steady_tolerance,
            "hann": self.hann or None,
            "take_out_drift": False if self.no_drift else None,
        }
        return replace(base, **{key: value for key, value in given.items() if value is not None})
