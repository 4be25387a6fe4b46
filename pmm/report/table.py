"""What is shown of a result, whoever renders it: sections of lines and tables."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Table:
    """A table whose first ``words`` columns are texts and the others numbers."""

    caption: str
    headings: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    words: int = 1


@dataclass(frozen=True)
class Section:
    """A part of a result under its title; tables without rows are left out."""

    title: str
    lines: tuple[str, ...] = ()
    tables: tuple[Table, ...] = ()
