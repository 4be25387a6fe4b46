"""Nothing is left behind; the simulated rig has its names although the package may run unpacked."""

from tests.sim.devices.conftest import _bus_name, _nothing_left_behind

__all__ = ["_bus_name", "_nothing_left_behind"]
