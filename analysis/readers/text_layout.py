"""How a text file is laid out: where the header is, what separates cells, where data begin."""

import csv
import io
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import islice

from analysis.readers.clock import NO_DAY, Days, read_stamp
from analysis.readers.columns import TextLayout
from analysis.readers.headers import Header, parse_header
from analysis.readers.text_source import TextSource
from analysis.reading_limits import LONGEST_LINE, MOST_COLUMNS
from hardware.description.errors import DataError
from hardware.description.units import is_unit

MISSING = ("", "NaN", "nan", "NAN", "-nan", "NA", "N/A", "n/a", "#N/A", "null", "NULL", "None")

_SAMPLE_LINES = 20
HEAD_LINES = 1000  # in which a header is looked for
_LARGEST_TITLE = 20  # lines above the header
_SEPARATORS = tuple((separator, decimal) for separator in "\t;|, " for decimal in ".,")


@dataclass(frozen=True)
class FoundLayout:
    """A file's layout as found.

    Attributes
    ----------
    separator
        Between cells; a space stands for any run of blanks.
    first_line
        Lines of the file before the data.
    missing
        Cells that stand for a missing value.
    first_day
        Of the first row's date: times with dates count from its midnight.
    """

    headers: tuple[Header, ...]
    separator: str
    decimal: str
    first_line: int
    missing: tuple[str, ...]
    first_day: Days = NO_DAY

    @property
    def is_single(self) -> bool:
        """Whether there is one column only, so that an empty line is a missing value."""
        return len(self.headers) == 1

    @property
    def fewest_cells(self) -> int:
        """Cells that every row must have: up to the last column that has a name."""
        named = [header.number for header in self.headers if header.text]
        return named[-1] if named else len(self.headers)

    def cells(self, line: str) -> list[str]:
        """Split a line into cells, without the blanks around them."""
        return split_line(line, self.separator)

    def number(self, cell: str) -> float:
        """Read a cell as a number, NaN where it stands for a missing value.

        A time of day, 14:03:07.25, is the seconds since midnight; with a date, since that of the
        first row's.

        Raises
        ------
        ValueError
            If it is neither.
        """
        if cell in self.missing:
            return float("nan")
        if "_" not in cell and (self.decimal == "." or "." not in cell):
            try:
                return float(cell.replace(self.decimal, "."))
            except ValueError:
                pass
        stamp = read_stamp(cell)
        if stamp is None:
            raise ValueError(cell)
        return stamp.seconds_since(self.first_day)


def split_line(line: str, separator: str) -> list[str]:
    """Split a line into cells; quoted cells may contain the separator."""
    if separator == " ":
        return line.split()
    row = next(csv.reader([line], delimiter=separator, skipinitialspace=True), [])
    return [cell.strip() for cell in row]


def find_layout(source: TextSource, layout: TextLayout) -> FoundLayout:
    """Find the header and the data of a text file by its first lines.

    Lines that are blank or begin with ``#`` or ``%`` before the header are passed over; where
    numbers follow at once, the last such line is the header (as ``numpy.savetxt`` writes), and
    without any the columns are called ``column_1``, ``column_2`` ...  A line of units under the
    header is taken as the columns' units. Lines above the header with fewer cells are titles.

    Raises
    ------
    DataError
        If there is no data at all, or none after ``skip_rows``; as :meth:`TextSource.head` does.
    """
    head = source.head(layout.skip_rows + HEAD_LINES)
    return layout_of(head, layout, str(source.path))


def layout_of(head: str, layout: TextLayout, where: str) -> FoundLayout:
    """Find header and data in a table's first lines, as :func:`find_layout`; raises DataError.

    Parameters
    ----------
    where
        The file's name, for messages.
    """
    most = layout.skip_rows + HEAD_LINES
    numbered = list(islice(enumerate(io.StringIO(head), 1), most))
    lines = [(n, line.strip("\n")) for n, line in numbered[layout.skip_rows :] if line.strip()]
    comments = [(n, line.lstrip()[1:]) for n, line in lines if line.lstrip()[0] in "#%"]
    body = [(n, line) for n, line in lines if line.lstrip()[0] not in "#%"]
    if not body:
        after = f" after the {layout.skip_rows} skipped lines" if layout.skip_rows else ""
        raise DataError(f"{where}: there is no data in the file{after}")
    missing = (*MISSING, *layout.missing)
    separator, decimal = _separator([line for _, line in body], layout, missing)
    bare = FoundLayout((), separator, decimal, 0, missing)
    first = bare.cells(body[0][1])
    if _is_data(bare, first):
        return _headless_layout(bare, first, comments, body[0][0] - 1, where)
    return _with_header(bare, _without_titles(bare, body), where)


def _without_titles(bare: FoundLayout, body: list[tuple[int, str]]) -> list[tuple[int, str]]:
    """Pass over lines above the header: too few cells, or words where a later line names time."""
    rows = [bare.cells(line) for _, line in body[:_LARGEST_TITLE]]
    data = next((k for k, cells in enumerate(rows) if len(cells) > 1 and _is_data(bare, cells)), 0)
    if not data:
        return body
    needed = len(rows[data]) - (not rows[data][-1])
    wide = [k for k in range(data) if _length(rows[k]) >= needed] or [0]
    named = [k for k in wide if not _is_title(bare, rows, k)] or wide[:1]
    timed = (k for k in named if any(parse_header(0, cell).is_time for cell in rows[k]))
    return body[next(timed, named[0]) :]


def _is_title(bare: FoundLayout, rows: list[list[str]], k: int) -> bool:
    """Tell a line with a number or a date in it, but for numbers of channels over their units."""
    cells = [cell for cell in rows[k] if cell]
    named = [cell for cell in cells if not _is_data(bare, [cell]) and read_stamp(cell) is None]
    return len(named) < len(cells) and _with_units(rows[k], rows[k + 1]) is None


def _length(cells: list[str]) -> int:
    """Count cells up to the last that is not empty: a spreadsheet pads its titles."""
    return max((k for k, cell in enumerate(cells, 1) if cell), default=0)


def too_many_cells(where: str, line: int, cells: int, columns: int) -> DataError:
    """Return the error of a line that has more cells than the header."""
    return DataError(
        f"{where}: line {line} has {cells} cells, the header has {columns}; correct the line, or "
        "say separator, decimal or skip_rows (lines before the header) in the column map"
    )


def too_few_cells(where: str, line: int, cells: int, columns: int) -> DataError:
    """Return the error of a line that has fewer cells than the header."""
    return DataError(
        f"{where}: line {line} has {cells} cells, the header has {columns}; complete the line "
        "(a missing value is an empty cell between two separators), or take it out"
    )


def _headless_layout(
    bare: FoundLayout,
    first: list[str],
    comments: list[tuple[int, str]],
    first_line: int,
    where: str,
) -> FoundLayout:
    lines = [line for _, line in comments[-2:]]
    names = _header_cells(lines[-1], bare.separator) if lines else []
    above = _header_cells(lines[0], bare.separator) if len(lines) > 1 else []
    if len(above) == len(first):
        names = _with_units(above, bare.cells(lines[1])) or names
    if len(names) != len(first):
        names = [""] * len(first)
    return _headed_layout(bare, names, first, first_line, where)


def _with_header(bare: FoundLayout, body: list[tuple[int, str]], where: str) -> FoundLayout:
    (_, header), *rows = body
    names = _header_cells(header, bare.separator)
    if rows and (united := _with_units(names, bare.cells(rows[0][1]))):
        names, rows = united, rows[1:]
    if not rows:
        raise DataError(f"{where}: there are no rows of data under the header")
    first_number, first = rows[0]
    cells = bare.cells(first)
    if len(cells) == len(names) + 1 and not cells[-1]:
        names.append("")  # every row ends with a separator
    if len(cells) > len(names):
        raise too_many_cells(where, first_number, len(cells), len(names))
    return _headed_layout(bare, names, cells, first_number - 1, where)


def _headed_layout(
    bare: FoundLayout, names: Sequence[str], first: Sequence[str], first_line: int, where: str
) -> FoundLayout:
    if len(names) > MOST_COLUMNS:
        raise DataError(f"{where}: {len(names)} columns; the limit is {MOST_COLUMNS}")
    headers = [parse_header(number, name) for number, name in enumerate(names, 1)]
    stamps = dict(enumerate(map(read_stamp, first)))
    for k, stamp in stamps.items():
        if stamp is not None and k < len(headers):
            headers[k] = replace(headers[k], unit=stamp.unit, unit_is_suffix=False)
    days = [stamp.days for stamp in stamps.values() if stamp is not None and stamp.days != NO_DAY]
    first_day = days[0] if days else NO_DAY
    return FoundLayout(
        tuple(headers), bare.separator, bare.decimal, first_line, bare.missing, first_day
    )


def _header_cells(line: str, separator: str) -> list[str]:
    if separator != " ":
        return split_line(line, separator)
    # "Time [s]  F (N)" is two columns: a blank before a bracket separates nothing.
    cells: list[str] = []
    for word in line.split():
        if word[0] in "[(" and cells:
            cells[-1] += f" {word}"
        else:
            cells.append(word)
    return cells


def _with_units(names: list[str], cells: list[str]) -> list[str] | None:
    """Return names with the units of a line below them; ``None`` where it is none of units.

    It has as many cells as names, no number among them but the unit 1, and another known unit;
    brackets may be round it.
    """
    units = [cell.strip("()[]") for cell in cells]
    numbers = [cell for cell in units if cell[-1:].isdigit() and not is_unit(cell)]
    known = [cell for cell in units if is_unit(cell) and cell != "1"]
    if len(units) != len(names) or numbers or not known:
        return None
    return [f"{a} [{b}]" if b else a for a, b in zip(names, units, strict=True)]


def _is_data(layout: FoundLayout, cells: list[str]) -> bool:
    """Tell a row of numbers; a date or a time alone stands in titles too."""
    try:
        numbers = [layout.number(cell) for cell in cells]
    except ValueError:
        return False
    present = [cell for cell, number in zip(cells, numbers, strict=True) if number == number]
    return any(read_stamp(cell) is None for cell in present)


def _separator(lines: list[str], layout: TextLayout, missing: tuple[str, ...]) -> tuple[str, str]:
    """Return the separator and decimal sign with which most of the first lines are numbers.

    With a column of text none are: then it is most of their cells.
    """
    choices = [
        (separator, decimal)
        for separator, decimal in _SEPARATORS
        if layout.decimal in (None, decimal) and layout.separator is None
    ] or [(layout.separator or ",", decimal) for decimal in (layout.decimal or ".,")]
    best, best_score = choices[0], (-1, -1, -1)
    lines = lines[: max(1, min(_SAMPLE_LINES, LONGEST_LINE // max(map(len, lines))))]
    for separator, decimal in choices:
        trial = FoundLayout((), separator, decimal, 0, missing)
        rows = [trial.cells(line) for line in lines]
        numeric = sum(_is_data(trial, row) for row in rows)
        numbers = sum(_is_data(trial, [cell]) for row in rows for cell in row)
        # A date and its time, a blank between, are one cell where another separator does.
        score = (numeric, 0 if separator == " " else len(rows[-1]), numbers)
        if score > best_score:
            best, best_score = (separator, decimal), score
    return best
