"""The carriage behind a programmable controller, over Modbus TCP or RTU."""

from hardware.asked_carriage import AskedCarriage
from hardware.carriage_settings import ModbusCarriageSettings
from hardware.driver import Driver
from hardware.roles import Role

DRIVER = Driver(Role.CARRIAGE, ModbusCarriageSettings, AskedCarriage)
