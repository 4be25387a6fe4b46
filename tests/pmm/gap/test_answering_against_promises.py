"""``pmm gap answer``: which cases are answered, where the answers go, and how it ends."""

import json
import platform
import shutil
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from hardware.description.errors import DataError
from pmm.cli import cli
from pmm.cli.gap import answer as answering
from tests.sealed.scoring import handmade

Asked = list[tuple[str, tuple[str, ...]]]


@pytest.fixture
def board(tmp_path: Path) -> Path:
    """Return a board of twelve cases with their answers."""
    return handmade.write(tmp_path / "board")


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> Asked:
    """Return the cases that the diagnosis is asked for; the third of them cannot be diagnosed."""
    found: Asked = []

    def diagnosed(folder: Path, left_out: tuple[str, ...] = ()) -> dict[str, Any]:
        found.append((folder.name, left_out))
        if folder.name == "case-0003":
            raise DataError("2 runs: a diagnosis needs 3 or more")
        return {"case": folder.name}

    monkeypatch.setattr(answering, "diagnosed", diagnosed)
    return found


def _run(board: Path, *words: str) -> Result:
    return CliRunner().invoke(cli, ["gap", "answer", str(board), "--jobs", "1", *words])


def test_what_has_an_answer_keeps_it(board: Path, asked: Asked) -> None:
    (board / "answers" / "case-0002.json").unlink()
    before = (board / "answers" / "case-0001.json").read_bytes()
    done = _run(board)
    assert done.exit_code == 0
    assert asked == [("case-0002", ())]
    assert json.loads((board / "answers" / "case-0002.json").read_text()) == {"case": "case-0002"}
    assert (board / "answers" / "case-0001.json").read_bytes() == before
    assert "11 had answers already" in done.stderr


def test_a_case_that_fails_is_named_and_all_others_are_answered(board: Path, asked: Asked) -> None:
    done = _run(board, "--overwrite")
    assert done.exit_code == 1
    assert "case-0003: 2 runs: a diagnosis needs 3 or more" in done.stderr
    assert "11 cases answered" in done.stderr
    assert len(asked) == 12
    assert not list((board / "answers").glob("*.part"))


def test_left_out_effects_reach_their_cases_alone(
    board: Path, asked: Asked, tmp_path: Path
) -> None:
    file = tmp_path / "leave-out.json"
    file.write_text(json.dumps({"case-0007": ["coulomb-friction"]}))
    target = tmp_path / "elsewhere"
    assert _run(board, "--leave-out", str(file), "--output", str(target)).exit_code == 0
    assert asked == [("case-0007", ("coulomb-friction",))]
    assert [path.name for path in target.iterdir()] == ["case-0007.json"]


def test_a_case_that_its_worker_does_not_see_ends_the_board_by_name(
    board: Path, asked: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    (board / "answers" / "case-0002.json").unlink()
    monkeypatch.chdir(board.parent)
    unseen = Path(board.name) / "cases" / "case-0002"
    monkeypatch.setattr(answering, "_cases", lambda _: [unseen])
    shutil.rmtree(unseen)  # as if the cases were not mounted where it works
    done = _run(Path(board.name))
    assert done.exit_code == 1
    # By the whole path: a worker may have begun in another folder.
    assert f"{board / 'cases' / 'case-0002'}: not there on {platform.node()}" in done.stderr
    assert asked == []


def test_wrong_usage_ends_with_2(board: Path, asked: Asked, tmp_path: Path) -> None:
    file = tmp_path / "leave-out.json"
    file.write_text(json.dumps({"case-0007": ["coulomb-fiction"]}))
    done = _run(board, "--leave-out", str(file))
    assert done.exit_code == 2
    assert "no effects: coulomb-fiction" in done.stderr
    assert _run(tmp_path).exit_code == 2
    assert asked == []
