"""The carriage whose speed is set by a voltage and read back by one, on an analogue module."""

from hardware.analogue_link import AnalogueLink, nodes
from hardware.asked_carriage import AskedCarriage
from hardware.carriage_settings import AnalogueCarriageSettings
from hardware.driver import Driver
from hardware.roles import Role


class AnalogueCarriage(AskedCarriage):
    """A :class:`hardware.roles.Carriage` that has to be brought back by a person."""

    def prepare(self) -> None:
        """Write the module's settings: what its outputs do when the controller is lost."""
        if isinstance(self._link, AnalogueLink):
            self._link.prepare()


DRIVER = Driver(Role.CARRIAGE, AnalogueCarriageSettings, AnalogueCarriage, nodes)
