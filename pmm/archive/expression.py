"""Conditions on runs: a small grammar, read into SQL with parameters.

    expression = term { "or" term }
    term       = factor { "and" factor }
    factor     = "not" factor | "(" expression ")" | column operator value
    operator   = "=" | "!=" | "<" | "<=" | ">" | ">="
    value      = number | 'text' | "text"; a quote in a text is doubled

A comparison with what is not known is false.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Final, NamedTuple

from hardware.description.errors import ConfigurationError

TEXT: Final = "text"
NUMBER: Final = "number"
_DEEPEST: Final = 50
_LONGEST: Final = 4000  # letters; SQLite takes about a thousand comparisons
_TOKEN: Final = re.compile(
    r"""\s*(?:(?P<operator><=|>=|!=|=|<|>)|(?P<bracket>[()])
    |(?P<text>'(?:[^']|'')*'|"(?:[^"]|"")*")
    |(?P<number>[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.]))
    |(?P<word>[^\W\d]\w*))""",
    re.VERBOSE,
)


@dataclass(frozen=True)
class KnownColumn:
    """What a name stands for: its SQL, and whether it holds text or numbers."""

    sql: str
    kind: str


class Condition(NamedTuple):
    """SQL that has a ``?`` for each parameter; no letter of it is the user's."""

    sql: str
    parameters: tuple[float | str, ...]


class _Token(NamedTuple):
    kind: str
    text: str
    place: int


def read_condition(
    text: str, columns: Mapping[str, KnownColumn], elsewhere: Mapping[str, str] | None = None
) -> Condition:
    """Read an expression.

    Parameters
    ----------
    columns
        What may be asked for, by name.
    elsewhere
        How to ask for other columns, by name.

    Raises
    ------
    ConfigurationError
        If it is none, with the place; or for a column that is not known, with the nearest and all.
    """
    if len(text) > _LONGEST or not text.isprintable():
        raise ConfigurationError(f"an expression has up to {_LONGEST} printable letters")
    reader = _Reader(text, columns, elsewhere or {})
    condition = reader.expression(0)
    if reader.token.kind != "end":
        raise reader.error("'and', 'or' or the end")
    return condition


def _tokens(text: str) -> list[_Token]:
    tokens, place = [], 0
    end = len(text.rstrip())
    while place < end:
        match = _TOKEN.match(text, place)
        if match is None:
            raise ConfigurationError(
                f"expression {text!r}: cannot be read from {text[place:].strip()!r} on; write "
                "as: hull = 'KVLCC2' and frequency_hz > 0.5"
            )
        kind = str(match.lastgroup)
        word = match[kind]
        if kind == "word" and word.lower() in ("and", "or", "not"):
            kind, word = word.lower(), word.lower()
        tokens.append(_Token(kind, word, match.start(match.lastgroup or 0)))
        place = match.end()
    return [*tokens, _Token("end", "the end", end)]


class _Reader:
    """Goes through the tokens once, a function for each rule."""

    def __init__(
        self, text: str, columns: Mapping[str, KnownColumn], elsewhere: Mapping[str, str]
    ) -> None:
        self.text, self.columns, self.elsewhere = text, columns, elsewhere
        self.tokens, self.at = _tokens(text), 0

    @property
    def token(self) -> _Token:
        return self.tokens[self.at]

    def take(self, kind: str, expected: str) -> _Token:
        token = self.token
        if token.kind != kind:
            raise self.error(expected)
        self.at += 1
        return token

    def error(self, expected: str) -> ConfigurationError:
        token_text = self.token.text if self.token.kind == "end" else repr(self.token.text)
        return ConfigurationError(
            f"expression {self.text!r}: {expected} is missing before {token_text}, letter "
            f"{self.token.place + 1}"
        )

    def expression(self, depth: int) -> Condition:
        return self._joined("or", depth)

    def _joined(self, word: str, depth: int) -> Condition:
        def part() -> Condition:
            return self._joined("and", depth) if word == "or" else self._factor(depth)

        parts = [part()]
        while self.token.kind == word:
            self.at += 1
            parts.append(part())
        if len(parts) == 1:
            return parts[0]
        sql = f" {word.upper()} ".join(condition.sql for condition in parts)
        return Condition(
            f"({sql})", tuple(value for condition in parts for value in condition.parameters)
        )

    def _factor(self, depth: int) -> Condition:
        if depth > _DEEPEST:
            raise ConfigurationError(f"an expression has up to {_DEEPEST} brackets in one another")
        if self.token.kind == "not":
            self.at += 1
            inner = self._factor(depth + 1)
            return Condition(f"(NOT {inner.sql})", inner.parameters)
        if self.token[:2] == ("bracket", "("):
            self.at += 1
            inner = self.expression(depth + 1)
            if self.token[:2] != ("bracket", ")"):
                raise self.error("')'")
            self.at += 1
            return inner
        return self._comparison()

    def _comparison(self) -> Condition:
        name = self.take("word", "a column").text
        if name not in self.columns and name in self.elsewhere:
            raise ConfigurationError(f"no column {name!r} here; {self.elsewhere[name]}")
        if name not in self.columns:
            raise ConfigurationError(f"no column {name!r}; {_nearest(name, list(self.columns))}")
        column = self.columns[name]
        operator = self.take("operator", "one of = != < <= > >=").text
        kind_text = "a quoted text" if column.kind == TEXT else "a number"
        token = self.take(column.kind, f"{kind_text} for {name}")
        value = _unquoted(token.text) if column.kind == TEXT else float(token.text)
        if isinstance(value, float) and not math.isfinite(value):
            raise ConfigurationError(f"{name}: {token.text} is beyond any number")
        return Condition(f"COALESCE({column.sql} {operator} ?, 0)", (value,))


def _unquoted(text: str) -> str:
    return text[1:-1].replace(2 * text[0], text[0])


def _nearest(name: str, names: list[str]) -> str:
    near = get_close_matches(name, names, n=1, cutoff=0.4)
    hint = f"did you mean {near[0]!r}? " if near else ""
    return f"{hint}columns: {', '.join(names)}"
