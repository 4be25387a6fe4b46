"""What a run's folder says of the run before its first sample: ``header.json``."""

import json
import math
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, Final

from hardware.description.channels import Channel
from hardware.description.errors import DataError
from hardware.description.setpoint import SetPoint
from hardware.roles import Reading
from pmm.recorder.line_shapes import is_integer, is_text

_NOTHING: Mapping[str, Any] = MappingProxyType({})


@dataclass(frozen=True, kw_only=True)
class LiveSettings:
    """How the live resolver was set, so that a replay can be set likewise.

    The fields are the arguments of :class:`analysis.resolver.live_resolver.LiveResolver`.
    """

    harmonics: int = 3
    periods: int = 1
    latency_s: float = 0.0
    angle_offset_rad: float = 0.0


@dataclass(frozen=True, kw_only=True)
class RunHeader:
    """What is known of a run when its recording begins.

    Attributes
    ----------
    channels
        Those recorded, in the order of the samples' rows: unit and full scale.
    sample_rate_hz
        SYNC messages per second.
    started_utc
        Date and time in ISO 8601, handed in.
    number
        Place of the run among all of its campaign, from 1: it orders them, whatever the clock says.
        0 in a campaign of before numbers were kept.
    kind, plan_json
        What kind of run it is, and its plan as JSON.
    configuration_sha256, provenance
        Hash of each configuration file; whatever else is to be kept, text to text.
    readings
        Dials and encoders as they were read: ``eccentricity``, ``phase``.
    sources
        Channel to the device that it comes from.
    calibration
        Channel to what turned its raw values into its unit: ``scale``, ``offset``, ``tare``.
    photocell
        Whether the rig has one; without, a recording has no edges at all.
    first_sync
        Number of the first SYNC of this recording; the rig's time is this over the sample rate.
    rig_tables
        The tables that :func:`hardware.rig_configuration.read_rig` takes; a replay needs them.
    opening
        What the devices carried over from before (:func:`hardware.carry_over.opening_of`); a replay
        of a run that did not begin with the rig's power needs it.
    """

    run_name: str
    channels: tuple[Channel, ...]
    sample_rate_hz: float
    started_utc: str
    kind: str
    number: int = 0
    set_point: SetPoint | None = None
    plan_json: str = "{}"
    configuration_sha256: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    provenance: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    readings: Mapping[str, Reading] = field(default_factory=lambda: _NOTHING)
    sources: Mapping[str, str] = field(default_factory=lambda: _NOTHING)
    calibration: Mapping[str, Mapping[str, float]] = field(default_factory=lambda: _NOTHING)
    photocell: bool = True
    first_sync: int = 1
    rig_tables: Mapping[str, Any] = field(default_factory=lambda: _NOTHING)
    opening: Mapping[str, Any] = field(default_factory=lambda: _NOTHING)
    live: LiveSettings = LiveSettings()

    @property
    def order(self) -> tuple[int, str, int]:
        """What sorts runs as they were made: by number; those without one come first, by clock."""
        return self.number, self.started_utc, self.first_sync

    def to_json(self) -> str:
        """Return the header as it is kept."""
        fields = {name: getattr(self, name) for name in self.__dataclass_fields__}
        return json.dumps({name: _plain(value) for name, value in fields.items()}, indent=1)

    @classmethod
    def read(cls, path: Path) -> "RunHeader":
        """Return the header of a run from its file.

        Raises
        ------
        DataError
            As :meth:`from_json`, or if it cannot be read as text.
        """
        try:
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise DataError(f"{path}: damaged run header: {error}") from error
        return cls.from_json(text, str(path))

    @classmethod
    def from_json(cls, text: str, where: str) -> "RunHeader":
        """Return the header that a text holds.

        Raises
        ------
        DataError
            If it is cut short, damaged, or of another make; the message names ``where``.
        """
        try:
            fields = json.loads(text)
            point = fields["set_point"]
            header = cls(
                **{
                    **fields,
                    "channels": tuple(Channel(**channel) for channel in fields["channels"]),
                    "set_point": point and SetPoint.read(point),
                    "readings": {
                        key: Reading(**reading) for key, reading in fields["readings"].items()
                    },
                    "live": LiveSettings(**fields["live"]),
                }
            )
        except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
            raise DataError(f"{where}: damaged run header: {error!r}") from error
        if wrong := [name for name, right in _KINDS.items() if not right(getattr(header, name))]:
            raise DataError(f"{where}: damaged run header: {', '.join(wrong)} cannot be so")
        return header


def _is_rate(value: object) -> bool:
    return isinstance(value, int | float) and 0.0 < value < math.inf


def _are_texts(value: object) -> bool:
    return isinstance(value, Mapping) and all(map(is_text, value.values()))


_KINDS: Final[Mapping[str, Callable[[object], bool]]] = {
    "run_name": is_text,
    "started_utc": is_text,
    "kind": is_text,
    "plan_json": is_text,
    "sample_rate_hz": _is_rate,
    "number": is_integer,
    "first_sync": is_integer,
    "configuration_sha256": _are_texts,
    "provenance": _are_texts,
}


def _plain(value: Any) -> Any:
    """Return what JSON can hold."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, tuple | list):
        return [_plain(item) for item in value]
    return asdict(value) if hasattr(value, "__dataclass_fields__") else value
