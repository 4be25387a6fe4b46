"""One small campaign for all tests of the diagnosis."""

import pytest

from analysis.gap.observe.components import GapRun
from pmm.gap.load import unlimited
from sim.rig import SimulatedRig, vertical_rig
from tests.analysis.gap.small import record


@pytest.fixture(scope="session")
def rig() -> SimulatedRig:
    return unlimited(vertical_rig())


@pytest.fixture(scope="session")
def clean(rig: SimulatedRig) -> tuple[GapRun, ...]:
    """A campaign without any effect."""
    return record(rig, (), seed=1)
