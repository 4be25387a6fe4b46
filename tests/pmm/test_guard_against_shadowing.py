"""A user's own ``analysis.py`` beside their script: one line that names the file to rename."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

HOUSE = Path(__file__).parents[2]


def _python(code: str, *folders: Path) -> "subprocess.CompletedProcess[str]":
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(map(str, (*folders, HOUSE)))}
    return subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        env=environment,
        cwd="/",
        check=False,
    )


@pytest.mark.parametrize("name", ["analysis", "sim", "hardware"])
@pytest.mark.parametrize("kind", ["{}.py", "{}/__init__.py"])
def test_a_users_own_module_is_named(name: str, kind: str, tmp_path: Path) -> None:
    own = tmp_path / kind.format(name)
    own.parent.mkdir(exist_ok=True)
    own.write_text("raise SystemExit('imported')\n")
    done = _python("import pmm", tmp_path)
    assert done.returncode == 1
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith("ImportError: ")
    assert str(own) in last
    assert "rename" in last


def test_a_missing_sibling_is_named(tmp_path: Path) -> None:
    (tmp_path / "pmm").mkdir()
    text = (HOUSE / "pmm" / "__init__.py").read_text(encoding="utf-8")
    (tmp_path / "pmm" / "__init__.py").write_text(text, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-S", "-c", "import pmm"],
        capture_output=True,
        text=True,
        env={"PYTHONPATH": str(tmp_path)},
        cwd="/",
        check=False,
    )
    assert "it is not there" in done.stderr.splitlines()[-1]


def test_the_guard_imports_none_of_the_siblings() -> None:
    code = (
        "import pmm, sys; print(sorted({'analysis', 'sim', 'hardware', 'numpy'} & {*sys.modules}))"
    )
    done = _python(code)
    assert done.stdout.strip() == "[]", done.stderr
