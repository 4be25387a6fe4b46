"""Which runs to withhold, from what a user says: names of runs, or what they have in common."""

import math
from collections.abc import Callable, Mapping, Sequence
from difflib import get_close_matches
from typing import Final

from hardware.description.errors import ConfigurationError
from hardware.description.kinds import RunKind
from pmm.campaign.campaign import Campaign
from pmm.campaign.runs import AtRest, Run

# As people write them, in the units that the tables show.
KEYS: Final[Mapping[str, Callable[[Run], float]]] = {
    "frequency": lambda run: run.frequency_hz,
    "amplitude": lambda run: 1e3 * run.eccentricity_m,
    "phase": lambda run: math.degrees(run.strut_phase_rad) % 360.0,
    "speed": lambda run: run.carriage_speed_m_s,
    "drift": lambda run: math.degrees(run.drift_rad),
}
_REST: Final = "rest"  # as the regimes call the medium of zero runs


def held_out_runs(campaign: Campaign, said: Sequence[str]) -> tuple[str, ...]:
    """Return the names of the runs to withhold, in the campaign's order, zero runs last.

    Parameters
    ----------
    said
        Names of runs, or ``KEY=VALUE`` with a frequency in Hz, an amplitude in mm, a phase or
        a drift in degrees, a speed in m/s, or ``medium=air``; ``medium=rest`` are the zero runs.

    Raises
    ------
    ConfigurationError
        If nothing is called so, or no run is like that.
    """
    chosen = {name for criterion in said for name in _matching_runs(campaign, criterion)}
    return tuple(run.name for run in _records(campaign) if run.name in chosen)


def _records(campaign: Campaign) -> tuple[Run | AtRest, ...]:
    """Return what a diagnosis compares: the runs, and of the records at rest the zero runs."""
    return (*campaign.runs, *(record for record in campaign.at_rest if record.kind is RunKind.ZERO))


def _matching_runs(campaign: Campaign, said: str) -> list[str]:
    if said in {run.name for run in _records(campaign)}:
        return [said]
    for record in campaign.at_rest:
        if record.name == said:
            raise ConfigurationError(
                f"--hold-out {said}: of the records at rest zero runs alone are compared, and this "
                f"is of kind {record.kind.value!r}"
            )
    key, equals, value = said.partition("=")
    if not equals:
        return [campaign.run(said).name]  # says which names there are
    names = [run.name for run in _records(campaign) if _is_so(run, key.strip(), value.strip())]
    if not names:
        raise ConfigurationError(f"--hold-out {said}: no run of {campaign.name!r} is like that")
    return names


def _is_so(run: Run | AtRest, key: str, value: str) -> bool:
    if key == "medium":
        return value == (_REST if isinstance(run, AtRest) else run.medium.value)
    if key not in KEYS:
        near = get_close_matches(key, [*KEYS, "medium"], n=1, cutoff=0.4)
        hint = f"did you mean {near[0]!r}?" if near else f"keys: {', '.join([*KEYS, 'medium'])}"
        raise ConfigurationError(f"--hold-out {key}={value}: no key {key!r}; {hint}")
    try:
        wanted = float(value)
    except ValueError:
        raise ConfigurationError(f"--hold-out {key}={value}: {value!r} is no number") from None
    # A zero run has no frequency and no amplitude, and its speed is no regime of the runs'.
    return isinstance(run, Run) and math.isclose(KEYS[key](run), wanted, rel_tol=1e-3, abs_tol=1e-6)
