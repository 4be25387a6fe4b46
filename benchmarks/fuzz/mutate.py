"""Inputs made of good ones: bits, bytes, stretches and numbers changed."""

import re
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

_MOST: Final = 6  # changes of one input
_LONGEST: Final = 64  # bytes that are cut, doubled or moved at once
_NUMBER: Final = re.compile(rb"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_WORDS: Final = (
    b"nan", b"inf", b"-inf", b"1e999", b"-1e308", b"1e-320", b"0", b"-1", b"9223372036854775808",
    b"4294967295", b"1979-05-27", b"true", b"null", b'""', b"[]", b"{}", b"\x00", b"\xff\xfe",
    b"\n", b",", b";", b"\t", b"=", b"[[", b"..", b"../../evil", b"'", b'"', b"*00", b"\xe2\x82",
    b"\x00\x00\x00\x00", b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", b"0x10", b"1_000", b"1,5",
)  # fmt: skip
Change = Callable[[bytearray, np.random.Generator], None]


def mutate(good: bytes, other: bytes, generator: np.random.Generator) -> bytes:
    """Return an input made of a good one.

    Parameters
    ----------
    other
        Another one, whose end may take the place of this one's.
    """
    data = bytearray(good)
    for _ in range(1 + int(_MOST * generator.random() ** 3)):  # mostly one
        _CHANGES[int(generator.integers(len(_CHANGES)))](data, generator)
    if generator.random() < 0.05:
        return bytes(data[: _at(data, generator)] + other[_at(bytearray(other), generator) :])
    return bytes(data)


def _at(data: bytearray, generator: np.random.Generator) -> int:
    return int(generator.integers(len(data) + 1))


def _stretch(data: bytearray, generator: np.random.Generator) -> slice:
    start = _at(data, generator)
    return slice(start, start + int(generator.integers(1, _LONGEST + 1)))


def _flip(data: bytearray, generator: np.random.Generator) -> None:
    if data:
        data[_at(data, generator) % len(data)] ^= 1 << int(generator.integers(8))


def _put(data: bytearray, generator: np.random.Generator) -> None:
    if data:
        data[_at(data, generator) % len(data)] = int(generator.integers(256))


def _insert(data: bytearray, generator: np.random.Generator) -> None:
    at = _at(data, generator)
    data[at:at] = _WORDS[int(generator.integers(len(_WORDS)))]


def _cut(data: bytearray, generator: np.random.Generator) -> None:
    del data[_stretch(data, generator)]


def _double(data: bytearray, generator: np.random.Generator) -> None:
    where = _stretch(data, generator)
    data[where.start : where.start] = data[where]


def _truncate(data: bytearray, generator: np.random.Generator) -> None:
    if generator.random() < 0.3:  # what is short tells little
        del data[_at(data, generator) :]


def _number(data: bytearray, generator: np.random.Generator) -> None:
    """Put a word in the place of a number, looked for behind some place."""
    found = _NUMBER.search(data, _at(data, generator)) or _NUMBER.search(data)
    if found is not None:
        data[found.start() : found.end()] = _WORDS[int(generator.integers(len(_WORDS)))]


_CHANGES: Final[Sequence[Change]] = (
    _flip, _put, _insert, _cut, _double, _truncate, _number, _number,
)  # fmt: skip
