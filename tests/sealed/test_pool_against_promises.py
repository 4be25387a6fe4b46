"""A pool of processes: what fails, dies or hangs is named, and all others go on."""

import pytest

from tests.sealed.awkward import awkward
from tests.sealed.pool import Done, each
from tests.sealed.progress import line


@pytest.mark.slow
def test_what_fails_dies_or_hangs_is_named_and_all_others_go_on() -> None:
    jobs = ["first", "raises", "dies", "second", "hangs", "third"]
    done = {one.job: one for one in each(awkward, jobs, 2, limit_s=5.0)}
    assert {job: done[job].value for job in ("first", "second", "third")} == {
        job: f"{job} by 1 thread" for job in ("first", "second", "third")
    }
    assert {job: done[job].failed for job in ("raises", "dies", "hangs")} == {
        "raises": "ValueError: no such thing",
        "dies": "its process ended with 3",
        "hangs": "it took longer than it may",
    }


def test_oneawkwarder_without_a_limit_is_this_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    done = list(each(awkward, ["here", "raises"], 1))
    assert done == [Done("here", "here by 7 thread"),
                    Done("raises", None, "ValueError: no such thing")]  # fmt: skip


def test_what_is_left_is_told_at_the_pace_so_far() -> None:
    assert line("cases", 100, 600, 120.0) == "cases: 100 of 600, 10 min left"
    assert line("cases", 600, 600, 720.0) == "cases: 600 in 12.0 min"
