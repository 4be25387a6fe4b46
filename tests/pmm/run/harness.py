"""Run control on the simulated rig, in this process and in simulated time."""

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hardware.description.kinds import Motion, RunKind
from hardware.description.oscillator import VERTICAL_1963
from hardware.description.setpoint import SetPoint
from hardware.pacing import FreeRunning
from hardware.rig import Rig
from hardware.rig_configuration import read_rig
from pmm.campaign.calibration import Calibration
from pmm.plan.plan import Plan
from pmm.plan.rig_file import RigFile
from pmm.plan.rig_tables import Gauge, RecorderSettings
from pmm.plan.run_plan import RunPlan
from pmm.run.journal import Taps
from pmm.run.recorder_factory import RecorderFactory
from pmm.run.run_control import RunControl
from pmm.run.states import Command, State
from sim.devices.bench_file import DRIVERS
from sim.devices.parts import Scene
from sim.devices.plant import PlantConditions
from sim.devices.registry import running
from sim.devices.world import World
from sim.rig import SimulatedRig, vertical_rig
from tests.hardware.rigs import ECCENTRICITY, PHASE, SHAFT
from tests.sim.devices.benches import amplifier

E_M, PHASE_RAD = 0.02, 0.5
NAME = "run-control"
# Homed where they stand, so that no test waits for axes.
TABLES: dict[str, Any] = {
    "shaft": {**SHAFT, "acceleration_hz_per_s": 2.0},
    "eccentricity": {**ECCENTRICITY, "home_position": E_M, "homing_speed": 0.05},
    "phase": {**PHASE, "home_position": PHASE_RAD, "homing_speed": 0.5},
    "forces": [amplifier(4, "force_aft"), amplifier(5, "force_fore")],
    "photocell": {"driver": "touch-probe"},
}


def absent(_question: str) -> str | None:
    """Nobody is there to answer."""
    return None


absent.absent = True  # type: ignore[attr-defined]


class Blind:
    """Looks at nothing."""

    def show(self, control: RunControl) -> None:
        return


def oscillation(name: str = "heave", frequency_hz: float = 1.0, **more: Any) -> RunPlan:
    """A short run."""
    given = {"periods": 4, "max_periods": 4, "settling_periods": 1, "kind": RunKind.OSCILLATION}
    given |= more
    point = SetPoint(
        frequency_hz, E_M, PHASE_RAD, given.pop("speed_m_s", 0.0), given.pop("medium", "water")
    )
    return RunPlan(name=name, motion=Motion.PHASE, set_point=point, **given)


def at_rest(name: str, kind: RunKind, duration_s: float = 1.0, **more: Any) -> RunPlan:
    """A run without motion."""
    told = {key: more.pop(key) for key in ("medium", "drift_rad") if key in more}
    point = SetPoint(0.0, 0.0, 0.0, more.pop("speed_m_s", 0.0), **told)
    return RunPlan(
        name=name, kind=kind, motion=Motion.NONE, set_point=point, duration_s=duration_s, **more
    )


@dataclass
class Bench:
    """A rig, its world and its run control."""

    control: RunControl
    world: World
    rig: Rig
    folder: Path
    wall_s: list[float] = field(default_factory=lambda: [0.0])

    def until(self, state: State, within: int = 6000) -> int:
        """Step until a state is reached; return how many cycles it took."""
        for count in range(within):
            if self.control.state is state:
                return count
            self.control.step()
        raise AssertionError(
            f"still {self.control.state} after {within} cycles; {self.control.status().alarms}"
        )

    def finish(self, within: int = 20000) -> None:
        """Step until nothing more happens."""
        for _ in range(within):
            if self.control.finished:
                return
            self.control.step()
        raise AssertionError(
            f"not finished after {within} cycles: {self.control.state}, "
            f"{self.control.status().question!r} {self.control.status().alarms}"
        )

    def at_rest(self) -> bool:
        """Whether the simulated shaft stands."""
        return self.world.plant.speed_rad_s == 0.0


@contextmanager
def bench(
    folder: Path,
    runs: Sequence[RunPlan],
    *,
    tables: dict[str, Any] | None = None,
    simulated: SimulatedRig | None = None,
    prompt: Callable[[str], str | None] = absent,
    gauges: tuple[Gauge, ...] = (),
    serial: tuple[str, ...] = (),
    start: bool = True,
    scene: dict[str, float] | None = None,
    view: Any = None,
    reserve_mb: float = 1.0,
    calibration: Calibration | None = None,
    utc: Callable[[], str] = lambda: "2026-01-01T00:00:00+00:00",
    executor: Executor | None = None,
) -> Iterator[Bench]:
    """A rig with the runs to do; ``serial`` parts are on ``sim://``."""
    whole = dict(tables or TABLES)
    for part in serial:
        whole[part] = {**whole[part], "port": {"url": f"sim://{NAME}/{part}"}}
    whole["bus"] = {
        "interface": "pmm-simulated",
        "channel": NAME,
        "receive_thread": False,
        **whole.get("bus", {}),
    }
    configuration = read_rig(whole, DRIVERS)
    place = {"eccentricity_m": E_M - 1e-4, "strut_phase_rad": PHASE_RAD - 1e-3}
    place |= scene or {}
    world = World(configuration, Scene(simulated or vertical_rig(), PlantConditions(), **place))
    rig_file = RigFile(
        path=Path("rig.toml"),
        sha256="0" * 64,
        oscillator=VERTICAL_1963,
        hardware=configuration,
        gauges=gauges,
        calibration=calibration,
        recorder=RecorderSettings(reserve_mb=reserve_mb),
        realtime=False,
        hardware_tables=MappingProxyType(whole),
    )
    plan = Plan(
        name="test",
        path=Path("plan.toml"),
        rig_path=Path("rig.toml"),
        runs=tuple(runs),
        operator="nobody",
        sha256="1" * 64,
    )
    taps = Taps()
    wall_s = [0.0]
    with (
        running(NAME, world),
        Rig(
            configuration,
            lambda: world.time_s,
            FreeRunning(),
            prompt,
            observers=(taps.frame,),
            line_observers=(taps.line,),
        ) as rig,
        RecorderFactory(rig, rig_file, plan, folder, utc, taps) as recording,
    ):
        rig.prepare()
        folder.mkdir(parents=True, exist_ok=True)

        def now_s() -> float:
            return world.time_s

        control = RunControl(rig, rig_file, runs, recording.begin, now_s, view or Blind(), executor)
        one = Bench(control, world, rig, folder, wall_s)
        if start:
            control.request(Command.START)
        yield one
