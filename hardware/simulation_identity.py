"""What a simulated rig behind a bus says of itself: which rig it simulates.

A real bus has nothing to say. The interface that python-can finds under the bus's name is asked, so
that whoever drives a rig knows no simulator.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from hardware.bus import BusConfiguration
from hardware.installed import installed


@dataclass(frozen=True)
class SimulatedTables:
    """The rig that is simulated, under the names of ``campaign.toml``.

    Attributes
    ----------
    file
        Its file.
    rig
        All that is simulated.
    file_tables
        What the file itself states, beside what it takes from a rig's file.
    """

    file: str
    rig: Mapping[str, Any]
    file_tables: Mapping[str, Any]


def simulated_behind(bus: BusConfiguration | None) -> SimulatedTables | None:
    """Return what is simulated behind a bus; ``None`` for a real one, and where nobody can say.

    Raises
    ------
    ConfigurationError
        If the simulated rig's file is wrong.
    """
    if bus is None:
        return None
    for point in installed("can.interface", bus.interface):
        tell = getattr(point.load(), "tables", None)
        if tell is not None:
            tables = tell(bus.channel)
            return tables if isinstance(tables, SimulatedTables) else None
    return None
