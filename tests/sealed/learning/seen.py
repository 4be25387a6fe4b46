"""What the amortised classifier sees of a campaign: its remainder in sigma, and its set-points."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hardware.description.arrays import FloatArray
from hardware.description.setpoint import Medium, SetPoint
from tests.sealed.peers.scene import scene


@dataclass(frozen=True, eq=False)
class Seen:
    """Components of all runs, one after the other.

    Attributes
    ----------
    cell
        Channel, part and order of each, as one text.
    run
        Number of the run of each, shape ``(components,)``.
    off
        Measured minus simulated with the coefficients fitted, in sigma, shape ``(components,)``.
    settings
        Of each run: log of the frequency in Hz, log of the eccentricity in m, cosine of the phase
        between the struts, carriage speed in m/s, and 1 in water; shape ``(runs, 5)``.
    """

    cell: tuple[str, ...]
    run: NDArray[np.intp]
    off: FloatArray
    settings: FloatArray

    @classmethod
    def of(cls, table: Mapping[str, Any]) -> "Seen":
        """Read what :func:`as_table` wrote."""
        return cls(
            tuple(table["cell"]),
            np.asarray(table["run"], np.intp),
            np.asarray(table["off"], np.float64),
            np.asarray(table["settings"], np.float64),
        )


def as_table(seen: Seen) -> dict[str, Any]:
    """Return it as lists."""
    return {
        "cell": list(seen.cell),
        "run": seen.run.tolist(),
        "off": seen.off.tolist(),
        "settings": seen.settings.tolist(),
    }


def seen_of(case: Path) -> Seen:
    """Return what is seen of a case's folder."""
    left = scene(case).fitting
    off = left.values / left.sigma
    there = np.flatnonzero(np.isfinite(off))
    names = [f"{one.channel}|{one.part.value}|{one.order}" for one in left.components]
    return Seen(
        tuple(names[at] for at in there),
        left.run[there],
        off[there],
        np.array([_settings(one.set_point) for one in left.runs]),
    )


def _settings(point: SetPoint) -> list[float]:
    return [
        math.log(max(point.frequency_hz, 1e-3)),
        math.log(max(point.eccentricity_m, 1e-4)),
        math.cos(point.strut_phase_rad),
        point.carriage_speed_m_s,
        float(point.medium is Medium.WATER),
    ]
