"""Which runs repeat another one: all settings agree within what drives and drawings state."""

import json
import sqlite3
from collections.abc import Mapping
from dataclasses import asdict
from types import MappingProxyType
from typing import Any, Final

from pmm.campaign.runs import AtRest, Run

# What is not here has to be the same. As numbers, not rounded: two that lie on both sides of a
# rounding's edge are alike too.
_DISTANCES: Final[Mapping[str, float]] = MappingProxyType(
    {
        "frequency_hz": 1e-4,
        "wave_frequency_hz": 1e-4,
        "revolutions_hz": 1e-3,
        "eccentricity_m": 1e-5,
        "share": 1e-4,
        "strut_phase_rad": 2e-3,
        "phase_rad": 2e-3,
        "carriage_speed_m_s": 1e-3,
        "drift_rad": 2e-4,
        "heel_rad": 2e-4,
        "rudder_angle_rad": 2e-4,
        "release_rad": 2e-4,
        "turn_rate_rad_s": 2e-4,
        "wave_amplitude_m": 1e-4,
        "wave_heading_rad": 2e-3,
        "mass_kg": 1e-3,
        "x_m": 1e-3,
        "own_inertia_kg_m2": 1e-3,
        "force_n": 1e-2,
    }
)
_OTHER_SETTINGS: Final = """
SELECT DISTINCT settings FROM runs JOIN campaigns ON campaigns.id = runs.campaign
WHERE hull = :hull AND kind = :kind
"""


def settings_of(run: Run | AtRest) -> str:
    """Return all that a run was set to, as JSON: set-point, known mass, load of a gauge."""
    loads = {
        "known_mass": None if run.known_mass is None else asdict(run.known_mass),
        "load": asdict(run.load) if isinstance(run, AtRest) and run.load is not None else None,
    }
    return json.dumps({**asdict(run.set_point), **loads}, sort_keys=True)


def settings_alike(connection: sqlite3.Connection, run: Mapping[str, Any]) -> str:
    """Return the settings that repeat a run's, of its hull and kind, as a JSON list.

    Parameters
    ----------
    run
        With ``id``, ``hull`` and ``kind``.
    """
    own = connection.execute("SELECT settings FROM runs WHERE id = ?", (run["id"],)).fetchone()
    wanted = json.loads(own["settings"])
    others = connection.execute(_OTHER_SETTINGS, {key: run[key] for key in ("hull", "kind")})
    return json.dumps([text for (text,) in others if _alike("", wanted, json.loads(text))])


def _alike(key: str, value: Any, other: Any) -> bool:
    if isinstance(value, dict) and isinstance(other, dict):
        return value.keys() == other.keys() and all(
            _alike(name, value[name], other[name]) for name in value
        )
    if isinstance(value, list) and isinstance(other, list):
        return len(value) == len(other) and all(
            _alike(key, *pair) for pair in zip(value, other, strict=True)
        )
    if key in _DISTANCES:
        return bool(abs(value - other) <= _DISTANCES[key])
    return bool(value == other)
