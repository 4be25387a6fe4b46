"""Build wheel and source distribution, and use each from a fresh environment: ``make release``.

A step that the results have of this commit is not done again, so a broken-off run goes on. The
session is that of ``docs/python.md``: a recording, a campaign, a pendulum test and a diagnosis. The
notebook goes from recordings to coefficients; it is run from the wheel.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import venv
from pathlib import Path
from typing import Any, Final

from benchmarks.machine import ROOT, commit, describe
from planar_motion_mechanism import DISTRIBUTION

RESULTS: Final = ROOT / "benchmarks" / "results" / "release.json"
# Of the page, and of the notebook with the installation where all libraries are there.
SESSION_LIMIT_S: Final = 120.0
# Of each what it ends in, and the lock of what is there beside it.
_KINDS: Final = {"wheel": ("*.whl", "docs"), "source distribution": ("*.tar.gz", "user")}
_BLOCK: Final = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


class Fresh:
    """A fresh environment with one of the built files in it, away from the sources."""

    def __init__(self, folder: Path, built: Path, lock: str) -> None:
        self.folder = folder
        self._bin = folder / "environment" / ("Scripts" if os.name == "nt" else "bin")
        venv.create(folder / "environment", with_pip=True, symlinks=os.name != "nt")
        locked = str(ROOT / "lock" / f"{lock}.txt")
        self.pip("--no-deps", "--require-hashes", "--requirement", locked)
        begun = time.monotonic()
        self.pip("--no-index", "--no-build-isolation", f"{built}[fast]")
        self.install_s = time.monotonic() - begun

    def pip(self, *words: str) -> None:
        """Install; without an index only what the file asks for and is there already."""
        self.run("python", "-m", "pip", "install", "--quiet", *words)

    def run(self, program: str, *words: str) -> str:
        """Run a program of the environment; what it says ends in the error if it fails."""
        own = {name: one for name, one in os.environ.items() if name != "PYTHONPATH"}
        command = [str(self._bin / program), *words]
        done = subprocess.run(
            command, cwd=self.folder, env=own, capture_output=True, text=True, check=False
        )
        if done.returncode:
            sys.exit(f"{' '.join(command)}: {done.stderr}{done.stdout}")
        return done.stdout


def _version(fresh: Fresh) -> None:
    print(fresh.run("pmm", "--version").strip())


def _demo(fresh: Fresh) -> None:
    said = fresh.run("pmm", "demo", "--output", "demo").splitlines()
    page = fresh.folder / said[-1]
    if not page.is_file():
        sys.exit(f"pmm demo: no page {page}")


def _session(fresh: Fresh) -> None:
    shutil.copytree(ROOT / "examples", fresh.folder / "examples")
    page = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")
    for block in _BLOCK.findall(page):
        fresh.run("python", "-W", "error", "-c", block)


def _notebook(fresh: Fresh) -> None:
    shutil.copytree(ROOT / "docs" / "notebooks", fresh.folder / "docs" / "notebooks")
    text, file = (f"docs/notebooks/recordings.{kind}" for kind in ("md", "ipynb"))
    fresh.run("mystnb-to-jupyter", text, file)
    fresh.run("jupyter", "execute", "--inplace", file)
    if not re.search(r"Z_w: -\d", (fresh.folder / file).read_text(encoding="utf-8")):
        sys.exit(f"{file}: no coefficient in it")


_STEPS: Final = {
    "pmm --version": _version,
    "pmm demo": _demo,
    "a session": _session,
    "a notebook": _notebook,
}


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--output", type=Path, default=RESULTS, metavar="FILE")
    output: Path = parser.parse_args().output
    found = _kept(output)
    with tempfile.TemporaryDirectory() as folder:
        built = Path(folder) / "dist"
        build = [sys.executable, "-m", "build", "--outdir", str(built), str(ROOT)]
        subprocess.run(build, check=True, stdout=subprocess.DEVNULL)
        for kind, (pattern, _) in _KINDS.items():
            (file,) = built.glob(pattern)
            _tried(kind, file, Path(folder), found, output)
    for kind, took in found["seconds"].items():
        for what, took_s in {
            "a session": took["a session"],
            "a notebook, installed": took["install"] + took.get("a notebook", 0.0),
        }.items():
            if took_s > SESSION_LIMIT_S:
                sys.exit(f"{kind}: {what}: {took_s:.0f} s, more than {SESSION_LIMIT_S:.0f} s")


def _kept(output: Path) -> dict[str, Any]:
    if output.exists():
        kept: dict[str, Any] = json.loads(output.read_text(encoding="utf-8"))
        if kept["machine"]["commit"] == commit():
            return kept
    return {"distribution": DISTRIBUTION, "machine": describe(), "seconds": {}}


def _tried(kind: str, file: Path, folder: Path, found: dict[str, Any], output: Path) -> None:
    """Do the steps of one file that are not done yet, and write the results after each."""
    took = found["seconds"].setdefault(kind, {})
    lock = _KINDS[kind][1]
    steps = {name: one for name, one in _STEPS.items() if lock == "docs" or one is not _notebook}
    if all(name in took for name in steps):
        return
    place = folder / kind.replace(" ", "-")
    place.mkdir()
    fresh = Fresh(place, file, lock)
    took["install"] = round(fresh.install_s, 1)
    for name, step in steps.items():
        if name not in took:
            begun = time.monotonic()
            step(fresh)
            took[name] = round(time.monotonic() - begun, 1)
            print(f"{kind}: {name}, {took[name]:.1f} s", flush=True)
        output.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    shutil.rmtree(place)


if __name__ == "__main__":
    main()
