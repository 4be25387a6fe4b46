"""The carriage behind a drive panel that answers lines of text."""

from hardware.asked_carriage import AskedCarriage
from hardware.carriage_settings import LineCarriageSettings
from hardware.driver import Driver
from hardware.roles import Role

DRIVER = Driver(Role.CARRIAGE, LineCarriageSettings, AskedCarriage)
