"""A rig or a bus to look at: from ``rig.toml``, or from an interface or port alone."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

from hardware.bus import BusConfiguration
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane
from hardware.rig_configuration import ROLES, RigConfiguration, read_rig
from pmm.configuration import read_toml

SIMULATED: Final = "pmm-simulated"
_SIM: Final = "sim://"
_DEVICES: Final = (*ROLES, "bus", "cycle_rate_hz")


class DeviceTables:
    """The tables of a rig's file that name devices; the file may have others, not looked at here.

    Raises
    ------
    ConfigurationError
        If the file cannot be read, or names no device.
    """

    def __init__(self, path: Path) -> None:
        tables = read_toml(path)
        self.path = path
        self.devices: dict[str, Any] = {key: tables[key] for key in _DEVICES if key in tables}
        if not self.devices:
            choices = ", ".join(_DEVICES)
            raise ConfigurationError(f"{path}: names no device; the tables are {choices}")
        self.plane = _plane(tables)
        _resolve_simulated_paths(self.devices, path.parent)

    def configuration(self) -> RigConfiguration:
        """Return the rig, checked as a whole; raises :class:`ConfigurationError`."""
        try:
            return read_rig(self.devices)
        except ConfigurationError as error:
            raise ConfigurationError(f"{self.path}: {error}") from error

    def ports(self) -> dict[str, dict[str, Any]]:
        """Return the port of each serial device, by its part's name."""
        ports = {}
        for name, table in self._parts():
            port = table.get("port")
            if isinstance(port, dict) and isinstance(port.get("url"), str):
                ports[name] = port
        return ports

    def _parts(self) -> list[tuple[str, Mapping[str, Any]]]:
        parts = []
        for key, table in self.devices.items():
            is_array = isinstance(table, list)
            for i, entry in enumerate(table if is_array else [table]):
                if isinstance(entry, Mapping):
                    parts.append((f"{key}[{i}]" if is_array else key, entry))
        return parts


def bus_alone(
    interface: str, channel: str, bit_rate: int, options: Mapping[str, int | float | str | bool]
) -> BusConfiguration:
    """Return a bus that nothing is known of but how to open it."""
    return BusConfiguration(
        interface,
        channel,
        bit_rate,
        receive_thread=interface != SIMULATED,
        options=options,
    )


def _plane(tables: Mapping[str, Any]) -> Plane | None:
    oscillator = tables.get("oscillator")
    plane = oscillator.get("plane") if isinstance(oscillator, Mapping) else None
    return Plane(plane) if plane in set(Plane) else None


def _resolve_simulated_paths(devices: Mapping[str, Any], folder: Path) -> None:
    """Let a simulated rig's file be seen from the rig's file, wherever the command is given."""
    bus = devices.get("bus")
    if isinstance(bus, dict) and bus.get("interface") == SIMULATED:
        bus["channel"] = _resolved_path(str(bus.get("channel")), folder)
    for table in devices.values():
        for part in table if isinstance(table, list) else [table]:
            port = part.get("port") if isinstance(part, dict) else None
            url = port.get("url") if isinstance(port, dict) else None
            if isinstance(port, dict) and isinstance(url, str) and url.startswith(_SIM):
                file, _, name = url.removeprefix(_SIM).rpartition("/")
                port["url"] = f"{_SIM}{_resolved_path(file, folder)}/{name}"


def _resolved_path(name: str, folder: Path) -> str:
    return (folder / name).resolve().as_posix() if name.endswith(".toml") else name
