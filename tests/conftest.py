"""What holds for every test: the same examples each time, and nothing is left behind."""

from collections.abc import Iterator

import can
import pytest
from hypothesis import settings

from tests.hardware.leaks import Leaks

settings.register_profile("seeded", derandomize=True)
settings.load_profile("seeded")


@pytest.fixture(autouse=True)
def _nothing_left_behind() -> Iterator[None]:
    """Fail the test that leaves a bus, a port, a thread or a process."""
    with pytest.MonkeyPatch.context() as patch:
        leaks = Leaks(patch)
        yield
        left = leaks.found()
    assert not left, f"left behind: {', '.join(left)}"


@pytest.fixture(autouse=True, scope="session")
def _bus_name() -> None:
    """Give the simulated bus its name although the package may run unpacked."""
    can.interface.BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
