"""The page: all numbers, nothing from elsewhere, nobody's markup."""

import re
from collections import Counter
from collections.abc import Sequence
from html.parser import HTMLParser
from pathlib import Path

import pytest

from analysis.resolver.analysis import Analysis
from pmm.document.notation import is_open, rounded
from pmm.document.page import write_page
from pmm.harmonics.rows import floored
from pmm.report.harmonics_document import harmonics_document
from tests.pmm.report.runs import analysed, run

HOSTILE = "<script>alert('x')</script>"
_VOID = {"meta", "link", "br", "img", "input", "hr"}


class _Reader(HTMLParser):
    """Collects tags, ids, references and text."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: Counter[str] = Counter()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.references: list[str] = []
        self.text: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_startendtag(tag, attrs)
        if tag not in _VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags[tag] += 1
        for name, value in attrs:
            assert not name.startswith("on"), f"{tag} has a handler"
            if name == "id":
                self.ids.append(value or "")
            if name in ("href", "src"):
                self.references.append(value or "")
            self.references += [
                f"#{found}" for found in re.findall(r"url\(#([^)]+)\)", value or "")
            ]

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text.append(data)


def _write(analyses: Sequence[Analysis], path: Path, *, title: str, command: str) -> None:
    write_page(harmonics_document(analyses, "page"), path, title=title, command=command)


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> str:
    path = tmp_path_factory.mktemp("page") / "new" / "report.html"
    hostile = run(1, names=(HOSTILE,), name=f"{HOSTILE} 1")
    analyses = [analysed(hostile), analysed(run(2), gate_periods=5)]
    _write(analyses, path, title=f"Title & {HOSTILE}", command="pmm analyse 'a <b>.csv'")
    return path.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def read(page: str) -> _Reader:
    reader = _Reader()
    reader.feed(page)
    reader.close()
    assert not reader.open
    return reader


@pytest.mark.slow
def test_nothing_comes_from_elsewhere(page: str, read: _Reader) -> None:
    assert not re.findall(r"https?://|@import|url\((?!#)", page)
    assert all(reference.startswith("#") for reference in read.references)
    assert not {"link", "img", "iframe", "object", "script"} & set(read.tags)
    assert read.tags["style"] == 1  # none of a drawing's, which would reach the whole page


@pytest.mark.slow
def test_ids_are_unique_and_every_reference_has_its_target(read: _Reader) -> None:
    assert [name for name, count in Counter(read.ids).items() if count > 1] == []
    assert {reference[1:] for reference in read.references} <= set(read.ids)
    assert read.tags["svg"] == 6


@pytest.mark.slow
def test_names_are_text(page: str, read: _Reader) -> None:
    assert "<script" not in page
    text = "".join(read.text)
    assert f"Title & {HOSTILE}" in text
    assert text.count(HOSTILE) > 8  # headings, table, provenance and the drawings
    assert "pmm analyse 'a <b>.csv'" in text


@pytest.mark.slow
def test_the_table_has_every_number(read: _Reader) -> None:
    text = "".join(read.text)
    analysis = analysed(run(2), gate_periods=5)
    for reading in analysis.readings:
        half = reading.half_width()
        for row, factor in ((0, 1e3), (1, 1.0)):
            for column in range(reading.coefficients.shape[1]):
                value = float(reading.coefficients[row, column]) * factor
                size = max(abs(reading.mean[row]), reading.amplitude[row].max()) * factor
                told = floored(value, float(half[row, column]) * factor, size)
                assert rounded(*told) in text
    assert f"Gate {len(analysis.readings)} of {len(analysis.readings)}" in text
    assert "setting, gate_periods" in text


@pytest.mark.slow
def test_flags_are_said(tmp_path: Path) -> None:
    analysis = analysed(opens_s=2.0, periods=1)
    _write([analysis], tmp_path / "one.html", title="t", command="c")
    page = (tmp_path / "one.html").read_text(encoding="utf-8")
    assert '<li class="warning">' in page
    assert "no_interval" in page
    assert "nan" not in re.sub(r"<[^>]*>", " ", page).lower().split()


@pytest.mark.slow
def test_a_name_that_is_no_text_does_not_cost_the_page(tmp_path: Path) -> None:
    analysis = analysed(run(1, names=("force\x00\udc80",), name="run\udcff"))
    _write([analysis], tmp_path / "a.html", title="\udcff", command="pmm \udcff")
    assert "force" in (tmp_path / "a.html").read_text(encoding="utf-8")


@pytest.mark.slow
def test_the_same_analysis_gives_the_same_page(tmp_path: Path) -> None:
    for name in ("a", "b"):
        _write([analysed(run(1, 8.0))], tmp_path / name, title="t", command="c")
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.parametrize(
    ("value", "half_width", "expected"),
    [
        (15.8123, 0.0996, "15.81 ± 0.10"),
        (-0.0001, 0.017, "0.000 ± 0.017"),
        (123.4, 45.0, "123 ± 45"),
        (-3e-7, 1e-8, "(−3.00 ± 0.10)·10^−7"),
        (30.0, 1.8e-13, "30 ± 1.8e−13"),
        (5.0, float("nan"), "5"),
        (float("nan"), 1.0, "–"),
    ],
)
def test_numbers_show_what_is_known(value: float, half_width: float, expected: str) -> None:
    assert rounded(value, half_width) == expected


def test_a_phase_that_may_be_any_is_open() -> None:
    assert is_open(200.0, 1.0)
    assert not is_open(2.0, 1.0)


@pytest.mark.slow
def test_a_single_period_has_no_intervals_in_good_english(tmp_path: Path) -> None:
    _write([analysed(opens_s=2.0, periods=1)], tmp_path / "a.html", title="t", command="c")
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "No intervals: too few periods." in page
    assert "from the none" not in page


def test_phases_that_are_not_known_are_open() -> None:
    assert is_open(90.0, 1.0)
    assert is_open(1.0, 0.0)
    assert not is_open(89.0, 1.0)
