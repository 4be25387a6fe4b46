"""A campaign beside a table from elsewhere: strip theory, a panel method, CFD, another tank."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from analysis.coefficients.campaign_records import LINEAR, ZERO_FREQUENCY, ReferenceRow
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.hull_coefficients import coefficients_by_name
from analysis.coefficients.names import Form
from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from hardware.description.oscillator import Plane


@dataclass(frozen=True, eq=False)
class ReferenceTable:
    """Coefficients over frequency at one speed.

    Attributes
    ----------
    name
        Of the method, for the report.
    normalisation
        The system of the values; it has to be the campaign's.
    frequency_hz
        Shape ``(k,)``, rising; a single 0 for derivatives at zero frequency.
    values
        By coefficient, shape ``(k,)``.
    allowance_relative
        Uncertainty of the table itself, relative: the measured interval is widened by it.
    """

    name: str
    speed_m_s: float
    normalisation: str
    frequency_hz: FloatArray
    values: Mapping[str, FloatArray]
    allowance_relative: float = 0.0

    def __post_init__(self) -> None:
        """Refuse a table whose frequencies do not rise or whose columns differ in length.

        Raises
        ------
        DataError
            Naming the column.
        """
        frequency = np.asarray(self.frequency_hz)
        if frequency.size == 0 or (np.diff(frequency) <= 0.0).any():
            raise DataError(f"{self.name}: its {frequency.size} frequencies have to rise")
        for name, column in self.values.items():
            if np.shape(column) != frequency.shape:
                raise DataError(
                    f"{self.name}: {name} has {np.size(column)} values for {frequency.size} "
                    "frequencies"
                )

    def at(self, name: str, frequency_hz: float) -> float | None:
        """Return a value between the table's frequencies; ``None`` outside: no extrapolation."""
        from scipy.interpolate import PchipInterpolator

        low, high = self.frequency_hz[0], self.frequency_hz[-1]
        margin = 1e-3 * max(abs(low), abs(high))
        if name not in self.values or not low - margin <= frequency_hz <= high + margin:
            return None
        if len(self.frequency_hz) == 1:
            return float(self.values[name][0])
        inside = min(max(frequency_hz, low), high)
        return float(PchipInterpolator(self.frequency_hz, self.values[name])(inside))


def table_of_matrices(
    name: str,
    plane: Plane,
    frequency_hz: Sequence[float],
    added_mass: FloatArray,
    damping: FloatArray,
    *,
    form: Form = Form.SEAKEEPING,
    speed_m_s: float = 0.0,
    allowance_relative: float = 0.0,
) -> ReferenceTable:
    """Return a table of added mass and damping, each ``(k, 2, 2)``, in SI units.

    As panel methods give them; in the manoeuvring form with the opposite sign.
    """
    values = coefficients_by_name(added_mass, damping, plane, form)
    return ReferenceTable(
        name, speed_m_s, "dimensional", np.asarray(frequency_hz), values, allowance_relative
    )


def compare(coefficients: CampaignCoefficients, table: ReferenceTable) -> CampaignCoefficients:
    """Return the campaign with the table's values beside its own: linear and zero frequency.

    Raises
    ------
    ConfigurationError
        If the systems differ.
    DataError
        If the table has nothing for any of the campaign's entries.
    """
    if table.normalisation != coefficients.normalisation:
        raise ConfigurationError(
            f"{table.name} is in the system {table.normalisation!r}, the campaign in "
            f"{coefficients.normalisation!r}; bring both to one"
        )
    half, rows = coefficients.half_widths, []
    for k, entry in enumerate(coefficients.entries):
        same_speed = abs(entry.speed_m_s - table.speed_m_s) <= 0.02 * max(table.speed_m_s, 0.01)
        if entry.method not in (LINEAR, ZERO_FREQUENCY) or not same_speed:
            continue
        expected = table.at(entry.name, entry.frequency_hz)
        if expected is not None:
            rows.append(_row(coefficients, k, float(half[k]), table, expected))
    if not rows:
        raise DataError(
            f"{table.name} ({', '.join(table.values)}; {table.frequency_hz[0]:g} to "
            f"{table.frequency_hz[-1]:g} Hz, {table.speed_m_s:g} m/s) has nothing of what the "
            "campaign measured; check names, frequencies and speed"
        )
    return replace(coefficients, references=(*coefficients.references, *rows))


def _row(
    coefficients: CampaignCoefficients, k: int, half: float, table: ReferenceTable, expected: float
) -> ReferenceRow:
    entry, measured = coefficients.entries[k], float(coefficients.values[k])
    allowance = table.allowance_relative * abs(expected)
    return ReferenceRow(
        entry.name,
        entry.unit,
        entry.frequency_hz,
        entry.speed_m_s,
        table.name,
        measured,
        half,
        expected,
        measured - expected,
        allowance,
        bool(abs(measured - expected) <= np.hypot(half, allowance)),
    )
