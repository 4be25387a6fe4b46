"""A Python file of the user's own, with effects in it."""

import importlib.util
import sys
from collections.abc import Collection
from pathlib import Path
from types import ModuleType

from hardware.description.errors import ConfigurationError


def import_file(path: Path) -> ModuleType:
    """Import a user's file and return it as a module of its own.

    Raises
    ------
    ConfigurationError
        If there is no such file, or importing it raises.
    """
    spec = importlib.util.spec_from_file_location(f"user_effects_{path.stem}", path)
    if spec is None or spec.loader is None or not path.is_file():
        raise ConfigurationError(f"{path}: no Python file of effects")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    try:
        spec.loader.exec_module(module)
    except Exception as error:
        raise ConfigurationError(
            f"{path}: cannot be imported: {type(error).__name__}: {error}"
        ) from error
    return module


def refuse_taken(path: str | Path, names: Collection[str], reserved: Collection[str]) -> None:
    """Refuse effects of the user's own that are called as the catalogue's are.

    Raises
    ------
    ConfigurationError
        Naming them.
    """
    taken = sorted(set(names) & set(reserved))
    if taken:
        raise ConfigurationError(
            f"{path}: {', '.join(taken)}: the catalogue has an effect of that name; rename yours"
        )
