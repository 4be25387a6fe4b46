"""The numbers that decide over rest and power: one table, each with unit and source.

``docs/safety.md`` shows them, and tests hold the page to this table.
"""

from typing import Final

from hardware.description.errors import ConfigurationError

SHAFT_REST_SHARE: Final = 0.005
"""Of the shaft's highest frequency: below it the shaft is at rest. Half the share of the slowest
oscillation that the examples plan (0.02 Hz of 2 Hz); at an eccentricity of 60 mm the struts then
move at less than 4 mm/s."""

AXIS_REST_SHARE: Final = 0.02
"""Of a position axis's speed: below it the axis is at rest. A spindle at that speed stands within
its tolerance once its power is off."""

REST_WINDOW_S: Final = (0.02, 0.5)
"""Seconds over which positions have to stay for rest: two cycles of 100 Hz; up to the larger number
where the encoder makes fewer than :data:`REST_COUNTS` at the speed of rest."""

REST_COUNTS: Final = 2
"""Counts: what an encoder at rest may wander, by its resolution and by a servo that holds."""

REST_DEADLINE_S: Final = 5.0
"""Seconds that a quick stop may take to measured rest before the power is taken off all the same:
a drive that has not braked by then does not brake, and its motor must not go on driving."""

SPEED_WINDOW_S: Final = 0.1
"""Seconds over which positions make a speed: 20 counts at 0.02 Hz and 10,000 a turn, and a shaft
that runs away is seen within it."""

RESTLESS_S: Final = 1.0
"""Seconds for which a shaft that has to stand may be seen to move: a drive that is enabled takes
hold of it with a jerk."""

OVERSPEED: Final = 1.05
"""Over the highest frequency, either way: beyond a drive's overshoot (2 %) and its ripple (3 %, the
largest of the catalogue of effects)."""

OVERSPEED_S: Final = 0.05
"""Seconds for which the shaft has to be beyond it: a frame that comes a cycle late is numbered a
cycle off, and shifts the speed over the window by a tenth until the next one."""

FREQUENCY_SHARE: Final = 0.1
"""Of the set frequency: so far from it, and by the speed of rest, the shaft may be while the gate
is armed or open; three times the largest ripple of the catalogue of effects."""

FREQUENCY_S: Final = 0.3
"""Seconds for which it has to be so far off: a drive that is blocked says so itself before."""

LATE_PERIODS: Final = 1.0
"""Periods that a cycle may come late while struts follow a path: then a set-point was left out. The
drive goes on by itself for one period; a strut at 0.8 m/s goes 8 mm in one of 100 Hz.
Half as much stops a run for what the drive's window of following error would bear; twice as much
lets two set-points go, and the drives fault by themselves."""

READ_BACK_SHARE: Final = 0.01
"""Of a value written to a drive: so far off it may read back, rounded to the drive's own units."""

COASTING_S: Final = 10.0
"""Seconds for which an axis without power is recorded and waited for until it rests: twice what the
simulated shaft takes from 3 Hz."""

RECONNECT_TRIES: Final = 3
"""How often a reset opens a lost port again, and waits for its device to be heard. Half of it does
not outlast a controller that has just come back; twice as much keeps who has forgotten to plug in
waiting for no more than he knows."""

RECONNECT_S: Final = 1.0
"""Seconds that each of these tries waits; a device is silent after as long. At half, an answer that
has to be asked for five times is missed."""

RAMP_MARGIN: Final = 1.5
"""Over the time that a ramp takes by its settings: load, jerk limits and the drive's own cycle."""


CARRIAGE_REST_SHARE: Final = 0.005
"""Of the carriage's highest speed: below it the carriage is at rest, by its own measurement. At
3 m/s that is 15 mm/s; half is within the ripple of a servo that holds, twice would end a run while
the carriage still rolls."""

CARRIAGE_PLAUSIBLE: Final = 1.5
"""Over the carriage's highest speed: what reads more is no speed of it but a wrong register, type,
word order or scale. A half word in the wrong place makes a factor of 65536."""

CARRIAGE_SHARE: Final = 0.05
"""Of the set speed: so far from it, and by the tolerance, the carriage may be while the gate is
armed or open; five times the ripple of a carriage that the catalogue of effects calls large."""

CARRIAGE_S: Final = 0.5
"""Seconds for which it has to be so far off: a rail joint is over by then."""

TRACK_MARGIN: Final = 1.2
"""Over the way in which the carriage brakes: that far from the end of its track, and the way of two
answers that were lost, it is stopped."""


def check_above_0(settings: object, *keys: str) -> None:
    """Refuse settings of which one of these keys is not above zero.

    Raises
    ------
    ConfigurationError
        With the key and its value.
    """
    for key in keys:
        if not getattr(settings, key) > 0.0:
            raise ConfigurationError(f"{key} = {getattr(settings, key):g} has to be above 0")


def check_ends(low: float, high: float) -> None:
    """Refuse a range whose low end is not below its high end.

    Raises
    ------
    ConfigurationError
        With both ends.
    """
    if not low < high:
        raise ConfigurationError(f"low = {low:g} has to be below high = {high:g}")


def check_quick_stop(speed: float, ramp: float, unit: str, key: str) -> None:
    """Refuse a quick stop that could not be over by its deadline.

    Raises
    ------
    ConfigurationError
        If the ramp, with its margin, takes longer from the highest speed.
    """
    takes_s = RAMP_MARGIN * speed / ramp
    if takes_s > REST_DEADLINE_S:
        raise ConfigurationError(
            f"{key} = {ramp:g} {unit} per second: a quick stop from {speed:g} {unit} may take "
            f"{takes_s:.3g} s (limit {REST_DEADLINE_S:g} s, {RAMP_MARGIN:g} ramps); make it steeper"
        )
