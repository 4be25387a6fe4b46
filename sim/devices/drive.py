"""A simulated CiA 402 drive: the state machine, its ramps down, its faults."""

from typing import Final

from hardware.cia402 import TRANSITIONS, ControlWord, DriveCommand, DriveState, Mode, StatusWord
from hardware.dictionary import Entry
from hardware.drive import (
    CONTROL_WORD,
    ERROR_CODE,
    MODE,
    MODE_DISPLAY,
    POSITION,
    STATUS_WORD,
    VELOCITY,
)
from sim.devices.network import Wire
from sim.devices.node import Number, SimulatedNode

FOLLOWING_ERROR_CODE: Final = 0x8611
MASTER_LOST_CODE: Final = 0x8130
ACCELERATION, DECELERATION = Entry(0x6083), Entry(0x6084)
QUICK_STOP_DECELERATION = Entry(0x6085)
_FOLLOWING_ERROR = Entry(0x60F4)
_WINDOW, _WINDOW_MS = Entry(0x6065), Entry(0x6066)
_ABORT_CONNECTION, _QUICK_STOP_OPTION = Entry(0x6007), Entry(0x605A)
# "Shutdown" and "disable voltage" take the torque off at once (605B = 0, transitions 8, 9, 12).
_WITHOUT_TORQUE: Final = (DriveState.READY_TO_SWITCH_ON, DriveState.SWITCH_ON_DISABLED)
_STOPPING: Final = (DriveState.QUICK_STOP_ACTIVE, DriveState.FAULT_REACTION_ACTIVE)
_WITH_TORQUE: Final = (DriveState.OPERATION_ENABLED, *_STOPPING)
_WORDS: Final = {
    state: state.value[1]
    | int(StatusWord.REMOTE)
    | (int(StatusWord.VOLTAGE_ENABLED) if state.value[1] else 0)
    for state in DriveState
}


class SimulatedDrive(SimulatedNode):
    """What shaft and position axes share; what moves is up to the subclass.

    Attributes
    ----------
    state
        Of the power drive system; it begins in SWITCH ON DISABLED.
    bits
        Bits of the status word beyond the state's.
    blocked
        Fault: the axis does not move whatever the drive does.
    safe_torque_off
        The emergency stop is pressed: no torque, and no way up.
    """

    modes: tuple[Mode, ...] = ()

    def __init__(
        self, wire: Wire, name: str, node_id: int, eds: str, sample_rate_hz: float
    ) -> None:
        super().__init__(wire, name, node_id, eds, sample_rate_hz)
        self.state = DriveState.SWITCH_ON_DISABLED
        self.bits = 0
        self.blocked = self.safe_torque_off = False
        self._control = 0
        self._astray = 0
        self._connected = True
        self._begin()

    @property
    def standing(self) -> bool:
        """Whether nothing is demanded to move."""
        raise AssertionError("a drive says whether it stands")

    @property
    def speed(self) -> float:
        """The axis's true speed, in Hz, m/s or rad/s."""
        raise AssertionError("a drive knows how fast it moves")

    @property
    def torque(self) -> bool:
        """Whether the drive's state lets it make torque."""
        return self.state in _WITH_TORQUE

    def move(self) -> None:
        """Go on by one sample and bring position, velocity and ``bits`` up to date."""

    def obey(self, control: int, risen: int) -> None:
        """Act on a control word in OPERATION ENABLED; ``risen`` are the bits that came on."""

    def ramp_down(self, deceleration: Number) -> None:
        """Decelerate to rest, in the drive's units (0: at once)."""

    def coast(self) -> None:
        """Make no torque: inertia and friction alone decide."""

    def boot(self) -> None:
        """Restart as after a loss of power: the axis coasts meanwhile."""
        super().boot()
        self.coast()
        self._begin()

    def commanded(self) -> None:
        """Act on a whole RPDO: first the state machine, then the mode of operation."""
        control, before = int(self.values[CONTROL_WORD]), self._control
        self._control = control
        command = _command(control, before)
        following = TRANSITIONS.get((self.state, command)) if command is not None else None
        if following is not None and not (
            self.safe_torque_off and command is DriveCommand.SHUTDOWN
        ):
            self._enter_state(following[1])
        mode = self.values.get(MODE, 0)
        if mode in self.modes:
            self.values[MODE_DISPLAY] = mode
        if self.state is DriveState.OPERATION_ENABLED:
            self.obey(control, control & ~before)
        self._show()

    def tick(self) -> None:
        """Go on by one sample."""
        self.move()
        if self.state in _STOPPING:
            self._after_stop()
        if self.master_lost() is self._connected:
            self._connected = not self._connected
            if not self._connected:
                self._lose_master()
        self._show()

    def disconnected(self) -> None:
        """React to a stop of the node or a reset of its communication as object 6007 says."""
        self._lose_master()

    def fault(self, code: int, register: int = 1) -> None:
        """Go to FAULT with an error code, by the quick-stop ramp."""
        self.values[ERROR_CODE] = code
        self.emergency(code, register)
        self._enter_state(DriveState.FAULT_REACTION_ACTIVE)
        self._after_stop()
        self._show()

    def trip(self, code: int) -> None:
        """Go to FAULT without torque: mains lost, short circuit."""
        self.values[ERROR_CODE] = code
        self.emergency(code, 1)
        self.coast()
        self.state = DriveState.FAULT
        self._show()

    def cut_torque(self) -> None:
        """Switch the torque off as the emergency stop does, until it is released."""
        self.safe_torque_off = True
        if self.torque or self.state in (DriveState.READY_TO_SWITCH_ON, DriveState.SWITCHED_ON):
            self._enter_state(DriveState.SWITCH_ON_DISABLED)
            self._show()

    def stray(self, counts: float) -> None:
        """Take the following error of this sample; beyond its window for its time is a fault."""
        self.values[_FOLLOWING_ERROR] = round(counts)
        beyond = abs(counts) > self.number(_WINDOW) > 0
        self._astray = self._astray + 1 if beyond else 0
        limit = self.number(_WINDOW_MS) * self.sample_rate_hz / 1000.0
        if self._astray > limit and self.state is DriveState.OPERATION_ENABLED:
            self._astray = 0
            self.fault(FOLLOWING_ERROR_CODE, 0x21)

    def _begin(self) -> None:
        self.state, self.bits, self._control = DriveState.SWITCH_ON_DISABLED, 0, 0
        for at in (MODE_DISPLAY, POSITION, VELOCITY, ERROR_CODE, _FOLLOWING_ERROR):
            self.values[at] = 0
        self._show()

    def _enter_state(self, state: DriveState) -> None:
        before, self.state = self.state, state
        self.bits = 0
        if before is DriveState.FAULT:
            self.values[ERROR_CODE] = 0
            self.emergency(0, 0)
        if state in _WITHOUT_TORQUE and before not in _WITHOUT_TORQUE:
            self.coast()
        elif before is DriveState.OPERATION_ENABLED:
            gentle = state is DriveState.SWITCHED_ON
            self.ramp_down(self.number(DECELERATION if gentle else QUICK_STOP_DECELERATION))

    def _after_stop(self) -> None:
        """Leave the states that end when the axis stands."""
        if not self.standing:
            return
        if self.state is DriveState.FAULT_REACTION_ACTIVE:
            self.state = DriveState.FAULT
        elif self.state is DriveState.QUICK_STOP_ACTIVE and self.number(_QUICK_STOP_OPTION) < 5:
            self.state = DriveState.SWITCH_ON_DISABLED

    def _lose_master(self) -> None:
        """React to the loss of the controller's heartbeat as object 6007 says."""
        self.emergency(MASTER_LOST_CODE, 0x11)
        reaction = self.number(_ABORT_CONNECTION)
        if self.state is not DriveState.OPERATION_ENABLED or not reaction:
            return
        if reaction == 1:
            self.fault(MASTER_LOST_CODE, 0x11)
        else:
            quick = reaction == 3
            self._enter_state(
                DriveState.QUICK_STOP_ACTIVE if quick else DriveState.SWITCH_ON_DISABLED
            )

    def _show(self) -> None:
        self.values[STATUS_WORD] = _WORDS[self.state] | self.bits


def wrapped(counts: float) -> int:
    """Return a count as an object of 32 bits with sign holds it."""
    return (round(counts) + 2**31) % 2**32 - 2**31


def halting(control: int) -> bool:
    """Tell whether a control word asks for a halt."""
    return bool(control & ControlWord.HALT)


def _command(control: int, before: int) -> DriveCommand | None:
    if control & DriveCommand.FAULT_RESET:
        return None if before & DriveCommand.FAULT_RESET else DriveCommand.FAULT_RESET
    if not control & 0x02:
        return DriveCommand.DISABLE_VOLTAGE
    if not control & 0x04:
        return DriveCommand.QUICK_STOP
    if not control & 0x01:
        return DriveCommand.SHUTDOWN
    return DriveCommand.ENABLE_OPERATION if control & 0x08 else DriveCommand.SWITCH_ON
