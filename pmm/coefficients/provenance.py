"""What made the numbers: program, commit, Python and the libraries that were used."""

import platform

from hardware.description.version import version_of
from pmm.version import version_line

_PACKAGES = ("numpy", "scipy", "h5netcdf", "matplotlib")


def provenance() -> tuple[tuple[str, str], ...]:
    """Return pairs of what and which version."""
    return (
        ("program", version_line()),
        ("system", f"{platform.system()} {platform.machine()}"),
        *((name, version_of(name)) for name in _PACKAGES),
    )
