"""What a benchmark returns, and what it must show."""

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

Row: TypeAlias = dict[str, str | float | int]
Report: TypeAlias = Callable[[str], None]
"""Takes a word about what is being measured now."""

_THRESHOLDS = Path(__file__).with_name("thresholds.toml")


@dataclass(frozen=True)
class Outcome:
    """What one benchmark found.

    Attributes
    ----------
    tables
        Rows under a caption each; the rows of a table have the same keys.
    measured
        The values that ``thresholds.toml`` judges, by its keys.
    notes
        How it was measured, and what was left out and why.
    """

    tables: Mapping[str, list[Row]]
    measured: Mapping[str, float]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Benchmark:
    """A measurement with a name; ``run(quick, report)`` does it."""

    name: str
    title: str
    run: Callable[[bool, Report], Outcome]


@dataclass(frozen=True)
class Verdict:
    """A threshold beside what was measured; ``met`` is ``None`` where nothing was."""

    key: str
    what: str
    limit: str
    measured: float | None
    met: bool | None

    @property
    def word(self) -> str:
        """The verdict in a word."""
        return {None: "not measured", True: "met", False: "MISSED"}[self.met]


def judge(name: str, measured: Mapping[str, float]) -> list[Verdict]:
    """Hold what a benchmark measured against its thresholds.

    Raises
    ------
    KeyError
        If something was measured for which no threshold stands.
    """
    thresholds = tomllib.loads(_THRESHOLDS.read_text(encoding="utf-8"))[name]
    unknown = set(measured) - set(thresholds)
    if unknown:
        raise KeyError(f"thresholds.toml: [{name}] has no {', '.join(sorted(unknown))}")
    return [_verdict(key, entry, measured.get(key)) for key, entry in thresholds.items()]


def _verdict(key: str, entry: Mapping[str, Any], value: float | None) -> Verdict:
    below = "at_most" in entry
    bound = float(entry["at_most" if below else "at_least"])
    limit = f"at {'most' if below else 'least'} {bound:g}"
    met = None
    if value is not None:
        met = value <= bound if below else value >= bound
    return Verdict(key, entry["what"], limit, value, met)
