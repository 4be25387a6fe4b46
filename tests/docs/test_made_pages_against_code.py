"""Pages that scripts write are what the scripts would write now, and nothing is left out."""

from pathlib import Path

import pytest

from docs import errors, gallery, plan_checks
from hardware.description import errors as base
from hardware.errors import FollowingError, InterlockError

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.slow
def test_the_page_of_errors_is_the_scripts() -> None:
    assert (DOCS / "errors.md").read_text(encoding="utf-8") == errors.page()


def test_the_page_of_checks_is_the_scripts() -> None:
    assert (DOCS / "plan-checks.md").read_text(encoding="utf-8") == plan_checks.page()


@pytest.mark.slow
def test_types_found_in_the_sources_are_those_of_the_running_program() -> None:
    import pmm.run.errors  # noqa: F401
    from analysis.resolver.reference import NoReferenceError

    names = set(errors.error_types())

    def below(kind: type) -> set[str]:
        own = {kind.__name__} if kind.__module__.split(".")[0] in errors.ROOMS else set()
        return own.union(*map(below, kind.__subclasses__()))

    loaded = below(base.PmmError)
    assert NoReferenceError.__name__ in loaded
    assert loaded <= names


@pytest.mark.slow
@pytest.mark.parametrize("kind", [FollowingError, InterlockError])
def test_reactions_are_those_of_the_classes(kind: type[FollowingError | InterlockError]) -> None:
    shown = errors.reaction(kind.__name__, errors.error_types())
    assert shown == kind.reaction.name.lower().replace("_", " ")


@pytest.mark.slow
def test_a_message_that_the_code_has_not_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = (DOCS / "errors.toml").read_text(encoding="utf-8")
    wrong = told.replace('text = "no such file"', 'text = "never said anywhere, by nobody"')
    (tmp_path / "errors.toml").write_text(wrong, encoding="utf-8")
    errors.error_types(), errors.templates()  # kept: what is read next are the texts alone
    monkeypatch.setattr(errors, "HERE", tmp_path)
    with pytest.raises(SystemExit, match="never said anywhere"):
        errors.page()


def test_the_gallery_is_the_scripts() -> None:
    assert (DOCS / "gallery.md").read_text(encoding="utf-8") == gallery.page()


def test_no_command_of_the_gallery_writes_into_the_folder_of_another() -> None:
    text = (DOCS / "gallery.md").read_text(encoding="utf-8")
    lines = [line.split() for line in text.splitlines() if line.startswith("pmm ")]
    assert len({tuple(words) for words in lines}) == len(lines), "a command stands there twice"
    folders = [words[words.index("--output") + 1] for words in lines if "--output" in words]
    assert len(set(folders)) == len(folders) > 5


def test_every_plot_of_the_program_is_in_the_gallery() -> None:
    assert {one.draws for one in gallery.entries()} | gallery.helpers() == (
        gallery.drawing_functions()
    )


@pytest.mark.parametrize("entry", gallery.entries(), ids=lambda one: one.draws)
def test_every_picture_is_there_and_small(entry: gallery.Entry) -> None:
    assert entry.picture.is_file() != bool(entry.why_not)
    if not entry.why_not:
        assert entry.picture.stat().st_size < 150_000


@pytest.mark.slow
def test_a_command_draws_what_the_gallery_says(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gallery, "PICTURES", tmp_path)
    missing = list(gallery.draw(lambda one: one.draws.endswith(".inertia_figures.gates_figure")))
    assert missing == []
    assert [path.suffix for path in tmp_path.iterdir()] == [".png"]
