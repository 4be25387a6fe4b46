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
        *whole, self._asked = self._asked.split(self._ending)
        for line in whole:
            if self.mute or not self.cable.plugged:
                return
            self._heard_s = self._time_s
            said = "ERROR" if self.refuses else self._said(line.decode("ascii", "replace"))
            self.cable.waiting += said.encode()[: -2 if self.torn else None] + self._ending

    def _said(self, asked: str) -> str:
        for one in self._every:
            if (answer := self._answer_to(one, asked)) is not None:
                return answer
        return "ERROR"

    def _answer_to(self, one: Line, asked: str) -> str | None:
        """Do what a line says; return the reply, ``None`` where it is not this one."""
        match one:
            case LineCommand():
                if asked not in (one.on, one.off, one.clear) or not asked:
                    return None
                self._words[3, one.address] = int(asked == one.on)
                self.alarm = self.alarm and asked != one.clear
                return one.answer
            case LineStatus():
                says = (getattr(one, name) for name, on in self._states().items() if on)
                return f"{one.answer} {' '.join(says)} " if asked == one.line else None
            case LineNumber() if is_told(one):
                found = pattern_of(one.line).fullmatch(asked)
                if found is None:
                    return None
                for k, word in enumerate(struct.unpack(">4H", struct.pack(">d", float(found[1])))):
                    self._words[3, one.address + k] = word
                return one.answer
            case LineNumber():
                words = [self._words.get((3, one.address + k), 0) for k in range(one.count)]
                (raw,) = struct.unpack(">d", struct.pack(">4H", *words))
                return _VALUE.sub(f"{raw:.6f}", one.answer) if asked == one.line else None
