"""Write the locks beside this file: ``make lock``.

A lock has every package that an installation needs, in the version of ``constraints.txt``, with the
checksums of all its files: it holds for each system and each Python that the project is for. A lock
names in its first line the one that it adds to, so that nothing stands twice.
"""

import re
import subprocess
import tomllib
from pathlib import Path
from typing import Final

HERE: Final = Path(__file__).parent
HOUSE: Final = HERE.parent
# The lock that it adds to, and extras, by the Makefile's installation.
LOCKS: Final = {
    "user": ("", ("fast",)),
    "dev": ("user", ("dev", "s3")),
    "docs": ("dev", ("docs",)),
    "bench": ("dev", ("bench",)),
    "sealed": ("dev", ("peers",)),
}
OLDEST_PYTHON: Final = "3.11.5"  # what soupsieve, below furo, asks for
_BLOCK: Final = re.compile(r"^\S.*(?:\n[ \t].*)*\n", re.MULTILINE)


def chain(name: str) -> list[str]:
    """Return a lock and those that it adds to, the first one first."""
    below, _ = LOCKS[name]
    return [*(chain(below) if below else []), name]


def blocks(text: str) -> list[str]:
    """Return the packages of a lock, each with the lines of its checksums."""
    return [one for one in _BLOCK.findall(text) if "==" in one.partition("\n")[0]]


def _compiled(extras: list[str]) -> list[str]:
    """Let uv find all packages; to build the project itself, its build tools are among them."""
    project = tomllib.loads((HOUSE / "pyproject.toml").read_text(encoding="utf-8"))
    tools = [*project["build-system"]["requires"], "editables"]
    words = ["--universal", "--python-version", OLDEST_PYTHON, "--generate-hashes", "--quiet",
             "--constraint", "constraints.txt", "--no-header", "--no-annotate",
             "--no-emit-index-url", *(f"--extra={one}" for one in extras)]  # fmt: skip
    done = subprocess.run(  # noqa: S603
        ["uv", "pip", "compile", *words, "pyproject.toml", "-"],  # noqa: S607
        cwd=HOUSE, input="\n".join(tools), capture_output=True, text=True, check=True,
    )  # fmt: skip
    return blocks(done.stdout)


def main() -> None:
    """Write all locks."""
    for name, (below, _) in LOCKS.items():
        found = _compiled([extra for one in chain(name) for extra in LOCKS[one][1]])
        before = {
            block
            for one in chain(name)[:-1]
            for block in blocks((HERE / f"{one}.txt").read_text(encoding="utf-8"))
        }
        head = [f"-r {below}.txt\n"] if below else []
        lines = [*head, *(one for one in found if one not in before)]
        (HERE / f"{name}.txt").write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
