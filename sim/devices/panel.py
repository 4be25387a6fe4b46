"""A simulated drive panel of a carriage: it answers lines of text, as rig.toml has them."""

import re
import struct

from hardware.carriage_settings import AskedCarriageSettings, LineCarriageSettings
from hardware.line_link import is_told
from hardware.line_registers import Line, LineCommand, LineNumber, LineStatus, pattern_of
from sim.devices.modbus_devices import SimulatedCarriage

_VALUE = re.compile(r"\{value(:[^}]*)?\}")


class SimulatedPanel(SimulatedCarriage):
    """Runs on its ramps at the speed that it was told in a line."""

    def _open(self, name: str, settings: AskedCarriageSettings) -> None:
        if not isinstance(settings, LineCarriageSettings):
            raise TypeError(f"{name}: a panel has lines")
        self.unit_id = 0
        self._begin(settings.lines)
        self._every, self._ending = settings.every_line, settings.port.ending.encode()

    def _serve(self) -> None:
        """Answer the lines that are whole."""
        *lines, self._asked = self._asked.split(self._ending)
        for line in lines:
            if self.mute or not self.cable.plugged:
                return
            self._heard_s = self._time_s
            said = "ERROR" if self.refuses else self._reply(line.decode("ascii", "replace"))
            self.cable.waiting += said.encode()[: -2 if self.torn else None] + self._ending

    def _reply(self, asked: str) -> str:
        for line in self._every:
            if (answer := self._answer_to(line, asked)) is not None:
                return answer
        return "ERROR"

    def _answer_to(self, line: Line, asked: str) -> str | None:
        """Do what a line says; return the reply, ``None`` where it is not this one."""
        match line:
            case LineCommand():
                if asked not in (line.on, line.off, line.clear) or not asked:
                    return None
                self._words[3, line.address] = int(asked == line.on)
                self.alarm = self.alarm and asked != line.clear
                return line.answer
            case LineStatus():
                says = (getattr(line, name) for name, on in self._states().items() if on)
                return f"{line.answer} {' '.join(says)} " if asked == line.line else None
            case LineNumber() if is_told(line):
                groups = pattern_of(line.line).fullmatch(asked)
                if groups is None:
                    return None
                for k, word in enumerate(struct.unpack(">4H", struct.pack(">d", float(groups[1])))):
                    self._words[3, line.address + k] = word
                return line.answer
            case LineNumber():
                words = [self._words.get((3, line.address + k), 0) for k in range(line.count)]
                (raw,) = struct.unpack(">d", struct.pack(">4H", *words))
                return _VALUE.sub(f"{raw:.6f}", line.answer) if asked == line.line else None
