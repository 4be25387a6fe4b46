"""What stands beside the code for a release, against the rules of those who read it."""

import re
import tomllib
from pathlib import Path

import pytest

HOUSE = Path(__file__).parents[1]
PROJECT = tomllib.loads((HOUSE / "pyproject.toml").read_text(encoding="utf-8"))
WORKFLOW = (HOUSE / ".github" / "workflows" / "ci.yml").read_text(encoding="utf-8")
CITED = (HOUSE / "CITATION.cff").read_text(encoding="utf-8")
PAPER = (HOUSE / "paper" / "paper.md").read_text(encoding="utf-8")


def test_every_action_is_pinned_by_the_hash_of_a_commit() -> None:
    used = re.findall(r"uses: (\S+)", WORKFLOW)
    assert used
    assert all(re.fullmatch(r"[\w-]+/[\w-]+@[0-9a-f]{40}", one) for one in used)
    by_action = {one.partition("@")[0]: one for one in used}
    assert set(used) == set(by_action.values()), "one action by two hashes"


def test_the_oldest_python_of_the_workflow_is_the_one_that_is_asked_for() -> None:
    (listed,) = re.findall(r"python: \[(.*)\]", WORKFLOW)
    oldest = listed.split(",")[0].strip('" ')
    assert PROJECT["project"]["requires-python"] == f">={oldest}"


def test_the_workflow_asks_for_no_right_to_write() -> None:
    assert re.findall(r"^permissions:\n  contents: (\w+)$", WORKFLOW, re.MULTILINE) == ["read"]


def test_the_version_comes_from_tags_and_has_a_fallback() -> None:
    assert PROJECT["project"]["dynamic"] == ["version"]
    told = PROJECT["tool"]["hatch"]["version"]
    assert told["source"] == "vcs"
    assert re.fullmatch(r"\d+\.\d+\.\d+", told["fallback-version"])


def test_the_citation_has_what_its_format_asks_for() -> None:
    keys = set(re.findall(r"^([\w-]+):", CITED, re.MULTILINE))
    assert {"cff-version", "message", "title", "authors", "license"} <= keys
    assert f"license: {PROJECT['project']['license']}\n" in CITED


def test_the_paper_is_as_long_as_its_journal_takes() -> None:
    """250 to 1000 words by the guide of the Journal of Open Source Software."""
    _, _, body = PAPER.split("---\n", 2)
    assert 250 <= len(re.sub(r"```.*?```", "", body, flags=re.DOTALL).split()) <= 1000


def test_each_reference_of_the_paper_is_there_and_asked_for() -> None:
    there = re.findall(r"^@\w+\{(\w+),", (HOUSE / "paper" / "paper.bib").read_text(), re.MULTILINE)
    assert set(re.findall(r"@(\w+)[\];]", PAPER)) == set(there)


@pytest.mark.parametrize("name", ["CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"])
def test_links_lead_somewhere(name: str) -> None:
    targets = re.findall(r"\]\((?!https?:)([^)#]+)\)", (HOUSE / name).read_text(encoding="utf-8"))
    assert targets
    assert [one for one in targets if not (HOUSE / one).exists()] == []
