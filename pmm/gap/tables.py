"""The columns of what ``pmm gap`` shows of a campaign, and how their cells are written."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from analysis.gap.judge.marginal import Marginal
from pmm.document.content import Column, Table, data_only, number, word
from pmm.document.notation import NOT_KNOWN, percent, written
from pmm.gap.coefficients import CoefficientRow
from pmm.gap.steps import StepRow
from pmm.gap.words import joined


@dataclass(frozen=True)
class RankedAnswer:
    """One answer with its probability.

    Attributes
    ----------
    withheld_u
        The gap that it leaves of withheld regimes or runs, in u, noise taken off; NaN where it
        foretells none.
    alike
        Effects that these runs cannot tell from it, with the sigma that they leave.
    measure
        What would tell them apart.
    """

    answer: str
    probability: float
    withheld_u: float
    stage: str
    effects: list[dict[str, Any]]
    alike: dict[str, float]
    measure: list[str]


@dataclass(frozen=True)
class ControlRow:
    """How one answer does on the withheld runs; gaps in u with the noise floor taken off.

    Attributes
    ----------
    low, high
        95 % interval of ``share``; NaN for one regime alone, whose scatter nobody knows.
    """

    what: str
    before_u: float
    after_u: float
    share: float
    low: float
    high: float


@dataclass(frozen=True)
class RegimeRow:
    """One withheld regime: root mean square in u without and with each answer; NaN for none."""

    regime: str
    before: float
    after: float
    second_best: float
    polynomial: float


_TWO: Final = written(".2f")
_FOUR: Final = written(".4f")

STEPS: Final[tuple[Column[StepRow], ...]] = (
    Column("verdict", lambda row: row.verdict),
    Column("largest", lambda row: row.largest),
    number("E/u as stated", "stated_u", lambda stated: "" if math.isnan(stated) else _TWO(stated)),
    number("E/u", "gap_u", _TWO),
    number("numbers", "count"),
    *data_only("beyond", "worst", "tells", "strained"),
)
RANKING: Final[tuple[Column[RankedAnswer], ...]] = (
    word("answer", "answer", joined),
    word("stage", "stage"),
    Column("parameters (95 %)", lambda row: "; ".join(parameters(row.effects))),
    number("probability", "probability", _FOUR),
    number("withheld", "withheld_u", _TWO, "u"),
    *data_only("effects", "alike", "measure"),
)
EFFECTS: Final[tuple[Column[Marginal], ...]] = (
    word("effect in any answer", "name"),
    word("stage", "stage"),
    Column("cannot be told from", lambda marginal: _alike(marginal)),
    number("probability", "probability", _FOUR),
    number("of its class", "class_probability", _FOUR),
    *data_only("size_sigma", "alike"),
)
CONTROLS: Final[tuple[Column[ControlRow], ...]] = (
    word("answer", "what"),
    number("gap before", "before_u", _TWO, "u"),
    number("after", "after_u", _TWO, "u"),
    Column("shrinks", lambda row: shrinks(row), number=True),
    Column("95 %", lambda row: interval(row), number=True),
    *data_only("share", "low", "high"),
)
REGIMES: Final = (
    word("withheld", "regime"),
    number("before", "before", _TWO, "u"),
    number("after", "after", _TWO, "u"),
    number("second best", "second_best", _TWO, "u"),
    number("polynomial", "polynomial", _TWO, "u"),
)
NEXT: Final[tuple[Column[dict[str, Any]], ...]] = (
    Column("run", lambda run: run["said"], "said"),
    Column("expected log odds", lambda run: run["gain_log_odds"], "gain_log_odds", written(".1f"),
           number=True),
    Column("tank time, min", lambda run: run["tank_time_min"], "tank_time_min", written(".1f"),
           number=True),
    Column(None, lambda run: run["run"], "run"),
    Column(None, lambda run: run["between"], "between"),
)  # fmt: skip


def steps(name: str, heading: str, rows: Sequence[StepRow], key: str) -> Table[StepRow]:
    """Return a table of steps of the walk, or of contrasts."""
    return Table(name, (word(heading, "what"), *STEPS), rows, key, filled=True)


def parameters(effects: Sequence[Mapping[str, Any]]) -> list[str]:
    """Return each parameter of an answer's effects with its interval, as people read it."""
    return [
        f"{name} = {_with_interval(value)}"
        for effect in effects
        for name, value in effect["parameters"].items()
    ]


def _with_interval(estimate: Mapping[str, float]) -> str:
    if estimate["low"] == estimate["high"]:  # not fitted
        return f"{estimate['value']:.4g}"
    return f"{estimate['value']:.4g} ({estimate['low']:.4g} to {estimate['high']:.4g})"


def _alike(marginal: Marginal) -> str:
    if math.isnan(marginal.class_probability):
        return "its absence"
    return ", ".join(f"{name} ({sigma:.1f} sigma left)" for name, sigma in marginal.alike.items())


def shrinks(row: ControlRow) -> str:
    """Return by how much a gap shrinks; a dash where there was none."""
    return percent("z.0f")(row.share if row.before_u > 0.0 else math.nan)


def interval(row: ControlRow) -> str:
    """Return the interval of that; a dash where nobody knows it."""
    if row.before_u <= 0.0 or math.isnan(row.low):
        return NOT_KNOWN
    return f"{100.0 * row.low:z.0f} to {percent('z.0f')(row.high)}"


def coefficient_columns(*, compared: bool) -> tuple[Column[CoefficientRow], ...]:
    """Return the columns of the coefficients; ``compared`` if they were fitted with an effect."""
    fitted: tuple[Column[CoefficientRow], ...] = (
        Column(
            "fitted without effect" if compared else "fitted",
            lambda row: f"{row.without:.6g} ± {2.0 * row.u_without:.2g}",
            number=True,
        ),
    )
    with_it: tuple[Column[CoefficientRow], ...] = (
        Column("with it", lambda row: f"{row.with_effect:.6g} ± {2.0 * row.u_with:.2g}",
               number=True),
        number("bias", "bias_u", written("+z.1f"), "u"),
    )  # fmt: skip
    return (
        Column("coefficient", lambda row: row.where),
        word("unit", "unit"),
        number("stated", "stated", written(".6g")),
        *fitted,
        *(with_it if compared else data_only("bias_u")),
        *data_only("name", "u_stated", "without", "u_without", "with_effect", "u_with", "speed_m_s",
                   "frequency_hz"),
    )  # fmt: skip
