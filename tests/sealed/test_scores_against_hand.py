"""Scores that are kept: each once, in the order in which they were made, and a page of all."""

import json
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from benchmarks import machine
from hardware.description.errors import DataError
from tests.sealed import steps, steps_of_worlds
from tests.sealed.__main__ import main
from tests.sealed.scoreboard import page, write_scoreboard
from tests.sealed.scores import all_scores, is_development, keep, read
from tests.sealed.scoring import handmade
from tests.sealed.scoring.board import read_board
from tests.sealed.scoring.document import read_document
from tests.sealed.scoring.score import Score, score

DOCS = Path(__file__).parents[2] / "docs"
FIRST, SECOND = "a" * 40, "0" * 3 + "b" * 37
MADE_ON = {"date": "2026-03-01 08:00 UTC", "commit": "aaaaaaa", "cpu": "some cpu", "cores": "2",
           "python": "3.11.7"}  # fmt: skip


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Score:
    """Return the score of the board that docs/sealed-scoring.md works out, by another seed."""
    board = handmade.write(tmp_path_factory.mktemp("hand") / "board")
    return replace(score(read_board(board)), seed=FIRST)


@pytest.fixture
def docs(tmp_path: Path, made: Score) -> Path:
    """Return a folder in which two scores were kept, the later one by name before the other."""
    keep(tmp_path, made, MADE_ON)
    # A hash that begins with zeros loses them as a number.
    later = replace(made, seed=SECOND.lstrip("0"), rows=(made.rows[0],))
    keep(tmp_path, later, {**MADE_ON, "date": "2026-03-02 07:00 UTC", "cores": "8"})
    return tmp_path


def _changed(path: Path, **entries: Any) -> None:
    path.write_text(json.dumps({**json.loads(path.read_text()), **entries}))


def _run(*words: str) -> Result:
    return CliRunner().invoke(main, list(words))


def test_a_score_is_read_as_it_was_written(docs: Path, made: Score) -> None:
    assert read_document(docs / "scores" / "aaaaaaa.json") == made
    kept = read(docs / "scores" / "aaaaaaa.json")
    assert kept.made_on == MADE_ON
    assert {one.key: one.measured for one in kept.targets}["pairs_clear"] == 1.0


def test_scores_stand_in_the_order_in_which_they_were_made(docs: Path) -> None:
    assert [one.name for one in all_scores(docs)] == ["aaaaaaa", "000bbbb"]


def test_a_board_is_scored_once(docs: Path, made: Score) -> None:
    before = (docs / "scores" / "aaaaaaa.json").read_bytes()
    with pytest.raises(DataError, match=r"aaaaaaa was scored on 2026-03-01 .* scored once"):
        keep(docs, replace(made, cases=1), {**MADE_ON, "date": "2026-03-03 08:00 UTC"})
    assert (docs / "scores" / "aaaaaaa.json").read_bytes() == before


@pytest.mark.parametrize("seed", ["0", "7", "63"])
def test_seeds_for_development_are_never_kept(docs: Path, made: Score, seed: str) -> None:
    assert is_development(seed)
    with pytest.raises(DataError, match="for development"):
        keep(docs, replace(made, seed=seed), MADE_ON)
    assert len(list((docs / "scores").iterdir())) == 2


@pytest.mark.slow
def test_the_page_has_a_column_for_each_score_and_links_to_all_figures(docs: Path) -> None:
    target = "| sealed board: share of pairs named, each member 10 sigma"
    write_scoreboard(docs)
    text = (docs / "scoreboard.md").read_text()
    lines = text.splitlines()
    assert "|  | limit | aaaaaaa | 000bbbb |" in lines
    newest, pairs = [line for line in lines if line.startswith(target)]
    # The page of scores: 1 of 1 clear pairs named, where a linear matcher names 0.8.
    assert newest.endswith("| at least 0.7 | 1 of 0.8, met |")
    assert pairs.endswith("| at least 0.7 | 1 of 0.8, met | 1 of 0.8, met |")
    assert "| the same | at most 0.98 | 0.833, met | 0.833, met |" in lines
    assert "| 1 | [aaaaaaa](scores/aaaaaaa.json) | 2026-03-01 08:00 UTC |" in text
    assert "some cpu, 8 cores, Python 3.11.7" in text
    assert "The newest board, 000bbbb, of 12 cases, was scored on" in text
    assert text.count("<details>") == text.count("</details>") == 3
    assert (docs / "images" / "scoreboard.svg").read_text().startswith("<?xml")
    assert "| stage | 0.714 [0.36, 0.92] n 7 | 0.714 [0.36, 0.92] n 7 |" in lines
    assert "**SNR 3 to 10**" in lines


def test_a_score_from_before_a_column_has_a_dash_there(docs: Path) -> None:
    path = docs / "scores" / "aaaaaaa.json"
    rows = json.loads(path.read_text())["rows"]
    for row in rows:
        for one in row["bins"]:
            one["figures"].pop("ranked_by_class", None)
    _changed(path, rows=rows)
    lines = page(all_scores(docs)).splitlines()
    newer = "0.8 [0.38, 0.96] n 5 of 0.92"
    assert f"| top-1 by class | {newer} | {newer} |" in lines
    assert f"| best name by class | - | {newer} |" in lines


def test_every_table_of_the_page_is_even(docs: Path) -> None:
    lines = page(all_scores(docs)).splitlines()
    tables = 0
    for above, line in pairwise(lines):
        if above.startswith("|") and line.startswith("|"):
            assert above.count("|") == line.count("|"), line
        tables += line.startswith("| ---")
    assert tables > 8


def test_a_limit_of_another_day_stands_beside_its_verdict(docs: Path) -> None:
    path = docs / "scores" / "aaaaaaa.json"
    targets = json.loads(path.read_text())["targets"]
    stage = next(one for one in targets if one["key"] == "stage")
    stage.update(limit="at least 0.2", met=True)
    targets.append({**stage, "key": "gone", "what": "no more", "measured": 0.5})
    _changed(path, targets=targets)
    text = page(all_scores(docs))
    assert "| at least 0.95 | 0.333, met (at least 0.2) | 0.333, MISSED |" in text
    assert "| no more | at least 0.2 | 0.5, met | not measured |" in text


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        ({"made_on": {"date": "2026-03-01"}}, "made_on lacks commit, cpu, cores, python"),
        ({"schema": "sealed-score-0"}, "should be 'sealed-score-1'"),
        ({"cases": "many"}, "cases"),
    ],
)
def test_what_is_no_score_is_named(docs: Path, entries: dict[str, Any], said: str) -> None:
    _changed(docs / "scores" / "aaaaaaa.json", **entries)
    with pytest.raises(DataError, match=said):
        all_scores(docs)


@pytest.mark.slow
def test_the_page_is_written_again_from_what_was_kept(docs: Path) -> None:
    assert _run("page", "--docs", str(docs)).exit_code == 0
    assert (docs / "scoreboard.md").read_text() == page(all_scores(docs))


def test_a_page_without_scores_is_refused(tmp_path: Path) -> None:
    done = _run("page", "--docs", str(tmp_path))
    assert done.exit_code == 1
    assert "no scores yet" in done.output


@pytest.mark.slow
def test_score_keeps_what_it_may_and_refuses_before_it_scores(docs: Path, tmp_path: Path) -> None:
    board = handmade.write(tmp_path / "board")
    shown = tmp_path / "shown.json"
    done = _run("score", str(board), "--json", str(shown))
    assert done.exit_code == 0
    assert json.loads(shown.read_text())["made_on"]["commit"] == machine.commit()
    toml = board / "board.toml"
    for seed, said in (("7", "for development"), (FIRST, "scored once")):
        toml.write_text(toml.read_text().replace('seed = "7"', f'seed = "{seed}"'))
        done = _run("score", str(board), "--docs", str(docs))
        assert done.exit_code == 1
        assert said in done.output
    assert len(list((docs / "scores").iterdir())) == 2
    toml.write_text(toml.read_text().replace(FIRST, "c" * 40))
    assert _run("score", str(board), "--docs", str(docs)).exit_code == 0
    assert [one.name for one in all_scores(docs)] == ["aaaaaaa", "000bbbb", "ccccccc"]
    assert "The newest board, ccccccc," in (docs / "scoreboard.md").read_text()


@pytest.mark.parametrize(
    ("words", "here", "said"),
    [
        (("--commit", FIRST), "aaaaaaa", "scored once"),
        (("--commit", "c" * 40), "ddddddd", "ddddddd is checked out"),
        (("--commit", "c" * 40), "ccccccc with changes", "ccccccc with changes is checked out"),
        (("--commit", "c" * 40), "unknown", "unknown is checked out"),
        (("--commit", "c" * 40, "--cases", "20"), "ccccccc", "takes 300 of each"),
        (("--commit", "ccccccc"), "ccccccc", "no whole hash"),
    ],
)
def test_whole_refuses_before_it_makes_a_board(
    docs: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], here: str, said: str
) -> None:
    monkeypatch.setattr(machine, "commit", lambda: here)
    done = _run("whole", *words, "--output", str(docs / "board"), "--docs", str(docs))
    assert done.exit_code == 2
    assert said in " ".join(done.output.split())
    assert not (docs / "board").exists()


@pytest.mark.parametrize(
    ("words", "kept"), [(("--seed", "7"), False), (("--commit", "c" * 40), True)]
)
def test_whole_keeps_the_score_of_a_commit_alone(
    docs: Path, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], kept: bool
) -> None:
    told: list[Path | None] = []
    monkeypatch.setattr(machine, "commit", lambda: "ccccccc")
    for step in ("generated", "answered", "others", "left_out_answered"):
        monkeypatch.setattr(steps, step, lambda *arguments: None)
    monkeypatch.setattr(steps, "scored", lambda board, place: told.append(place))
    held: list[Path] = []
    monkeypatch.setattr(steps_of_worlds, "held", lambda board, place: held.append(place))
    assert _run("whole", *words, "--output", str(docs), "--docs", str(docs)).exit_code == 0
    assert told == [docs if kept else None]
    assert held == [docs / "scores/worlds/ccccccc-A.json" if kept else docs / "limits.json"]


def test_the_documentation_s_page_is_what_its_scores_make() -> None:
    kept = all_scores(DOCS)
    assert kept[0].name == "a8639d1"
    assert (DOCS / "scoreboard.md").read_text() == page(kept)
