"""What holds for every test: the same examples each time, and nothing is left behind."""

import gc
import os
from collections import defaultdict
from collections.abc import Iterator

import can
import pytest
from hypothesis import HealthCheck, settings

from tests.compiled_loops import compile_loops
from tests.hardware.leaks import Leaks

# No clock decides a test: a slow machine is no fault of the code. A few examples of each in every
# run of the tests; `make bench` asks for many.
settings.register_profile(
    "seeded",
    max_examples=12,
    derandomize=True,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.register_profile("full", settings.get_profile("seeded"), max_examples=200)
settings.load_profile("seeded")


def pytest_sessionstart(session: pytest.Session) -> None:
    """Compile what takes long before workers begin."""
    if getattr(session.config.option, "numprocesses", None):
        compile_loops()


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Iterator[None]:
    """Look for garbage seldom, and never among the modules and tests, which stay to the end."""
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.set_threshold(20_000, 10, 10)
        gc.enable()


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Mark as slow all cases of a test but the sample of them that it asks for, evenly drawn."""
    cases = defaultdict(list)
    for item in items:
        if item.get_closest_marker("sample"):
            cases[item.nodeid.partition("[")[0]].append(item)
    for those in cases.values():
        mark = those[0].get_closest_marker("sample")
        assert mark is not None
        (count,) = mark.args
        drawn = {(2 * k + 1) * len(those) // (2 * count) for k in range(count)}
        for place, item in enumerate(those):
            if place not in drawn:
                item.add_marker(pytest.mark.slow)


@pytest.fixture(autouse=True)
def _nothing_left_behind() -> Iterator[None]:
    """Fail the test that leaves a bus, a port, a thread or a process."""
    with pytest.MonkeyPatch.context() as patch:
        leaks = Leaks(patch)
        yield
        left = leaks.found()
    assert not left, f"left behind: {', '.join(left)}"


@pytest.fixture(autouse=True, scope="session")
def _bus_name() -> None:
    """Give the simulated bus its name although the package may run unpacked."""
    can.interface.BACKENDS.setdefault("pmm-simulated", ("sim.devices.bus", "SimulatedBus"))


@pytest.fixture(autouse=True, scope="session")
def _one_core() -> Iterator[None]:
    """Let commands work in this process unless a test asks for more: tests share the cores."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "sched_getaffinity", lambda _: {0}, raising=False)
        yield
