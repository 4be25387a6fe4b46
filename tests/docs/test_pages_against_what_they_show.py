"""Every code block of the README and the pages is read or run, or says why it is not."""

import json
import re
import shlex
import subprocess
import sys
import tomllib
from pathlib import Path

import click
import pytest
from click.testing import CliRunner

from pmm.cli import cli
from tests.docs.blocks import HOUSE, Block, blocks, pages

# Pages whose commands or programs a test of their own runs, with more to say about the outcome.
RUN_BY = {
    "README.md": "tests/end_to_end/test_readme_against_commands.py",
    "docs/adding-an-effect.md": "tests/pmm/effects/test_effects_documents_against_code.py",
    "docs/coefficients.md": "tests/analysis/coefficients/test_document_against_code.py",
    "docs/console-api.md": "tests/pmm/console/test_python_client_against_recordings.py",
    "docs/formats.md": "tests/analysis/readers/test_formats_document.py",
    "docs/gap.md": "tests/pmm/gap/test_gap_command_against_its_page.py",
    "docs/gallery.md": "docs/gallery.py",
    "docs/inertia-files.md": "tests/end_to_end/test_inertia_pages_against_commands.py",
    "docs/python.md": "tests/pmm/interface/test_front_door_against_commands.py",
    "docs/pendulums.md": "tests/sim/pendulum/test_effects_against_their_catalogue.py",
    "docs/recording-safety.md": "tests/pmm/recorder/test_run_folder_against_truth.py",
}
KINDS = {"sh", "toml", "python", "json", "csv", "options", "text", "{toctree}"}
SHOWN_ONLY = {"make demo", "make test", ". .venv/bin/activate"}  # other tests and CI do these


def test_every_block_is_of_a_kind_that_is_looked_at() -> None:
    assert {block.language for block in blocks()} <= KINDS
    fences = sum(len(re.findall(r"^```", page.read_text(encoding="utf-8"), re.M))
                 for page in pages())  # fmt: skip
    assert fences == 2 * len(blocks())


@pytest.mark.parametrize("page", RUN_BY)
def test_what_another_test_runs_is_named_there(page: str) -> None:
    text = (HOUSE / RUN_BY[page]).read_text(encoding="utf-8")
    assert Path(page).name in text


@pytest.mark.parametrize("block", blocks("toml"), ids=str)
def test_toml_is_toml(block: Block) -> None:
    assert tomllib.loads(block.text)


@pytest.mark.parametrize("block", blocks("json"), ids=str)
def test_json_is_json(block: Block) -> None:
    assert json.loads(block.text)


@pytest.mark.parametrize("block", blocks("python"), ids=str)
def test_python_is_python(block: Block) -> None:
    compile(block.text, str(block), "exec")


@pytest.mark.sample(1)
@pytest.mark.parametrize(
    "block",
    [one for one in blocks("python") if one.page not in RUN_BY and not one.reason],
    ids=str,
)
def test_python_runs(block: Block) -> None:
    command = [sys.executable, "-W", "error", "-c", block.text]
    done = subprocess.run(command, cwd=HOUSE, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def _commands(block: Block) -> list[list[str]]:
    """The commands of this program, as words; what else a shell does is known by heart."""
    found = []
    for line in block.text.splitlines():
        bare = line.partition("  #")[0].strip()
        if bare in SHOWN_ONLY or bare.startswith(("dask ", "export ")):
            continue
        words = shlex.split(bare.rpartition("|")[2])
        assert words[0] in ("pmm", ".venv/bin/pmm"), line
        found.append(words[1:])
    return found


def _parsed(words: list[str], command: click.Command = cli, name: str = "pmm") -> None:
    """Let click take the options apart, group by group, without running anything."""
    ctx = click.Context(command, info_name=name)
    if not isinstance(command, click.Group):
        parser = command.make_parser(ctx)
        parser.parse_args(list(words))
        return
    rest = command.make_parser(ctx).parse_args(list(words))[1]
    if not rest:
        assert words[0].startswith("-")
        return
    sub = command.get_command(ctx, rest[0])
    if sub is None and name == "gap":
        sub, rest = command.get_command(ctx, "diagnose"), ["diagnose", *rest]
    assert sub is not None, f"no command {rest[0]!r}"
    _parsed(rest[1:], sub, rest[0])


@pytest.mark.parametrize("block", blocks("sh"), ids=str)
def test_commands_and_options_are_there(block: Block) -> None:
    for words in _commands(block):
        _parsed(words)


@pytest.fixture
def place(tmp_path: Path) -> Path:
    """A folder with the examples in it, as a clone has them."""
    (tmp_path / "examples").symlink_to(HOUSE / "examples")
    return tmp_path


def _run_here() -> list[Block]:
    """The blocks that are run here, without those whose lines another block has already."""
    run, seen = [], set()
    for block in blocks("sh"):
        lines = set(block.text.replace(".venv/bin/", "").splitlines())
        shown = block.page == "README.md" or block.page not in RUN_BY
        if shown and not block.reason and "my-campaign" not in block.text and lines - seen:
            run.append(block)
            seen |= lines
    return run


@pytest.mark.sample(1)
@pytest.mark.parametrize("block", [one for one in _run_here() if " gap " not in one.text], ids=str)
def test_commands_run(block: Block, place: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(place)
    for words in _commands(block):
        told = [path for word in words for path in _expanded(word)]
        done = CliRunner().invoke(cli, told)
        assert done.exit_code == 0, f"{shlex.join(told)}: {done.stderr}"


def _expanded(word: str) -> list[str]:
    """Do what a shell does with a star."""
    return sorted(map(str, Path().glob(word))) if "*" in word else [word]


def _anchors(path: Path) -> set[str]:
    headings = re.findall(r"^#+ (.+)$", path.read_text(encoding="utf-8"), re.M)
    return {re.sub(r"[^\w\- ]", "", one.lower()).strip().replace(" ", "-") for one in headings}


@pytest.mark.parametrize("page", pages(), ids=lambda page: page.stem)
def test_links_lead_somewhere(page: Path) -> None:
    text = re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.S)
    for target in re.findall(r"\]\((?!https?:|mailto:)([^)\s]+)\)", text):
        name, _, anchor = target.partition("#")
        path = (page.parent / name).resolve() if name else page
        if path.suffix == ".rst" and "api" in path.parts:
            continue  # written while the site is built, which fails where a link does
        assert path.exists(), target
        assert not anchor or anchor in _anchors(path), target


def test_equations_can_be_drawn() -> None:
    drawn = pytest.importorskip("docutils.utils.math.latex2mathml", reason="needs the extra docs")
    for page in pages():
        text = re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.S)
        for alone, inline in re.findall(r"\$\$(.+?)\$\$|\$([^$\n]+)\$", text, flags=re.S):
            equation = (alone or inline).strip()
            assert not re.search(r"frac\d", equation), "it is read as one number over the next"
            assert "<math" in drawn.tex2mathml(equation, as_block=bool(alone)), page.name


def test_the_built_site_asks_nobody_for_anything() -> None:
    site = HOUSE / "site"
    if not (site / "index.html").exists():
        pytest.skip("the site is not built here: make docs")
    for path in site.rglob("*.html"):
        text = path.read_text(encoding="utf-8")
        assert not re.search(r'(?:src|<link[^>]*href)="(?:https?:)?//', text), path.name
    for path in site.rglob("*.css"):
        text = path.read_text(encoding="utf-8")
        assert not re.search(r"(?:@import|url\()\s*[\"']?(?:https?:)?//", text), path.name
