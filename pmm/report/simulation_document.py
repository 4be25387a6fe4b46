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
    Column("run", lambda row: row.run, "run", lambda run: run.name),
    Column("f", lambda row: _G(row.run.frequency_hz), unit="Hz", number=True),
    Column("e", lambda row: _G(1e3 * row.run.eccentricity_m), unit="mm", number=True),
    Column("phase", lambda row: _G(math.degrees(row.run.strut_phase_rad)), unit="deg", number=True),
    Column("U", lambda row: _G(row.run.carriage_speed_m_s), unit="m/s", number=True),
    Column("periods", lambda row: row.run.periods, number=True),
    number("samples", "samples"),
    word("recording", "file"),
    *data_only("seed", "sample_rate_hz", "flags"),
)


def simulation_document(simulation: PlannedSimulation, campaign: SimulatedCampaign) -> Document:
    """Return what was simulated of a campaign."""
    memory = simulation.campaign.memory
    contents = (
        Text((f"{simulation.campaign.name}: {counted(len(campaign.runs), 'run')}", "")),
        Table("Runs", _RUNS, campaign.runs, "runs"),
        Text([f"memory of the water, {memory}"] if memory else []),
        Text([f"at rest: {file}" for file in campaign.at_rest]),
        Text([f"effect {effect.name}: {_parameters(effect)}" for effect in simulation.effects]),
        Notes(flag_notes(flag for run in campaign.runs for flag in run.flags)),
        Data("folder", simulation.folder),
        Data("effects", effect_rows(simulation.effects)),
        Data("at_rest", campaign.at_rest),
    )
    return Document("", "simulated runs", (Section("", contents),), SCHEMA)


def _parameters(effect: Effect) -> str:
    return ", ".join(f"{key} = {value:g}" for key, value in asdict(effect).items())
