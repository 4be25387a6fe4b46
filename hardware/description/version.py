"""The versions of what is installed, as provenance says them, and how to install what is not."""

from functools import cache

from planar_motion_mechanism import DISTRIBUTION


@cache
def version_of(package: str) -> str:
    """Return the version of an installed distribution, or in words that it is not."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"


@cache
def program() -> str:
    """Return the program's name and version, as recordings and pages carry it."""
    installed = version_of(DISTRIBUTION)
    return f"pmm {'from a source tree' if installed == 'not installed' else installed}"


def installing(extra: str) -> str:
    """Return the command that installs the program with an extra."""
    return f"python -m pip install '{DISTRIBUTION}[{extra}]'"
