"""``pmm`` in a process of its own; the simulated bus has its name although nothing is installed."""

import can

from pmm.cli import main

if __name__ == "__main__":
    can.interface.BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))
    main()
