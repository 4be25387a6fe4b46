"""Runs on a circle (rotating arm, circular motion): steady velocities ahead, across and turning.

With the arm's rate ``r`` and radius ``R`` about which the midpoint goes round, at a drift angle b:

    U = abs(r) R      u = U cos b      v = -U sin b

They stand among the static runs of their speed, so that straight tows and oblique ones at the same
speed are fitted with them.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from analysis.coefficients.body_cycle import SURGE_FORCE, BodyCycle, at_order, labels
from analysis.coefficients.phasors import Phasors
from analysis.coefficients.stated_uncertainties import STATED, StatedUncertainties
from analysis.kinematics.body_frame import CHANNELS, UNIT_OF
from analysis.uncertainty.values import Contribution
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.oscillator import Plane

_TINY: Final = 1e-12  # N or N m: of a record without any scatter


@dataclass(frozen=True)
class SteadyTurn:
    """One run on a circle, its zero reading taken off.

    Attributes
    ----------
    radius_m
        Of the midpoint between the struts about the centre.
    turn_rate_rad_s
        Of the arm, positive to starboard.
    drift_rad
        Of the model against its way at the midpoint, bow to starboard (outwards where it turns to
        port).
    force_n, moment_n_m, surge_force_n
        Of what holds the model **on the model**, in its own axes: to starboard, bow to starboard,
        ahead (``None`` where there is no gauge for it). Inertia is in them, as the gauges read.
    u_force_n, u_moment_n_m, u_surge_force_n, u_radius_m, u_turn_rate_rad_s
        Standard uncertainties.

    Raises
    ------
    ConfigurationError
        If the radius or an uncertainty of the loads is not above 0, or nothing turns.
    """

    run: str
    radius_m: float
    turn_rate_rad_s: float
    force_n: float
    moment_n_m: float
    u_force_n: float
    u_moment_n_m: float
    drift_rad: float = 0.0
    surge_force_n: float | None = None
    u_surge_force_n: float = 0.0
    u_radius_m: float = 0.0
    u_turn_rate_rad_s: float = 0.0

    def __post_init__(self) -> None:
        for key in ("radius_m", "u_force_n", "u_moment_n_m"):
            if not getattr(self, key) > 0.0:
                raise ConfigurationError(f"{self.run}: {key} = {getattr(self, key):g} is not > 0")
        if self.turn_rate_rad_s == 0.0:
            raise ConfigurationError(f"{self.run}: turn_rate_rad_s = 0 is no circle")

    @property
    def speed_m_s(self) -> float:
        """Speed of the midpoint between the struts along its circle."""
        return abs(self.turn_rate_rad_s) * self.radius_m


def turn_cycle(turn: SteadyTurn, half_spacing_m: float, body: Body) -> BodyCycle:
    """Return a run on a circle as a static cycle.

    Parameters
    ----------
    half_spacing_m
        Of the rig of the other runs.
    body
        The model with all that the gauges carry: its inertia is taken off.
    """
    surge = turn.surge_force_n is not None
    channels = CHANNELS if surge else CHANNELS[:-1]
    values = {
        "ahead": turn.speed_m_s * math.cos(turn.drift_rad),
        "across": -turn.speed_m_s * math.sin(turn.drift_rad),
        "force": turn.force_n,
        "moment": turn.moment_n_m,
        "surge_force": turn.surge_force_n or 0.0,
    }
    spread = {"force": turn.u_force_n, "moment": turn.u_moment_n_m}
    spread |= {"surge_force": turn.u_surge_force_n} if surge else {}
    sources = tuple(
        Contribution(
            f"scatter of {name} in {turn.run}",
            math.inf,
            np.array([2 * channels.index(name)]),
            np.array([[deviation]]),
        )
        for name, deviation in spread.items()
    )
    phasors = Phasors.of(
        labels(channels, 0),
        tuple(UNIT_OF[name] for name in channels),
        np.array([values.get(name, 0.0) for name in channels], dtype=np.complex128),
        sources,
    )
    cycle = BodyCycle(
        turn.run,
        Plane.HORIZONTAL,
        half_spacing_m,
        0.0,
        turn.speed_m_s,
        phasors,
        0,
        body=body,
        drift_rad=turn.drift_rad,
        mean_known=True,
        turn_rate_rad_s=turn.turn_rate_rad_s,
    )
    sensitivity = np.zeros((len(phasors.values), 2, len(STATED)))
    for name, key, slope in (
        ("ahead", "speed_m_s", math.cos(turn.drift_rad)),
        ("across", "speed_m_s", -math.sin(turn.drift_rad)),
        ("moment", "midpoint_x_m", turn.force_n),
    ):
        sensitivity[channels.index(name), 0, STATED.index(key)] = slope
    return by_radius(replace(cycle, sensitivity=sensitivity.reshape(-1, len(STATED))))


def by_radius(cycle: BodyCycle) -> BodyCycle:
    """Return a run on a circle whose speed is its rate times its radius, and uncertain by these."""
    sensitivity = cycle.sensitivity.copy()
    speed, rate, radius = (
        STATED.index(name) for name in ("speed_m_s", "turn_rate_relative", "turn_radius_m")
    )
    sensitivity[:, rate] += sensitivity[:, speed] * cycle.speed_m_s
    sensitivity[:, radius] += sensitivity[:, speed] * abs(cycle.turn_rate_rad_s)
    sensitivity[:, speed] = 0.0
    return replace(cycle, sensitivity=sensitivity)


def turn_of(cycle: BodyCycle, u_radius_m: float, u_turn_rate_rad_s: float) -> SteadyTurn:
    """Return what was recorded on a circle, of a static cycle whose zeros were taken off.

    Parameters
    ----------
    u_radius_m, u_turn_rate_rad_s
        By the scatter of what was recorded.
    """
    rows = ("force", "moment", *([SURGE_FORCE] if cycle.has_surge else []))
    loads = cycle.phasors.select([at_order(name, 0) for name in rows]).real
    values, spread = loads.values[::2].tolist(), loads.standard_uncertainty[::2].tolist()
    return SteadyTurn(
        cycle.name,
        cycle.speed_m_s / abs(cycle.turn_rate_rad_s),
        cycle.turn_rate_rad_s,
        values[0],
        values[1],
        max(spread[0], _TINY),
        max(spread[1], _TINY),
        cycle.drift_rad,
        values[2] if cycle.has_surge else None,
        spread[2] if cycle.has_surge else 0.0,
        u_radius_m,
        u_turn_rate_rad_s,
    )


def of_turns(turns: Sequence[SteadyTurn]) -> StatedUncertainties:
    """Return what is uncertain of the circles themselves: of several runs the largest."""
    return StatedUncertainties(
        turn_rate_relative=max(
            (turn.u_turn_rate_rad_s / abs(turn.turn_rate_rad_s) for turn in turns), default=0.0
        ),
        turn_radius_m=max((turn.u_radius_m for turn in turns), default=0.0),
    )
