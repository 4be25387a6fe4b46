"""``python -m tests.sealed score``: what is printed and written, and how it ends."""

import json
from html.parser import HTMLParser
from pathlib import Path

import pytest
from click.testing import CliRunner

from tests.sealed.__main__ import main


class _Page(HTMLParser):
    """Collects what a page would load, and its headings."""

    def __init__(self) -> None:
        super().__init__()
        self.loads: list[str] = []
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag in ("script", "link", "img", "iframe"):
            self.loads.append(tag)
        self.loads += [str(v) for k, v in attrs if k == "src"]
        self.loads += [str(v) for k, v in attrs if k == "href" and not str(v).startswith("#")]
        if tag not in ("meta", "path", "use", "br"):
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag in self.open:
            assert self.open.pop() == tag


def _run(*words: str | Path) -> tuple[int, str, str]:
    done = CliRunner().invoke(main, ["score", *map(str, words)])
    return done.exit_code, done.stdout, done.stderr


def test_json_has_every_figure(board: Path, tmp_path: Path) -> None:
    target = tmp_path / "score.json"
    assert _run(board, "--json", target)[0] == 0
    found = json.loads(target.read_text())
    assert found["schema"] == "sealed-score-1"
    figure = found["rows"][0]["bins"][-1]["figures"]["top_1_by_class"]
    assert figure["value"] == 0.8
    assert figure["low"] < 0.8 < figure["high"]
    assert (figure["count"], figure["ceiling"]) == (5, pytest.approx(0.92))


def test_table_names_columns_and_what_is_left_out(board: Path) -> None:
    status, text, said = _run(board)
    assert status == 0
    assert "top-1 by class" in text
    assert "scored: 12 cases, 1 rows" in said


@pytest.mark.slow
def test_page_needs_nothing_besides_itself(board: Path, tmp_path: Path) -> None:
    target = tmp_path / "pages" / "board.html"
    assert _run(board, "--page", target)[0] == 0
    page = _Page()
    page.feed(target.read_text())
    assert page.loads == []
    assert page.open == []
    text = target.read_text()
    assert "top-1 by class" in text
    assert "<svg" in text
    assert "0.8 [" in text
    assert "--ground: #ffffff" in text  # the style of all pages


def test_a_board_that_is_not_whole_ends_with_1(board: Path) -> None:
    (board / "answers" / "case-0001.json").unlink()
    status, text, said = _run(board)
    assert (status, text) == (1, "")
    assert "no answer to case-0001" in said


def test_missing_boards_end_with_2(tmp_path: Path) -> None:
    assert _run(tmp_path / "nowhere")[0] == 2
