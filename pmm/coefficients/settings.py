"""``coefficients.toml``: what a campaign's recordings do not tell and its coefficients need."""

from copy import deepcopy
from dataclasses import dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import Any, Final, Literal

from analysis.coefficients.names import Form
from analysis.coefficients.quoting import Names, Quoting
from analysis.coefficients.roll_decay import RollDecay
from analysis.coefficients.stated_uncertainties import StatedUncertainties
from analysis.water import Water
from hardware.description.errors import ConfigurationError
from hardware.description.toml import is_number
from hardware.description.units import STANDARD_GRAVITY_M_S2
from pmm.coefficients.decay_file import fill_decays
from pmm.configuration import STRICT_TABLE, Fault, as_error, limit_faults, read_toml, validate

SETTINGS_FILE: Final = "coefficients.toml"
MODEL: Final = "model"
DRY: Final = "dry"

_FRESH_KG_M3: Final = 998.8
_PAIR = "should be two rows of two numbers"


class System(StrEnum):
    """A system that a table of coefficients is in."""

    DIMENSIONAL = "dimensional"
    PRIME = "prime"
    MMG = "mmg"
    SEAKEEPING = "seakeeping"
    BIS = "bis"


@dataclass(frozen=True)
class ShipTable:
    """The model, as systems without dimensions and SIMMAN's description need it.

    Attributes
    ----------
    volume_m3
        Displaced; ``None`` takes the mass over the density.
    density_kg_m3
        Of the water; ``None`` takes the campaign's ``[water]``, or 998.8 where there is none.
    scale
        Ship over model; for a description alone.
    """

    length_m: float | None = None
    draught_m: float | None = None
    volume_m3: float | None = None
    density_kg_m3: float | None = None
    gravity_m_s2: float = STANDARD_GRAVITY_M_S2
    scale: float | None = None

    @property
    def density(self) -> float:
        """The density, kg/m3; that of fresh water of 17 degrees Celsius where nobody says."""
        return _FRESH_KG_M3 if self.density_kg_m3 is None else self.density_kg_m3

    def within(self, water: Water | None) -> "ShipTable":
        """Return the table with a water's density where it states none itself."""
        if water is None or self.density_kg_m3 is not None:
            return self
        return replace(self, density_kg_m3=water.density_kg_m3)


@dataclass(frozen=True)
class AmplifierTable:
    """What is known of one channel's amplifier and sampling; taken out of its harmonics.

    Attributes
    ----------
    lag_s, gain
        By how much it is late, and what it reads over the truth.
    cutoff_hz, order, kind
        Of its low-pass filter, if it has one: ``"butterworth"`` or ``"bessel"``.
    """

    lag_s: float = 0.0
    gain: float = 1.0
    cutoff_hz: float | None = None
    order: int = 1
    kind: str = "butterworth"


@dataclass(frozen=True)
class ReferenceFile:
    """A table from elsewhere; see :mod:`pmm.coefficients.references`.

    Attributes
    ----------
    allowance_relative
        Uncertainty of the table itself.
    speed_m_s
        Where the file does not say it.
    body
        Which one of a table with several hulls.
    density_kg_m3, length_m, first_column
        Of WAMIT's tables; see :class:`sim.model.water.radiation_file.RadiationFile`.
    """

    file: str
    name: str | None = None
    allowance_relative: float = 0.0
    speed_m_s: float = 0.0
    body: str | None = None
    rotation_sign: int = 1
    density_kg_m3: float | None = None
    length_m: float = 1.0
    first_column: Literal["period", "frequency"] = "period"


@dataclass(frozen=True)
class DecayTable:
    """Standard uncertainties of metacentric height and inertia of ``[heel]``."""

    u_gm_m: float = 0.0
    u_inertia_kg_m2: float = 0.0


@dataclass(frozen=True)
class CoefficientSettings:
    """How a campaign's coefficients are had.

    Attributes
    ----------
    form, wanted, level, system
        As in :class:`analysis.coefficients.campaign_plan.Request`, and the table's system.
    names, with_mass
        How the table is quoted, as in :class:`analysis.coefficients.quoting.Quoting`.
    inertia
        ``"model"`` (the campaign's own table), ``"dry"`` (its runs in air), or a file that
        ``pmm inertia`` wrote; ``None`` takes the model, else dry runs.
    harmonics
        Highest that is resolved. Terms are fitted to three; the others are what a large angle mixes
        into these: with 7 a yaw of 25 degrees leaves 1e-6 of a coefficient, with 3 some percent.
    leave_out
        Names of runs that are not used.
    point_ahead_m
        Of the midpoint between the struts: where the coefficients are wanted.
    restoring
        Hydrostatic, about the midpoint; ``None`` takes that of ``[hull]``.
    calibration
        File of ``pmm evaluate`` whose matrix is applied.
    calibration_matrix
        The same by hand: force for a reading, aft and fore.
    roll_decays
        What K_p and K_pdot come from.
    decays
        What is uncertain of the model in the free decays that were recorded.
    steady_turns
        File of runs on a circle, as :class:`analysis.coefficients.steady_turns.SteadyTurn`.
    uncertainty
        Standard uncertainties; what is 0 here is taken from the campaign where it says more.
    """

    form: Form = Form.MANOEUVRING
    wanted: tuple[str, ...] = ()
    level: float = 0.95
    system: System = System.DIMENSIONAL
    names: Names = Names.PLAIN
    with_mass: bool = False
    inertia: str | None = None
    harmonics: int = 7
    leave_out: tuple[str, ...] = ()
    point_ahead_m: float = 0.0
    restoring: tuple[tuple[float, ...], ...] | None = None
    calibration: str | None = None
    calibration_matrix: tuple[tuple[float, ...], ...] | None = None
    nonlinear: bool = True
    zero_frequency: bool = True
    trials: int = 0
    seed: int = 0
    ship: ShipTable = field(default_factory=ShipTable)
    uncertainty: StatedUncertainties = field(default_factory=StatedUncertainties)
    amplifiers: dict[str, AmplifierTable] = field(default_factory=dict)
    references: tuple[ReferenceFile, ...] = ()
    roll_decays: tuple[RollDecay, ...] = ()
    decays: DecayTable = field(default_factory=DecayTable)
    steady_turns: str | None = None

    __pydantic_config__ = STRICT_TABLE

    @property
    def quoting(self) -> Quoting:
        """How the table is quoted."""
        return Quoting(self.names, self.with_mass)


def read_settings(path: Path) -> CoefficientSettings:
    """Read a settings file; files that it names lie beside it.

    Raises
    ------
    ConfigurationError
        If it cannot be read, or for unknown keys, wrong types and impossible values: all errors of
        the file in one message.
    """
    table = read_toml(path)
    faults: list[Fault] = list(limit_faults(table))
    faults += _value_faults(table)
    resolved_table = _with_folder(table, path.parent)
    faults += fill_decays(resolved_table, path.parent)
    settings = validate(CoefficientSettings, resolved_table, faults)
    if settings is None or faults:
        raise as_error(path, faults, table)
    return settings


def settings_of(folder: Path, file: str | None) -> tuple[CoefficientSettings, Path | None]:
    """Return the settings of a campaign's folder, or those of the file that was given.

    It raises what :func:`read_settings` raises.
    """
    path = folder / SETTINGS_FILE if file is None else Path(file)
    if file is None and not path.exists():
        return CoefficientSettings(), None
    return read_settings(path), path


def _value_faults(table: dict[str, Any]) -> list[Fault]:
    faults = []
    uncertainties = table.get("uncertainty")
    for key, value in uncertainties.items() if isinstance(uncertainties, dict) else ():
        if is_number(value) and value < 0.0:
            faults.append(Fault(("uncertainty", key), f"= {value:g} should be 0 or more"))
    pairs = ("restoring", "calibration_matrix")
    faults += [Fault((key,), _PAIR) for key in pairs if key in table and not _is_pair(table[key])]
    level = table.get("level")
    if is_number(level) and not 0.0 < level < 1.0:
        faults.append(Fault(("level",), f"= {level:g} is no probability between 0 and 1"))
    return faults


def _is_pair(value: Any) -> bool:
    rows = value if isinstance(value, list) else []
    return len(rows) == 2 and all(
        isinstance(row, list) and len(row) == 2 and all(map(is_number, row)) for row in rows
    )


def _with_folder(table: dict[str, Any], folder: Path) -> dict[str, Any]:
    """Return the table with the files that it names seen from here."""
    resolved_table = deepcopy(table)
    for key in ("inertia", "calibration", "steady_turns"):
        if isinstance(resolved_table.get(key), str) and resolved_table[key] not in (MODEL, DRY):
            resolved_table[key] = str(folder / resolved_table[key])
    references = resolved_table.get("references")
    for reference in references if isinstance(references, list) else []:
        if isinstance(reference, dict) and isinstance(reference.get("file"), str):
            reference["file"] = str(folder / reference["file"])
    return resolved_table


def check_trials(trials: int) -> None:
    """Refuse so few trials that an interval's ends are chance.

    Raises
    ------
    ConfigurationError
        If there are any, but fewer than 1000.
    """
    if 0 < trials < 1000:
        raise ConfigurationError(
            f"{trials} trials: the ends of a 95 % interval would rest on "
            f"{max(1, trials // 40)} of them; take 1000 or more"
        )
