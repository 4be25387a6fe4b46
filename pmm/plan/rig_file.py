"""Reading ``rig.toml``: the devices, the limits, the model, the tank and the recorder."""

import hashlib
from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Oscillator
from hardware.rig_configuration import TABLES, RigConfiguration, read_rig
from hardware.watch import WatchLimits
from pmm.campaign.attitude import attitude_faults
from pmm.campaign.calibration import Calibration, read_calibration
from pmm.campaign.model_uncertainty import expand_preset
from pmm.configuration import (
    Fault,
    as_error,
    limit_faults,
    read_toml,
    read_toml_and_bytes,
    validate,
)
from pmm.plan.rig_checks import (
    SIMULATED,
    carriage_faults,
    channels_of,
    gauge_faults,
    gauges_of,
    point_at_simulation,
    table_faults,
)
from pmm.plan.rig_tables import ModesFile, RigTables, StructuralMode


@dataclass(frozen=True, kw_only=True)
class RigFile(RigTables):
    """A rig's file, read and checked: its tables, and what goes with them.

    Attributes
    ----------
    hardware
        The devices, as :class:`hardware.rig.Rig` opens them.
    hardware_tables
        The tables that they were read from, paths of simulated rigs resolved.
    gauges
        Ranges of the force channels: the file's, else those of the amplifiers.
    modes
        Structural modes from a pluck test, those of its file among them.
    calibration
        Of the gauges, from check weights; kept with every recording and applied in the analysis.
    tables, content
        All of the file, as it is written: as tables, and its bytes, empty for a rig that was not
        read from a file.
    realtime
        Whether cycles keep to the clock; a simulated rig runs free unless it is asked for.
    """

    path: Path
    sha256: str
    hardware: RigConfiguration
    hardware_tables: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    realtime: bool = True
    calibration: Calibration | None = None
    tables: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    content: bytes = b""

    @property
    def hashes(self) -> dict[str, str]:
        """SHA-256 of the rig's file, and of its calibration's where it names one."""
        calibration = self.calibration
        return {"rig": self.sha256} | (
            {} if calibration is None else {"calibration": calibration.sha256}
        )

    @property
    def watched(self) -> WatchLimits:
        """What the rig watches in every cycle: highest frequency, safe loads."""
        loads = {gauge.channel: gauge.safe_n for gauge in self.gauges}
        return WatchLimits(self.oscillator.frequency_hz.high, MappingProxyType(loads))

    @property
    def sample_rate_hz(self) -> float:
        """Samples per second of all channels."""
        return self.hardware.sample_rate_hz


@dataclass(frozen=True)
class RigFileReading:
    """What could be made of a rig's file: all of it, or the parts that a plan is read against.

    Attributes
    ----------
    rig
        ``None`` where the file has errors.
    oscillator, channels
        As far as they could be read.
    error
        All errors of the file.
    """

    rig: RigFile | None = None
    oscillator: Oscillator | None = None
    channels: tuple[str, ...] | None = None
    error: ConfigurationError | None = None


def read_rig_file(path: str | Path) -> RigFile:
    """Read a rig's file.

    Raises
    ------
    ConfigurationError
        If the file cannot be read, or for unknown keys (with a suggestion), wrong types, values
        beyond their limits, and devices that do not fit together: all errors of the file in one
        message, each with its place in the file.
    """
    reading = examine_rig(Path(path))
    if reading.rig is None:
        raise reading.error or ConfigurationError(f"{path}: cannot be read")
    return reading.rig


def examine_rig(path: Path) -> RigFileReading:
    """Read a rig's file as far as it goes."""
    try:
        original, content = read_toml_and_bytes(path)
    except ConfigurationError as error:
        return RigFileReading(error=error)
    faults: list[Fault] = []
    table = deepcopy(original)
    devices = {key: table.pop(key) for key in TABLES if key in table}
    faults += [*limit_faults(table), *table_faults(table)]
    expand_preset(table, faults)
    tables = validate(RigTables, table, faults)
    point_at_simulation(devices, path)
    hardware = _read_devices(devices, faults)
    if tables is not None and hardware is not None:
        faults += [*gauge_faults(tables, hardware), *carriage_faults(tables, hardware)]
        if tables.realtime is False and not is_simulated(hardware):
            said = "= false is for a bus 'pmm-simulated': a real rig keeps to the clock"
            faults.append(Fault(("realtime",), said))
    modes = _more_modes(tables, path, faults)
    calibration = _calibration(tables, hardware, path, faults)
    oscillator = validate(Oscillator, table.get("oscillator", {}), [])
    handed_on = tables.campaign if tables is not None else {}
    inner = attitude_faults(oscillator, handed_on, own=True)
    faults += [Fault(("campaign", *fault.place), fault.message) for fault in inner]
    channels = None if hardware is None else channels_of(hardware)
    if faults or tables is None or hardware is None:
        return RigFileReading(None, oscillator, channels, as_error(path, faults, original))
    free = is_simulated(hardware)
    # As written: a table that is read again elsewhere is handed on untouched.
    campaign = MappingProxyType(dict(original.get("campaign", {})))
    more = {
        # What no [[gauges]] states has its amplifier's range: no force goes unwatched for it.
        "gauges": tuple({g.channel: g for g in (*gauges_of(hardware), *tables.gauges)}.values()),
        "modes": tables.modes + modes,
        "realtime": not free if tables.realtime is None else tables.realtime,
        "campaign": campaign,
    }
    rig = RigFile(
        path=path,
        sha256=hashlib.sha256(content).hexdigest(),
        hardware=hardware,
        hardware_tables=MappingProxyType(devices),
        calibration=calibration,
        tables=MappingProxyType(original),
        content=content,
        **(vars(tables) | more),
    )
    return RigFileReading(rig, oscillator, channels)


def _more_modes(
    tables: RigTables | None, path: Path, faults: list[Fault]
) -> tuple[StructuralMode, ...]:
    """Read the pluck test's file, if one is named."""
    if tables is None or tables.modes_file is None:
        return ()
    file = path.parent / tables.modes_file
    inner: list[Fault] = []
    try:
        table = read_toml(file)
    except ConfigurationError as error:
        faults.append(Fault(("modes_file",), f"= {tables.modes_file!r}: {error}"))
        return ()
    content = validate(ModesFile, table, inner)
    inner += limit_faults(table)
    if content is None or inner:
        faults.append(
            Fault(("modes_file",), f"= {tables.modes_file!r}: {as_error(file, inner, table)}")
        )
        return ()
    return content.modes


def _calibration(
    tables: RigTables | None, hardware: RigConfiguration | None, path: Path, faults: list[Fault]
) -> Calibration | None:
    """Read the check weights' file, if one is named; its channels have to be the rig's gauges."""
    if tables is None or tables.calibration_file is None:
        return None
    try:
        calibration = read_calibration(path.parent / tables.calibration_file)
    except ConfigurationError as error:
        faults.append(Fault(("calibration_file",), f"= {tables.calibration_file!r}: {error}"))
        return None
    channels = calibration.channels if hardware is None else channels_of(hardware)
    faults += [
        Fault(
            ("calibration_file",),
            f"= {tables.calibration_file!r}: of {name!r}, which is no gauge of this rig "
            f"(channels: {', '.join(channels)})",
        )
        for name in calibration.channels
        if name not in channels
    ]
    return calibration


def is_simulated(hardware: RigConfiguration) -> bool:
    """Whether the rig is simulated in this process."""
    return hardware.bus is not None and hardware.bus.interface == SIMULATED


def _read_devices(devices: Mapping[str, Any], faults: list[Fault]) -> RigConfiguration | None:
    try:
        return read_rig(devices)
    except ConfigurationError as error:
        faults += [Fault((), line) for line in str(error).splitlines()]
        return None
