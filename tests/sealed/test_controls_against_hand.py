"""Controls and peers: what they answer where the right thing to say is plain."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from analysis.gap.observe.components import Component, GapRun, Observation, Part
from hardware.description.setpoint import SetPoint
from sim.effects.campaign import CampaignRun
from sim.effects.catalogue import catalogue
from tests.sealed import answering
from tests.sealed.__main__ import main
from tests.sealed.answering import answer_case, still_asked
from tests.sealed.board import generate, jobs_of
from tests.sealed.controls import CONTROLS, at_random
from tests.sealed.peers import by_bic, largest, sparse, structural
from tests.sealed.peers.scene import Remainder, Scene, scene
from tests.sealed.peers.terms import TERMS, force_rows, library
from tests.sealed.scoring import handmade
from tests.sealed.scoring.board import read_board
from tests.sealed.scoring.score import score
from tests.sealed.targets import verdicts

PARTS = [Component(channel, Part.MEAN) for channel in ("force_aft", "force_fore")] + [
    Component(channel, part, order)
    for channel in ("force_aft", "force_fore")
    for order in range(1, 7)
    for part in (Part.IN_PHASE, Part.QUADRATURE)
]
POINTS = [SetPoint(f, e, phase) for f, e, phase in
          ((0.4, 0.02, 0.0), (0.8, 0.02, 1.0), (0.8, 0.04, 3.1), (1.2, 0.03, 0.5))]  # fmt: skip


def _remainder(points: list[SetPoint], values: np.ndarray | None = None) -> Remainder:
    count = len(PARTS)
    empty = Observation(tuple(PARTS), np.zeros(count), np.full(count, 0.1))
    runs = tuple(
        GapRun(f"run-{i}", one, CampaignRun(i, 0.0, 0.0, one), empty, 10, 200.0)
        for i, one in enumerate(points)
    )
    size = count * len(points)
    return Remainder(runs, tuple(PARTS) * len(points), np.repeat(np.arange(len(points)), count),
                     np.zeros(size) if values is None else values, np.full(size, 0.1))  # fmt: skip


def _scene(law: str | None, size: float, seed: int = 1) -> Scene:
    """Return a case whose forces hold noise of 0.1 N and one law of each strut's motion."""
    there = _remainder(POINTS)
    noise = 0.1 * np.random.default_rng(seed).standard_normal(len(there.values))
    if law is not None:
        at = list(TERMS).index(law)
        columns = library(there)[:, 2 * at : 2 * at + 2].sum(axis=1)
        noise[force_rows(there)] += size * columns / np.abs(columns).max()
    return Scene(
        "case-0001", _remainder(POINTS, noise), _remainder(POINTS[:2]), ("withheld-1", "withheld-2")
    )


@pytest.fixture
def board(tmp_path: Path) -> Path:
    """Return the board that docs/sealed-scoring.md works out."""
    return handmade.write(tmp_path / "board")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("row", "reached"),
    [
        # Of 3 cases without a gap, 7 with one, 5 of them named; none of these is a zero offset.
        ("no-gap", {"false_alarms": 0, "detection": 0, "top_1": 0, "unknown": 0, "stage": 0}),
        (
            "commonest",
            {"false_alarms": 1, "detection": 1, "top_1": 0, "unknown": 0, "stage": 1 / 7},
        ),
    ],
)
def test_trivial_row_reaches_what_it_must(board: Path, row: str, reached: dict[str, float]) -> None:
    done = CliRunner().invoke(main, ["rows", str(board), "--only", row])
    assert done.exit_code == 0, done.output
    found = score(read_board(board)).rows[1]
    figures = {key: found.figure("all", key) for key in reached}
    assert found.name == row
    assert {key: one.value for key, one in figures.items() if one} == pytest.approx(reached)


def test_random_answers_are_the_same_each_time_and_spread_over_everything() -> None:
    cases = [Path(f"case-{i:04d}") for i in range(1500)]
    said = [next(iter(at_random(case)["probabilities"])) for case in cases]
    assert said == [next(iter(at_random(case)["probabilities"])) for case in cases]
    assert set(said) == {"none", "coefficients", "unknown", *catalogue()}
    counts = np.unique(said, return_counts=True)[1]
    # A multinomial share of 1500 draws stays within 5 deviations.
    expected = 1500 / len(counts)
    assert np.abs(counts - expected).max() < 5.0 * np.sqrt(expected)


@pytest.mark.parametrize("row", CONTROLS)
def test_stages_go_with_what_is_said(row: str) -> None:
    for number in range(40):
        found = CONTROLS[row](Path(f"case-{number:04d}"))
        for name in set(found["probabilities"]) & set(catalogue()):
            assert found["stages"] == {catalogue()[name].stage.value: 1.0}


def test_a_case_that_cannot_be_answered_is_answered_as_failed(
    board: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def broken(case: Path) -> dict[str, object]:
        raise ZeroDivisionError("division by zero")

    (board / "answers-largest-residual").mkdir()
    monkeypatch.setattr(largest, "scene", broken)
    monkeypatch.setattr(answering, "prepared", broken)
    for one in still_asked(board, ("largest-residual",)):
        assert answer_case(one) == {"largest-residual": "ZeroDivisionError: division by zero"}
    peer = score(read_board(board)).rows[1]
    reached = {key: figure.value for key, figure in peer.bins[-1].figures.items()}
    assert (reached["failed"], reached["false_alarms"], reached["detection"]) == (1.0, 1.0, 0.0)
    assert reached["brier"] == 2.0


def test_targets_are_held_against_the_first_row(board: Path) -> None:
    reached = {one.key: one.measured for one in verdicts(score(read_board(board)))}
    # By the page: 5 of 6 intervals hold; bins low (1 case), middle (7, 11), high (8, 12).
    assert reached == {
        "class_below_ceiling": pytest.approx(0.85 - 0.5),
        "class_size": pytest.approx(5 / 3),
        "unknown_below_ceiling": None,
        "stage": pytest.approx(1 / 3),
        "false_alarms": pytest.approx(1 / 3),
        "pairs_clear": 1.0,
        "gap_after": pytest.approx(0.75),
        "shrinkage": pytest.approx(0.45),
        "shrinkage_covered": pytest.approx(5 / 6),
        "shrinkage_covered_not_too_often": pytest.approx(5 / 6),
        "ahead_of_others": None,
        "left_out_sure_and_wrong": None,
        "case_s": 2.0,
    }


@pytest.fixture(scope="module")
def null_board(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a sealed board of one case in which nothing is."""
    folder = tmp_path_factory.mktemp("sealed") / "board"
    assert list(generate(jobs_of(6, 0, 1, folder))) == ["case-0001"]
    return folder


@pytest.fixture(scope="module")
def seen(null_board: Path) -> Scene:
    """Return what peers see of it."""
    return scene(null_board / "cases" / "case-0001")


@pytest.mark.slow
def test_peers_see_noise_alone_where_nothing_is(seen: Scene) -> None:
    rows = force_rows(seen.fitting)
    off = seen.fitting.values[rows] / seen.fitting.sigma[rows]
    assert np.sqrt(np.mean(off**2)) == pytest.approx(1.0, abs=0.3)
    before, after = seen.foretold()
    assert before == after
    more = seen.foretold(np.ones(len(seen.withheld.components)))[1]
    mean = before["withheld-1"]["force_aft"]["mean"]
    assert more["withheld-1"]["force_aft"]["mean"] == pytest.approx(mean + 1.0)


@pytest.mark.slow
def test_rows_of_a_sealed_board_are_whole(
    null_board: Path, seen: Scene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(largest, "scene", lambda case: seen)
    monkeypatch.setattr(answering, "prepared", lambda case: None)
    rows = ("no-gap", "largest-residual")
    for row in rows:
        (null_board / f"answers-{row}").mkdir()
    asked = still_asked(null_board, rows)
    assert [answer_case(one) for one in asked] == [{}]
    assert still_asked(null_board, rows) == []
    found = score(read_board(null_board))
    assert [row.name for row in found.rows] == ["largest-residual", "no-gap"]
    for one in found.rows:
        alarms, seconds = one.figure("all", "false_alarms"), one.figure("all", "seconds")
        assert alarms is not None
        assert seconds is not None
        assert alarms.count == seconds.count == 1


@pytest.mark.slow
def test_rows_that_nobody_knows_are_named(null_board: Path) -> None:
    done = CliRunner().invoke(main, ["rows", str(null_board), "--only", "nogap"])
    assert done.exit_code == 2
    assert "no rows nogap" in done.output


def _said(found: dict[str, dict[str, float]]) -> str:
    return max(found["probabilities"], key=lambda name: found["probabilities"][name])


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    ("law", "size", "said"),
    [(None, 0.0, "none"), ("sign v", 3.0, "coulomb-friction"), ("v|v|", 3.0, "quadratic-damping")],
)
def test_lmfit_names_a_law_that_is_there(
    monkeypatch: pytest.MonkeyPatch, law: str | None, size: float, said: str
) -> None:
    pytest.importorskip("lmfit", reason="optional dependency peers")
    monkeypatch.setattr(by_bic, "scene", lambda case: _scene(law, size))
    found = by_bic.lmfit_bic(Path("case-0001"))
    assert _said(found) == said


@pytest.mark.parametrize(("law", "size", "said"), [(None, 0.0, "none"), ("1", 3.0, "zero-offset")])
def test_pysindy_names_a_law_that_is_there(
    monkeypatch: pytest.MonkeyPatch, law: str | None, size: float, said: str
) -> None:
    pytest.importorskip("pysindy", reason="optional dependency peers")
    monkeypatch.setattr(sparse, "scene", lambda case: _scene(law, size))
    assert _said(sparse.pysindy_stlsq(Path("case-0001"))) == said


@pytest.mark.parametrize(("law", "size", "said"), [(None, 0.0, "none"), ("1", 3.0, "zero-offset")])
def test_largest_residual_says_what_sticks_out(
    monkeypatch: pytest.MonkeyPatch, law: str | None, size: float, said: str
) -> None:
    monkeypatch.setattr(largest, "scene", lambda case: _scene(law, size))
    assert _said(largest.largest_residual(Path("case-0001"))) == said


@pytest.mark.parametrize(
    ("fired", "stages"),
    [
        ({"force"}, ["model and water", "structure", "dynamometers", "acquisition"]),
        ({"displacement", "force"}, ["mechanism"]),
        ({"shaft", "displacement", "force", "pulse"}, ["drive"]),
        ({"pulse"}, ["photocell"]),
    ],
)
def test_structure_isolates_as_the_chain_says(fired: set[str], stages: list[str]) -> None:
    pytest.importorskip("faultdiagnosistoolbox", reason="optional dependency peers")
    assert structural.isolated(structural.tests_of_chain(), fired) == stages
