"""A window for each channel that needs its own: one is unsteady, waves reach one later.

All channels share a window where they can. A channel without which the others keep a far longer
steady stretch has one of its own, and so have those whose gate is to be later than the reference's.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from analysis.recording import Recording
from analysis.resolver.analysis import Analysis, analyse
from analysis.resolver.period_values import PeriodValues, solve_periods
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from analysis.resolver.steady_stretch import find_steady
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag, Severity

SHORTER = 0.8
"""Of the longest steady stretch of a channel alone: a common one that is shorter is spoilt. Halved,
a channel may cost the others more than half of their periods; at 1 nearly each has its own window,
by a period or two at the ends."""


def analyse_windows(
    recording: Recording,
    choice: ReferenceChoice = ReferenceChoice(),
    settings: ResolverSettings = ResolverSettings(),
    delays_s: Mapping[str, float] | None = None,
) -> tuple[Analysis, ...]:
    """Resolve a recording in as few windows as its channels need, the widest shared first.

    Parameters
    ----------
    delays_s
        Of channels that waves reach so much later than the reference's sensor: their gates open and
        close so much later.

    Raises
    ------
    DataError, ConfigurationError
        As :func:`analysis.resolver.analysis.analyse`; or a delay is of a channel that is not
        resolved.
    """
    delays_s = delays_s or {}
    whole = analyse(recording, choice, settings)
    names = whole.recording.channel_names
    if strange := [name for name in delays_s if name not in names]:
        raise ConfigurationError(
            f"{recording.name}: a delay of {strange[0]!r}, which is not resolved; resolved are "
            f"{', '.join(names)}"
        )
    if not any(delays_s.values()):
        return _apart(recording, choice, settings, whole)
    found: list[Analysis] = []
    for delay_s in sorted({delays_s.get(name, 0.0) for name in names}):
        own = tuple(name for name in names if delays_s.get(name, 0.0) == delay_s)
        late = replace(settings, channels=own, delay_s=delay_s)
        found += _apart(recording, choice, late, analyse(recording, choice, late))
    return tuple(found)


def _apart(
    recording: Recording, choice: ReferenceChoice, settings: ResolverSettings, whole: Analysis
) -> tuple[Analysis, ...]:
    """Take an analysis apart where one channel spoils the window of another."""
    names = whole.recording.channel_names
    if whole.settings.opens_s is not None or len(names) == 1:
        return (whole,)
    values = solve_periods(whole.sums)
    groups = shared_windows(values, settings.steady_tolerance)
    if len(groups) == 1:
        return (whole,)
    found = []
    for rows in groups:
        own = tuple(names[row] for row in rows)
        one = analyse(recording, choice, replace(settings, channels=own))
        found.append(replace(one, flags=(*one.flags, _own_window(one, whole))))
    return tuple(found)


def _own_window(one: Analysis, whole: Analysis) -> Flag:
    names, steady = ", ".join(one.recording.channel_names), one.steady_sums
    together = find_steady(solve_periods(whole.sums), one.settings.steady_tolerance).period_count
    message = (
        f"{names}: a window of its own, {steady.period_count} periods from "
        f"{steady.opened_s[0]:.3f} s to {steady.closed_s[-1]:.3f} s; all channels together are "
        f"steady for {together}"
    )
    return Flag("own_window", Severity.NOTE, message, one.recording.channel_names[0])


def shared_windows(values: PeriodValues, tolerance: float) -> list[list[int]]:
    """Return the rows of channels that share a steady stretch, the largest set first.

    A channel leaves a set while the set's common stretch is shorter than 0.8 of the longest that
    one of its channels has alone: always the one without which the others' grows most.
    """
    rows = list(range(values.coefficients.shape[1]))
    if _steady(values, rows, tolerance) >= SHORTER * len(values.ramp):
        return [rows]
    alone = {row: _steady(values, [row], tolerance) for row in rows}
    groups: list[list[int]] = []
    while rows:
        group, left = rows, []
        while len(group) > 1 and _steady(values, group, tolerance) < SHORTER * max(
            alone[row] for row in group
        ):
            without = [[one for one in group if one != row] for row in group]
            kept = [_steady(values, others, tolerance) for others in without]
            at = int(np.argmax(kept))
            left.append(group[at])
            group = without[at]
        groups.append(group)
        rows = sorted(left)
    return sorted(groups, key=len, reverse=True)


def _steady(values: PeriodValues, rows: Sequence[int], tolerance: float) -> int:
    """Count the periods of the longest steady stretch of some channels."""
    chosen = PeriodValues(values.coefficients[:, list(rows)], values.ramp)
    return find_steady(chosen, tolerance).period_count
