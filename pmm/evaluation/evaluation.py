"""What the tests of a campaign say of rig and model."""

from dataclasses import dataclass, field
from pathlib import Path

from pmm.campaign.calibration import Calibration
from pmm.evaluation.control_chart import Chart
from pmm.evaluation.rig_tests import GaugeResponse, GaugeZeros, RungMode
from pmm.evaluation.water_tests import InWater


@dataclass(frozen=True)
class Evaluation:
    """What a campaign's tests say; what was not tested is empty.

    Attributes
    ----------
    notes
        What could not be judged yet, and what is missing for it.
    failed
        Tests that show nothing, and why.
    files
        What was written.
    """

    zeros: tuple[GaugeZeros, ...]
    calibration: Calibration | None
    modes: tuple[RungMode, ...]
    responses: tuple[GaugeResponse, ...]
    charts: tuple[Chart, ...]
    water: InWater = field(default_factory=InWater)
    notes: tuple[str, ...] = ()
    failed: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()

    @property
    def in_control(self) -> bool:
        """Whether no chart shows a change."""
        return all(one.in_control for one in self.charts)
