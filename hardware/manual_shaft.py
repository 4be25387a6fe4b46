"""A drive shaft whose speed an operator sets by hand and reads off a tachometer."""

import math
from dataclasses import dataclass

from hardware.command_limits import check_enabled, check_speed
from hardware.description.channels import Channel
from hardware.description.oscillator import Range
from hardware.driver import Driver, Services
from hardware.errors import DialReadingError
from hardware.manual_axis import DialQuestion
from hardware.roles import Cycle, Role, SampleBlock


@dataclass(frozen=True)
class ManualShaftSettings:
    """Settings of a shaft whose speed is set by hand and read off a tachometer."""

    lowest_frequency_hz: float
    highest_frequency_hz: float
    tolerance_share: float = 0.1


class ManualShaft:
    """A :class:`hardware.roles.Shaft` whose knob is the operator's; it has no encoder."""

    channels: tuple[Channel, ...] = ()

    def __init__(self, name: str, settings: ManualShaftSettings, services: Services) -> None:
        self.name = name
        self.frequency_hz = Range(settings.lowest_frequency_hz, settings.highest_frequency_hz)
        self.sample_rate_hz = services.sample_rate_hz
        self.enabled = False
        self.measured_frequency_hz = math.nan
        self._tolerance_share = settings.tolerance_share
        self._question = DialQuestion(name, services)
        self._wanted_hz = 0.0

    @property
    def moving(self) -> bool:
        """Whether the shaft turns as far as anyone has said; unknown counts as turning."""
        return self._question.open or self.measured_frequency_hz != 0.0

    @property
    def at_speed(self) -> bool:
        """Whether the operator has read the commanded speed."""
        off = abs(self.measured_frequency_hz - self._wanted_hz)
        return self._wanted_hz > 0.0 and off <= self._tolerance_share * self._wanted_hz

    def prepare(self) -> None:
        """Nothing to write."""

    def enable(self) -> None:
        """Let the shaft be started; if nobody has said yet that it stands, ask for that."""
        self.enabled = True
        if math.isnan(self.measured_frequency_hz):
            self.stop()

    def disable(self) -> None:
        """Have the shaft stopped and let it be started no more."""
        self.stop()
        self.enabled = False

    def turn(self, frequency_hz: float) -> None:
        """Ask the operator to set a speed and to read it; raises as the driven shaft does."""
        check_speed(self, frequency_hz)
        check_enabled(self)
        self._wanted_hz = frequency_hz
        text = f"{self.name}: set {frequency_hz:g} Hz and read the speed [Hz]"
        self._question.ask(text, frequency_hz)

    def stop(self) -> None:
        """Ask the operator to stop the shaft, unless it stands."""
        self._wanted_hz = 0.0
        if self.moving:
            self._question.ask(f"{self.name}: stop the shaft, then enter 0 [Hz]", 0.0)

    def quick_stop(self) -> None:
        """Ask for a stop: a hand-set shaft has no other way than its emergency stop."""
        self.disable()

    def reset_fault(self) -> None:
        """Nothing to reset."""
        self.disable()

    def tick(self, cycle: Cycle) -> None:
        """Look for an answer.

        Raises
        ------
        DialReadingError
            If it is no number or not the speed that was asked for; the operator is asked again.
        """
        answer = self._question.answer()
        if answer is None:
            return
        self.measured_frequency_hz = abs(answer)
        wanted = self._wanted_hz
        if abs(answer - wanted) > self._tolerance_share * wanted:
            text = f"{self.name}: set {wanted:g} Hz and read the speed [Hz]"
            self._question.ask(text, wanted)
            raise DialReadingError(
                self.name,
                f"reads {answer:g} Hz; wanted {wanted:g} Hz within {self._tolerance_share:.0%}",
            )

    def take(self) -> tuple[SampleBlock, ...]:
        """Return nothing: there is no encoder."""
        return ()

    def close(self) -> None:
        """Nothing to let go of."""


DRIVER = Driver(Role.SHAFT, ManualShaftSettings, ManualShaft)
