"""Which version this is, and what it runs on."""

import platform
import shutil
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path


def version_line() -> str:
    """Return version, git commit where it is known, Python and NumPy, on one line."""
    commit = _commit()
    built = f"pmm {_version('pmm')}" + (f" ({commit})" if commit else "")
    return f"{built}, Python {platform.python_version()}, NumPy {_version('numpy')}"


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "from a source tree"


def _commit() -> str | None:
    """Return the commit of the clone that this package lies in, if it lies in one."""
    house = Path(__file__).resolve().parents[2]
    git = shutil.which("git")
    if git is None or not (house / ".git").exists():
        return None
    command = [git, "-C", str(house), "rev-parse", "--short", "HEAD"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
    return done.stdout.strip() or None
