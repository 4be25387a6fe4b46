"""The container's file against what its lines need, and its lines carried out without a builder."""

import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from pmm.cli.console import console

HOUSE = Path(__file__).parents[1]
FILE = (HOUSE / "Containerfile").read_text(encoding="utf-8").replace("\\\n", "")
LINES = [one.partition(" ") for one in FILE.splitlines() if one and not one.startswith("#")]
IGNORED = (HOUSE / ".containerignore").read_text(encoding="utf-8").split()


def _lines(word: str) -> list[str]:
    return [rest for first, _, rest in LINES if first == word]


def test_it_ends_as_a_user_without_rights() -> None:
    assert re.fullmatch(r"[1-9]\d+:[1-9]\d+", _lines("USER")[-1])


def test_the_program_that_it_starts_is_one_of_the_distribution() -> None:
    project = tomllib.loads((HOUSE / "pyproject.toml").read_text(encoding="utf-8"))
    assert [one.strip('["]') for one in _lines("ENTRYPOINT")] == list(project["project"]["scripts"])


def test_the_port_that_it_names_is_the_consoles() -> None:
    (port,) = (one.default for one in console.params if one.name == "port")
    assert _lines("EXPOSE") == [str(port)]


def test_what_was_built_meets_the_python_it_was_built_with() -> None:
    built, last = _lines("FROM")
    assert built == f"{last} AS built"


def test_nothing_that_the_build_reads_is_left_out() -> None:
    """Without git the version would be the fallback; without lock or sources nothing is built."""
    names = {"pmm", "hardware", "analysis", "sim", "pyproject.toml"}
    names |= {"planar_motion_mechanism.py", "planar_motion_mechanism_command.py"}
    assert not (names | {"README.md", "LICENSE", "lock", ".git"}) & set(IGNORED)


def test_its_base_is_a_python_that_the_tests_run_on() -> None:
    image, version = _lines("FROM")[-1].removesuffix("-slim").split(":")
    tried = (HOUSE / ".github/workflows/ci.yml").read_text(encoding="utf-8")
    assert image == "python"
    assert f'"{version}"' in tried


def test_it_installs_as_make_does() -> None:
    """Locked packages by their checksums, then the project alone, built by what the lock has."""
    make = (HOUSE / "Makefile").read_text(encoding="utf-8")
    locked, own = (
        one.partition(" pip install ")[2].replace("--no-cache-dir ", "").strip()
        for one in _lines("RUN")[1].split("&&")[1:]
    )
    assert locked.replace("user.txt", "$(@:$(VENV)/.%=%).txt") in make.replace("--quiet ", "")
    assert own.replace(" .", " --editable .") in make.replace("--quiet ", "")


def test_what_the_last_stage_takes_was_made_in_the_first_and_is_found() -> None:
    _, taken = _lines("COPY")
    stage, made, place = taken.split()
    assert stage == f"--from={_lines('FROM')[0].split()[-1]}"
    assert f"python -m venv {made} " in _lines("RUN")[1]
    assert made == place  # scripts of an environment hold its path
    assert f"PATH={place}/bin:$PATH" in _lines("ENV")[0].split()


def test_the_last_stage_only_adds_the_user_that_it_ends_as_with_a_place_to_compile() -> None:
    words = [first for first, _, _ in LINES]
    (last,) = (rest for first, _, rest in LINES[words.index("FROM", 1) :] if first == "RUN")
    user = re.fullmatch(r"useradd --create-home --uid (\d+) (\w+)", last)
    assert user
    assert _lines("USER")[-1].split(":")[0] == user[1]
    assert f"NUMBA_CACHE_DIR=/home/{user[2]}/" in _lines("ENV")[0]


def test_it_starts_without_a_shell_and_fetches_nothing_unchecked() -> None:
    """A shell in between would keep the signals that end a run (hadolint DL3025, DL4006)."""
    assert all(re.fullmatch(r'\["[^"]+"\]', _lines(one)[-1]) for one in ("ENTRYPOINT", "CMD"))
    assert {first for first, _, _ in LINES} <= {
        "FROM", "RUN", "WORKDIR", "COPY", "USER", "ENV", "EXPOSE", "ENTRYPOINT", "CMD",
    }  # fmt: skip
    assert _lines("RUN")[0].startswith("apt-get update && apt-get install --yes --no-install-")
    assert not re.search(r"curl|wget|sudo|\|", " ".join(_lines("RUN")))


@pytest.mark.slow
@pytest.mark.timeout(1800)
def test_its_lines_carried_out_here_make_a_program_that_runs(tmp_path: Path) -> None:
    """All but the system's own lines, in a copy of what is not ignored, without a container."""
    source, made = tmp_path / "source", tmp_path / "pmm"
    subprocess.run(["git", "clone", "-q", str(HOUSE), str(source)], check=True)  # noqa: S607
    install = _lines("RUN")[1].replace("/opt/pmm", str(made))
    without = {name: one for name, one in os.environ.items() if name != "PYTHONPATH"}
    subprocess.run(["sh", "-ec", install], cwd=source, env=without, check=True)  # noqa: S607
    told = subprocess.run(
        [str(made / "bin" / "pmm"), "--help"],
        cwd=tmp_path, env=without, check=True, capture_output=True, text=True,
    )  # fmt: skip
    assert "Planar motion mechanism" in told.stdout
