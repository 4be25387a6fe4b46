"""``pmm demo``: a table, plots, a page that needs nothing else, and a command that repeats it."""

import re
import shlex
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from pmm.cli import cli
from pmm.cli.demo import CAMPAIGNS
from tests.end_to_end.walk import COMMANDS, done_or_a_way_out

TOO_FEW = "2 runs to fit, a diagnosis needs 3: record more set-points"


@pytest.fixture(scope="module")
def demo(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Result]:
    folder = tmp_path_factory.mktemp("somewhere") / "demo"
    return folder, CliRunner().invoke(
        cli, ["demo", "--output", str(folder)], catch_exceptions=False
    )


@pytest.mark.slow
def test_the_last_line_is_the_page(demo: tuple[Path, Result]) -> None:
    folder, done = demo
    assert done.exit_code == 0
    for runs in (11, 4):
        assert f"{runs} of {runs} runs complete" in done.stdout
    assert done.stdout.splitlines()[-1] == str(folder / "report.html")
    page = (folder / "report.html").read_text(encoding="utf-8")
    assert "heave-f0.5-a20" in page
    assert "pitch-f1.2-a20" in page
    assert not re.search(r"(?:src|href)=\"(?:https?:)?//", page)


@pytest.mark.slow
def test_the_table_has_a_line_per_run_and_force(demo: tuple[Path, Result]) -> None:
    lines = demo[1].stdout.splitlines()
    assert len([line for line in lines if re.search(r"force_(?:aft|fore) \[N\]\s+1 ", line)]) == 18


@pytest.mark.slow
def test_plots_are_written(demo: tuple[Path, Result]) -> None:
    names = {path.name for path in (demo[0] / "plots").iterdir()}
    assert {f"heave-f0.5-a20-{one}" for one in ("gate.svg", "gate.png", "phasors.svg")} <= names


@pytest.mark.slow
def test_the_command_it_names_repeats_one_of_them(demo: tuple[Path, Result]) -> None:
    (line,) = (line for line in demo[1].stdout.splitlines() if line.startswith("again"))
    program, *arguments = shlex.split(line.removeprefix("again"))
    assert program == "pmm"
    done = CliRunner().invoke(cli, arguments, catch_exceptions=False)
    assert done.exit_code == 0
    first = re.search(r"force_aft \[N\]\s+1 .*", demo[1].stdout)
    assert first
    for value in re.findall(r"\S+ ± \S+", first[0]):
        assert value in done.stdout


@pytest.mark.slow
@pytest.mark.parametrize("command", COMMANDS, ids=lambda words: words[0])
@pytest.mark.parametrize("name", CAMPAIGNS)
def test_every_command_takes_its_campaigns(
    name: str, command: tuple[str, ...], demo: tuple[Path, Result]
) -> None:
    refusal = TOO_FEW if (name, command[0]) == ("horizontal", "gap") else None
    done_or_a_way_out(demo[0] / name, command, refusal)


@pytest.mark.parametrize(
    ("options", "wanted"), [((), CAMPAIGNS), (("--vertical-only",), CAMPAIGNS[:1])]
)
def test_the_campaigns_that_are_asked_for(
    options: tuple[str, ...],
    wanted: tuple[str, ...],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run: list[str] = []
    monkeypatch.setattr("pmm.cli.demo._campaign", lambda name, _: run.append(name))
    CliRunner().invoke(cli, ["demo", "--output", str(tmp_path), *options])
    assert tuple(run) == wanted
