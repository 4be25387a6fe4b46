"""Arguments of the front door against its signatures, before anything is done with them."""

from collections.abc import Callable
from functools import cache, wraps
from inspect import Parameter, signature
from pathlib import Path
from typing import Annotated, Any, ParamSpec, TypeAlias, TypeVar

from pydantic import BaseModel, ConfigDict, Field, ValidationError, create_model

from hardware.description.errors import ConfigurationError

P = ParamSpec("P")
R = TypeVar("R")

FilePath: TypeAlias = str | Path
Level: TypeAlias = Annotated[float, Field(gt=0.0, lt=1.0)]
"""A probability of intervals, as 0.95."""
Count: TypeAlias = Annotated[int, Field(ge=0)]
"""A whole number that is not negative."""


def checked(call: Callable[P, R]) -> Callable[P, R]:
    """Let a call refuse arguments that are not of its signature's types, by their names.

    Raises
    ------
    ConfigurationError
        By the call, before it does anything.
    """
    told = signature(call)
    names = [one for one in told.parameters if one != "self"]

    @cache
    def model() -> type[BaseModel]:
        fields: dict[str, Any] = {
            name: (one.annotation, ... if one.default is Parameter.empty else one.default)
            for name, one in told.parameters.items()
            if name in names
        }
        return create_model(call.__name__, __config__=ConfigDict(extra="forbid"), **fields)

    @wraps(call)
    def refusing(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            bound = told.bind(*args, **kwargs)
        except TypeError as error:
            takes = f"it takes {', '.join(names)}"
            raise TypeError(f"{call.__name__}: {error}; {takes}") from None
        given = {name: one for name, one in bound.arguments.items() if name in names}
        try:
            found = model().model_validate(given)
        except ValidationError as error:
            raise ConfigurationError(f"{call.__name__}: {_said(error)}") from None
        bound.arguments |= {name: getattr(found, name) for name in given}
        return call(*bound.args, **bound.kwargs)

    return refusing


def text_of(path: FilePath | None) -> str | None:
    """Return a path as the commands take it."""
    return None if path is None else str(path)


def _said(error: ValidationError) -> str:
    """Return the first thing that is wrong with each argument."""
    first = {one["loc"][0]: one for one in reversed(error.errors(include_url=False))}
    return "; ".join(
        f"{name} = {one['input']!r} is one text; give a list of them"
        if one["type"] == "sequence_str"
        else f"{name} = {one['input']!r} {one['msg'].removeprefix('Input ')}"
        for name, one in reversed(first.items())
    )
