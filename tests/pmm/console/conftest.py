"""Nothing is left behind; the simulated bus has its name although the package may run unpacked."""

from collections.abc import Iterator

import can
import pytest

from tests.hardware.leaks import Leaks


@pytest.fixture(autouse=True)
def _nothing_left_behind(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    leaks = Leaks(monkeypatch)
    yield
    left = leaks.found()
    assert not left, f"left behind: {', '.join(left)}"


@pytest.fixture(autouse=True, scope="session")
def _bus_name() -> None:
    can.interface.BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
