"""The versions of what is installed, as provenance says them."""

from functools import cache


@cache
def version_of(package: str) -> str:
    """Return the version of an installed package, or in words that it is not."""
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version(package)
    except PackageNotFoundError:
        return "from a source tree" if package == "pmm" else "not installed"
