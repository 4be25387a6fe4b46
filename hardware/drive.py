"""What all CiA 402 drives share: settings, state, control word, faults."""

from collections.abc import Iterable
from typing import Final

from hardware.cia402 import ERROR_WORDS, ControlWord, DriveState, Mode, StatusWord
from hardware.description.errors import ConfigurationError
from hardware.dictionary import Entry, has
from hardware.drive_state_machine import DriveStateMachine, Goal
from hardware.errors import (
    DriveFaultError,
    FollowingError,
    HardwareError,
    SdoAbortError,
    TransitionTimeoutError,
)
from hardware.limits import READ_BACK_SHARE, REST_DEADLINE_S
from hardware.motion import EncoderMotion
from hardware.node import CONSUMED_BEAT, Node
from hardware.sdo import Number

CONTROL_WORD, STATUS_WORD = Entry(0x6040), Entry(0x6041)
MODE, MODE_DISPLAY = Entry(0x6060), Entry(0x6061)
POSITION, VELOCITY, ERROR_CODE = Entry(0x6064), Entry(0x606C), Entry(0x603F)
TARGET_POSITION, TARGET_VELOCITY = Entry(0x607A), Entry(0x60FF)
PROBE_POSITION, PROBE_EDGES, PROBE_STATUS = Entry(0x60BA), Entry(0x60D5), Entry(0x60B9)

STATE_PDOS: Final = ((STATUS_WORD, MODE_DISPLAY, POSITION), (VELOCITY, ERROR_CODE))
_POSITION_AT: Final = STATE_PDOS[0].index(POSITION)
PROBE_PDO: Final = (PROBE_POSITION, PROBE_EDGES, PROBE_STATUS)

_SUPPORTED_MODES, _MAX_MOTOR_SPEED = Entry(0x6502), Entry(0x6080)
_FOLLOWING_ERROR: Final = int(StatusWord.FOLLOWING_ERROR)
_FOLLOWING_ERROR_CODE: Final = 0x8611
_SAFETY: Final = (
    (Entry(0x6007), 3),  # connection lost: quick stop
    (Entry(0x605A), 6),  # quick stop: decelerate on the quick-stop ramp and stay in that state
    (Entry(0x605B), 1),  # shutdown: decelerate along the profile before the power goes
    (Entry(0x605C), 1),  # disable operation: the same
    (Entry(0x605D), 1),  # halt: decelerate along the profile
    (Entry(0x605E), 2),  # fault: decelerate on the quick-stop ramp
)
# What CiA 402 leaves to the maker: a drive without one of them is named, and used all the same.
_OPTIONAL: Final = {
    0x1016: "consumer heartbeat time: it goes on when the controller falls silent",
    0x6007: "abort connection option: it may go on when the controller falls silent",
    0x605A: "quick stop option: it stops as its maker chose",
    0x605B: "shutdown option: it stops as its maker chose",
    0x605C: "disable operation option: it stops as its maker chose",
    0x605D: "halt option: it stops as its maker chose",
    0x605E: "fault reaction option: it stops as its maker chose",
    0x6065: "following error window: it does not notice that it strays",
    0x6066: "following error time-out: it decides itself how long it may stray",
    0x6067: "position window: it decides itself what arrived means",
    0x607C: "home offset: it counts from its own reference",
    0x607D: "software position limit: the controller alone keeps it",
    0x607F: "max profile velocity: the controller alone keeps it",
    0x6080: "max motor speed: the controller alone keeps it",
    0x6084: "profile deceleration: it stops at its acceleration",
    0x6085: "quick stop deceleration: it stops as its maker chose",
    0x60C2: "interpolation time: it takes the time between set-points as its maker chose",
    0x609A: "homing acceleration: it homes as its maker chose",
}
_ABSENT: Final = (0x06020000, 0x06090011)  # CiA 301: no such object, no such sub-index
STEP_CYCLES: Final = 50


class Drive:
    """A drive on its node: keeps the control word going and notices what goes wrong.

    Attributes
    ----------
    mode
        The mode of operation that is asked for.
    extra
        Bits of the control word beyond the state machine's; sent in OPERATION ENABLED only.
    motion
        Whether the axis moves, by the positions that the drive sends.
    notes
        What the drive lacks of its optional objects, a sentence each; known once it is prepared.
    """

    def __init__(self, node: Node, modes: tuple[Mode, ...], motion: EncoderMotion) -> None:
        self.node = node
        self.motion = motion
        self.mode = modes[0]
        self.extra = ControlWord(0)
        self._modes = modes
        self._machine = DriveStateMachine(
            node.name, STEP_CYCLES, round(REST_DEADLINE_S * motion.sample_rate_hz)
        )
        self._strayed = False
        self._deadline: int | None = None
        self._waiting_for = ""
        self.notes: tuple[str, ...] = ()

    @property
    def status(self) -> StatusWord:
        """The status word, state bits included."""
        return StatusWord(int(self.node.values[STATUS_WORD]))

    @property
    def enabled(self) -> bool:
        """Whether the drive is in OPERATION ENABLED and is to be."""
        return (
            self._machine.goal is Goal.ENABLED
            and self._machine.state is DriveState.OPERATION_ENABLED
        )

    @property
    def in_mode(self) -> bool:
        """Whether the drive displays the mode that is asked for."""
        return int(self.node.values[MODE_DISPLAY]) == self.mode

    def prepare(self, settings: Iterable[tuple[Entry, Number]]) -> None:
        """Check the supported modes, write the safety options and the axis's own settings.

        Everything is read back. An optional object that the drive lacks is told in :attr:`notes`.

        Raises
        ------
        ConfigurationError
            If the drive does not support a mode that the axis needs, or keeps another value than
            the one that was written.
        SdoAbortError
            If it refuses a value, or lacks an object that is not optional.
        """
        supported = int(self.node.sdo.read(_SUPPORTED_MODES))
        for mode in self._modes:
            if not supported & mode.supported_bit:
                raise ConfigurationError(
                    f"{self.node.name}: the drive does not support {mode.name.lower()} "
                    f"(object 6502 = 0x{supported:08X}, bit {mode.value - 1} is 0)"
                )
        lacking = [at for at in (CONSUMED_BEAT,) if not has(self.node.dictionary, at)]
        lacking += [at for at, value in (*_SAFETY, *settings) if not self._keep(at, value)]
        self.notes = tuple(
            f"{self.node.name}: the drive lacks object {at}, {_OPTIONAL[at.object_index]}"
            for at in lacking
        )

    def _keep(self, at: Entry, value: Number) -> bool:
        """Write an object and read it back; tell whether the drive has it."""
        try:
            self.node.sdo.write(at, value)
            reading = self.node.sdo.read(at)
        except SdoAbortError as error:
            if error.code not in _ABSENT or at.object_index not in _OPTIONAL:
                raise
            return False
        if not isinstance(reading, str) and abs(reading - value) <= READ_BACK_SHARE * abs(value):
            return True
        raise ConfigurationError(
            f"{self.node.name}: object {at} was set to {value} and reads {reading} (limit "
            f"{READ_BACK_SHARE:.0%} off); set the drive's own range, or rig.toml, so that it fits"
        )

    def head_for(self, goal: Goal) -> None:
        """Change the state to be in; a pending deadline is off."""
        self._machine.head_for(goal)
        self.extra = ControlWord(0)
        self._deadline = None

    def reset_fault(self) -> None:
        """Reset the drive's fault; it stays disabled."""
        self.head_for(Goal.DISABLED)
        self._machine.reset_fault()
        self._strayed = False

    def set_deadline(self, cycles: float, event: str) -> None:
        """Set the deadline for what the axis waits for; :meth:`cancel_deadline` takes it back."""
        self._deadline, self._waiting_for = round(cycles), event

    def cancel_deadline(self) -> None:
        """Take the deadline back."""
        self._deadline = None

    def listen(self, number: int) -> list[tuple[int, int]]:
        """Take the positions of cycle ``number``; return them with their numbers, unwrapped."""
        samples = self.node.streams[0].samples
        return self.motion.take(
            number, [(sync, int(values[_POSITION_AT])) for sync, values in samples]
        )

    def tick(self) -> None:
        """Take the status word, set the control word.

        Raises
        ------
        DriveFaultError, FollowingError, DriveStateError, TransitionTimeoutError, NotAtRestError
            Each once.
        """
        status = int(self.node.values[STATUS_WORD])
        try:
            self._machine.tick(status, at_rest=self.motion.at_rest)
        except DriveFaultError as error:
            raise self._drive_fault() from error
        finally:
            self._write_control()
        self._watch(status)

    def _write_control(self) -> None:
        extra = int(self.extra) if self.enabled else 0
        self.node.put(CONTROL_WORD, self._machine.word | extra)
        self.node.put(MODE, self.mode)

    def _drive_fault(self) -> HardwareError:
        code = int(self.node.values[ERROR_CODE])
        if code == _FOLLOWING_ERROR_CODE:
            return FollowingError(self.node.name, f"outside its window (error 0x{code:04X})")
        words = f": {ERROR_WORDS[code]}" if code in ERROR_WORDS else ""
        return DriveFaultError(
            self.node.name,
            f"{self._machine.state.name}, error code 0x{code:04X} (603F){words}; reset it",
        )

    def _watch(self, status: int) -> None:
        strayed = bool(status & _FOLLOWING_ERROR)
        stray = strayed and self.enabled and self.mode is not Mode.HOMING
        if stray and not self._strayed:
            self._strayed = True
            raise FollowingError(
                self.node.name, f"outside its window (status word 0x{status:04X}, bit 13)"
            )
        self._strayed = stray
        if self._deadline is None:
            return
        self._deadline -= 1
        if self._deadline < 0:
            self._deadline = None
            raise TransitionTimeoutError(
                self.node.name,
                f"{self._waiting_for}: not in time (status word 0x{status:04X}, "
                f"position {self.node.values[POSITION]})",
            )


def motor_speed(rpm: float | None) -> tuple[tuple[Entry, Number], ...]:
    """Return what sets a motor's highest speed; nothing where it is not given."""
    return () if rpm is None else ((_MAX_MOTOR_SPEED, round(rpm)),)
