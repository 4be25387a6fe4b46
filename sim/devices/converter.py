"""A simulated analogue module with a carriage's drive behind its voltages."""

from collections.abc import Callable

from hardware.analogue_link import signed
from hardware.carriage_settings import AnalogueCarriageSettings
from hardware.dictionary import Entry, entry
from sim.devices.network import Wire
from sim.devices.node import SimulatedNode

_STEP_S = 0.1  # a ramp is steps of so long: each has the chain made anew
_ERROR_MODE, _ERROR_VALUE = 0x6443, 0x6444


class SimulatedConverter(SimulatedNode):
    """Shows the carriage's speed as a voltage, and runs it on its ramps as its output says.

    Parameters
    ----------
    driven
        Returns the speed that the carriage really has.
    runs
        Told the speed along the ramp, in steps.
    """

    def __init__(
        self,
        wire: Wire,
        name: str,
        settings: AnalogueCarriageSettings,
        sample_rate_hz: float,
        driven: Callable[[], float],
        runs: Callable[[float], None],
    ) -> None:
        super().__init__(wire, name, settings.node, settings.eds, sample_rate_hz)
        self._settings, self._driven, self._runs = settings, driven, runs
        self._ramp_m_s = self._told_m_s = 0.0
        self._out, self._in = (
            entry(channel.object)
            for channel in (settings.voltages.set_speed, settings.voltages.speed)
        )
        self.values[self._out] = signed(settings.voltages.set_speed.written(0.0))
        self.tick()

    def tick(self) -> None:
        """Go on along the ramp by one sample, and show the speed."""
        settings, volts = self._settings, self._settings.voltages
        wanted = volts.set_speed.value((int(self._output()) & 0xFFFF,))
        most = settings.acceleration_m_s2 / self.sample_rate_hz
        self._ramp_m_s += min(max(wanted - self._ramp_m_s, -most), most)
        late = abs(self._ramp_m_s - self._told_m_s) >= settings.acceleration_m_s2 * _STEP_S
        if self._ramp_m_s != self._told_m_s and (late or self._ramp_m_s == wanted):
            self._told_m_s = self._ramp_m_s
            self._runs(self._ramp_m_s)
        self.values[self._in] = signed(volts.speed.written(self._driven()))

    def _output(self) -> float:
        """Return the counts at the output: those of the error value once the controller is lost."""
        if self.master_lost() and self.number(Entry(_ERROR_MODE, self._out.subindex)):
            return self.number(Entry(_ERROR_VALUE, self._out.subindex))
        return self.number(self._out)
