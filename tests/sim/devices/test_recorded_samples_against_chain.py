"""What comes through the protocols is what the chain says, but for the transport's rounding."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hardware.description.motor import Servo, SpeedLoop
from hardware.description.setpoint import SetPoint
from sim.acquisition.photocell import PhotocellStage
from sim.devices.plant import Plant, PlantConditions
from sim.devices.profile import SpeedProfile, following
from sim.rig import SimulatedRig, vertical_rig
from tests.hardware.rigs import COUNTS_PER_TURN
from tests.sim.devices.benches import NEWTON_PER_COUNT, WHOLE, in_process, turning

RATE_HZ = 100.0
ECCENTRICITY_M, PHASE_RAD = 0.02, 0.5
AROUND = PlantConditions(carriage_speed_m_s=1.2, seed=7)
SIGNALS = ("shaft_angle", "recorded_force_aft", "recorded_force_fore", "displacement_fore")


def chain_of(rig: SimulatedRig, profile: SpeedProfile, eccentricity_m: float = ECCENTRICITY_M):
    told = replace(rig, drive=following(rig.drive, profile))
    return told.chain(SetPoint(1.0, eccentricity_m, PHASE_RAD, AROUND.carriage_speed_m_s))


def loaded_rig() -> SimulatedRig:
    """A rig whose drive gives way, with memory in every place."""
    rig = vertical_rig()
    servo = Servo(loop=SpeedLoop(proportional=20.0, integral=100.0))
    cell = PhotocellStage(mark_angle_rad=0.3, latency_s=0.013, jitter_rms_s=1e-4)
    return replace(rig, drive=replace(rig.drive, motor=servo), photocell=cell)


def taken(plant: Plant, count: int) -> dict[str, list[float]]:
    """Advance; return the samples and the pulses."""
    found: dict[str, list[float]] = {name: [] for name in SIGNALS} | {"pulses": []}
    for _ in range(count):
        plant.advance()
        for name in SIGNALS:
            found[name].append(plant.value(name))
        found["pulses"] += [one.time_s for one in plant.passed()]
    return found


@pytest.mark.slow
@pytest.mark.parametrize("kind", [vertical_rig, loaded_rig])
@settings(max_examples=6, deadline=None)
@given(at=st.lists(st.integers(1, 200), min_size=1, max_size=4), vain=st.booleans())
def test_a_plant_that_takes_back_is_a_chain_that_knew(kind, at: list[int], vain: bool) -> None:
    """Commands in the middle of blocks give the samples of chains that were cut there."""
    rig = kind()
    plant = Plant(rig, AROUND, RATE_HZ, ECCENTRICITY_M, PHASE_RAD)
    speeds = [2.0 * math.pi * (0.3 + 0.2 * i) for i in range(len(at))]
    found: dict[str, list[float]] = {name: [] for name in (*SIGNALS, "pulses")}
    expected: dict[str, list[float]] = {name: [] for name in (*SIGNALS, "pulses")}
    chain = chain_of(rig, SpeedProfile())
    state, _ = chain.run(chain.start(RATE_HZ, AROUND.seed), 1)
    for count, speed in zip([*at, 100], [*speeds, None], strict=True):
        for name, values in taken(plant, count).items():
            found[name] += values
        state, run = chain.run(state, count)
        for name in SIGNALS:
            expected[name] += run[name].tolist()
        expected["pulses"] += run["photocell_edge_time"].tolist()
        if speed is None:
            break
        if vain:
            plant.turn(-speed, 1.0)  # taken back at once by the next command
        plant.turn(speed, 5.0)
        chain = chain_of(rig, plant.profile)
    for name in SIGNALS:
        assert found[name] == pytest.approx(expected[name], rel=1e-9, abs=1e-9), name
    due = [one for one in expected["pulses"] if one <= plant.time_s]
    assert found["pulses"] == pytest.approx(due, abs=1e-9)


def test_blocks_grow_while_nothing_changes_and_begin_anew_on_a_command() -> None:
    plant = Plant(vertical_rig(), AROUND, RATE_HZ, ECCENTRICITY_M, PHASE_RAD)
    for _ in range(2000):
        plant.advance()
    assert plant.blocks <= 9 + 2000 // 256 + 1
    before = plant.blocks
    plant.turn(1.0, 1.0)
    plant.advance()
    assert plant.blocks == before + 1


def harmonics(values, angle, orders: int = 3):
    """Least squares of mean and harmonics of the shaft angle."""
    columns = [np.ones_like(angle)]
    for k in range(1, orders + 1):
        columns += [np.sin(k * angle), np.cos(k * angle)]
    return np.linalg.lstsq(np.column_stack(columns), values, rcond=None)[0]


@pytest.mark.slow
def test_samples_and_harmonics_through_the_stack_are_the_chains() -> None:
    tables = {**WHOLE, "shaft": {**WHOLE["shaft"], "counts_per_turn": COUNTS_PER_TURN}}
    start = {"eccentricity_m": 0.019, "strut_phase_rad": 0.45}
    with in_process(tables, around=AROUND, **start) as (rig, world):
        turning(rig, ECCENTRICITY_M, PHASE_RAD, 1.0)
        for _ in range(200):
            rig.cycle()
        for one in (rig.shaft, rig.photocell, *rig.forces):
            one.take()
        true: dict[str, list[float]] = {"angle": [], "force_aft": [], "force_fore": []}
        for _ in range(1000):
            rig.cycle()
            true["angle"].append(world.plant.value("shaft_angle"))
            for name in ("force_aft", "force_fore"):
                true[name].append(world.plant.value(f"recorded_{name}"))
        measured = {one.channels[0].name: one.take() for one in (rig.shaft, *rig.forces)}
        pulses = rig.photocell.take()
        linkage = (rig.eccentricity.reading.value, rig.phase.reading.value)
        chain = chain_of(vertical_rig(), world.plant.profile, linkage[0])
    assert all(len(blocks) == 1 for blocks in measured.values()), "a sample was lost"
    for name in ("force_aft", "force_fore"):
        off = measured[name][0].values[0] - true[name]
        assert np.max(np.abs(off)) <= 0.5 * NEWTON_PER_COUNT + 1e-9
        angle = np.array(true["angle"])
        both = harmonics(measured[name][0].values[0], angle), harmonics(true[name], angle)
        # Rounding is at most half a count each; a harmonic is a mean of it with weight 2.
        assert np.max(np.abs(both[0] - both[1])) <= NEWTON_PER_COUNT
        assert np.max(np.abs(both[1])) > 10.0
    step = 2.0 * math.pi * (1.0 / COUNTS_PER_TURN + 1.0 / 2**16)
    # 6064 is of 32 bits and begins where the drive was switched on.
    off = measured["shaft_angle"][0].values[0] - true["angle"]
    assert np.max(np.abs(off - 2.0 * math.pi * round(off[0] / (2.0 * math.pi)))) <= step
    assert np.diff([one.time_s for one in pulses]) == pytest.approx(1.0, abs=1e-3)
    assert len(pulses) in (10, 11)  # of ten turns
    _steady_forces(chain, measured)


def _steady_forces(chain, measured) -> None:
    """The same harmonics from a fresh run of the chain, its own noise apart."""
    count = 4000
    _, run = chain.run(chain.start(RATE_HZ, 1), count)
    late = slice(count - 1000, count)
    angle = run["shaft_angle"][late]
    shaft = measured["shaft_angle"][0].values[0]
    for name in ("force_aft", "force_fore"):
        fresh = harmonics(run[f"recorded_{name}"][late], angle)
        ours = harmonics(measured[name][0].values[0], shaft)
        # 0.05 N of noise on 1000 samples is 2 mN; the encoder's step turns 90 N by some 60 mN.
        assert ours == pytest.approx(fresh, abs=0.1)
