"""Axes that an operator sets by hand, as in 1963: micrometer and phase drum.

The operator is asked through :attr:`hardware.driver.Services.prompt`, once per cycle until there is
an answer, so that the loop (and with it the heartbeat) never waits for a person.
"""

import math
from dataclasses import dataclass
from typing import Literal

from hardware.command_limits import check_enabled, check_move
from hardware.demand import Demand
from hardware.description.oscillator import Range
from hardware.driver import Driver, Services
from hardware.errors import DialReadingError
from hardware.limits import check_above_0, check_ends
from hardware.roles import Cycle, Reading, Role


class DialQuestion:
    """One question to the operator, asked until a number comes."""

    def __init__(self, name: str, services: Services) -> None:
        self._name = name
        self._prompt = services.prompt
        self._text: str | None = None

    @property
    def open(self) -> bool:
        """Whether an answer is waited for."""
        return self._text is not None

    def ask(self, text: str, wanted: float | None = None, per_unit: float = 1.0) -> None:
        """Begin to ask; ``wanted`` is the value asked for, ``per_unit`` divisions of the dial."""
        self._text = Demand(text, self._name, wanted, per_unit)

    def withdraw(self) -> None:
        """Wait for no answer any more."""
        self._text = None

    def answer(self) -> float | None:
        """Return the answer once it is there.

        Raises
        ------
        DialReadingError
            If it is no finite number; the question stays open.
        """
        reply = None if self._text is None else self._prompt(self._text)
        if reply is None:
            return None
        try:
            value = float(reply.strip().replace(",", "."))
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise DialReadingError(self._name, f"{reply!r} is no number; {self._text}")
        self._text = None
        return value


@dataclass(frozen=True)
class ManualAxisSettings:
    """Settings of an axis that is set by hand.

    Attributes
    ----------
    dial
        What the operator reads: "micrometer", "phase drum".
    dial_unit, dial_per_unit
        Unit on the dial, and its divisions per metre or radian (1000 for millimetres).
    standard_uncertainty
        Of a reading, in the axis's unit.
    tolerance
        How far a reading may be from what was asked for, in the axis's unit.
    """

    low: float
    high: float
    standard_uncertainty: float
    tolerance: float
    dial_unit: str
    dial_per_unit: float
    dial: str = "dial"
    unit: Literal["m", "rad"] = "m"

    def __post_init__(self) -> None:
        check_ends(self.low, self.high)
        check_above_0(self, "standard_uncertainty", "tolerance", "dial_per_unit")


class ManualAxis:
    """A :class:`hardware.roles.PositionAxis` whose motor is the operator."""

    def __init__(self, name: str, settings: ManualAxisSettings, services: Services) -> None:
        self.name = name
        self.unit: str = settings.unit
        self.limits = Range(settings.low, settings.high)
        self.enabled = False
        self.settled = False
        self.reading: Reading | None = None
        self._settings = settings
        self._question = DialQuestion(name, services)
        self._target: float | None = None

    @property
    def homed(self) -> bool:
        """Whether a reading has been taken."""
        return self.reading is not None

    @property
    def moving(self) -> bool:
        """Whether the operator has been asked and has not answered."""
        return self._question.open

    def prepare(self) -> None:
        """Nothing to write."""

    def enable(self) -> None:
        """Let the axis be set."""
        self.enabled = True

    def disable(self) -> None:
        """Let the axis be set no more."""
        self.stop()
        self.enabled = False

    def stop(self) -> None:
        """Withdraw the question."""
        self._question.withdraw()

    def quick_stop(self) -> None:
        """Withdraw the question and let the axis be set no more."""
        self.disable()

    def reset_fault(self) -> None:
        """Withdraw the question."""
        self.disable()

    def home(self) -> None:
        """Ask what the dial reads.

        Raises
        ------
        NotReadyError
            If the axis is not enabled.
        """
        self._target = None
        self._ask(f"{self.name}: read the {self._settings.dial}")

    def move_to(self, position: float) -> None:
        """Ask the operator to set a position and to read the dial.

        Raises
        ------
        LimitError
            If it lies outside the limits (or is no number).
        NotReadyError
            If the axis is not enabled or was never read.
        """
        check_move(self, position)
        dial = f"{position * self._settings.dial_per_unit:.6g} {self._settings.dial_unit}"
        self._target = position
        self._ask(f"{self.name}: set the {self._settings.dial} to {dial} and read it")

    def tick(self, cycle: Cycle) -> None:
        """Look for an answer.

        Raises
        ------
        DialReadingError
            If it is no number, outside the limits, or further from the set-point than the
            tolerance; the operator is asked again.
        """
        answer = self._question.answer()
        if answer is not None:
            self._take(answer)

    def close(self) -> None:
        """Nothing to let go of."""

    def _ask(self, text: str) -> None:
        check_enabled(self)
        self.settled = False
        settings = self._settings
        self._question.ask(f"{text} [{settings.dial_unit}]", self._target, settings.dial_per_unit)

    def _take(self, dial: float) -> None:
        value = dial / self._settings.dial_per_unit
        wanted = value if self._target is None else self._target
        if value not in self.limits or abs(value - wanted) > self._settings.tolerance:
            low, high = self.limits.low, self.limits.high
            self._ask(f"{self.name}: that reading does not fit; set and read again")
            raise DialReadingError(
                self.name,
                f"the {self._settings.dial} reads {dial:g} {self._settings.dial_unit} = {value:g} "
                f"{self.unit}; wanted {wanted:g} within {self._settings.tolerance:g} and "
                f"{low:g} to {high:g} {self.unit}",
            )
        self.reading = Reading(value, self._settings.standard_uncertainty, self._settings.dial)
        self.settled = True


DRIVER = Driver(Role.POSITION_AXIS, ManualAxisSettings, ManualAxis)
