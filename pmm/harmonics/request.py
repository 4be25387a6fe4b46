"""What is asked of recordings: the reference, the settings and the file of columns."""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from analysis.readers.columns_options import parse_options
from analysis.readers.columns_toml import read_column_map
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.errors import ConfigurationError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from analysis.readers import ColumnMap
    from pmm.harmonics.sources import Source


@dataclass(frozen=True)
class HarmonicsRequest:
    """The options of ``pmm analyse``, by their names there; ``None`` where one is not given."""

    reference: str | None = None
    frequency: float | None = None
    edges: str | None = None
    latency: float | None = None
    angle_offset: float | None = None
    channels: tuple[str, ...] = ()
    harmonics: int | None = None
    gate: int | None = None
    opens_at: float | None = None
    periods: int | None = None
    steady_tolerance: float | None = None
    delays: tuple[str, ...] = ()
    let_through: tuple[float, ...] = ()
    classic: bool = False
    carrier: float | None = None
    bandwidth: float | None = None
    hann: bool = False
    local_polynomials: bool = False
    response_to: str | None = None
    lines: tuple[int, ...] = ()
    no_drift: bool = False
    column_map: str | None = None
    columns: tuple[str, ...] = ()
    sample_rate: float | None = None
    calibration: str | None = None
    level: float = 0.95
    save: str | None = None

    def check(self, sources: "Sequence[Source]") -> None:
        """Refuse what cannot go together, before any recording is read.

        Raises
        ------
        ConfigurationError
            If it cannot.
        """
        ways = {
            "--reference": self.reference,
            "--frequency": self.frequency,
            "--edges": self.edges,
        }
        reference_options = [name for name, value in ways.items() if value is not None]
        if len(reference_options) > 1:
            raise ConfigurationError(f"give one reference, not {' and '.join(reference_options)}")
        if self.edges and len(sources) > 1 and "{stem}" not in self.edges:
            raise ConfigurationError(
                f"--edges {self.edges}: one file of edges for several recordings; put {{stem}} "
                "where the recording's name stands in the names of their edge files"
            )
        if self.bandwidth is not None and self.carrier is None:
            raise ConfigurationError("--bandwidth belongs to --carrier; give both or neither")
        if self.lines and self.response_to is None:
            raise ConfigurationError("--line belongs to --response-to; say which channel moves")
        paths = [Path(self.save or "") / f"{source.stem}.nc" for source in sources if self.save]
        paths = [path for path in paths if path.exists()]
        if paths:
            names = ", ".join(map(str, paths))
            raise ConfigurationError(f"{names}: exists already; --save to another folder")

    def chosen_columns(self) -> "ColumnMap | None":
        """Return the column map that is given, if any.

        Raises
        ------
        ConfigurationError
            If both kinds are given, or one is wrong.
        """
        if self.column_map and self.columns:
            raise ConfigurationError("give --map or --column, not both")
        if self.column_map:
            return read_column_map(self.column_map)
        return parse_options(self.columns) if self.columns else None

    def delays_s(self) -> dict[str, float]:
        """Return each late channel's delay behind the reference.

        Raises
        ------
        ConfigurationError
            If one is not ``CHANNEL=SECONDS`` or ``CHANNEL=METRES/SPEED``, or a channel has two.
        """
        delays: dict[str, float] = {}
        for text in self.delays:
            name, _, value = (part.strip() for part in text.rpartition("="))
            distance, _, speed = value.replace(" ", "").partition("/")
            try:
                delay_s = float(distance.rstrip("sm")) / float(speed.removesuffix("m/s") or 1.0)
            except (ValueError, ZeroDivisionError):
                delay_s = math.nan
            if not name or name in delays or not math.isfinite(delay_s):
                raise ConfigurationError(
                    f"--delay {text}: give CHANNEL=SECONDS, or CHANNEL=METRES/SPEED with the "
                    "distance from the reference's sensor and the waves' group velocity in m/s, "
                    "once for a channel"
                )
            delays[name] = delay_s
        return delays

    def choice(self, base: ReferenceChoice) -> ReferenceChoice:
        """Return the reference wanted, on top of what a campaign says."""
        arguments: dict[str, Any] = {}
        if self.reference is not None or self.frequency is not None or self.edges is not None:
            arguments = {"channel": self.reference, "frequency_hz": self.frequency}
        if self.latency is not None:
            arguments["latency_s"] = self.latency
        if self.angle_offset is not None:
            arguments["angle_offset_rad"] = math.radians(self.angle_offset)
        return replace(base, **arguments)

    def settings(self, base: ResolverSettings) -> ResolverSettings:
        """Return the settings wanted, on top of what a campaign says."""
        arguments: dict[str, Any] = {
            "channels": tuple(dict.fromkeys(self.channels)) or None,
            "harmonics": self.harmonics,
            "gate_periods": self.gate,
            "opens_s": self.opens_at,
            "periods": self.periods,
            "steady_tolerance": self.steady_tolerance,
            "hann": self.hann or None,
            "local_polynomials": self.local_polynomials or None,
            "take_out_drift": False if self.no_drift else None,
        }
        return replace(
            base, **{key: value for key, value in arguments.items() if value is not None}
        )
