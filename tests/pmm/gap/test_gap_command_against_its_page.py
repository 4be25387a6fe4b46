"""``docs/gap.md``: its commands run, from a raw campaign to a cured simulator."""

import json
import math
import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

import pmm
from analysis.gap.locate.walk import CHAIN
from pmm.cli import cli
from pmm.cli.gap import gap
from pmm.gap.document import SCHEMA
from pmm.interface.gap import GapResult
from sim.effects.catalogue import catalogue

HOUSE = Path(__file__).parents[3]
PAGE = (HOUSE / "docs" / "gap.md").read_text()
FEW = ("coulomb-friction", "amplifier-lag")
TRUTH_N = 0.3


def run(*arguments: str) -> Result:
    return CliRunner().invoke(cli, arguments)


def commands(first: str) -> list[list[str]]:
    """Return the commands of the page's block that begins with one."""
    blocks = re.findall(r"^```sh\n(.*?)^```", PAGE, flags=re.DOTALL | re.MULTILINE)
    (block,) = [one for one in blocks if one.startswith(first)]
    return [shlex.split(line)[1:] for line in block.strip().splitlines()]


@pytest.fixture(scope="module")
def few() -> Iterator[None]:
    """A catalogue of a handful, so that the page's commands take seconds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "pmm.gap.own_effects.catalogue", lambda: {name: catalogue()[name] for name in FEW}
        )
        yield


@pytest.fixture(scope="module")
def told(few: None, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Result]:
    """The page's commands, run one after the other in a folder of their own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("gap"))
        simulate, diagnose, add, again = commands("pmm simulate")
        simulate[1] = str(HOUSE / simulate[1])
        (held_out,) = commands("pmm gap rig --hold-out")
        found = {
            "simulate": run(*simulate),
            "diagnose": run(*diagnose),
            "json": run(*diagnose[:2], *held_out[2:], "--json", "--page", "held-out.html"),
            "python": pmm.open("rig").gap(hold_out=held_out[3:]),
            "add": run(*add),
            "again": run(*again, "--page", "again.html"),
            "twice": run(*add, "--effect", FEW[0]),
        }
        page, file = Path("gap.html").read_text(), Path("rig/campaign.toml").read_text()
        kept, held = Path("rig/campaign.toml.1").read_text(), Path("held-out.html").read_text()
        cured = Path("again.html").read_text()
    texts = {"page": page, "held out": held, "cured": cured, "file": file, "kept": kept}
    return found | texts  # type: ignore[return-value]


@pytest.mark.slow
def test_all_of_them_succeed(told: dict[str, Result]) -> None:
    for name in ("simulate", "diagnose", "json", "add", "again"):
        assert told[name].exit_code == 0, (name, told[name].output)


@pytest.mark.slow
def test_python_is_told_the_same(told: dict[str, Result | GapResult]) -> None:
    ours, command = told["python"], told["json"]
    assert isinstance(ours, GapResult)
    assert isinstance(command, Result)
    theirs = json.loads(command.stdout)
    assert ours.to_dict() == theirs
    assert (ours.verdict, list(ours.said)) == (theirs["verdict"], theirs["said"])
    shown = ours.to_dataset()
    assert shown.attrs["verdict"] == ours.verdict
    assert dict(zip(shown["answer"].values, shown["probability"].values, strict=True)) == {
        one["answer"]: one["probability"] for one in theirs["ranking"]
    }
    assert ours.plot_ranking()


@pytest.mark.slow
def test_a_reader_who_stops_reading_has_page_and_plan_all_the_same(
    few: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """``pmm gap ... | head -3`` closes the pipe before the tables are out."""

    def closed(*_: object) -> None:
        raise BrokenPipeError

    monkeypatch.chdir(tmp_path)
    assert (
        run("simulate", str(HOUSE / "examples/gap/campaign.toml"), "--output", "rig").exit_code == 0
    )
    monkeypatch.setattr("pmm.document.terminal.print_document", closed)
    assert run("gap", "rig", "--page", "gap.html", "--plan", "next.toml").exit_code != 0
    assert "</html>" in Path("gap.html").read_text()
    assert tomllib.loads(Path("next.toml").read_text())


@pytest.mark.slow
def test_friction_is_found_and_its_size(told: dict[str, Result]) -> None:
    said = told["diagnose"].stdout
    assert said.startswith(
        "gap: Coulomb friction below the dynamometer (coulomb-friction) is missing"
    )
    low, high = map(float, re.findall(r"friction_n = \S+ \((\S+) to (\S+)\)", said)[0])
    assert low - 0.002 < TRUTH_N < high + 0.002


@pytest.mark.slow
def test_withheld_runs_are_predicted(told: dict[str, Result]) -> None:
    found = json.loads(told["json"].stdout)
    assert found["schema"] == SCHEMA
    assert found["held_out"] == ["heave-1.10-20", "pitch-1.10-20"]
    assert not set(found["held_out"]) & set(found["runs"])
    best, *controls = found["controls"]
    assert best["before_u"] > 5.0
    assert best["after_u"] < 1.3
    assert all(one["after_u"] > best["after_u"] for one in controls[1:])
    assert sum(one["probability"] for one in found["ranking"]) <= 1.0 + 1e-9
    assert found["ranking"][0]["probability"] <= found["class_probability"] <= 1.0 + 1e-9
    assert {one["what"]: one["stated_u"] for one in found["walk"]}["forces"] > 10.0


@pytest.mark.slow
def test_the_bias_of_the_damping_is_that_of_friction(told: dict[str, Result]) -> None:
    """Two struts with friction F take the work of 8 F / (pi omega x), x being the amplitude."""
    found = json.loads(told["json"].stdout)
    (damping,) = [one for one in found["coefficients"] if one["name"] == "Z_w"]
    lent = [-8.0 * TRUTH_N / (math.pi * 2.0 * math.pi * f * 0.02) for f in (0.5, 0.8)]
    assert damping["stated"] == -190.0
    assert damping["with_effect"] == pytest.approx(-190.0, abs=3.0 * damping["u_with"])
    off = damping["without"] - damping["with_effect"]
    assert lent[0] < off < 0.8 * lent[1]
    assert damping["bias_u"] == pytest.approx(off / damping["u_with"])
    said = re.findall(r"^Z_w +N s/m .* ([-+]\d+\.\d)$", told["diagnose"].stdout, re.MULTILINE)
    assert float(said[0]) < -10.0


def table_of(page: str, name: str) -> list[list[str]]:
    """Return the rows of one of a page's tables."""
    (body,) = re.findall(rf'aria-label="{name}">.*?<tbody>(.*?)</tbody>', page, flags=re.DOTALL)
    rows = re.findall(r"<tr>(.*?)</tr>", body)
    return [re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row) for row in rows]


@pytest.mark.slow
def test_the_page_has_the_documents_numbers(told: dict[str, Result]) -> None:
    found, page = json.loads(told["json"].stdout), str(told["held out"])
    (effect,) = found["effects"]  # the other is out of the question
    assert effect["size_sigma"] > 100.0
    assert effect["probability"] <= effect["class_probability"]
    shares = [f"{effect[key]:.4f}" for key in ("probability", "class_probability")]
    assert table_of(page, "Effects") == [[effect["name"], effect["stage"], "", *shares]]
    ranked = [(one["answer"], f"{one['probability']:.4f}") for one in found["ranking"]]
    assert [(row[0], row[3]) for row in table_of(page, "Ranking")] == ranked
    steps = [(one["what"], f"{one['gap_u']:.2f}") for one in found["walk"]]
    assert [(row[0], row[4]) for row in table_of(page, "Walk")][: len(steps)] == steps


@pytest.mark.slow
def test_cells_and_the_numbers_in_them_sum_to_the_steps(told: dict[str, Result]) -> None:
    found = json.loads(told["json"].stdout)
    parts = {"trend": 5, "cycle scatter": 2, "between the harmonics": 2, "line": 2}
    own = [one for one in (*found["walk"], *found["remains"]) if one["what"] in CHAIN]
    for one in own:  # the others are of the same numbers, with measured inputs
        cells = [cell for cell in found["cells"] if cell["stage"] == one["what"]]
        weights = [parts.get(cell["what"], 2 if cell["order"] else 1) for cell in cells]
        assert sum(weights) == one["count"]
        when = "before" if one in found["walk"] else "after"
        whole = sum(n * cell[when] ** 2 for n, cell in zip(weights, cells, strict=True))
        assert whole == pytest.approx(one["count"] * one["gap_u"] ** 2), one["what"]
    assert {cell["stage"] for cell in found["cells"]} == {one["what"] for one in own}
    labels = {(cell["channel"], cell["what"]) for cell in found["cells"]}
    assert {(name, what) for name in ("force_aft", "force_fore") for what in parts} <= labels


@pytest.mark.slow
def test_every_key_of_the_document_is_on_the_page(told: dict[str, Result]) -> None:
    (section,) = re.findall(r"^## What `--json` prints\n(.*?)^## ", PAGE, re.DOTALL | re.MULTILINE)
    rows = re.findall(r"^\| (`.*?) \| (.*) \|$", section, flags=re.MULTILINE)
    keys = [key for names, _ in rows for key in re.findall(r"`(\w+)`", names)]
    found = json.loads(told["json"].stdout)
    assert sorted(keys) == sorted(found)
    said = {key: meaning for names, meaning in rows for key in re.findall(r"`(\w+)`", names)}
    for key in ("ranking", "effects", "cells", "next_runs"):
        assert found[key][0].keys() <= {*re.findall(r"`(\w+)`", said[key])}, key


def test_no_paragraph_of_the_gap_pages_is_longer_than_a_reader() -> None:
    for path in (HOUSE / "docs").glob("gap*.md"):
        longest = max(path.read_text(encoding="utf-8").splitlines(), key=len)
        assert len(longest) < 900, f"{path.name}: {longest[:80]}"


@pytest.mark.slow
def test_the_effect_is_in_the_file_and_the_old_file_is_kept(told: dict[str, Result]) -> None:
    file, kept = str(told["file"]), str(told["kept"])
    assert kept == (HOUSE / "examples" / "gap" / "campaign.toml").read_text()
    assert file.startswith(kept.rstrip("\n"))
    (added,) = tomllib.loads(file)["effects"]
    assert added["name"] == "coulomb-friction"
    assert added["parameters"]["friction_n"] == pytest.approx(TRUTH_N, rel=0.02)


@pytest.mark.slow
def test_the_cured_simulator_has_no_gap(told: dict[str, Result]) -> None:
    assert told["again"].stdout.startswith("gap: No gap: ")


@pytest.mark.slow
def test_a_bias_is_told_only_of_an_effect_that_is_named(told: dict[str, Result]) -> None:
    assert {len(row) for row in table_of(str(told["page"]), "Coefficients")} == {6}
    assert {len(row) for row in table_of(str(told["cured"]), "Coefficients")} == {4}
    assert "bias" in told["diagnose"].stdout
    assert "bias" in str(told["page"]).lower()
    assert "bias" not in told["again"].stdout
    assert "bias" not in str(told["cured"]).lower()


@pytest.mark.slow
def test_an_effect_is_not_added_twice(told: dict[str, Result]) -> None:
    assert told["twice"].exit_code == 2
    assert "coulomb-friction is in [[effects]] already" in told["twice"].stderr


@pytest.mark.slow
def test_the_page_stands_alone(told: dict[str, Result]) -> None:
    page = str(told["page"])
    assert page.count("<svg") == 4
    for title in ("Where", "Which", "How far", "Coefficients", "What remains", "Next"):
        assert f">{title}</h2>" in page
    assert not re.findall(r'(?:src|href)="(?!#)', page)
    assert "<script" not in page
    assert "mathdefault" not in page


def test_the_help_lists_what_a_campaign_takes_and_the_jobs() -> None:
    told, own = run("gap", "--help").stdout, run("gap", "diagnose", "--help").stdout
    _, options = own.split("Options:\n")
    assert f"Options with a campaign:\n{options}" in told
    assert set(re.findall(r"`(--[\w-]+)", PAGE.partition("## A worked example")[0])) <= set(
        re.findall(r"--[\w-]+", options)
    )
    assert re.findall(r"^  ([\w-]+) ", told.partition("Commands:")[2], re.MULTILINE) == list(
        gap.names
    )


def test_misspelt_names_get_the_nearest() -> None:
    campaign = str(HOUSE / "examples" / "gap")
    found = run("gap", campaign, "--effects", "coulomb-frictoin")
    assert found.exit_code == 2
    assert "coulomb-friction" in found.stderr
    found = run("gap", campaign, "--hold-out", "frequncy=1.1")
    assert found.exit_code == 2
    assert "did you mean 'frequency'" in found.stderr
    found = run("gap", campaign, "--hold-out", "heave-0.55-20")
    assert found.exit_code == 2
    assert "heave-0.50-20" in found.stderr


def test_a_folder_that_is_not_there_is_said() -> None:
    found = run("gap", "nowhere")
    assert found.exit_code == 2
    assert "nowhere: no such folder or campaign file; jobs: add, answer" in found.stderr
    found = run("gap", "pendulm")
    assert "pendulm: no such folder or campaign file; did you mean the job 'pendulum'?" in (
        found.stderr
    )
    found = run("gap", "diagnose", "nowhere")
    assert found.exit_code == 2
    assert "nowhere: no such folder or campaign file" in found.stderr


def test_a_campaign_without_recordings_says_so() -> None:
    found = run("gap", str(HOUSE / "examples" / "gap"), "--effects", "coulomb-friction")
    assert found.exit_code == 1
    assert "0 runs" in found.stderr
