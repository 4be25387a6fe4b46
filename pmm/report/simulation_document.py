"""What ``pmm simulate`` shows: the runs with their recordings, and what was switched on."""

import math
from dataclasses import asdict
from typing import Final

from pmm.campaign.simulated_campaign import PlannedSimulation, SimulatedCampaign
from pmm.campaign.simulation import SimulatedRun, effect_rows
from pmm.document.content import (
    Column,
    Data,
    Document,
    Notes,
    Section,
    Table,
    Text,
    data_only,
    number,
    word,
)
from pmm.document.flag_lines import flag_notes
from pmm.document.notation import counted, written
from sim.effects.effect import Effect

SCHEMA: Final = "pmm-simulation-1"
_G: Final = written("g")
_RUNS: Final[tuple[Column[SimulatedRun], ...]] = (
    Column("run", lambda one: one.run, "run", lambda run: run.name),
    Column("f", lambda one: _G(one.run.frequency_hz), unit="Hz", number=True),
    Column("e", lambda one: _G(1e3 * one.run.eccentricity_m), unit="mm", number=True),
    Column("phase", lambda one: _G(math.degrees(one.run.strut_phase_rad)), unit="deg", number=True),
    Column("U", lambda one: _G(one.run.carriage_speed_m_s), unit="m/s", number=True),
    Column("periods", lambda one: one.run.periods, number=True),
    number("samples", "samples"),
    word("recording", "file"),
    *data_only("seed", "sample_rate_hz", "flags"),
)


def simulation_document(planned: PlannedSimulation, done: SimulatedCampaign) -> Document:
    """Return what was simulated of a campaign."""
    memory = planned.campaign.memory
    told = (
        Text((f"{planned.campaign.name}: {counted(len(done.runs), 'run')}", "")),
        Table("Runs", _RUNS, done.runs, "runs"),
        Text([f"memory of the water, {memory}"] if memory else []),
        Text([f"at rest: {file}" for file in done.at_rest]),
        Text([f"effect {one.name}: {_parameters(one)}" for one in planned.effects]),
        Notes(flag_notes(flag for one in done.runs for flag in one.flags)),
        Data("folder", planned.folder),
        Data("effects", effect_rows(planned.effects)),
        Data("at_rest", done.at_rest),
    )
    return Document("", "simulated runs", (Section("", told),), SCHEMA)


def _parameters(effect: Effect) -> str:
    return ", ".join(f"{key} = {value:g}" for key, value in asdict(effect).items())
