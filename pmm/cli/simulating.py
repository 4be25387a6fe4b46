"""What ``pmm simulate`` does: simulate each run and write its recording."""

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from analysis.readers import from_dataset, write_recording
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag
from pmm.campaign.campaign import Campaign
from pmm.campaign.campaign_file import read_campaign
from pmm.campaign.file_names import CAMPAIGN_FILE
from pmm.campaign.order import place_in
from pmm.campaign.runs import AtRest, Run
from pmm.cli.folders import check_folder
from pmm.cli.hints import pasted
from pmm.cli.screen import output, print_flags, show_progress
from pmm.cli.simulating_zeros import simulate_zero, zero_runs
from pmm.document.notation import counted
from pmm.recorder.campaign_owner import own_new_campaign
from pmm.whole_file import write_whole
from sim.effects.catalogue import build, user_effects
from sim.effects.effect import Effect
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig
from sim.run import simulate

if TYPE_CHECKING:
    from analysis.recording import Recording

JSON_SCHEMA = "pmm-simulation-1"


@dataclass(frozen=True)
class SimulateOptions:
    """The options of ``pmm simulate``, by their names there."""

    campaign: str
    output: str | None
    seed: int | None
    runs: tuple[str, ...]
    effects: tuple[str, ...]
    effects_file: str | None
    plot: str | None
    overwrite: bool
    as_json: bool


@dataclass(frozen=True)
class Written:
    """A run that was simulated, and its recording."""

    run: Run
    file: str
    seed: int
    sample_rate_hz: float
    samples: int
    flags: tuple[Flag, ...]


def run(request: SimulateOptions) -> None:
    """Simulate the runs that were asked for.

    Raises
    ------
    ConfigurationError
        If the campaign or an effect is wrong, a run is beyond the rig's limits, or a recording is
        there already.
    OwnedElsewhereError
        If another process is writing into the folder.
    """
    path = Path(request.campaign)
    path = path / CAMPAIGN_FILE if path.is_dir() else path
    campaign = read_campaign(path)
    folder = Path(campaign.name) if request.output is None else Path(request.output)
    chosen = [campaign.run(name) for name in request.runs] or list(campaign.runs)
    seed = campaign.simulation.seed if request.seed is None else request.seed
    effects = _effects(request, campaign)
    zeros = () if request.runs else zero_runs(campaign)
    check_output(path, campaign, (*chosen, *zeros), folder, overwrite=request.overwrite)
    if request.plot is not None:
        check_folder(Path(request.plot), "--plot")
    more: dict[str, Any] = {"overwrite": request.overwrite, "effects": effects}
    with own_new_campaign(folder):
        written = list(simulate_runs(campaign, chosen, folder, seed, **more))
        at_rest = list(simulate_zeros(campaign, zeros, folder, seed, **more))
        copy_campaign(path, folder)
        copy_table(path, campaign, folder)
    figures = [] if request.plot is None else _draw(campaign, written, effects, Path(request.plot))
    if request.as_json:
        click.echo(json.dumps(_document(folder, written, effects, at_rest), indent=1))
    else:
        _print(campaign, written, folder, effects, at_rest)
        for figure in figures:
            output().print(str(figure), soft_wrap=True)


def _effects(request: SimulateOptions, campaign: Campaign) -> tuple[Effect, ...]:
    """Return the effects of the file, and those of the command line after them."""
    more = user_effects(request.effects_file)
    return (*campaign.effects_on(more), *(build(text, more) for text in request.effects))


def _draw(
    campaign: Campaign, written: Sequence[Written], effects: Sequence[Effect], folder: Path
) -> list[Path]:
    from pmm.report.chain_figures import save_chain_figure

    figures: list[Path] = []
    for one in show_progress(written, "plotting"):
        figures += save_chain_figure(campaign, one.run, effects, one.seed, folder)
    return figures


def check_output(
    path: Path, campaign: Campaign, runs: Sequence[Run | AtRest], folder: Path, *, overwrite: bool
) -> None:
    """Refuse a folder in which something would be lost or confused, before any work is done.

    Raises
    ------
    ConfigurationError
        If the campaign has no runs, or is one of measured recordings and lies in that very folder;
        if the folder cannot be written to, or a recording, or another campaign file, is there and
        may not be overwritten.
    """
    if not campaign.runs:
        raise ConfigurationError(f"{path}: the campaign has no runs; add a table [[runs]] for each")
    check_folder(folder, "--output")
    target = folder / CAMPAIGN_FILE
    own = target.exists() and target.samefile(path)
    if own and any(run.file for run in campaign.runs):
        raise ConfigurationError(
            f"{path}: its runs name recordings of another system; simulate into another folder "
            "with --output, so that measured and simulated runs are not taken for each other"
        )
    if overwrite:
        return
    there = [one for one in (folder / f"{run.name}.nc" for run in runs) if one.exists()]
    if target.exists() and not own and target.read_bytes() != path.read_bytes():
        there.append(target)
    if there:
        names = ", ".join(str(one) for one in there)
        raise ConfigurationError(f"{names}: there already; choose another --output, or --overwrite")


def simulate_runs(
    campaign: Campaign,
    runs: Sequence[Run],
    folder: Path,
    seed: int,
    *,
    overwrite: bool,
    effects: Sequence[Effect] = (),
) -> Iterator[Written]:
    """Simulate runs one by one and write their recordings.

    Each run has noise of its own, which depends on the seed and the run's name alone. Effects act
    on a run as its place in the whole campaign asks, whichever runs are simulated.
    """
    rig = campaign.rig()
    for one in show_progress(runs, "simulating"):
        run_seed = seed_of(seed, one.name)
        own = rig if one.recorded_with is None else campaign.as_recorded(one.name).rig()
        recording = simulate_recording(own, campaign, one, run_seed, effects)
        folder.mkdir(parents=True, exist_ok=True)  # not before a run is known to be possible
        file = write_recording(recording, folder / f"{one.name}.nc", overwrite=overwrite)
        rate, count = recording.sample_rate_hz, recording.sample_count
        yield Written(one, str(file), run_seed, rate, count, recording.flags)


def simulate_zeros(
    campaign: Campaign,
    zeros: Sequence[AtRest],
    folder: Path,
    seed: int,
    *,
    overwrite: bool,
    effects: Sequence[Effect] = (),
) -> Iterator[str]:
    """Simulate zero runs, write their recordings beside those of the runs, and yield the files."""
    rig = campaign.rig()
    for one in zeros:
        recording = simulate_zero(rig, campaign, one, seed_of(seed, one.name), effects)
        yield str(write_recording(recording, folder / f"{one.name}.nc", overwrite=overwrite))


def simulate_recording(
    rig: SimulatedRig, campaign: Campaign, run: Run, run_seed: int, effects: Sequence[Effect] = ()
) -> "Recording":
    """Simulate one run; its recording says what it was told to do, and which effects were on.

    Raises
    ------
    ConfigurationError
        As :func:`sim.run.simulate` does; the message begins with the run's name.
    """
    try:
        changed, set_point = switch_on(effects, rig, run.set_point, place_in(campaign, run))
        dataset = simulate(
            changed,
            set_point,
            periods=run.periods,
            settling_periods=campaign.simulation.settling_periods,
            sample_rate_hz=campaign.simulation.sample_rate_hz,
            seed=run_seed,
            name=run.name,
        )
    except ConfigurationError as error:
        raise ConfigurationError(f"run {run.name!r}: {error}") from None
    recording = from_dataset(dataset)
    switched_on = {"effects": json.dumps(_effect_rows(effects))} if effects else {}
    provenance = {**recording.provenance, **switched_on}
    return replace(recording, set_point=run.set_point, provenance=provenance)


def _effect_rows(effects: Sequence[Effect]) -> list[dict[str, Any]]:
    return [{"name": one.name, "parameters": asdict(one)} for one in effects]


def seed_of(seed: int, name: str) -> int:
    """Return a run's own seed, whatever other runs there are."""
    sequence = np.random.SeedSequence([seed, *name.encode()])
    return int(sequence.generate_state(1)[0])


def copy_campaign(path: Path, folder: Path) -> None:
    """Put the campaign file beside its recordings, unless it is there."""
    target = folder / CAMPAIGN_FILE
    if not (target.exists() and target.samefile(path)):
        write_whole(target, path.read_bytes())


def copy_table(path: Path, campaign: Campaign, folder: Path) -> None:
    """Put the table of added mass beside the campaign file's copy, where that looks for it."""
    if campaign.radiation is None:
        return
    source = Path(campaign.radiation.file)
    own = path.parent.resolve()
    if source.resolve().is_relative_to(own):
        target = folder / source.resolve().relative_to(own)
        if not (target.exists() and target.samefile(source)):
            target.parent.mkdir(parents=True, exist_ok=True)
            write_whole(target, source.read_bytes())


def _document(
    folder: Path, written: Sequence[Written], effects: Sequence[Effect], at_rest: Sequence[str]
) -> dict[str, Any]:
    return {
        "schema": JSON_SCHEMA,
        "folder": str(folder),
        "effects": _effect_rows(effects),
        "runs": [asdict(one) for one in written],
        "at_rest": list(at_rest),
    }


def _print(
    campaign: Campaign,
    written: Sequence[Written],
    folder: Path,
    effects: Sequence[Effect],
    at_rest: Sequence[str],
) -> None:
    from rich.table import Table

    console = output()
    table = Table(title=f"{campaign.name}: {counted(len(written), 'run')}", title_justify="left")
    table.add_column("run", overflow="fold")
    for heading in ("f [Hz]", "e [mm]", "phase [deg]", "U [m/s]", "periods", "samples"):
        table.add_column(heading, justify="right")
    table.add_column("recording", overflow="fold")
    for one in written:
        run = one.run
        table.add_row(
            run.name,
            f"{run.frequency_hz:g}",
            f"{1e3 * run.eccentricity_m:g}",
            f"{math.degrees(run.strut_phase_rad):g}",
            f"{run.carriage_speed_m_s:g}",
            f"{run.periods}",
            f"{one.samples}",
            one.file,
        )
    console.print(table)
    for file in at_rest:
        console.print(f"at rest: {file}", soft_wrap=True)
    for effect in effects:
        values = ", ".join(f"{key} = {value:g}" for key, value in asdict(effect).items())
        console.print(f"effect {effect.name}: {values}", soft_wrap=True)
    for one in written:
        print_flags(console, one.flags)
    console.print(pasted("analyse", folder), soft_wrap=True)
