"""Which version this is, what it was built from, and what it runs on."""

import platform
import shutil
import subprocess
from pathlib import Path
from typing import Final

from hardware.description.version import program, version_of

_PACKAGES: Final = ("numpy", "scipy", "h5netcdf", "matplotlib")
_BESIDE: Final = ("NumPy", "SciPy", "numba", "python-can", "canopen")


def version_line() -> str:
    """Return version, commit where it is known, Python, the system, and the libraries' versions."""
    commit = _commit()
    program_text = program() + (f" ({commit})" if commit else "")
    libraries = ", ".join(f"{name} {version_of(name)}" for name in _BESIDE)
    system = f"{platform.system()} {platform.machine()}"
    return f"{program_text}, Python {platform.python_version()}, {system}, {libraries}"


def _commit() -> str | None:
    """Return the commit of the clone that this package lies in, and whether files were changed."""
    house = Path(__file__).resolve().parents[1]
    git = shutil.which("git")
    if git is None or not (house / ".git").exists():
        return None
    git_command = [git, "--no-optional-locks", "-C", str(house)]
    command = [*git_command, "describe", "--always", "--dirty", "--abbrev=8"]
    process = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
    return process.stdout.strip() or None


def provenance() -> tuple[tuple[str, str], ...]:
    """Return pairs of what and which version."""
    return (
        ("program", version_line()),
        ("system", f"{platform.system()} {platform.machine()}"),
        *((name, version_of(name)) for name in _PACKAGES),
    )
