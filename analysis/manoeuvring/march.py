"""Ships under one helm order until something happens to each: all of them at once.

A fixed step of Runge and Kutta's fourth order, cut short where the rudder comes to rest and where
the event lies, so that no step goes across a corner of either.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from analysis.manoeuvring.ship import PSI, R, Ship, U
from hardware.description.arrays import FloatArray

Event = Callable[[FloatArray], FloatArray]
"""Of a state: rises through 0 where the phase ends."""
_SECANTS = 6  # the step is short and the event smooth in it: digits of a double


@dataclass(frozen=True)
class ShipState:
    """Where n ships are: time in s and rudder in rad, ``(n,)``, and state, ``(6, n)``."""

    time_s: FloatArray
    state: FloatArray
    rudder_rad: FloatArray


@dataclass
class Log:
    """What is kept of every step of the first ships, for figures."""

    ships: int = 40
    moments: list[ShipState] = field(default_factory=list)

    def keep(self, moment: ShipState) -> None:
        """Add a moment of the first ships."""
        few = slice(self.ships)
        self.moments.append(
            ShipState(moment.time_s[few], moment.state[:, few], moment.rudder_rad[few])
        )


def approach(ship: Ship) -> ShipState:
    """Return the state of straight course at the approach speed, all rudders amidships."""
    state = np.zeros((6, ship.count))
    state[U] = ship.approach_m_s
    return ShipState(np.zeros(ship.count), state, np.zeros(ship.count))


def heading_beyond(target_rad: float, side: float) -> Event:
    """Return the event that the heading passes an angle to starboard (side 1) or port (-1)."""
    return lambda state: side * (state[PSI] - target_rad)


def turning_back(side: float) -> Event:
    """Return the event that a turn to starboard (side 1) or port (-1) comes to rest."""
    return lambda state: -side * state[R]


def march(
    ship: Ship,
    start: ShipState,
    order_rad: float,
    until: Event | None,
    longest_s: float,
    step_s: float,
    log: Log | None = None,
) -> ShipState:
    """Return where the ships are at the event; without an event, after ``longest_s``.

    Ships that do not come to the event in that time are NaN from there on.
    """
    now, running = start, ~np.isnan(start.time_s)
    if log is not None and not log.moments:
        log.keep(start)
    ends = start.time_s + longest_s
    while running.any():
        way = order_rad - now.rudder_rad
        rate = np.sign(way) * math.radians(ship.rudder_rate_deg_s)
        with np.errstate(divide="ignore", invalid="ignore"):
            reach = np.where(way != 0.0, np.abs(way / rate), np.inf)
        durations = np.minimum(np.minimum(step_s, reach), ends - now.time_s)
        durations = np.where(running, durations, 0.0)
        moved = _stepped(ship, now, rate, durations)
        if until is not None:
            hit = running & (until(moved) >= 0.0) & (until(now.state) < 0.0)
            if hit.any():
                durations = np.where(hit, _event_time(ship, now, rate, durations, until), durations)
                moved = _stepped(ship, now, rate, durations)
            running = running & ~hit
        arrived = durations == reach
        rudder = np.where(arrived, order_rad, now.rudder_rad + rate * durations)
        now = ShipState(now.time_s + durations, moved, rudder)
        late = running & (now.time_s >= ends)
        if until is not None and late.any():
            now = ShipState(
                np.where(late, np.nan, now.time_s), np.where(late, np.nan, now.state), rudder
            )
        running = running & ~late
        if log is not None:
            log.keep(now)
    return now


def _stepped(ship: Ship, now: ShipState, rate: FloatArray, durations: FloatArray) -> FloatArray:
    def rates(state: FloatArray, share: float) -> FloatArray:
        return ship.rates(state, now.rudder_rad + share * durations * rate)

    first = rates(now.state, 0.0)
    second = rates(now.state + 0.5 * durations * first, 0.5)
    third = rates(now.state + 0.5 * durations * second, 0.5)
    fourth = rates(now.state + durations * third, 1.0)
    return np.asarray(now.state + durations / 6.0 * (first + 2.0 * second + 2.0 * third + fourth))


def _event_time(
    ship: Ship, now: ShipState, rate: FloatArray, durations: FloatArray, until: Event
) -> FloatArray:
    """Return how long each step lasts until the event, by secants."""
    before, after = np.zeros_like(durations), durations
    value, last = until(now.state), until(_stepped(ship, now, rate, durations))
    for _ in range(_SECANTS):
        with np.errstate(divide="ignore", invalid="ignore"):
            better = after - last * (after - before) / (last - value)
        better = np.where(np.isfinite(better), np.clip(better, 0.0, durations), after)
        before, after, value = after, better, last
        last = until(_stepped(ship, now, rate, after))
    return np.asarray(after)
