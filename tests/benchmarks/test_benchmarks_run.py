"""Every benchmark runs at a small size, is judged, and gets its section on the page."""

import json
from pathlib import Path

import pytest

from benchmarks.command import NAMES, load
from benchmarks.machine import describe
from benchmarks.outcome import Outcome, judge
from benchmarks.page import figure, keep, write_page

# Left out: compiling and timing rivals takes longer than all others together, and so does watching
# browsers or the loop in real time, which tests/pmm/console and tests/pmm/run do besides.
_QUICK = [
    name for name in NAMES if name not in ("speed", "console", "crowd", "latency", "live_values")
]


@pytest.mark.slow
@pytest.mark.parametrize("name", _QUICK)
def test_quick_run_measures_and_is_kept(name: str, tmp_path: Path) -> None:
    if name == "evidence":
        pytest.importorskip("dynesty", reason="optional dependency bench")
    benchmark = load(name)
    outcome = benchmark.run(True, lambda _: None)
    for rows in outcome.tables.values():
        assert len({tuple(row) for row in rows}) == 1, "rows of a table differ in columns"
    path = keep(tmp_path, benchmark, outcome, describe(), quick=True)
    stored = json.loads(path.read_text(), parse_constant=pytest.fail)
    assert {row["verdict"] for row in stored["thresholds"]} <= {"met", "MISSED", "not measured"}
    page = tmp_path / "page.md"
    write_page(tmp_path, page, [name])
    assert f"## {benchmark.title}" in page.read_text()


@pytest.mark.parametrize("name", NAMES)
def test_thresholds_stand_for_every_benchmark(name: str) -> None:
    verdicts = judge(name, {})
    assert verdicts
    assert all(verdict.met is None for verdict in verdicts)
    assert load(name).name == name


def test_missed_threshold_is_said_on_the_page(tmp_path: Path) -> None:
    startup = load("startup")
    outcome = Outcome({"Times": [{"command": "pmm", "ms": 200.0}]}, {"help_s": 0.2})
    keep(tmp_path, startup, outcome, describe(), quick=False)
    write_page(tmp_path, tmp_path / "page.md", ["startup"])
    text = (tmp_path / "page.md").read_text()
    assert "**Missed: pmm --help, median of ten, s.**" in text
    assert "| at most 0.15 | 0.2 | MISSED |" in text


def test_measurement_without_threshold_is_refused() -> None:
    with pytest.raises(KeyError, match="no such_thing"):
        judge("startup", {"such_thing": 1.0})


@pytest.mark.parametrize(
    ("value", "text"), [(1234.5, "1234"), (0.00123456, "0.00123"), (7, "7"), ("a", "a"), (0.0, "0")]
)
def test_figures_are_three(value: float | str, text: str) -> None:
    assert figure(value) == text
