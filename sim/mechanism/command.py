"""What the struts are told to do: the positions that a drive gives beside those it has reached."""

from dataclasses import dataclass, replace

from hardware.description.arrays import FloatArray
from sim import signals
from sim.drive.prescribed_drive import DriveSettings
from sim.mechanism.linkage import Mechanism
from sim.signals import Signals
from sim.solve.period import Period, Spectra
from sim.stage import Block


@dataclass(frozen=True)
class StrutCommand:
    """The struts' displacements by a shaft without ripple at the set frequency, linkages as set.

    Over a period the drive keeps the period's frequency: by what the set one is off does not repeat
    with the shaft.
    """

    mechanism: Mechanism
    drive: DriveSettings
    frequency_hz: float

    name = "command"
    reads = ()
    writes = (signals.COMMAND_AFT, signals.COMMAND_FORE)

    def start(self, sample_rate_hz: float, seed: int) -> None:
        """Return no state: the commands follow from the time alone."""

    def run(self, state: None, block: Block, inputs: Signals) -> tuple[None, Signals]:
        """Return the commands over the block."""
        drive = replace(self.drive, speed_error=0.0, ripple=())
        return state, self._displacements(drive.commanded(self.frequency_hz, block.time_s).angle)

    def steady(self, period: Period, inputs: Spectra) -> tuple[Period, Spectra]:
        """Return the harmonics of the commands."""
        displacements = self._displacements(period.omega_rad_s * period.time_s)
        return period, {name: period.harmonics(values) for name, values in displacements.items()}

    def _displacements(self, angle: FloatArray) -> dict[str, FloatArray]:
        return {
            signal.name: self.mechanism.displacement(angle + ahead)[0]
            for signal, (_, ahead) in zip(self.writes, self.mechanism.struts, strict=True)
        }
