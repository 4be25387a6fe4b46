"""A watch on simulated drives: at which true speed does a command of ours take the torque off?"""

from dataclasses import dataclass

from hardware.limits import AXIS_REST_SHARE, SHAFT_REST_SHARE
from sim.devices.drive import SimulatedDrive
from sim.devices.world import World
from tests.hardware.rigs import ECCENTRICITY, PHASE, SHAFT

# Below these speeds a command may take the power off: what docs/safety.md states.
REST_SPEEDS = {
    "shaft": SHAFT_REST_SHARE * SHAFT["highest_frequency_hz"],
    "eccentricity": AXIS_REST_SHARE * ECCENTRICITY["speed"],
    "phase": AXIS_REST_SHARE * PHASE["speed"],
}


@dataclass(frozen=True)
class PowerOff:
    """A control word that took the torque off: when, whose, and at which true speed."""

    time_s: float
    part: str
    speed: float


class PowerWatch:
    """Keeps every such control word."""

    def __init__(self, world: World) -> None:
        self.seen: list[PowerOff] = []
        self._world = world
        for name, node in world.nodes.items():
            if isinstance(node, SimulatedDrive):
                self._tap(name, node)

    @property
    def while_moving(self) -> list[PowerOff]:
        """Those above the speed of rest."""
        return [one for one in self.seen if abs(one.speed) > REST_SPEEDS[one.part]]

    def _tap(self, name: str, drive: SimulatedDrive) -> None:
        commanded = drive.commanded

        def tapped() -> None:
            before = drive.torque
            commanded()
            if before and not drive.torque:
                self.seen.append(PowerOff(self._world.time_s, name, drive.speed))

        drive.commanded = tapped
