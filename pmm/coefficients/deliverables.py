"""A campaign's runs as SIMMAN asks for them: averaged cycle, Fourier coefficients, description."""

from pathlib import Path

from analysis.exchange.simman import SimmanDescription, deliverables_of
from analysis.exchange.simman_files import write_simman
from hardware.description.errors import DataError
from pmm.coefficients.workflow import CampaignOutcome


def write_deliverables(outcome: CampaignOutcome, folder: Path, *, overwrite: bool = False) -> int:
    """Write the deliverables of every run that oscillated, a folder each; return how many.

    Raises
    ------
    DataError
        If a run's are there already, or no run oscillated.
    """
    moving = [cycle for cycle in outcome.cycles if cycle.frequency_hz > 0.0]
    if not moving:
        raise DataError("no run oscillates: there is no cycle to deliver")
    rates = {one.name: one.sample_rate_hz for one in outcome.runs}
    periods = {one.name: one.periods for one in outcome.runs}
    body, ship = outcome.body, outcome.settings.ship
    for cycle in moving:
        description = SimmanDescription(
            run=cycle.name,
            campaign=", ".join(outcome.names),
            scale=ship.scale,
            length_m=ship.length_m,
            mass_kg=None if body is None else body.mass_kg,
            inertia_kg_m2=None if body is None else body.inertia_kg_m2,
            cg_x_m=None if body is None else body.cg_x_m,
            water_temperature_deg_c=ship.water_temperature_deg_c,
            density_kg_m3=ship.density_kg_m3,
            logging_rate_hz=rates[cycle.name],
            periods=periods[cycle.name],
        )
        write_simman(deliverables_of(cycle, description), folder / cycle.name, overwrite=overwrite)
    return len(moving)
