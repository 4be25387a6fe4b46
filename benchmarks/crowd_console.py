"""``pmm`` in a process of its own that notes when a quick stop is on the simulated bus.

The first argument is the file of the times, seconds of the machine's monotonic clock, a line each.
"""

import os
import sys
import time
from typing import Any, Final

_SHAFT_RPDO: Final = 0x201  # CiA 301: 0x200 and the shaft's node
_QUICKLY: Final = 0x0002  # CiA 402: quick stop, which is active low


def main() -> None:
    """Run the command line given behind the file."""
    import can
    from can.interfaces import BACKENDS

    from pmm.cli import main as pmm
    from sim.devices.bus import SimulatedBus

    BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
    times = os.open(sys.argv.pop(1), os.O_WRONLY | os.O_CREAT | os.O_APPEND)
    send = SimulatedBus.send

    def noted(self: SimulatedBus, msg: can.Message, timeout: float | None = None) -> None:
        send(self, msg, timeout)
        quickly = int.from_bytes(msg.data[:2], "little") == _QUICKLY
        if msg.arbitration_id == _SHAFT_RPDO and quickly:
            os.write(times, b"%.6f\n" % time.monotonic())

    patched: Any = SimulatedBus
    patched.send = noted
    pmm()


if __name__ == "__main__":
    main()
