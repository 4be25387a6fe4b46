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
    shared = analyse(recording, choice, settings)
    names = shared.recording.channel_names
    if strange := [name for name in delays_s if name not in names]:
        raise ConfigurationError(
            f"{recording.name}: a delay of {strange[0]!r}, which is not resolved; resolved are "
            f"{', '.join(names)}"
        )
    if not any(delays_s.values()):
        return _split_by_window(recording, choice, settings, shared)
    analyses: list[Analysis] = []
    for delay_s in sorted({delays_s.get(name, 0.0) for name in names}):
        delayed_names = tuple(name for name in names if delays_s.get(name, 0.0) == delay_s)
        late = replace(settings, channels=delayed_names, delay_s=delay_s)
        analyses += _split_by_window(recording, choice, late, analyse(recording, choice, late))
    return tuple(analyses)


def _split_by_window(
    recording: Recording, choice: ReferenceChoice, settings: ResolverSettings, shared: Analysis
) -> tuple[Analysis, ...]:
    """Take an analysis apart where one channel spoils the window of another."""
    names = shared.recording.channel_names
    if shared.settings.opens_s is not None or len(names) == 1:
        return (shared,)
    values = solve_periods(shared.sums)
    groups = shared_windows(values, settings.steady_tolerance)
    if len(groups) == 1:
        return (shared,)
    analyses = []
    for rows in groups:
        group_names = tuple(names[row] for row in rows)
        analysis = analyse(recording, choice, replace(settings, channels=group_names))
        analyses.append(replace(analysis, flags=(*analysis.flags, _own_window(analysis, shared))))
    return tuple(analyses)


def _own_window(analysis: Analysis, shared: Analysis) -> Flag:
    names, steady = ", ".join(analysis.recording.channel_names), analysis.steady_sums
    shared_count = find_steady(
        solve_periods(shared.sums), analysis.settings.steady_tolerance
    ).period_count
    message = (
        f"{names}: a window of its own, {steady.period_count} periods from "
        f"{steady.opened_s[0]:.3f} s to {steady.closed_s[-1]:.3f} s; all channels together are "
        f"steady for {shared_count}"
    )
    return Flag("own_window", Severity.NOTE, message, analysis.recording.channel_names[0])


def shared_windows(values: PeriodValues, tolerance: float) -> list[list[int]]:
    """Return the rows of channels that share a steady stretch, the largest set first.

    A channel leaves a set while the set's common stretch is shorter than 0.8 of the longest that
    one of its channels has alone: always the one without which the others' grows most.
    """
    rows = list(range(values.coefficients.shape[1]))
    if _steady(values, rows, tolerance) >= SHORTER * len(values.ramp):
        return [rows]
    own_lengths = {row: _steady(values, [row], tolerance) for row in rows}
    groups: list[list[int]] = []
    while rows:
        group, leavers = rows, []
        while len(group) > 1 and _steady(values, group, tolerance) < SHORTER * max(
            own_lengths[row] for row in group
        ):
            without = [[member for member in group if member != row] for row in group]
            lengths = [_steady(values, members, tolerance) for members in without]
            at = int(np.argmax(lengths))
            leavers.append(group[at])
            group = without[at]
        groups.append(group)
        rows = sorted(leavers)
    return sorted(groups, key=len, reverse=True)


def _steady(values: PeriodValues, rows: Sequence[int], tolerance: float) -> int:
    """Count the periods of the longest steady stretch of some channels."""
    chosen = PeriodValues(values.coefficients[:, list(rows)], values.ramp)
    return find_steady(chosen, tolerance).period_count
