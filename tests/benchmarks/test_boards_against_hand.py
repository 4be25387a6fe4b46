"""The boards count what they say: tallies by hand, planted SNR by simulation, jobs that go on."""

import lzma
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from analysis.readers import read_recording
from benchmarks.boards.campaigns import EXAMPLES, NULLS
from benchmarks.boards.friction import snr_of_newton
from benchmarks.boards.judged import with_outcome
from benchmarks.boards.mutated import spoiled
from benchmarks.boards.rows import FOLDERS, Job, jobs_of, keep, kept, missing
from benchmarks.boards.worlds import frozen
from benchmarks.campaign_boards import Tally, tallies
from benchmarks.gap_worlds import counted


def test_what_breaks_down_is_wrong_and_what_is_refused_is_not_judged() -> None:
    outcomes = ["right"] * 6 + ["alarm", "traceback", "refused"]
    (one, whole) = tallies([{"campaign": "a", "outcome": x} for x in outcomes], {"a": 20})
    assert one == Tally("a", 20, {"right": 6, "alarm": 1, "traceback": 1, "refused": 1})
    assert (one.judged, one.share_wrong, whole.counts) == (8, 0.25, one.counts)
    row = one.row("false alarms", "few")
    # Wilson (1927) of 2 in 8.
    assert row["95 % interval (Wilson)"] == "0.071 to 0.591"


def test_lines_are_kept_and_only_what_is_missing_is_measured(tmp_path: Path) -> None:
    jobs = jobs_of("nulls", ["examples/gap"], (0, 3))
    for seed, commit in ((0, "old"), (1, "new"), (1, "newer")):
        row = {"campaign": "examples/gap", "seed": seed, "commit": commit}
        keep("nulls", row, tmp_path)
    rows = kept("nulls", tmp_path)
    assert [one["commit"] for one in rows] == ["old", "newer"]
    assert [one.first for one in missing(jobs, rows, None)] == [2]
    assert [one.first for one in missing(jobs, rows, "newer")] == [0, 2]


def test_lines_go_on_from_compressed_ones(tmp_path: Path) -> None:
    keep("seen", {"campaign": "A", "seed": 0, "commit": "old"}, tmp_path)
    keep("seen", {"campaign": "B", "seed": 0, "commit": "old"}, tmp_path)
    file = tmp_path / "seen.jsonl"
    (tmp_path / "seen.jsonl.xz").write_bytes(lzma.compress(file.read_bytes()))
    assert len(kept("seen", tmp_path)) == 2
    file.unlink()
    keep("seen", {"campaign": "B", "seed": 0, "commit": "new"}, tmp_path)
    keep("seen", {"campaign": "C", "seed": 0, "commit": "new"}, tmp_path)
    rows = {one["campaign"]: one["commit"] for one in kept("seen", tmp_path)}
    assert rows == {"A": "old", "B": "new", "C": "new"}
    assert [
        job.campaign for job in missing(jobs_of("seen", [], (0, 1)), kept("seen", tmp_path), None)
    ] == ["D"]


def test_the_slices_hold_every_mutated_folder_once() -> None:
    slices = jobs_of("mutations", [], None)
    assert [slices[0].first, slices[-1].stop] == [0, FOLDERS]
    assert all(one.stop == two.first for one, two in pairwise(slices))
    assert slices[0] == Job("mutations", "mutated", 0, slices[0].stop)


def test_as_many_seeds_as_are_asked_for() -> None:
    many = [name for name, one in NULLS.items() if one.seeds == 100]
    assert len(many) == 4
    assert {one.seeds for one in NULLS.values()} == {100, 20}


def test_friction_has_the_snr_that_is_said(tmp_path: Path) -> None:
    """Oracle: a least-squares fit of sines to the difference of two noise-free simulations."""
    source = EXAMPLES / "gap" / "campaign.toml"
    text = source.read_text().partition("[acquisition]")
    quiet = f"{text[0]}[simulation]{text[2].partition('[simulation]')[2]}"
    head, *runs = quiet.split("[[runs]]")
    (tmp_path / "one.toml").write_text(f"{head}[[runs]]{runs[1]}")
    from benchmarks.boards.campaigns import simulated

    size_n, noise_n, squares = 0.3, 0.05, 0.0
    files = []
    for number, effects in enumerate(((), (f"coulomb-friction:friction_n={size_n}",))):
        folder = tmp_path / str(number)
        folder.mkdir()
        files.append(simulated(tmp_path / "one.toml", folder, 1, effects) / "heave-0.80-20.nc")
    still, rubbing = (read_recording(file) for file in files)
    count = round(10 / 0.8 * still.sample_rate_hz)
    times = still.time_s()[-count:]
    for gauge in ("force_aft", "force_fore"):
        gap = (rubbing.values(gauge) - still.values(gauge))[-count:]
        for order in (3, 5):
            turn = 2.0 * np.pi * order * 0.8 * times
            fit, *_ = np.linalg.lstsq(np.stack((np.sin(turn), np.cos(turn)), 1), gap, rcond=None)
            squares += float(fit @ fit) / (2.0 * noise_n**2 / count)
    (tmp_path / "with-noise.toml").write_text(
        f"{text[0]}[acquisition]\nforce_aft = {{ noise_rms = {noise_n} }}\n\n"
        f"[simulation]{head.partition('[simulation]')[2]}[[runs]]{runs[1]}"
    )
    said = size_n * snr_of_newton(tmp_path / "with-noise.toml")
    assert np.sqrt(squares) == pytest.approx(said, rel=0.03)


@pytest.mark.slow
def test_a_seed_spoils_alike_each_time(tmp_path: Path) -> None:
    folders = [tmp_path / "one", tmp_path / "two"]
    for folder in folders:
        folder.mkdir()
    assert spoiled(9, folders[0]) == spoiled(9, folders[1])
    one, two = ((folder / "campaign.toml").read_bytes() for folder in folders)
    assert one == two


@pytest.mark.parametrize(
    ("board", "campaign", "answer", "outcome"),
    [
        ("nulls", "examples/gap", "none", "right"),
        ("nulls", "examples/gap", "zero-drift", "alarm"),
        ("nulls", "examples/gap", "coefficients", "alarm"),
        ("nulls", "pmm init campaign", "coefficients", "right"),
        ("nulls", "examples/foreign", "zero-drift", "right"),
        ("friction", "examples/gap", "coulomb-friction", "right"),
        ("friction", "examples/gap", "coulomb-friction+zero-drift", "missed"),
        ("friction", "examples/foreign", "coulomb-friction+zero-drift", "right"),
        ("friction", "examples/foreign", "none", "missed"),
    ],
)
def test_what_is_right(board: str, campaign: str, answer: str, outcome: str) -> None:
    verdict = answer if answer in ("none", "coefficients") else "effect"
    stated = [answer] if verdict == "effect" and "+" not in answer else []
    row = {"campaign": campaign, "verdict": verdict, "answer": answer, "stated": stated}
    assert with_outcome(board, row)["outcome"] == outcome


def test_an_effect_that_it_says_it_cannot_tell_from_friction_is_right() -> None:
    row = {"campaign": "examples/gap", "verdict": "effect", "answer": "stribeck-friction"}
    said = {**row, "stated": ["coulomb-friction", "stribeck-friction"]}
    assert with_outcome("friction", said)["outcome"] == "right"
    assert with_outcome("nulls", {"outcome": "refused"}) == {"outcome": "refused"}


def test_sealed_cases_of_all_worlds_take_turns_and_are_seeded_by_the_frozen_commit() -> None:
    jobs = jobs_of("worlds", [], None)
    assert [one.campaign for one in jobs[:5]] == ["A", "B", "C", "D", "A"]
    assert len(jobs) == 4 * 600
    with pytest.raises(SystemExit, match="work tree of that commit"):
        frozen([{"frozen": "0" * 40}])


@pytest.mark.slow
def test_figures_of_kept_marks_are_those_of_the_answers_themselves() -> None:
    """Oracle: counts by hand of six lines."""
    right = {"top_1_by_class": [1.0], "stage": [1.0], "shrinkage_covered": [], "false_alarms": []}
    wrong = {**right, "top_1_by_class": [0.0]}
    null = {**{key: [] for key in right}, "false_alarms": [0.0]}
    alarm = {**null, "false_alarms": [1.0]}
    lines = [
        {"campaign": world, "seed": seed, "is_clear": clear, "values": values, "stated": stated,
         "frozen": "f" * 40}
        for seed, (world, clear, values, stated) in enumerate(
            [
                ("A", True, right, [0.95, 1.0]),
                ("A", True, wrong, [0.92, 0.0]),
                ("A", False, wrong, [0.99, 0.0]),  # below SNR 10: in no figure
                ("A", True, null, [0.5, 1.0]),
                ("A", True, alarm, None),  # failed: sure and wrong
                ("B", True, right, [0.6, 1.0]),
            ]
        )
    ]  # fmt: skip
    found = counted(lines)
    rows = {(r["world"], r["figure"]): r for r in found.tables["Figures by world"]}
    wrong_and_sure = "wrong, of the answers with class probability of 0.9 or more"
    expected = {"nulls": ("0.500", 2), "top-1 by class": ("0.500", 2), "stage": ("1.000", 2),
                wrong_and_sure: ("0.667", 3)}  # fmt: skip
    for figure, (value, count) in expected.items():
        assert (rows["A", figure]["measured"], rows["A", figure]["n"]) == (value, count), figure
    assert rows["A", "top-1 by class"][""] == "close"
    assert ("B", "nulls") not in rows
    assert found.measured == {"cases_a": 5.0, "cases_b": 1.0, "limits_missed": 3.0}
