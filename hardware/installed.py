"""What the installed packages present: their entry points, looked up once a process."""

from functools import cache
from importlib.metadata import EntryPoint, entry_points


@cache
def installed(group: str, name: str | None = None) -> tuple[EntryPoint, ...]:
    """Return the entry points of a group, or those of a name among them.

    Each look reads the lists of all installed packages.
    """
    return tuple(point for point in entry_points(group=group) if name in (None, point.name))
