"""A package of another's that takes a name of ours is named; pip itself lays both of them down."""

import base64
import hashlib
import os
import re
import subprocess
import sys
import tomllib
import venv
import zipfile
from collections.abc import Mapping
from pathlib import Path

import pytest

from hardware.description.version import installing
from planar_motion_mechanism import DISTRIBUTION, PACKAGES

HOUSE = Path(__file__).parents[1]
PROJECT = tomllib.loads((HOUSE / "pyproject.toml").read_text(encoding="utf-8"))["project"]
STRANGERS = "print('a stranger')\n"


class Environment:
    """A fresh virtual environment, into which the running one's pip installs wheels."""

    def __init__(self, folder: Path) -> None:
        venv.create(folder / "environment", symlinks=True)
        self._folder = folder
        self._bin = folder / "environment" / ("Scripts" if os.name == "nt" else "bin")
        (self.site,) = (folder / "environment").rglob("site-packages")

    def install(
        self, name: str, version: str, files: Mapping[str, str], entry_points: str = ""
    ) -> None:
        about = f"{name.replace('-', '_')}-{version}.dist-info"
        kind = "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"
        whole = {
            **files,
            f"{about}/METADATA": f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n",
            f"{about}/WHEEL": kind,
            f"{about}/entry_points.txt": entry_points,
        }
        wheel = self._folder / f"{name.replace('-', '_')}-{version}-py3-none-any.whl"
        with zipfile.ZipFile(wheel, "w") as archive:
            for path, text in whole.items():
                archive.writestr(path, text)
            sums = {path: hashlib.sha256(text.encode()).digest() for path, text in whole.items()}
            record = [
                f"{path},sha256={base64.urlsafe_b64encode(digest).decode().rstrip('=')},"
                for path, digest in sums.items()
            ]
            archive.writestr(f"{about}/RECORD", "\n".join([*record, f"{about}/RECORD,,", ""]))
        self.pip("install", "--no-index", "--no-deps", "--no-compile", str(wheel))

    def pip(self, *words: str) -> None:
        command = [sys.executable, "-m", "pip", "--python", str(self._bin / "python")]
        subprocess.run([*command, "--quiet", *words], check=True, capture_output=True)

    def run(self, program: str, *words: str) -> "subprocess.CompletedProcess[str]":
        without = {name: one for name, one in os.environ.items() if name != "PYTHONPATH"}
        return subprocess.run(
            [str(self._bin / program), *words],
            capture_output=True,
            text=True,
            env=without,
            cwd="/",
            check=False,
        )

    def importing(self, name: str) -> str:
        """Return the last line of what an import says."""
        done = self.run("python", "-c", f"import {name}")
        said = (done.stdout + done.stderr).strip().splitlines()
        return said[-1] if said else ""


@pytest.fixture
def ours(tmp_path: Path) -> Environment:
    return _installed(tmp_path)


@pytest.fixture(scope="module")
def unharmed(tmp_path_factory: pytest.TempPathFactory) -> Environment:
    """One for all tests that leave it as it was."""
    return _installed(tmp_path_factory.mktemp("unharmed"))


def _installed(folder: Path) -> Environment:
    environment = Environment(folder)
    entrance = [f"planar_motion_mechanism{one}.py" for one in ("", "_command")]
    names = [*entrance, *(f"{one}/__init__.py" for one in PACKAGES)]
    files = {name: (HOUSE / name).read_text(encoding="utf-8") for name in names}
    files["pmm/cli.py"] = "def main() -> None:\n    print('our command')\n"
    scripts = "\n".join(f"{name} = {place}" for name, place in PROJECT["scripts"].items())
    environment.install(DISTRIBUTION, "1.0", files, f"[console_scripts]\n{scripts}\n")
    return environment


@pytest.mark.slow
def test_nothing_is_said_of_what_pip_laid_down(unharmed: Environment) -> None:
    assert [unharmed.importing(name) for name in PACKAGES] == [""] * 4
    assert unharmed.run("pmm").stdout == "our command\n"


@pytest.mark.slow
@pytest.mark.parametrize("taken", ["pmm", "hardware"])
def test_the_distribution_that_overwrites_a_package_is_named(taken: str, ours: Environment) -> None:
    ours.install(f"the-other-{taken}", "0.33.0", {f"{taken}/__init__.py": STRANGERS})
    for name in PACKAGES:
        said = ours.importing(name)
        if name == taken:
            assert said == "a stranger"
        else:
            assert said.startswith("ImportError: "), name
            assert str(ours.site / taken / "__init__.py") in said
            assert f"pip uninstall the-other-{taken}," in said
    command = ours.run("pmm")
    assert command.returncode == 1
    (line,) = command.stderr.splitlines()
    assert f"belongs to 'the-other-{taken}'" in line


@pytest.mark.slow
def test_a_package_that_went_with_the_stranger_is_missed(ours: Environment) -> None:
    ours.install("the-other-hardware", "0.33.0", {"hardware/__init__.py": STRANGERS})
    ours.pip("uninstall", "--yes", "the-other-hardware")
    assert "the package 'hardware' is not there" in ours.importing("analysis")
    assert DISTRIBUTION in ours.importing("analysis")


@pytest.mark.slow
def test_a_file_that_nobody_owns_up_to_is_named(unharmed: Environment) -> None:
    file = unharmed.site / "sim" / "__init__.py"
    before = file.read_bytes()
    file.write_text(STRANGERS)
    said = unharmed.importing("pmm")
    file.write_bytes(before)
    assert str(file) in said
    assert "install anew" in said


@pytest.mark.sample(1)
@pytest.mark.parametrize("name", ["analysis", "sim", "hardware"])
@pytest.mark.parametrize("kind", ["{}.py", "{}/__init__.py"])
def test_a_users_own_module_is_named(name: str, kind: str, tmp_path: Path) -> None:
    own = tmp_path / kind.format(name)
    own.parent.mkdir(exist_ok=True)
    own.write_text(STRANGERS)
    done = subprocess.run(
        [sys.executable, "-c", "import pmm"],
        capture_output=True,
        text=True,
        env=os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(HOUSE)])},
        cwd="/",
        check=False,
    )
    said = done.stderr.strip().splitlines()[-1]
    assert said.startswith("ImportError: ")
    assert str(own) in said
    assert "rename" in said


def test_the_guard_imports_none_of_the_others() -> None:
    code = (
        "import pmm, sys; print(sorted({'analysis', 'sim', 'hardware', 'numpy'} & {*sys.modules}))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, cwd=HOUSE, check=False
    )
    assert done.stdout.strip() == "[]", done.stderr


def test_one_name_is_everywhere() -> None:
    assert PROJECT["name"] == DISTRIBUTION
    pages = [*(HOUSE / "docs").rglob("*.md"), HOUSE / "README.md"]
    told = {
        (page.name, name, extra)
        for page in pages
        for name, extra in re.findall(
            r"pip install '?([\w-]+)\[(\w+)\]", page.read_text(encoding="utf-8")
        )
    }
    assert told
    assert {name for _, name, _ in told} == {DISTRIBUTION}
    assert {extra for _, _, extra in told} <= set(PROJECT["optional-dependencies"])
    assert f"'{DISTRIBUTION}[tdms]'" in installing("tdms")


def test_every_extra_of_a_user_is_told_of() -> None:
    page = (HOUSE / "docs" / "platforms.md").read_text(encoding="utf-8")
    table = page.partition("| extra | for |")[2].partition("\n\n")[0]
    told = {one for row in re.findall(r"^\| (`.*?) \|", table, re.M) for one in row.split(", ")}
    developers = {"bench", "dev", "docs", "peers"}
    assert told == {f"`{one}`" for one in {*PROJECT["optional-dependencies"]} - developers}


@pytest.mark.parametrize("name", PACKAGES)
def test_each_package_says_that_it_is_typed(name: str) -> None:
    assert (HOUSE / name / "py.typed").read_bytes() == b""
