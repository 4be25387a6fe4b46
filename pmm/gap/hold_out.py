"""Which runs to withhold, from what a user says: names of runs, or what they have in common."""

import math
from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from typing import Final

from hardware.description.errors import ConfigurationError
from pmm.campaign import Campaign, Run

# As people write them, in the units that the tables show.
KEYS: Final[Mapping[str, Callable[[Run], float]]] = {
    "frequency": lambda run: run.frequency_hz,
    "amplitude": lambda run: 1e3 * run.eccentricity_m,
    "phase": lambda run: math.degrees(run.strut_phase_rad) % 360.0,
    "speed": lambda run: run.carriage_speed_m_s,
}


def held_out_runs(campaign: Campaign, said: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the runs to withhold, in the campaign's order.

    Parameters
    ----------
    said
        Names of runs, or ``KEY=VALUE`` with a frequency in Hz, an amplitude in mm, a phase in
        degrees, a speed in m/s, or ``medium=air``.

    Raises
    ------
    ConfigurationError
        If nothing is called so, or no run is like that.
    """
    chosen = {name for one in said for name in _meant(campaign, one)}
    return tuple(run.name for run in campaign.runs if run.name in chosen)


def _meant(campaign: Campaign, said: str) -> list[str]:
    if said in {run.name for run in campaign.runs}:
        return [said]
    key, equals, value = said.partition("=")
    if not equals:
        return [campaign.run(said).name]  # says which names there are
    found = [run.name for run in campaign.runs if _is_so(run, key.strip(), value.strip())]
    if not found:
        raise ConfigurationError(f"--hold-out {said}: no run of {campaign.name!r} is like that")
    return found


def _is_so(run: Run, key: str, value: str) -> bool:
    if key == "medium":
        return run.medium.value == value
    if key not in KEYS:
        near = get_close_matches(key, [*KEYS, "medium"], n=1, cutoff=0.4)
        hint = f"did you mean {near[0]!r}?" if near else f"keys: {', '.join([*KEYS, 'medium'])}"
        raise ConfigurationError(f"--hold-out {key}={value}: no key {key!r}; {hint}")
    try:
        return math.isclose(KEYS[key](run), float(value), rel_tol=1e-3, abs_tol=1e-6)
    except ValueError:
        raise ConfigurationError(f"--hold-out {key}={value}: {value!r} is no number") from None
