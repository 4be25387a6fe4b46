"""What is still under way at the start, and what fails at the end, are no faults of a run."""

import can
import pytest

from hardware.errors import NodeStateError
from tests.hardware.doubles import Drive
from tests.hardware.rigs import SHAFT, on_bus


def test_a_heartbeat_that_was_under_way_at_the_start_is_no_fault() -> None:
    """A node says pre-operational until it has taken the start; later that is a fault."""
    with on_bus({"shaft": SHAFT}, lambda n: Drive(n, 1)) as (rig, drive):
        drive.network.send_message(0x701, bytes((127,)))
        for _ in range(14):  # as long as the first heartbeat may take: 10 cycles and 3
            rig.cycle()
        drive.network.send_message(0x701, bytes((127,)))
        with pytest.raises(NodeStateError, match="state 127"):
            rig.cycle()


def test_an_adapter_that_fails_in_closing_does_not_fail_the_closing(monkeypatch) -> None:
    with on_bus({"shaft": SHAFT}, lambda n: Drive(n, 1)) as (rig, _):
        bus = rig.master._bus
        shutdown = bus.shutdown

        def fails() -> None:
            shutdown()
            raise can.CanOperationError("Could not write to serial device")

        monkeypatch.setattr(bus, "shutdown", fails)
        rig.close()
