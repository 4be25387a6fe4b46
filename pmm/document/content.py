"""What a result says, whoever reads it: sections of texts, tables, figures and notes.

A topic says its content once; :mod:`pmm.document.terminal`, :mod:`pmm.document.page` and
:mod:`pmm.document.data` render it. What has a ``key`` is what programs get under that key.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import TYPE_CHECKING, Any, Final, Generic, TypeVar

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

Row = TypeVar("Row")
PEOPLE_ALONE: Final = ""
"""The key of what programs do not get."""
ABSENT: Final = object()
"""The value of what a row does not have: programs then get no key."""


@dataclass(frozen=True)
class Column(Generic[Row]):
    """One column: what it says of a row.

    Attributes
    ----------
    heading
        What stands above it; ``None`` where it is for programs alone.
    value
        Of a row: what programs get, and what ``written`` turns into text for people.
    unit
        Stands in brackets behind the heading.
    number
        Whether it is set to the right.
    once
        Whether it stands only where it, or a column before it, is not as in the row above.
    """

    heading: str | None
    value: Callable[[Row], Any]
    key: str = PEOPLE_ALONE
    written: Callable[[Any], str] = str
    unit: str = ""
    number: bool = False
    once: bool = False

    def text(self, row: Row) -> str:
        """Return what people read of a row."""
        return self.written(self.value(row))

    @property
    def title(self) -> str:
        """Heading, and the unit in brackets where there is one."""
        return f"{self.heading} [{self.unit}]".lstrip() if self.unit else str(self.heading)


def word(heading: str, key: str, written: Callable[[Any], str] = str) -> Column[Any]:
    """Return a column of words: an attribute of the row, for people and programs."""
    return Column(heading, attrgetter(key), key, written)


def number(
    heading: str, key: str, written: Callable[[Any], str] = str, unit: str = ""
) -> Column[Any]:
    """Return a column of numbers: an attribute of the row, for people and programs."""
    return Column(heading, attrgetter(key), key, written, unit, number=True)


def data_only(*keys: str) -> tuple[Column[Any], ...]:
    """Return columns for programs alone: attributes of the row."""
    return tuple(Column(None, attrgetter(key), key) for key in keys)


@dataclass(frozen=True)
class Table(Generic[Row]):
    """Rows of the same kind under their columns; without rows people do not see it.

    Attributes
    ----------
    name
        What it is a table of; unique on its page.
    titled
        Whether that stands above it.
    notes
        What is said about all rows, a paragraph each.
    most
        Rows that people see; all if 0.
    folded
        Whether a page shows it only when it is asked for.
    filled
        Whether columns in which nothing stands are left out for people.
    grade
        Of a row: ``"faint"`` where it stands back, a note's grade, or empty.
    by
        The row's name, where programs get the rows by name and not in a list.
    """

    name: str
    columns: Sequence[Column[Row]]
    rows: Sequence[Row]
    key: str = PEOPLE_ALONE
    titled: bool = False
    notes: tuple[str, ...] = ()
    most: int = 0
    folded: bool = False
    filled: bool = False
    grade: Callable[[Row], str] = lambda _: ""
    by: Callable[[Row], str] | None = None

    @cached_property
    def shown_columns(self) -> Sequence[Column[Row]]:
        """The columns that people see."""
        columns = [column for column in self.columns if column.heading is not None]
        if not self.filled:
            return columns
        return [column for column in columns if any(map(column.text, self.rows))]

    @property
    def lines(self) -> Iterator[tuple[list[str], str]]:
        """The rows as people read them, under :attr:`shown_columns`, and the grade of each."""
        above: list[str] = []
        for row in self.rows[: self.most or None]:
            cells = [column.text(row) for column in self.shown_columns]
            yield (
                [
                    "" if column.once and above[: k + 1] == cells[: k + 1] else cells[k]
                    for k, column in enumerate(self.shown_columns)
                ],
                self.grade(row),
            )
            above = cells

    @property
    def empty(self) -> bool:
        """Whether people see nothing of it."""
        return not self.rows

    @property
    def data(self) -> list[dict[str, Any]] | dict[str, dict[str, Any]]:
        """The rows as programs get them."""
        if self.by is not None:
            return {self.by(row): self._row_data(row) for row in self.rows}
        return [self._row_data(row) for row in self.rows]

    def _row_data(self, row: Row) -> dict[str, Any]:
        cells = ((column.key, column.value(row)) for column in self.columns if column.key)
        return {key: value for key, value in cells if value is not ABSENT}


@dataclass(frozen=True)
class Text:
    """Paragraphs; ``strong`` where they are the answer, ``faint`` where they explain."""

    lines: Sequence[str]
    key: str = PEOPLE_ALONE
    strong: bool = False
    faint: bool = False

    @property
    def empty(self) -> bool:
        """Whether people see nothing of it."""
        return not self.lines

    @property
    def data(self) -> list[str]:
        """The paragraphs."""
        return list(self.lines)


_GRADES: Final = {
    **dict.fromkeys(("pass", "ok"), "good"),
    **dict.fromkeys(("note", "next step"), "note"),
    **dict.fromkeys(("void", "fail", "fault", "refuse", "error"), "void"),
}


@dataclass(frozen=True)
class Note:
    """Something to be known besides.

    Attributes
    ----------
    kind
        What it is, in a word or two: that of a flag, a verdict.
    code
        By which documentation knows it.
    """

    kind: str
    text: str
    code: str = ""

    @property
    def grade(self) -> str:
        """How grave it is: ``"good"``, ``"note"``, ``"warning"`` or ``"void"``."""
        return _GRADES.get(self.kind, "warning")


@dataclass(frozen=True)
class Notes:
    """Notes, one a line."""

    items: Sequence[Note]
    key: str = PEOPLE_ALONE

    @property
    def empty(self) -> bool:
        """Whether people see nothing of it."""
        return not self.items

    @property
    def data(self) -> list[str]:
        """The notes' texts."""
        return [note.text for note in self.items]


@dataclass(frozen=True)
class Figure:
    """A figure, drawn where a page or a file wants it.

    Attributes
    ----------
    name
        Unique in its document, and part of a file's name.
    data
        What it shows, for programs.
    """

    name: str
    caption: str
    draw: "Callable[[], Drawing]"
    key: str = PEOPLE_ALONE
    data: Any = None
    empty = False


@dataclass(frozen=True)
class Data:
    """What programs alone get."""

    key: str
    data: Any
    empty = True


Content = Table[Any] | Text | Notes | Figure | Data


@dataclass(frozen=True)
class Section:
    """A part of a document; what stands before the first title has none.

    People do not see it where all in it is empty.
    """

    title: str
    contents: tuple[Content, ...]


@dataclass(frozen=True)
class Document:
    """What a command found.

    Attributes
    ----------
    name
        What it is of: a campaign, a record; empty where its first line says so.
    about
        What of that is told.
    schema
        Names the keys that programs get; empty where they get none of it.
    """

    name: str
    about: str
    sections: tuple[Section, ...]
    schema: str

    @property
    def contents(self) -> Iterator[Content]:
        """All contents in their order."""
        return (content for section in self.sections for content in section.contents)

    @property
    def figures(self) -> Iterator[Figure]:
        """The figures in their order."""
        return (content for content in self.contents if isinstance(content, Figure))


def pairs(name: str, values: Mapping[str, str], *, titled: bool = False) -> Table[tuple[str, str]]:
    """Return a table without headings: names and what they are."""
    columns: Sequence[Column[tuple[str, str]]] = (
        Column("", lambda pair: pair[0]),
        Column("", lambda pair: pair[1]),
    )
    return Table(name, columns, tuple(values.items()), titled=titled)
