"""What ``pmm gap --tolerances`` shows: the table of tolerances as it was used."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Final

import numpy as np

from analysis.gap.forward.problem import Problem
from analysis.gap.judge.diagnosis import problem_of
from analysis.gap.judge.verdict import coefficient_shift
from analysis.gap.observe.bands import MAINS_HZ
from pmm.document.content import Document, Section, Table, Text, number, word
from pmm.document.notation import written
from pmm.gap.case import stated_tolerances
from pmm.gap.examination import Options
from pmm.gap.own_effects import chosen_effects
from pmm.gap.preparation import PreparedCampaign, campaign_file, prepare

SCHEMA: Final = "pmm-gap-tolerances-1"
_LEARNT: Final = 0.9  # tolerances: a number known no better afterwards was not shown by these runs
_STATED: Final = "stated in "
_AS_USUAL: Final = "default: "
_COMMANDED: Final = "commands and measured positions"
_SAID: Final = (
    "Standard deviations about what the campaign states; what stays within them is no gap. Moved: "
    "by how many tolerances each number is off from what is stated, with its standard uncertainty, "
    "where these runs show it and nothing else explains them."
)

NUMBERS: Final[Mapping[str, tuple[str, ...]]] = {
    "added_mass_relative": ("a11", "a22"),
    "damping_relative": ("b11", "b22"),
    "restoring_relative": ("c11", "c22"),
    "coupling_relative": ("a12", "a21", "b12", "b21", "c12", "c21"),
    "mass_relative": ("mass_kg",),
    "inertia_relative": ("inertia_kg_m2",),
    "cg_m": ("cg_x_m", "cg_z_m"),
    "gain_relative": ("gain aft", "gain fore"),
    "zero_n": ("zero aft", "zero fore"),
    "eccentricity_m": ("eccentricity aft", "eccentricity fore"),
    "strut_phase_rad": ("strut phase",),
    "photocell_angle_rad": ("photocell",),
    "carriage_speed_relative": ("carriage speed",),
    "ripple_1_relative": ("ripple 1 sine", "ripple 1 cosine"),
    "ripple_2_relative": ("ripple 2 sine", "ripple 2 cosine"),
    "load_ripple_1_kg_m2": ("load ripple",),
    "warming_k_h": ("warming",),
    "warming_n_s": ("drift aft", "drift fore"),
    "hum_n": tuple(
        f"hum {side} {mains_hz:g} Hz" for side in ("aft", "fore") for mains_hz in MAINS_HZ
    ),
}
"""The free numbers that each tolerance is of, by its key; no others have a name."""


@dataclass(frozen=True)
class ToleranceRow:
    """One tolerance.

    Attributes
    ----------
    source
        The file that states it, or where the default comes from.
    moved
        Of the numbers that it is of, those that these runs show: by how many ``"tolerances"`` they
        are off, and ``"u"``, one standard uncertainty.
    """

    key: str
    value: float
    unit: str
    meaning: str
    source: str
    moved: Mapping[str, Mapping[str, float]]


_COLUMNS: Final = (
    word("tolerance", "key"),
    word("of", "meaning"),
    number("value", "value", written(".4g")),
    word("unit", "unit"),
    word("from", "source"),
    word("moved [tolerances]", "moved", lambda moved: ", ".join(_moved(moved))),
)


def tolerance_document(folder: Path, options: Options) -> Document:
    """Return a campaign's tolerances.

    Raises
    ------
    ConfigurationError
        If the campaign, the case, an option or an effect of the user's own is wrong.
    DataError
        If fewer than three runs can be used, or a channel is in other units in all of them.
    """
    kinds, more = chosen_effects(options.effects, options.without)
    ready = prepare(folder, kinds, more, options.sensors, options.hold_out)
    rows = tuple(_rows(ready, campaign_file(folder)))
    table = Table("Tolerances", _COLUMNS, rows, "tolerances")
    stated = sum(row.source.startswith(_STATED) for row in rows)
    said = f"{stated} of {len(rows)} tolerances are stated, the others are as usual."
    section = Section("", (Text((said,), strong=True), Text((_SAID,)), table))
    return Document(ready.campaign.name, "what may be off without a gap", (section,), SCHEMA)


def _rows(ready: PreparedCampaign, file: Path) -> Iterator[ToleranceRow]:
    tolerances, stated = ready.case.tolerances, stated_tolerances(file)
    problem = problem_of(ready.recentred.rig, ready.fitted, ready.settings, ready.recentred.free)
    moved = _shown_shifts(problem)
    commanded = {setting.key for setting in ready.commanded}
    for tolerance in fields(tolerances):
        metadata = tolerance.metadata
        where = f"{_STATED}{stated[tolerance.name][1]}" if tolerance.name in stated else ""
        where = _COMMANDED if tolerance.name in commanded else where
        yield ToleranceRow(
            tolerance.name,
            getattr(tolerances, tolerance.name),
            metadata["unit"],
            metadata["meaning"],
            where or _AS_USUAL + metadata["source"],
            {name: moved[name] for name in NUMBERS.get(tolerance.name, ()) if name in moved},
        )


def _shown_shifts(problem: Problem) -> dict[str, dict[str, float]]:
    """Return by how many tolerances each number that these runs show is off, and how sure that is.

    Beside all others that may be off.
    """
    columns = problem.nuisances.columns
    covariance = np.linalg.inv(np.eye(columns.shape[1]) + columns.T @ columns)
    spread = np.sqrt(np.diagonal(covariance))
    pairs = zip(coefficient_shift(problem).items(), spread.tolist(), strict=False)
    return {name: {"tolerances": off, "u": u} for (name, off), u in pairs if u < _LEARNT}


def _moved(moved: Mapping[str, Mapping[str, float]]) -> Iterator[str]:
    for name, shift in moved.items():
        yield f"{name} {shift['tolerances']:+.2f} ± {shift['u']:.2f}"
