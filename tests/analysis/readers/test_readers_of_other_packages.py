"""A reader that another package brings: found by its entry point, with nothing changed here."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

READER = '''
import numpy as np
from analysis.foreign.columns import ForeignColumns
from analysis.readers.foreign import foreign_reader

def read(path):
    """Return the little-endian doubles of a file, sampled at 50 Hz."""
    return ForeignColumns({"F": np.fromfile(path, "<f8")}, {"F": "kN"}, 50.0)

READER = foreign_reader("raw", read)
'''
ASK = """
import sys
from analysis.readers import read_recording
from hardware.description.errors import PmmError
try:
    found = read_recording(sys.argv[1])
except PmmError as error:
    sys.exit(str(error))
print(found.samples[0].tolist(), found.sample_rate_hz, found.provenance["reader"])
"""


def asked(folder: Path, name: str, entry: str) -> subprocess.CompletedProcess[str]:
    """Return what comes of reading a file with a package beside that brings an entry point."""
    about = folder / "lab-1.dist-info"
    about.mkdir()
    (about / "METADATA").write_text("Metadata-Version: 2.1\nName: lab\nVersion: 1\n")
    (about / "entry_points.txt").write_text(f"[pmm.readers]\nraw = {entry}\n")
    (folder / "lab.py").write_text(READER)
    root = str(Path(__file__).parents[3])
    paths = os.pathsep.join((str(folder), root, os.environ.get("PYTHONPATH", "")))
    return subprocess.run(
        [sys.executable, "-c", ASK, folder / name],
        env={**os.environ, "PYTHONPATH": paths},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.slow
def test_a_package_brings_a_reader_in_one_file(tmp_path: Path) -> None:
    (tmp_path / "run.raw").write_bytes(b"\0" * 8 * 7)
    done = asked(tmp_path, "run.raw", "lab:READER")
    assert done.stdout.split() == [*str([0.0] * 7).split(), "50.0", "raw"], done.stderr


def test_a_reader_that_cannot_be_loaded_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "run.raw").write_bytes(b"\0")
    done = asked(tmp_path, "run.raw", "lab:NOTHING")
    assert "the reader of .raw files, lab:NOTHING, cannot be loaded" in done.stderr
    assert "Traceback" not in done.stderr


def test_what_is_no_reader_is_one_sentence(tmp_path: Path) -> None:
    (tmp_path / "run.raw").write_bytes(b"\0")
    done = asked(tmp_path, "run.raw", "lab:read")
    assert "lab:read is no analysis.readers.reader.Reader" in done.stderr
