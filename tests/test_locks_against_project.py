"""The locks against what pyproject.toml asks for and constraints.txt pins; pip reads them."""

import re
import tomllib
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from lock.make import LOCKS, blocks, chain

HOUSE = Path(__file__).parents[1]
PROJECT = tomllib.loads((HOUSE / "pyproject.toml").read_text(encoding="utf-8"))
TEXTS = {name: (HOUSE / "lock" / f"{name}.txt").read_text(encoding="utf-8") for name in LOCKS}


def _pins(texts: list[str]) -> dict[str, str]:
    """The version of each package, by its name as an index has it."""
    found: dict[str, str] = {}
    for text in texts:
        for one in re.findall(r"^[\w.-]+==[^\s;]+", text, re.MULTILINE):
            name, _, version = one.partition("==")
            assert found.setdefault(canonicalize_name(name), version) == version, name
    return found


@pytest.mark.parametrize("name", LOCKS)
def test_a_lock_has_all_that_its_extras_ask_for(name: str) -> None:
    locked = _pins([TEXTS[one] for one in chain(name)])
    extras = [extra for one in chain(name) for extra in LOCKS[one][1]]
    optional = PROJECT["project"]["optional-dependencies"]
    asked = [*PROJECT["project"]["dependencies"], *PROJECT["build-system"]["requires"],
             *(one for extra in extras for one in optional[extra])]  # fmt: skip
    for one in map(Requirement, asked):
        assert one.specifier.contains(locked[canonicalize_name(one.name)]), one


def test_developers_have_what_any_user_may_ask_for() -> None:
    optional = PROJECT["project"]["optional-dependencies"]
    locked = _pins([TEXTS[one] for one in chain("dev")])
    for extra in optional.keys() - {"dev", "docs", "bench", "peers"}:
        for one in map(Requirement, optional[extra]):
            assert one.specifier.contains(locked[canonicalize_name(one.name)]), (extra, one)


def test_a_lock_pins_what_the_constraints_pin() -> None:
    constrained = _pins([(HOUSE / "constraints.txt").read_text(encoding="utf-8")])
    locked = _pins(list(TEXTS.values()))
    assert {name: locked.get(name, one) for name, one in constrained.items()} == constrained


@pytest.mark.parametrize("name", LOCKS)
def test_every_package_has_checksums_and_nothing_names_an_index(name: str) -> None:
    below, _ = LOCKS[name]
    packages = blocks(TEXTS[name])
    head = f"-r {below}.txt\n" if below else ""
    assert TEXTS[name] == head + "".join(packages)
    for one in packages:
        first, *sums = one.removesuffix("\n").split(" \\\n    ")
        assert re.fullmatch(r"[\w.-]+==[^\s;]+(?: ; [^:/@]+)?", first)
        assert sums
        assert all(re.fullmatch(r"--hash=sha256:[0-9a-f]{64}", sum_) for sum_ in sums)


def test_the_makefile_has_an_installation_for_each_lock() -> None:
    makefile = (HOUSE / "Makefile").read_text(encoding="utf-8")
    (targets,) = re.findall(r"^(\$\(VENV\)/\..*): pyproject", makefile, re.MULTILINE)
    assert {one.removeprefix("$(VENV)/.") for one in targets.split()} == set(LOCKS)
