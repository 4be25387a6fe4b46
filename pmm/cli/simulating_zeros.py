"""The zero runs of a campaign, simulated as its runs are: the rig with its shaft standing."""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from analysis.coefficients.corrections import ZERO_BLOCKS
from analysis.readers import from_dataset
from hardware.description.errors import ConfigurationError
from hardware.description.kinds import RunKind
from pmm.campaign.campaign import Campaign
from pmm.campaign.order import made_in_order, place_in
from pmm.campaign.runs import AtRest
from sim.effects.effect import Effect
from sim.effects.switching import switch_on
from sim.rest import rig_at_rest
from sim.rig import SimulatedRig
from sim.run import simulate

if TYPE_CHECKING:
    from analysis.recording import Recording


def zero_runs(campaign: Campaign) -> tuple[AtRest, ...]:
    """Return the zero runs whose place in the campaign is known, in the order they are made."""
    made = made_in_order(campaign)
    return tuple(one for one in made if isinstance(one, AtRest) and one.kind is RunKind.ZERO)


def simulate_zero(
    rig: SimulatedRig, campaign: Campaign, zero: AtRest, seed: int, effects: Sequence[Effect] = ()
) -> "Recording":
    """Simulate one zero run, the struts at their middle.

    Raises
    ------
    ConfigurationError
        As :func:`sim.run.simulate` does; the message begins with the record's name.
    """
    # The gauges' mean is taken with the scatter between blocks: a block stands for a period.
    frequency_hz = ZERO_BLOCKS / zero.duration_s
    point = replace(zero.set_point, frequency_hz=frequency_hz)
    try:
        changed, set_point = switch_on(effects, rig, point, place_in(campaign, zero))
        dataset = simulate(
            rig_at_rest(changed),
            set_point,
            periods=ZERO_BLOCKS - 1,  # a simulated record is one longer
            settling_periods=0,
            sample_rate_hz=campaign.simulation.sample_rate_hz,
            seed=seed,
            name=zero.name,
        )
    except ConfigurationError as error:
        raise ConfigurationError(f"record at rest {zero.name!r}: {error}") from None
    return replace(from_dataset(dataset), set_point=None)
