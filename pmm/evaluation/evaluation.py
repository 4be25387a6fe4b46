"""What the tests of a campaign say of rig and model."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Final, TypeVar

from hardware.description.errors import ConfigurationError, DataError
from pmm.campaign.calibration import CALIBRATION_FILE, Calibration, write_calibration
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.evaluation.check_weights import calibrate, modes_text
from pmm.evaluation.control_chart import LEAST, Chart, control_charts
from pmm.evaluation.rig_tests import (
    GaugeResponse,
    GaugeZeros,
    RungMode,
    TowedSpeed,
    known_mass_responses,
    rung_modes,
    towed_speeds,
    zero_drifts,
)
from pmm.evaluation.run_results import RunResult, of_kind, read_results
from pmm.evaluation.water_tests import InWater, in_water
from pmm.recorder.campaign_owner import own_campaign
from pmm.whole_file import write_whole

MODES_FILE: Final = "modes.toml"
_Found = TypeVar("_Found")


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
    speeds: tuple[TowedSpeed, ...] = ()
    notes: tuple[str, ...] = ()
    failed: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()

    @property
    def in_control(self) -> bool:
        """Whether no chart shows a change."""
        return all(chart.in_control for chart in self.charts)


def evaluate(folder: Path, valid_days: int) -> Evaluation:
    """Return what a campaign's tests say; a test that shows nothing stops no other.

    Parameters
    ----------
    valid_days
        How long a calibration may be relied on.

    Raises
    ------
    DataError
        If the folder holds no complete run.
    ConfigurationError
        If known masses were moved and no campaign file says where the struts are.
    """
    results, failed = read_results(folder), list[str]()

    def tried(test: Callable[[], _Found], otherwise: _Found) -> _Found:
        try:
            return test()
        except DataError as error:
            failed.append(str(error))
            return otherwise

    weights, controls = of_kind(results, "check-weight"), of_kind(results, "control")

    def mode(run: RunResult) -> tuple[RungMode, ...]:
        return tried(lambda: rung_modes([run]), ())

    modes = [rung_mode for run in of_kind(results, "pluck") for rung_mode in mode(run)]
    water = _in_water(folder)
    failed += [failure.message for failure in water.failed]
    notes = []
    if 0 < len(controls) < LEAST:
        notes.append(
            f"control condition: {len(controls)} of the {LEAST} repeats that a chart needs; "
            "plan more with [control] every"
        )
    return Evaluation(
        zero_drifts(of_kind(results, "zero")),
        tried(lambda: _calibration(weights, valid_days), None),
        tuple(modes),
        tried(
            lambda: _responses(folder, of_kind(results, "known-mass"), of_kind(results, "dry")),
            (),
        ),
        control_charts(controls) if len(controls) >= LEAST else (),
        water,
        tried(lambda: towed_speeds(results), ()),
        tuple(notes),
        tuple(failed),
    )


def _calibration(weights: Sequence[RunResult], valid_days: int) -> Calibration | None:
    if not weights:
        return None
    made = datetime.fromisoformat(weights[-1].header.started_utc).date()
    return calibrate(weights, made, valid_days)


def _in_water(folder: Path) -> InWater:
    if not (folder / CAMPAIGN_FILE).exists():
        return InWater()
    return in_water(read_campaign(folder / CAMPAIGN_FILE), folder)


def _responses(
    folder: Path, mass_runs: Sequence[RunResult], dry_runs: Sequence[RunResult]
) -> tuple[GaugeResponse, ...]:
    return known_mass_responses(mass_runs, dry_runs, _half_spacing(folder)) if mass_runs else ()


def _half_spacing(folder: Path) -> float:
    oscillator = read_campaign(folder / CAMPAIGN_FILE).oscillator
    if oscillator is None:
        raise ConfigurationError(f"{folder / CAMPAIGN_FILE}: no [oscillator]; known masses need it")
    return oscillator.half_spacing_m


def keep(evaluation: Evaluation, folder: Path) -> list[Path]:
    """Write what later runs use; a campaign that is being recorded may be looked at meanwhile.

    Raises
    ------
    DataError
        If there is something to be written and another process is writing into the folder.
    """
    if evaluation.calibration is None and not evaluation.modes:
        return []
    with own_campaign(folder):
        return _write(evaluation, folder)


def _write(evaluation: Evaluation, folder: Path) -> list[Path]:
    paths = []
    if evaluation.calibration is not None:
        paths.append(write_calibration(evaluation.calibration, folder / CALIBRATION_FILE))
    if evaluation.modes:
        path = folder / MODES_FILE
        write_whole(path, modes_text([mode.as_table() for mode in evaluation.modes]))
        paths.append(path)
    return paths
