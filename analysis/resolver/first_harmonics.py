"""First harmonics of a run's struts and gauges, for the checks across a campaign."""

from collections.abc import Iterator

from analysis.recording import Recording
from analysis.resolver.analysis import Analysis
from analysis.resolver.estimate import resolve
from analysis.resolver.harmonics import Harmonics
from analysis.resolver.sums import period_sums
from analysis.run_harmonics import CHECKED, RunHarmonics
from hardware.description.channels import DISPLACEMENT_AFT, FORCE_AFT
from hardware.description.errors import DataError

_UNITS = (DISPLACEMENT_AFT.unit, FORCE_AFT.unit)


def first_harmonics(recording: Recording, analysis: Analysis) -> RunHarmonics | None:
    """Return the first harmonics over the first gate, also of the channel that tells the phase.

    It is ``None`` for a recording without a set-point, or with a motion of many lines.

    Parameters
    ----------
    recording
        With all its channels, as it was read.
    """
    set_point, reading = recording.set_point, analysis.readings[0]
    if set_point is None or set_point.lines:
        return None
    first = dict(_first(reading))
    for name in CHECKED:
        if name in recording.channel_names and name not in reading.channel_names:
            first |= _unresolved_channel(recording, analysis, name)
    return RunHarmonics(recording.name, set_point, reading.frequency_hz, first)


def _unresolved_channel(recording: Recording, analysis: Analysis, name: str) -> dict[str, complex]:
    """Return a channel that was not resolved; nothing where no period of it is whole."""
    gate = analysis.steady_sums.edges_cycles[: analysis.readings[0].periods + 1]
    try:
        sums = period_sums(recording.select([name]), analysis.reference, 1, edges_cycles=gate)
        return dict(_first(resolve(recording.select([name]), sums)))
    except DataError:
        return {}


def _first(reading: Harmonics) -> Iterator[tuple[str, complex]]:
    for row, name in enumerate(reading.channel_names):
        value = complex(*reading.coefficients[row, 1:3])
        if name in CHECKED and value == value and reading.units[row] in (*_UNITS, ""):
            yield name, value
