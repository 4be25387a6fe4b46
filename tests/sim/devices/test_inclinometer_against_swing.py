"""The inclinometer says what the swing's chain recorded, sample by sample at its own rate."""

import numpy as np
import pytest

from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.registry import running
from sim.devices.serial_devices import Swinging
from sim.devices.world import World
from sim.pendulum.benches import swing_bench
from sim.rig import vertical_rig
from tests.hardware.rigs import nobody

RATE_HZ, SEED, SIGNAL = 256.0, 4, "recorded_inclinometer_angle"


@pytest.mark.slow
def test_the_swing_arrives_as_the_chain_recorded_it() -> None:
    chain = swing_bench(upper_pivot=True, release_rad=0.03).chain()
    _, run = chain.run(chain.start(RATE_HZ, SEED), 1000)
    port = {"url": "sim://swing/inclinometer"}
    tables = {"inclinometer": {"driver": "serial-inclinometer", "port": port}}
    configuration = read_rig(tables, DRIVERS)
    swing = Swinging(chain, SIGNAL, RATE_HZ, SEED)
    world = World(configuration, Scene(vertical_rig(), angles=swing))
    with (
        running("swing", world),
        Rig(configuration, lambda: world.time_s, FreeRunning(), nobody) as rig,
    ):
        rig.prepare()
        for _ in range(300):
            rig.cycle()
        (block,) = rig.inclinometer.take()
    assert block.first == 0
    assert block.values.shape[1] == 1 + int(3.0 * RATE_HZ)
    # Ten digits of a degree are on the line.
    assert block.values[0] == pytest.approx(run[SIGNAL][: block.values.shape[1]], abs=1e-10)
    assert np.ptp(block.values[0]) > 0.003
