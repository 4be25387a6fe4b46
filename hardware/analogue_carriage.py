"""The carriage whose speed is set by a voltage and read back by one, on an analogue module."""

from hardware.analogue_link import nodes
from hardware.asked_carriage import AskedCarriage
from hardware.carriage_settings import AnalogueCarriageSettings
from hardware.driver import Driver
from hardware.roles import Role

DRIVER = Driver(Role.CARRIAGE, AnalogueCarriageSettings, AskedCarriage, nodes)
