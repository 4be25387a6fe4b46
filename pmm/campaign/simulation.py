"""A campaign simulated: a recording for each of its runs, as its file says and with effects."""

import json
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from analysis.coefficients.corrections import ZERO_BLOCKS
from analysis.readers import from_dataset, write_recording
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag
from hardware.description.kinds import RunKind
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign import Campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.order import made_in_order, place_in
from pmm.campaign.runs import AtRest, Run
from pmm.whole_file import write_whole
from sim.effects.effect import Effect
from sim.effects.switching import switch_on
from sim.rest import rig_at_rest
from sim.rig import SimulatedRig
from sim.run import simulate

if TYPE_CHECKING:
    from analysis.recording import Recording


@dataclass(frozen=True)
class SimulatedRun:
    """A run that was simulated, and its recording."""

    run: Run
    file: str
    seed: int
    sample_rate_hz: float
    samples: int
    flags: tuple[Flag, ...]


def at_rest_runs(campaign: Campaign) -> tuple[AtRest, ...]:
    """Return zero runs, tows and decays whose place in the campaign is known, as made."""
    records = (record for record in made_in_order(campaign) if isinstance(record, AtRest))
    kinds = (RunKind.ZERO, RunKind.FREE_DECAY)
    return tuple(record for record in records if record.kind in kinds or record.kind.towed)


def check_target(
    path: Path, campaign: Campaign, runs: Sequence[Run | AtRest], folder: Path, *, overwrite: bool
) -> None:
    """Refuse a folder in which something would be lost or confused, before any work is done.

    Raises
    ------
    ConfigurationError
        If the campaign has no runs, or is one of measured recordings and lies in that very folder;
        or if a recording, or another campaign file, is there and may not be overwritten.
    """
    if not runs:
        raise ConfigurationError(f"{path}: the campaign has no runs; add a table [[runs]] for each")
    target = folder / CAMPAIGN_FILE
    is_same_file = target.exists() and target.samefile(path)
    if is_same_file and any(run.file for run in campaign.runs):
        raise ConfigurationError(
            f"{path}: its runs name recordings of another system; simulate into another folder "
            "with --output, so that measured and simulated runs are not taken for each other"
        )
    if overwrite:
        return
    files = [file for file in (folder / f"{run.name}.nc" for run in runs) if file.exists()]
    if target.exists() and not is_same_file and target.read_bytes() != path.read_bytes():
        files.append(target)
    if files:
        names = ", ".join(str(file) for file in files)
        raise ConfigurationError(f"{names}: there already; choose another --output, or --overwrite")


def simulate_runs(
    campaign: Campaign,
    runs: Iterable[Run],
    folder: Path,
    seed: int,
    *,
    overwrite: bool,
    effects: Sequence[Effect] = (),
) -> Iterator[SimulatedRun]:
    """Simulate runs one by one and write their recordings.

    Each run has noise of its own, which depends on the seed and the run's name alone. Effects act
    on a run as its place in the whole campaign asks, whichever runs are simulated.

    Raises
    ------
    ConfigurationError
        As :func:`sim.run.simulate` does; the message begins with the run's name.
    """
    rig = campaign.rig()
    for run in runs:
        run_seed = seed_of(seed, run.name)
        run_rig = rig if run.recorded_with is None else campaign.as_recorded(run.name).rig()
        recording = _simulated(
            run_rig, campaign, run, run.set_point, run.periods, run_seed, effects
        )
        switched_on = {"effects": json.dumps(effect_rows(effects))} if effects else {}
        provenance = {**recording.provenance, **switched_on}
        recording = replace(recording, set_point=run.set_point, provenance=provenance)
        file = _written(recording, folder, run.name, overwrite=overwrite)
        rate, count = recording.sample_rate_hz, recording.sample_count
        yield SimulatedRun(run, file, run_seed, rate, count, recording.flags)


def simulate_at_rest(
    campaign: Campaign,
    records: Sequence[AtRest],
    folder: Path,
    seed: int,
    *,
    overwrite: bool,
    effects: Sequence[Effect] = (),
) -> Iterator[str]:
    """Simulate records with a standing shaft, the struts at their middle; yield files.

    Raises
    ------
    ConfigurationError
        As :func:`simulate_runs`.
    """
    rig = campaign.rig()
    for record in records:
        # The gauges' mean is taken with the scatter between blocks: a block stands for a period.
        point = replace(record.set_point, frequency_hz=ZERO_BLOCKS / record.duration_s)
        periods = ZERO_BLOCKS - 1  # a simulated record is one longer
        record_seed = seed_of(seed, record.name)
        recording = _simulated(rig, campaign, record, point, periods, record_seed, effects)
        recording = replace(recording, set_point=None)
        yield _written(recording, folder, record.name, overwrite=overwrite)


def _simulated(
    rig: SimulatedRig,
    campaign: Campaign,
    run: Run | AtRest,
    point: SetPoint,
    periods: int,
    seed: int,
    effects: Sequence[Effect],
) -> "Recording":
    at_rest, settings = isinstance(run, AtRest), campaign.simulation
    try:
        effect_rig, set_point = switch_on(effects, rig, point, place_in(campaign, run))
        dataset = simulate(
            rig_at_rest(effect_rig) if at_rest else effect_rig,
            set_point,
            periods=periods,
            settling_periods=0 if at_rest else settings.settling_periods,
            sample_rate_hz=settings.sample_rate_hz,
            seed=seed,
            name=run.name,
        )
    except ConfigurationError as error:
        kind = "record at rest" if at_rest else "run"
        raise ConfigurationError(f"{kind} {run.name!r}: {error}") from None
    return from_dataset(dataset)


def _written(recording: "Recording", folder: Path, name: str, *, overwrite: bool) -> str:
    folder.mkdir(parents=True, exist_ok=True)  # not before a run is known to be possible
    return str(write_recording(recording, folder / f"{name}.nc", overwrite=overwrite))


def effect_rows(effects: Sequence[Effect]) -> list[dict[str, Any]]:
    """Return effects with their parameters, as recordings and programs get them."""
    return [{"name": effect.name, "parameters": asdict(effect)} for effect in effects]


def seed_of(seed: int, name: str) -> int:
    """Return a run's own seed, whatever other runs there are."""
    sequence = np.random.SeedSequence([seed, *name.encode()])
    return int(sequence.generate_state(1)[0])


def copy_campaign(path: Path, campaign: Campaign, folder: Path) -> None:
    """Put a campaign file beside its recordings, and its table of added mass where it looks."""
    _copied(path, folder / CAMPAIGN_FILE)
    if campaign.radiation is not None:
        source, campaign_folder = Path(campaign.radiation.file).resolve(), path.parent.resolve()
        if source.is_relative_to(campaign_folder):
            _copied(source, folder / source.relative_to(campaign_folder))


def _copied(source: Path, target: Path) -> None:
    """Copy a file, unless it is there itself."""
    if not (target.exists() and target.samefile(source)):
        target.parent.mkdir(parents=True, exist_ok=True)
        write_whole(target, source.read_bytes())
