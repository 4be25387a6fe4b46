"""What all CiA 402 drives share: settings, state, control word, faults."""

from collections.abc import Iterable
from typing import Final

from hardware.cia402 import Control, Goal, Mode, State, Status, Walk, next_command
from hardware.description.errors import ConfigurationError
from hardware.dictionary import Entry, has
from hardware.errors import (
    DriveFaultError,
    FollowingError,
    HardwareError,
    TransitionTimeoutError,
)
from hardware.node import Node
from hardware.sdo import Number

CONTROL_WORD, STATUS_WORD = Entry(0x6040), Entry(0x6041)
MODE, MODE_DISPLAY = Entry(0x6060), Entry(0x6061)
POSITION, VELOCITY, ERROR_CODE = Entry(0x6064), Entry(0x606C), Entry(0x603F)
TARGET_POSITION, TARGET_VELOCITY = Entry(0x607A), Entry(0x60FF)
PROBE_POSITION, PROBE_EDGES, PROBE_STATUS = Entry(0x60BA), Entry(0x60D5), Entry(0x60B9)

STATE_PDOS: Final = ((STATUS_WORD, MODE_DISPLAY, POSITION), (VELOCITY, ERROR_CODE))
PROBE_PDO: Final = (PROBE_POSITION, PROBE_EDGES, PROBE_STATUS)

_SUPPORTED_MODES = Entry(0x6502)
_FOLLOWING_ERROR_CODE: Final = 0x8611
_SAFETY: Final = (
    (Entry(0x6007), 3),  # connection lost: quick stop
    (Entry(0x605A), 6),  # quick stop: decelerate on the quick-stop ramp and stay in that state
    (Entry(0x605E), 2),  # fault: decelerate on the quick-stop ramp
    (Entry(0x605D), 1),  # halt: decelerate along the profile
)
STEP_CYCLES: Final = 50


class Drive:
    """A drive on its node: keeps the control word going and notices what goes wrong.

    Attributes
    ----------
    mode
        The mode of operation that is asked for.
    extra
        Bits of the control word beyond the state machine's; sent in OPERATION ENABLED only.
    """

    def __init__(self, node: Node, modes: tuple[Mode, ...]) -> None:
        self.node = node
        self.mode = modes[0]
        self.extra = Control(0)
        self._modes = modes
        self._walk = Walk(node.name, STEP_CYCLES)
        self._strayed = False
        self._deadline: int | None = None
        self._waiting_for = ""

    @property
    def status(self) -> Status:
        """The status word, state bits included."""
        return Status(int(self.node.values[STATUS_WORD]))

    @property
    def enabled(self) -> bool:
        """Whether the drive is in OPERATION ENABLED and is to be."""
        return self._walk.goal is Goal.ENABLED and self._walk.state is State.OPERATION_ENABLED

    @property
    def stopping(self) -> bool:
        """Whether a quick stop was commanded."""
        return self._walk.goal is Goal.QUICK_STOPPED

    @property
    def in_mode(self) -> bool:
        """Whether the drive displays the mode that is asked for."""
        return int(self.node.values[MODE_DISPLAY]) == self.mode

    def prepare(self, settings: Iterable[tuple[Entry, Number]]) -> None:
        """Check the supported modes, write the safety options and the axis's own settings.

        Raises
        ------
        ConfigurationError
            If the drive does not support a mode that the axis needs.
        """
        supported = int(self.node.sdo.read(_SUPPORTED_MODES))
        for mode in self._modes:
            if not supported & mode.supported_bit:
                raise ConfigurationError(
                    f"{self.node.name}: the drive does not support {mode.name.lower()} "
                    f"(object 6502 = 0x{supported:08X}, bit {mode.value - 1} is 0)"
                )
        for at, value in (*_SAFETY, *settings):
            if has(self.node.dictionary, at):
                self.node.sdo.write(at, value)

    def head_for(self, goal: Goal) -> None:
        """Change the state to be in; a pending deadline is off."""
        self._walk.head_for(goal)
        self.extra = Control(0)
        self._deadline = None

    def reset_fault(self) -> None:
        """Reset the drive's fault; it stays disabled."""
        self.head_for(Goal.DISABLED)
        self._walk.reset_fault()
        self._strayed = False

    def within(self, cycles: float, what: str) -> None:
        """Set the deadline for what the axis waits for; :meth:`done` takes it back."""
        self._deadline, self._waiting_for = round(cycles), what

    def done(self) -> None:
        """Take the deadline back."""
        self._deadline = None

    def tick(self) -> None:
        """Take the status word, set the control word.

        Raises
        ------
        DriveFaultError, FollowingError, DriveStateError, TransitionTimeoutError
            Each once.
        """
        status = self.status
        try:
            word = self._walk.tick(int(status))
        except DriveFaultError as error:
            self._put(next_command(self._walk.state, self._walk.goal))
            raise self._named() from error
        except HardwareError:
            self._put(next_command(self._walk.state, self._walk.goal))
            raise
        self._put(word)
        self._watch(status)

    def _put(self, word: int) -> None:
        extra = self.extra if self.enabled else Control(0)
        self.node.put(CONTROL_WORD, word | extra)
        self.node.put(MODE, self.mode)

    def _named(self) -> HardwareError:
        code = int(self.node.values[ERROR_CODE])
        if code == _FOLLOWING_ERROR_CODE:
            return FollowingError(self.node.name, f"outside its window (error 0x{code:04X})")
        return DriveFaultError(
            self.node.name, f"{self._walk.state.name}, error code 0x{code:04X} (603F); reset it"
        )

    def _watch(self, status: Status) -> None:
        stray = self.enabled and self.mode is not Mode.HOMING and Status.FOLLOWING_ERROR in status
        if stray and not self._strayed:
            self._strayed = True
            raise FollowingError(
                self.node.name, f"outside its window (status word 0x{int(status):04X}, bit 13)"
            )
        self._strayed = stray
        if self._deadline is None:
            return
        self._deadline -= 1
        if self._deadline < 0:
            self._deadline = None
            raise TransitionTimeoutError(
                self.node.name,
                f"{self._waiting_for}: not in time (status word 0x{int(status):04X}, "
                f"position {self.node.values[POSITION]})",
            )
