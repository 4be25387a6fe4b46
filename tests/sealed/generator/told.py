"""What the keys of worlds B to D have besides: tolerances and forms for an oracle, the water."""

import math
from typing import Any

import numpy as np

from tests.sealed.generator.case import Case
from tests.sealed.generator.water import coefficients

_LINES = 9


def further_truth(case: Case) -> dict[str, Any]:
    """Return the entries; docs/sealed.md says what each means."""
    campaign = case.campaign
    rig = campaign.rig
    fast = [2.0 * math.pi * run.frequency_hz for run in campaign.runs]
    omega = np.geomspace(min(fast), max(fast), _LINES)
    added, damping = coefficients(case.situation.parameters, omega)
    return {
        "world": campaign.world.name,
        "tolerances": dict(campaign.world.tolerances),
        "forms": {effect.name: effect.form for effect in campaign.effects},
        "water": {
            "omega_rad_s": omega.tolist(),
            "added_mass": added.T.tolist(),
            "damping": damping.T.tolist(),
            "table_believed": campaign.table is not None,
        },
        "imperfections": [
            {"name": one.effect.name, "size": one.size, "snr": one.snr} for one in case.always
        ],
        "noise": {
            "coloured_n": rig.noise.coloured_n,
            "colour_s": rig.noise.colour_s,
            "wander_n": rig.noise.wander_n,
            "white_n": [rig.noise.white_n * run.loud for run in campaign.runs],
        },
    }
