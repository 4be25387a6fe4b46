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
    call_signature = signature(call)
    names = [name for name in call_signature.parameters if name != "self"]

    @cache
    def model() -> type[BaseModel]:
        fields: dict[str, Any] = {
            name: (
                parameter.annotation,
                ... if parameter.default is Parameter.empty else parameter.default,
            )
            for name, parameter in call_signature.parameters.items()
            if name in names
        }
        return create_model(call.__name__, __config__=ConfigDict(extra="forbid"), **fields)

    @wraps(call)
    def refusing(*args: P.args, **kwargs: P.kwargs) -> R:
        try:
            bound = call_signature.bind(*args, **kwargs)
        except TypeError as error:
            takes = f"it takes {', '.join(names)}"
            raise TypeError(f"{call.__name__}: {error}; {takes}") from None
        arguments = {name: value for name, value in bound.arguments.items() if name in names}
        try:
            validated = model().model_validate(arguments)
        except ValidationError as error:
            raise ConfigurationError(f"{call.__name__}: {_validation_message(error)}") from None
        bound.arguments |= {name: getattr(validated, name) for name in arguments}
        return call(*bound.args, **bound.kwargs)

    return refusing


def text_of(path: FilePath | None) -> str | None:
    """Return a path as the commands take it."""
    return None if path is None else str(path)


def _validation_message(error: ValidationError) -> str:
    """Return the first thing that is wrong with each argument."""
    first = {fault["loc"][0]: fault for fault in reversed(error.errors(include_url=False))}
    return "; ".join(
        f"{name} = {fault['input']!r} is one text; give a list of them"
        if fault["type"] == "sequence_str"
        else f"{name} = {fault['input']!r} {fault['msg'].removeprefix('Input ')}"
        for name, fault in reversed(first.items())
    )
