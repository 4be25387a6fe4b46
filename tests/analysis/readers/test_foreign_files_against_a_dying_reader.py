"""A binary file that ends, hangs or floods its reader: one sentence, and the next file is read."""

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from analysis.foreign import process
from analysis.foreign.process import end_children
from analysis.readers import read_recording
from analysis.reading_limits import MEMORY_SETTING, TIME_SETTING
from hardware.description.errors import ConfigurationError, DataError

TIME = np.arange(200) / 100.0
DYING = """
import json, os, sys, time
import analysis.foreign.child as child
from analysis.foreign.columns import ForeignColumns
import numpy as np
def say(count):
    answer = {"columns": [["a", "", count]], "sample_rate_hz": 1.0}
    os.write(answers, json.dumps(answer).encode() + b"\\n")
def read(path):
    text = path.read_text()
    if text == "hangs":
        time.sleep(600)
    if text == "crashes":
        os.kill(os.getpid(), 11)
    if text == "exits":
        os._exit(3)
    if text == "babbles":
        os.write(answers, b"x" * 100)
        os._exit(0)
    if text == "lies":
        say(1 << 60)
        time.sleep(600)
    if text == "cut":
        say(99)
        os._exit(0)
    if text == "prints":
        print("hello")
    if text == "raises":
        raise ZeroDivisionError
    if text == "eats":
        np.ones(1 << 40)
    return ForeignColumns({"t": np.arange(9.0), "F": np.ones(9)}, {"F": "kN"})
answers = os.dup(1)
child.resolve_name = lambda _: read
child.main()
"""


@pytest.fixture
def mat(tmp_path: Path) -> Path:
    """A sound MAT file."""
    path = tmp_path / "run.mat"
    savemat(path, {"t": TIME, "F1": np.sin(TIME)})
    return path


@pytest.fixture
def dying(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A reader that does what its file says."""
    monkeypatch.setattr(process, "_COMMAND", (sys.executable, "-c", DYING))
    end_children()
    yield
    end_children()


@pytest.mark.sample(1)
@pytest.mark.usefixtures("dying")
@pytest.mark.parametrize(
    ("does", "said"),
    [
        ("crashes", r"the reader of MAT files was ended by it \(SIGSEGV\)"),
        ("exits", r"was ended by it \(status 3\)"),
        ("babbles", r"was ended by it"),
        ("cut", r"was ended by it"),
        ("lies", r"1152921504606846976 rows or more of 1 columns, where the limit is"),
        ("raises", r"damaged: ZeroDivisionError"),
        ("eats", rf"too large: the file's MAT content.*raise {MEMORY_SETTING}"),
    ],
)
def test_the_end_of_a_reader_is_one_sentence(tmp_path: Path, does: str, said: str) -> None:
    path = tmp_path / "run.mat"
    path.write_text(does)
    with pytest.raises(DataError, match=said) as caught:
        read_recording(path)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)
    path.write_text("prints")
    assert read_recording(path).sample_count == 9


@pytest.mark.usefixtures("dying")
def test_a_reader_that_hangs_is_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "run.mat"
    path.write_text("hangs")
    monkeypatch.setenv(TIME_SETTING, "0.5")
    with pytest.raises(DataError, match=rf"took longer than 0.5 s .* raise {TIME_SETTING}"):
        read_recording(path)


@pytest.mark.slow
def test_one_reader_serves_many_files_and_ends_with_its_parent(mat: Path) -> None:
    text = f"""
import json, pathlib
from analysis.foreign import process
from analysis.readers import read_recording
found = [read_recording({str(mat)!r}).sample_count for _ in range(20)]
print(json.dumps([found, [one._process.pid for one in process._idle.children]]))
"""
    done = subprocess.run(
        [sys.executable, "-c", text],
        env={**os.environ, "PYTHONPATH": ":".join(sys.path)},
        capture_output=True,
        text=True,
        check=True,
    )
    counts, children = json.loads(done.stdout)
    assert counts == [200] * 20
    assert len(children) == 1
    assert done.stderr == ""
    with pytest.raises(ProcessLookupError):
        os.kill(children[0], 0)


def test_a_module_of_the_users_folder_is_not_taken(
    mat: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (mat.parent / "scipy.py").write_text("raise SystemExit('the wrong scipy')")
    (mat.parent / "numpy.py").write_text("raise SystemExit('the wrong numpy')")
    monkeypatch.chdir(mat.parent)
    end_children()  # another one begins in this folder
    assert read_recording("run.mat").sample_count == 200


@pytest.mark.slow
def test_spoiled_mat_files_never_end_this_process(mat: Path) -> None:
    """Some of these end scipy's reader by a segmentation fault; benchmarks.fuzz has thousands."""
    whole, ends = np.frombuffer(mat.read_bytes(), np.uint8), 0
    rng = np.random.default_rng(23)
    for _ in range(50):
        data = whole.copy()
        at = rng.integers(124, 400, int(rng.integers(1, 8)))
        data[at] = rng.integers(0, 256, len(at))
        mat.write_bytes(data.tobytes())
        try:
            found = read_recording(mat, sample_rate_hz=100.0)
            missing = np.isnan(found.samples[:, 0 : found.sample_count])
            assert bool(missing.any()) <= bool(found.flags)
        except (DataError, ConfigurationError) as error:
            ends += "was ended by it" in str(error)
    assert ends > 0
