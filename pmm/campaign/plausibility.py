"""Units and signs that look wrong in all runs: each command that reads a campaign says so."""

from collections.abc import Sequence

from analysis.plausibility import plausibility_flags
from analysis.run_harmonics import RunHarmonics
from hardware.description.arrangement import Joint
from hardware.description.flags import Flag
from pmm.campaign.campaign import Campaign


def implausible(campaign: Campaign, runs: Sequence[RunHarmonics]) -> tuple[Flag, ...]:
    """Return what :func:`analysis.plausibility.plausibility_flags` says of a campaign's runs.

    Nothing of a turntable: what is known beforehand is of two struts on one rigid model.
    """
    oscillator = campaign.oscillator
    if oscillator is not None and oscillator.joint is Joint.YAW_TABLE:
        return ()
    if oscillator is None:
        return plausibility_flags(runs, campaign.model)
    return plausibility_flags(runs, campaign.model, oscillator.half_spacing_m, oscillator.plane)
