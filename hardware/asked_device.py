"""What devices behind registers share that move: power, whose hand they are in, what is asked."""

import math
from collections.abc import Iterable, Iterator, Mapping

from hardware.analogue_link import AnalogueNumber
from hardware.asked_link import READ, WRITE, Answer, AskedSettings, RegisterRequest
from hardware.driver import Services
from hardware.errors import (
    DriveFaultError,
    DriveStateError,
    HardwareError,
    SilentPortError,
    TransitionTimeoutError,
    worst,
)
from hardware.line_registers import LineCommand, LineNumber, LineStatus
from hardware.modbus_registers import CommandRegister, Register, StatusRegister
from hardware.roles import Cycle

Place = tuple[int, int]  # function that reads it, address
Number = Register | LineNumber | AnalogueNumber
Status = StatusRegister | LineStatus
Command = CommandRegister | LineCommand


class AskedDevice:
    """Reads registers in turn and writes what has changed.

    Parameters
    ----------
    numbers
        The registers that are read, by a name each.

    Attributes
    ----------
    values
        What they read last, in SI units; NaN before, and after a silence.
    read_now
        Names of those that were read in the present cycle.
    """

    def __init__(
        self,
        name: str,
        settings: AskedSettings,
        services: Services,
        numbers: Mapping[str, Number],
        status: Status | None,
        command: Command | None,
    ) -> None:
        self.name = name
        self.values = dict.fromkeys(numbers, math.nan)
        self.read_now: set[str] = set()
        self._link = settings.link(name, services)
        self._numbers, self._status, self._command = dict(numbers), status, command
        self._refresh_s, self._silent_s = settings.refresh_s, settings.silent_s
        self._spans = spans(numbers.values(), status)
        self._turn = 0
        self._word: int | None = None  # of the status
        self._told: dict[int, tuple[int, ...]] = {}  # what is to stand at an address
        self._kept: dict[int, tuple[tuple[int, ...], float]] = {}  # what does, and since when
        self._wants_power = self._resets = self._toggle = False
        self._stands = False  # whether what it was told stands there, since power was asked for
        self._read_next = False
        self._life: tuple[float, float] | None = None  # the device's own counter, and since when
        self._deadline_s = math.inf
        self._waiting_for = ""
        self._now_s = 0.0
        self._known: set[type] = set()

    @property
    def enabled(self) -> bool:
        """Whether it is under power, as far as it says, and in the program's hand, and reads."""
        refused = False in (self._says("remote"), self._says("ready"))
        return self._wants_power and self.is_answering and not refused

    @property
    def is_answering(self) -> bool:
        """Whether it answers, and has told all that is read."""
        is_complete = not any(map(math.isnan, self.values.values()))
        return self._link.is_open and self._link.is_answering and is_complete

    def reconnect(self) -> None:
        """Open a lost port again, and ask anew; raises as :meth:`reset_fault`."""
        self._forget()
        self._life = None
        self._link.reset()

    def prepare(self) -> None:
        """Write the device's settings, if it has any; the first answers come with the cycles."""
        self._link.prepare()

    def enable(self) -> None:
        """Ask for power, at rest; a fault follows where a person has it in hand.

        Power is written once what the device was told stands there, written anew.
        """
        if not self._wants_power:
            self._kept.clear()
            self._stands = False
        self._wants_power = True

    def reset_fault(self) -> None:
        """Clear an alarm; it stays without power. A port that is still lost is opened again.

        Raises
        ------
        PortOpenError
            If the port is still not there.
        """
        self._wants_power, self._resets = False, True
        self._known.clear()
        self.cancel_deadline()
        if self.is_answering:
            self._life = None
            self._link.forget()
        else:
            self.reconnect()

    def close(self) -> None:
        """Close the port."""
        self._link.close()

    def set_deadline(self, seconds: float, event: str) -> None:
        """Set the deadline for what is waited for; :meth:`cancel_deadline` takes it back."""
        self._deadline_s, self._waiting_for = self._now_s + seconds, event

    def cancel_deadline(self) -> None:
        """Cancel the deadline: what was commanded has been reached."""
        self._deadline_s = math.inf

    def tell(self, register: Number, value: float) -> None:
        """Have a number, in SI units, stand in a register from now on."""
        self._told[register.address] = register.written(value)

    def exchange(self, cycle: Cycle) -> tuple[bool, list[HardwareError]]:
        """Take what came; return whether the values are new, and what is wrong, once each."""
        self._now_s = cycle.time_s
        self.read_now.clear()
        answers, faults = self._link.exchange(cycle, self._following)
        fresh = [self._take(answer) for answer in answers]
        if not self._link.is_answering:
            self._forget()
        self._stands = self._stands or self._is_told()
        wrong = [error for error in self._device_faults() if type(error) not in self._known]
        self._known |= {type(error) for error in wrong}
        return any(fresh), faults + wrong

    def _forget(self) -> None:
        """Take what it read, and what it was told, for old."""
        self.values = dict.fromkeys(self.values, math.nan)
        self._kept.clear()
        self._stands = False

    def _is_told(self) -> bool:
        """Whether it has said of all that it is told that it stands there."""
        return all(self._acknowledges(address) for address in self._told)

    def _acknowledges(self, address: int) -> bool:
        """Whether it has said that what it is told stands at an address."""
        told = self._told.get(address)
        return told is not None and self._kept.get(address, ((), 0.0))[0] == told

    def _says(self, name: str) -> bool | None:
        return None if self._status is None else self._status.says(name, self._word)

    def _device_faults(self) -> Iterator[HardwareError]:
        if self._says("alarm"):
            yield DriveFaultError(
                self.name, "reports an alarm; clear its cause at its panel, then reset"
            )
        if self._wants_power and self._says("remote") is False:
            self._wants_power = False  # it does not start again when the switch is turned back
            yield DriveStateError(
                self.name,
                "is in a person's hand (local); turn its switch to remote, reset and start again",
            )
        stood_s = 0.0 if self._life is None else self._now_s - self._life[1]
        if self._link.is_answering and stood_s > self._silent_s:
            yield SilentPortError(
                self.name,
                f"answers, but its counter stands for {stood_s:.2f} s (limit "
                f"{self._silent_s:g} s): what it says is old; look whether its program runs",
            )
        if self._now_s > self._deadline_s:
            self.cancel_deadline()
            values = ", ".join(f"{name} {value:.6g}" for name, value in self.values.items())
            yield TransitionTimeoutError(
                self.name,
                f"{self._waiting_for}: not in time (it reads {values}); look at the device, then "
                "at scale, words and type of the register map",
            )

    def _take(self, answer: Answer) -> bool:
        request, words = answer
        if request.function == WRITE:
            self._kept[request.address] = (self._untoggled(request.address, words), self._now_s)
            return False
        at = {(request.function, request.address + i): word for i, word in enumerate(words)}
        for name, number in self._numbers.items():
            if (READ[number.table], number.address) in at:
                first = number.address - request.address
                self.values[name] = number.value(words[first : first + number.count])
                self.read_now.add(name)
        if self._status is not None:
            self._word = at.get((READ[self._status.table], self._status.address), self._word)
        if not math.isnan(life := self.values.get("life", math.nan)) and (
            self._life is None or life != self._life[0]
        ):
            self._life = (life, self._now_s)
        return True

    def _following(self) -> RegisterRequest | None:
        """Return what is written where it is due, and what is read in turn with it."""
        self._read_next = not self._read_next
        if not self._read_next and (write := self._due_request()) is not None:
            return write
        if not self._spans:
            return None
        (function, address), count = self._spans[self._turn % len(self._spans)]
        self._turn += 1
        return RegisterRequest(function, address, count)

    def _due_request(self) -> RegisterRequest | None:
        command = self._command
        if command is not None and (self._stands or not self._wants_power):
            word = command.word(enable=self._wants_power, reset=self._resets, toggle=self._toggle)
            if not self._is_written(command.address, (word,)):
                self._resets, self._toggle = False, not self._toggle
                return RegisterRequest(WRITE, command.address, 1, (word,))
        for address, words in self._told.items():
            if not self._is_written(address, words):
                return RegisterRequest(WRITE, address, len(words), words)
        return None

    def _is_written(self, address: int, words: tuple[int, ...]) -> bool:
        last_words, since_s = self._kept.get(address, ((), -math.inf))
        fresh = self._now_s - since_s < self._refresh_s
        return fresh and last_words == self._untoggled(address, words)

    def _untoggled(self, address: int, words: tuple[int, ...]) -> tuple[int, ...]:
        """Return words without the bit that changes with every write."""
        command = self._command
        if command is None or command.toggle is None or address != command.address:
            return words
        return (words[0] & ~(1 << command.toggle),)


def spans(numbers: Iterable[Number], status: Status | None) -> tuple[tuple[Place, int], ...]:
    """Return what is read at once: registers that follow each other in their table."""
    wanted = {
        (READ[number.table], number.address + i) for number in numbers for i in range(number.count)
    }
    if status is not None:
        wanted.add((READ[status.table], status.address))
    stretches: list[tuple[Place, int]] = []
    for function, address in sorted(wanted):
        if stretches:
            (last, first), count = stretches[-1]
            if function == last and address == first + count and count < 120:
                stretches[-1] = ((last, first), count + 1)
                continue
        stretches.append(((function, address), 1))
    return tuple(stretches)


def raise_worst(faults: list[HardwareError]) -> None:
    """Raise the worst of some faults, if there is one."""
    if faults:
        raise worst(faults)
