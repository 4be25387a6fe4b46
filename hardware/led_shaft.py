"""The shaft of a rig whose struts are led, for the devices that have no motors of their own."""

from hardware.description.errors import ConfigurationError
from hardware.driver import Services
from hardware.path_shaft import PathShaft


def led_shaft(name: str, services: Services) -> PathShaft:
    """Return the rig's shaft, for a device whose motors are its struts'.

    Raises
    ------
    ConfigurationError
        If it has no struts that follow a path.
    """
    if not isinstance(services.shaft, PathShaft):
        raise ConfigurationError(f'{name}: needs [shaft] driver = "path-struts"')
    return services.shaft
