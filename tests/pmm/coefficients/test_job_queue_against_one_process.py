"""Jobs of a queue give what one process gives, and none is left; its commands are played here."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from hardware.description.errors import ConfigurationError, DataError
from pmm.parallel import as_done, open_executor
from tests.pmm.coefficients.work import drawn

COUNT = 6
_PAGE = (Path(__file__).parents[3] / "docs" / "parallel.md").read_text(encoding="utf-8")
# As the real one: it keeps the script, answers with a number, and the job runs on by itself.
_SBATCH = """#!/bin/sh
script={folder}/script-$$
cp "$1" $script
setsid sh $script > $script.log 2>&1 < /dev/null &
echo $! >> {folder}/jobs
echo "Submitted batch job $!"
"""
_SCANCEL = """#!/bin/sh
kill -KILL -- -$1
"""


@pytest.fixture
def queue(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    dask = pytest.importorskip("dask", reason="optional dependency queue")
    interrupted = signal.getsignal(signal.SIGINT)  # which its import takes over
    pytest.importorskip("dask_jobqueue", reason="optional dependency queue")
    signal.signal(signal.SIGINT, interrupted)
    for name, text in {"sbatch": _SBATCH, "scancel": _SCANCEL}.items():
        (tmp_path / name).write_text(text.format(folder=tmp_path), encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    with dask.config.set(
        {
            "jobqueue.slurm.cores": 1,
            "jobqueue.slurm.memory": "1GB",
            "jobqueue.slurm.scheduler-options": {"host": "127.0.0.1"},
        }
    ):
        yield tmp_path


def _runs(process: int) -> bool:
    try:
        os.killpg(process, 0)
    except ProcessLookupError:
        return False
    return True


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("setsid") is None, reason="no setsid on this system")
def test_jobs_give_the_same_and_end_with_the_command(queue: Path) -> None:
    with open_executor(scheduler="slurm:1") as executor:
        assert sorted(as_done(executor, drawn, range(COUNT))) == sorted(map(drawn, range(COUNT)))
    jobs = [int(line) for line in (queue / "jobs").read_text(encoding="utf-8").split()]
    assert len(jobs) == 1
    scripts = [one.read_text(encoding="utf-8") for one in queue.glob("script-*[0-9]")]
    assert len(scripts) == 1
    assert all("--nthreads 1" in one for one in scripts)
    assert all("export MALLOC_TRIM_THRESHOLD_=134217728\n" in one for one in scripts)
    ends_s = time.monotonic() + 10.0
    while any(map(_runs, jobs)) and time.monotonic() < ends_s:
        time.sleep(0.05)
    assert not any(map(_runs, jobs))


def test_a_job_has_the_workers_environment_and_then_what_the_settings_say(
    queue: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import dask

    (queue / "sbatch").write_text(f"#!/bin/sh\ncp $1 {queue}/kept; exit 1\n", encoding="utf-8")
    with (
        dask.config.set({"jobqueue.slurm.job-script-prologue": ["module load python"]}),
        pytest.raises(DataError, match="a job was refused"),
        open_executor(scheduler="slurm:1"),
    ):
        pass
    script = (queue / "kept").read_text(encoding="utf-8")
    before, _, after = script.partition("module load python\n")
    exports = [line for line in before.splitlines() if line.startswith("export ")]
    assert exports == [line for line in _PAGE.splitlines() if line.startswith("export ")]
    assert "distributed.cli.dask_worker" in after


def test_an_interrupt_stays_what_the_program_made_of_it(queue: Path) -> None:
    """The queue's library makes an exit of it as soon as it is imported."""
    stated = {"DASK_JOBQUEUE__SLURM__CORES": "1", "DASK_JOBQUEUE__SLURM__MEMORY": "1GB"}
    code = (
        "import signal; from pmm.cluster import _cluster\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # ignored in the background
        "_cluster('slurm:1', 'slurm').close()\n"
        "print(signal.getsignal(signal.SIGINT) is signal.default_int_handler)"
    )
    said = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, **stated},
        capture_output=True,
        text=True,
        check=True,
    )
    assert said.stdout.strip() == "True"


def test_a_queue_that_refuses_is_quoted(queue: Path) -> None:
    (queue / "sbatch").write_text(
        "#!/bin/sh\necho no such partition >&2; exit 1\n", encoding="utf-8"
    )
    with pytest.raises(DataError, match="no such partition"), open_executor(scheduler="slurm:1"):
        pass


@pytest.mark.usefixtures("queue")
@pytest.mark.parametrize(
    ("address", "setting", "message"),
    [
        ("slurm:0", {}, "at least one job"),
        ("pbs:1", {}, "no command qsub here"),
        (
            "slurm:1",
            {"jobqueue.slurm.memory": None},
            "state memory below jobqueue: slurm:",
        ),
    ],
)
def test_what_cannot_be_submitted_is_said(
    address: str, setting: dict[str, None], message: str
) -> None:
    import dask

    with (
        dask.config.set(setting),
        pytest.raises(ConfigurationError, match=message),
        open_executor(scheduler=address),
    ):
        pass
