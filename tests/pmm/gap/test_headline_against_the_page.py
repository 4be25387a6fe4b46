"""The headline agrees with the tables below it, in terminal, document and page alike.

The oracle is what a reader sees: the texts are taken apart again, nothing is asked of the code that
made them.
"""

import html
import json
import math
import re
from dataclasses import dataclass, replace
from io import StringIO
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from pmm.document.content import Document, Figure
from pmm.document.data import as_json
from pmm.document.page import write_page
from pmm.document.terminal import print_document
from pmm.gap.coefficients import CoefficientRow
from pmm.gap.conclusion import Conclusion, Weighing, verdict_of
from pmm.gap.document import document
from pmm.gap.hull_report import Convention
from pmm.gap.report import GapReport
from pmm.gap.sizes import HowLarge, Size, spoiled_coefficient
from pmm.gap.steps import StepRow
from pmm.gap.tables import ControlRow, RankedAnswer, RegimeRow
from pmm.gap.words import Remedies, sentences
from tests.pmm.gap.rigs import FEW, made, rewritten, run, with_friction

BEGINNINGS = {
    "none": ("No gap: ", "Nothing that was considered"),
    "coefficients": ("No effect is missing: ",),
    "odd-run": ("Run ",),
    "unknown": ("Something that the catalogue does not have", "Something else than the "),
}


@dataclass
class Shown:
    """What a reader has before them."""

    terminal: str
    document: dict[str, Any]
    page: str


def check(shown: Shown, campaign: str) -> None:
    """Hold the three renderings against each other and the headline against the tables."""
    said, page = shown.document["said"], html.unescape(shown.page)
    lines = shown.terminal.splitlines()
    assert [lines[0].removeprefix(f"{campaign}: "), *lines[1:3]] == said
    assert re.findall(r"<p><strong>(.*?)</strong></p>", page) == said
    _check_headline(shown)
    _check_what_is_added(shown)
    for text in (shown.terminal, re.sub(r"<[^>]+>", "\n", page)):
        _check_caution(text, shown.document)
        _check_that_u_is_explained_first(text)
    for one in said:
        assert not re.search(r"\bu\b|log odds|evidence|sigma", one)


def _check_headline(shown: Shown) -> None:
    verdict, said = shown.document["verdict"], shown.document["said"]
    words = walk_words(shown.terminal)
    steps = [one["what"] for one in shown.document["walk"]]
    assert [*words] == steps
    assert [*walk_words_of_page(shown.page)][: len(steps)] == steps
    assert {name: walk_words_of_page(shown.page)[name] for name in steps} == words
    if verdict in BEGINNINGS:
        assert said[0].startswith(BEGINNINGS[verdict])
    else:
        assert said[0].endswith("or whatever acts alike.") or "would look the same" in said[0]
    if said[0].startswith("No gap: "):
        own = [one for one in shown.document["walk"] if "," not in one["what"]]  # fed by nothing
        assert not any(one["beyond"] for one in own)


def walk_words(terminal: str) -> dict[str, str]:
    """Return the verdict of each step as the terminal shows it."""
    table = terminal.partition("along the chain")[2].partition("\n\n")[0]
    table = table.partition("forces, by kind of run")[0]
    rows = re.findall(
        r"^(\S.*?) {2,}(no gap|gap|out of tolerance|cannot tell)\b", table, re.MULTILINE
    )
    return dict(rows)


def walk_words_of_page(page: str) -> dict[str, str]:
    """Return the same of the page."""
    (body,) = re.findall(r'aria-label="Walk">.*?<tbody>(.*?)</tbody>', page, re.DOTALL)
    return dict(re.findall(r'<th scope="row">(.*?)</th><td>(.*?)</td>', body))


def _check_what_is_added(shown: Shown) -> None:
    verdict = shown.document["verdict"]
    offered = 'pmm gap add"' in shown.document["said"][2]
    assert offered <= (verdict == "effect")
    if verdict == "unknown":
        assert "gap add" not in shown.terminal
        assert "gap add" not in shown.page.partition("How this page was made")[0]


def _check_caution(text: str, document: dict[str, Any]) -> None:
    """The table of coefficients says in its head what nothing explains."""
    head = re.split(r"^Coefficients\s*$", text, flags=re.MULTILINE)[-1].strip()
    beyond = any(one["beyond"] for one in document["remains"])
    said = head.startswith("CAUTION: much is left unexplained")
    # What is unknown may be out of tolerance as well.
    assert said if beyond else (not said or document["verdict"] == "unknown")


def _check_that_u_is_explained_first(text: str) -> None:
    explained = text.index("u is the standard uncertainty")
    first = re.search(r"\d u\b|\[u\]|E/u", text)
    assert first is None or explained < first.start()


# Diagnoses made by hand

STEPS = ("shaft", "strut motion", "forces", "forces, with the measured motion")
ANSWERS = ("none", "coefficients", "unknown", "odd-run", "cable", "cable+hum", "friction")


@st.composite
def steps(draw: st.DrawFn) -> tuple[StepRow, ...]:
    quiet = draw(st.booleans())
    return tuple(
        StepRow(
            what,
            draw(st.floats(0.0, 1.2) if quiet else st.floats(0.0, 80.0)),
            96,
            not quiet and draw(st.booleans()),
            "run-1: force_aft n=1 mean +0.4 u",
            draw(st.floats(0.0, 90.0) | st.just(math.nan)),
            draw(st.booleans()),
            {} if quiet else draw(st.just({}) | st.just({"zero aft": 8.0})),
        )
        for what in STEPS
    )


@st.composite
def weighings(draw: st.DrawFn) -> Weighing:
    weights = [draw(st.floats(1e-6, 1.0)) ** 4 for _ in ANSWERS]
    pairs = sorted(zip(ANSWERS, weights, strict=True), key=lambda pair: -pair[1])
    shares = {name: weight / math.fsum(weights) for name, weight in pairs}
    named = [name for name in shares if name not in BEGINNINGS]
    best = "" if next(iter(shares)) in ("none", "coefficients") else named[0]
    alike = {one: draw(st.sampled_from([(), ("kin",), ("kin", "kith")])) for one in best.split("+")}
    return Weighing(
        shares,
        best,
        alike if best else {},
        {"cable": "Cable between model and carriage"},
        draw(st.floats(-1.0, 1.0)) if best else math.nan,
        draw(st.sampled_from(["structure", ""])),
        "run-7",
        draw(st.none() | st.integers(1, 50)),
    )


@st.composite
def rows(draw: st.DrawFn, *, named: bool) -> CoefficientRow:
    value = st.floats(-100.0, 100.0)
    with_effect, u = draw(value) if named else math.nan, 0.5
    without = draw(value)
    return CoefficientRow(
        "Z_w", "N s/m", draw(value), 0.0, without, u, with_effect, u, (without - with_effect) / u,
        math.nan, math.nan,
    )  # fmt: skip


@st.composite
def reports(draw: st.DrawFn) -> GapReport:
    weighing, walk = draw(weighings()), draw(steps())
    verdict = verdict_of(weighing)
    named = verdict == "effect"
    remains = tuple(one for one in (draw(steps()) if named else walk) if "," not in one.what)
    found = Conclusion(verdict, weighing, walk, remains)
    coefficients = (draw(rows(named=named)),)
    size = Size("forces", draw(st.floats(1e-6, 1e4)), "N", "harmonic 1 of force_aft", "run-1", 1.0)
    large = HowLarge((size,), spoiled_coefficient(coefficients))
    todo = Remedies(
        draw(st.sampled_from(["", "run-7"])), draw(st.sampled_from([(), ("a weight",)]))
    )
    near = "nearest, but not it: " * (not named) + weighing.best
    takes = weighing.takes
    controls = (ControlRow(near, 10.0, 10.0 * (1.0 - takes), takes, takes, takes),)
    ranking = tuple(
        RankedAnswer(name, p, 0.3, "", [], {}, []) for name, p in weighing.shares.items()
    )
    return GapReport(
        "hand", ("run-1",), (), {}, found, sentences(found, large, ("force 0.3 N",), todo), large,
        ("a note of 3 u",), walk[:1], {"structure": 1.0}, ranking, (), (),
        controls if weighing.best else (), (RegimeRow("all", 10.0, 1.0, 1.0, 1.0),),
        Convention("manoeuvring", "vertical", "dimensional", 0.0), coefficients, (), None, (),
    )  # fmt: skip


def test_sizes_of_several_steps_stand_in_a_list() -> None:
    weighing = Weighing({"none": 0.9}, "", {}, {}, math.nan, "", "")
    large = HowLarge(
        tuple(Size("forces", 1.0, "N", what, "one", math.nan) for what in ("a", "b", "c")), None
    )
    _, size, _ = sentences(Conclusion("none", weighing, (), ()), large, (), Remedies())
    each = [f"{what} by up to 1 N (run one)" for what in ("a", "b", "c")]
    assert size.startswith(f"They differ in {each[0]}, {each[1]} and {each[2]}, no more than")


def test_what_is_unknown_is_neither_noise_nor_nothing_to_be_done() -> None:
    weighing = Weighing({"unknown": 0.45, "none": 0.3}, "", {}, {}, math.nan, "structure", "")
    size = Size("forces", 0.1, "N", "harmonic 1 of force_aft", "run-1", 1.0)
    unknown, none = (
        sentences(
            Conclusion(verdict, weighing, (), ()), HowLarge((size,), None), (), Remedies(run="one")
        )
        for verdict in ("unknown", "none")
    )
    assert unknown[1:] == (
        "They differ in harmonic 1 of force_aft by up to 0.1 N (1 % of its first harmonic, run "
        "run-1), little more than noise; no coefficient is off by more than its uncertainty.",
        "Make the run that tells most, one, before any coefficient of this campaign is reported.",
    )
    assert none[2].startswith("Nothing has to be done")


@pytest.mark.slow
@given(report=reports())
def test_any_diagnosis(report: GapReport, tmp_path_factory: pytest.TempPathFactory) -> None:
    path = tmp_path_factory.getbasetemp() / "hand.html"
    told = document(report)
    write_page(without_figures(told), path, command="pmm")
    console = Console(file=StringIO(), width=200, highlight=False, markup=False)
    print_document(console, told)
    assert isinstance(console.file, StringIO)
    check(Shown(console.file.getvalue(), json.loads(as_json(told)), path.read_text()), "hand")


def without_figures(told: Document) -> Document:
    """Return the same without what takes time to draw."""
    sections = (
        replace(one, contents=tuple(each for each in one.contents if not isinstance(each, Figure)))
        for one in told.sections
    )
    return replace(told, sections=tuple(sections))


@given(report=reports())
def test_the_most_probable_answer_is_what_is_said(report: GapReport) -> None:
    found = report.conclusion
    first = max(found.weighing.shares, key=lambda name: found.weighing.shares[name])
    assert found.verdict == (first if first in BEGINNINGS else "effect")
    assert found.adds == (first not in BEGINNINGS)
    if found.adds:
        assert set(first.split("+")) <= set(re.findall(r"[\w-]+", report.said[0]))


# Diagnoses of simulated rigs


@pytest.fixture(autouse=True)
def wide(monkeypatch: pytest.MonkeyPatch) -> None:
    """A terminal so wide that no cell folds."""
    monkeypatch.setattr("pmm.cli.screen.WIDE", 240)


def shown(rig: Path, page: Path, *options: str) -> Shown:
    text = run("gap", rig, *options, "--page", page)
    assert text.exit_code == 0, text.output
    document = json.loads(run("gap", rig, *options, "--json").stdout)
    return Shown(text.stdout, document, page.read_text())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "options", "verdict"),
    [
        ("friction", FEW, "effect"),
        ("friction", ("--effects", "gain-error,memory"), "unknown"),
        ("none", FEW, "none"),
        ("added mass", FEW, "coefficients"),
    ],
)
def test_simulated_rigs(tmp_path: Path, kind: str, options: tuple[str, ...], verdict: str) -> None:
    rig = with_friction(tmp_path) if kind == "friction" else made(tmp_path)
    if kind == "added mass":
        rig = rewritten(rig, tmp_path, "[[75.0, 3.0]", "[[30.0, 3.0]")
    found = shown(rig, tmp_path / "gap.html", *options)
    assert found.document["verdict"] == verdict
    check(found, found.document["campaign"])
    added = run("gap", "add", rig, *options)
    assert (added.exit_code == 0) == (verdict == "effect"), added.output
    assert added.exit_code == 0 or added.stderr.count("nothing to add") == 1


@pytest.mark.slow
def test_the_size_of_friction_is_that_of_its_square_wave(tmp_path: Path) -> None:
    """Friction F at each strut has 4 F / pi in the first harmonic of each force."""
    found = shown(with_friction(tmp_path), tmp_path / "gap.html", *FEW).document
    (size,) = found["how_large"]["sizes"]
    assert size["unit"] == "N"
    assert size["value"] == pytest.approx(4.0 * 0.3 / math.pi, rel=0.05)
    assert re.search(r"friction force at each strut 0\.\d+ N", found["said"][1])
    worst = found["how_large"]["coefficient"]
    (row,) = [one for one in found["coefficients"] if one["name"] == worst["name"]]
    assert worst["per_cent"] == pytest.approx(100.0 * (row["without"] / row["with_effect"] - 1.0))
