"""Planar motion mechanism: run tests and analyse their recordings."""

import os
from importlib.util import find_spec


def _refuse_shadowed_siblings() -> None:
    """Refuse a user's own ``analysis.py`` that Python would import in place of our package."""
    house = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))  # noqa: PTH120
    for name in ("hardware", "sim", "analysis"):
        ours = os.path.join(house, name, "__init__.py")  # noqa: PTH118
        spec = find_spec(name)
        found = spec.origin if spec else None
        if found is None or os.path.realpath(found) != ours:
            other = f"{found} hides it; rename that file" if found else "it is not there; install"
            raise ImportError(f"pmm needs its own package {name!r} beside {house}/pmm, but {other}")


_refuse_shadowed_siblings()
