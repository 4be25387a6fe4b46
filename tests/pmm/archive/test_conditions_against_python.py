"""The archive's conditions against Python's own comparisons of the same rows, and bad input."""

import operator
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from hardware.description.errors import ConfigurationError
from pmm.archive.database import open_archive
from pmm.archive.expression import read_condition
from pmm.archive.queries import RUN_COLUMNS, find_runs

HULLS = ("KVLCC2", 'it\'s "Wigley"', "", "Ä;--")
ROWS = [
    {"hull": hull, "run": f"run-{k}", "frequency_hz": 0.25 * (k % 5), "drift_rad": drift,
     "repeat": 1 + k % 2}
    for k, (hull, drift) in enumerate((hull, drift) for hull in HULLS for drift in
                                      (-0.1, 0.0, 0.1, None))
]  # fmt: skip
COMPARE: dict[str, Callable[[Any, Any], bool]] = {
    "=": operator.eq, "!=": operator.ne, "<": operator.lt, "<=": operator.le,
    ">": operator.gt, ">=": operator.ge,
}  # fmt: skip
Test = Callable[[dict[str, Any]], bool]


@pytest.fixture(scope="module")
def archive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("conditions") / "archive.sqlite"
    with open_archive(path, create=True) as connection, connection:
        for n, hull in enumerate(HULLS):
            connection.execute(
                "INSERT INTO campaigns (id, folder, campaign, hull, seen_utc, sha256) "
                "VALUES (?, ?, 'c', ?, '', '')", (n, f"/{n}", hull),
            )  # fmt: skip
        for row in ROWS:
            connection.execute(
                "INSERT INTO runs (campaign, run, kind, outcome, repeat, frequency_hz, medium, "
                "drift_rad, settings) "
                "VALUES (?, ?, 'oscillation', 'complete', ?, ?, 'water', ?, '{}')",
                (HULLS.index(row["hull"]), row["run"], row["repeat"], row["frequency_hz"],
                 row["drift_rad"]),
            )  # fmt: skip
    return path


def _quoted(text: str, quote: str) -> str:
    return quote + text.replace(quote, 2 * quote) + quote


@st.composite
def comparisons(draw: st.DrawFn) -> tuple[str, Test]:
    name = draw(st.sampled_from(["hull", "run", "frequency_hz", "drift_rad", "repeat"]))
    sign = draw(st.sampled_from(list(COMPARE)))
    value: float | str
    if name in ("hull", "run"):
        value = draw(st.sampled_from([*HULLS, "run-3", "S", "' or 1=1 --"]))
        text = _quoted(value, draw(st.sampled_from("'\"")))
    else:
        value = draw(st.sampled_from([-0.1, 0.0, 0.1, 0.25, 0.5, 1.0, 2.0]))
        text = draw(st.sampled_from([f"{value}", f"{value:+.3e}", f"{value:g}"]))
    gap = draw(st.sampled_from(["", " ", "  "]))

    def holds(row: dict[str, Any]) -> bool:
        return row[name] is not None and COMPARE[sign](row[name], value)

    return f"{name}{gap}{sign}{gap}{text}", holds


def _not(one: tuple[str, Test]) -> tuple[str, Test]:
    text, test = one
    return f"not ({text})", lambda row: not test(row)


def _chain(parts: list[tuple[str, Test]], bits: list[bool]) -> tuple[str, Test]:
    """Join without brackets: ``and`` binds closer, as in Python."""
    words = ["and" if one else "or" for one in bits[: len(parts) - 1]]
    text = parts[0][0]
    groups = [[parts[0][1]]]
    for word, (more, test) in zip(words, parts[1:], strict=True):
        text += f" {word} {more}"
        if word == "and":
            groups[-1].append(test)
        else:
            groups.append([test])
    return text, lambda row: any(all(one(row) for one in group) for group in groups)


def _deeper(inner: st.SearchStrategy[tuple[str, Test]]) -> st.SearchStrategy[tuple[str, Test]]:
    bracketed = inner.map(lambda one: (f"({one[0]})", one[1]))
    chains = st.builds(
        _chain, st.lists(bracketed, min_size=2, max_size=4),
        st.lists(st.booleans(), min_size=3, max_size=3),
    )  # fmt: skip
    return st.one_of(bracketed, inner.map(_not), chains)


@pytest.mark.slow
@given(st.recursive(comparisons(), _deeper, max_leaves=8))
def test_what_is_found_is_what_python_finds(archive: Path, asked: tuple[str, Test]) -> None:
    text, test = asked
    with open_archive(archive) as connection:
        found = [row["run"] for row in find_runs(connection, text, None, 1)]
    assert found == [row["run"] for row in ROWS if test(row)]


@given(st.text(max_size=30))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        condition = read_condition(text, RUN_COLUMNS)
    except ConfigurationError:
        return
    known = "|".join(re.escape(one.sql) for one in RUN_COLUMNS.values())
    assert re.fullmatch(rf"(?:{known}|COALESCE|AND|OR|NOT|[()\s?,0=!<>])+", condition.sql)


def _refused() -> Iterator[tuple[str, str]]:
    yield "hul = 'KVLCC2'", r"no column 'hul'; did you mean 'hull'\? columns: folder, campaign"
    yield "frequency = 1", r"no column 'frequency'; did you mean 'frequency_hz'\?"
    yield "", "a column is missing before the end, letter 1"
    yield "hull", "one of = != < <= > >= is missing before the end"
    yield "hull = 3", "a quoted text for hull is missing before '3', letter 8"
    yield "frequency_hz > '3'", "a number for frequency_hz is missing"
    yield "repeat = 1 repeat = 2", "'and', 'or' or the end is missing before 'repeat', letter 12"
    yield "(repeat = 1", r"'\)' is missing before the end"
    yield "hull = 'a", "cannot be read from"
    yield "repeat = 1; DROP TABLE runs", "cannot be read from '; DROP TABLE runs' on"
    yield "repeat = 1e999", "beyond any number"
    yield "(" * 60 + "repeat = 1" + ")" * 60, "brackets in one another"
    yield "repeat = 1 or " * 400 + "repeat = 1", "up to 4000 printable letters"
    yield "hull = '\udc80'", "printable letters"


@pytest.mark.parametrize(("text", "message"), [*_refused()])
def test_what_is_no_condition_is_refused(archive: Path, text: str, message: str) -> None:
    with (
        open_archive(archive) as connection,
        pytest.raises(ConfigurationError, match=message),
    ):
        find_runs(connection, text, None, 1)
