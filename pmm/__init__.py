"""Planar motion mechanism: run tests and analyse their recordings.

For Python there are :func:`open`, :func:`simulate` and :func:`connect` (``docs/python.md``),
imported when they are first asked for.
"""

import sys
from typing import TYPE_CHECKING, Any

from planar_motion_mechanism import refuse_intruders

if TYPE_CHECKING:
    from pmm.interface.console import connect
    from pmm.interface.opening import open, simulate  # noqa: A004

refuse_intruders()

__all__ = ["connect", "open", "simulate"]


def __getattr__(name: str) -> Any:
    if name not in __all__:
        hint = f"there are {', '.join(__all__)} (docs/python.md)"
        raise AttributeError(
            f"module {__name__!r} has no attribute {name!r}; {hint}",
            name=name,
            obj=sys.modules[__name__],
        )
    from importlib import import_module

    room = "console" if name == "connect" else "opening"
    return getattr(import_module(f"pmm.interface.{room}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
