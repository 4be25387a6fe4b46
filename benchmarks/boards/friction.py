"""Campaigns with Coulomb friction planted below the dynamometers, at an SNR that is known."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from benchmarks.boards import outside
from benchmarks.boards.campaigns import EXAMPLES, NULLS
from pmm.campaign.campaign_file import read_campaign

OUTSIDE: Final = "sealed generator, CSV"
# The recipes in which friction is planted: what was simulated, and how many seeds are asked for.
PLANTED: Final[Mapping[str, tuple[Path, int]]] = {
    "examples/gap": (EXAMPLES / "gap" / "campaign.toml", 100),
    "examples/vertical": (EXAMPLES / "vertical" / "campaign.toml", 20),
    "examples/foreign": (EXAMPLES / "foreign" / "truth.toml", 20),
}
SEEDS: Final[Mapping[str, int]] = {
    **{name: count for name, (_, count) in PLANTED.items()},
    OUTSIDE: 100,
}
# Odd orders that no coefficient of the model takes up: the first goes into the damping.
_ORDERS: Final = (3, 5)
_GAUGES: Final = 2


def snr_of_newton(file: Path) -> float:
    """Return the SNR of 1 N of friction at each strut, by closed form.

    A square wave has ``4 F / (pi n)`` at each odd order n; a component of a mean over N samples of
    noise sigma scatters by ``sigma sqrt(2 / N)``. The first order is left out, so the true SNR is
    larger.
    """
    campaign = read_campaign(file)
    rate = campaign.simulation.sample_rate_hz
    gauge = campaign.acquisition.force_aft
    if gauge is None or not gauge.noise_rms:
        raise ValueError(f"{file}: no noise of force_aft is stated")
    total = 0.0
    for run in campaign.runs:
        count = run.periods / run.frequency_hz * rate
        for order in _ORDERS:
            line_n = 4.0 / (math.pi * order)
            total += _GAUGES * line_n**2 / (2.0 * gauge.noise_rms**2 / count)
    return math.sqrt(total)


def made(name: str, folder: Path, seed: int) -> tuple[Path, dict[str, float]]:
    """Make a campaign with friction; return its folder, the SNR and the friction, N."""
    if name == OUTSIDE:
        case, found = outside.with_friction(seed)
        written = outside.written(case, folder / "theirs", stated=False)
        return written, {"snr": found.snr, "friction_n": found.size}
    file, _ = PLANTED[name]
    rng = np.random.default_rng([22, seed, 3])
    low, high = np.log(outside.LEAST_SNR), np.log(outside.LARGEST_SNR)
    snr = float(np.exp(rng.uniform(low, high)))
    friction_n = snr / snr_of_newton(file)
    effect = f"{outside.FRICTION}:friction_n={friction_n!r}"
    return NULLS[name].make(folder, seed, (effect,)), {"snr": snr, "friction_n": friction_n}
