"""What was found beside a campaign's values: forms, outliers, checks, arrangements, tables."""

from collections.abc import Iterator
from typing import Final

from analysis.coefficients.campaign_records import (
    ConsistencyCheck,
    FormChoice,
    OtherArrangement,
    Outlier,
    ReferenceRow,
)
from analysis.coefficients.campaign_result import CampaignCoefficients
from analysis.coefficients.form_choice import BEYOND_DOUBT
from pmm.document.content import Column, Content, Table, number, word
from pmm.document.notation import NOT_KNOWN, rounded, written
from pmm.report.coefficient_tables import frequency

_LIKELIHOOD = (
    "Evidence ratio: likelihood of the recordings under the other over that under what is stated. "
    "Moves are in half-widths."
)


def _ratio(value: float) -> str:
    """Return an evidence ratio; what is beyond any doubt is not counted out."""
    return f"over {BEYOND_DOUBT:g}" if value >= BEYOND_DOUBT else written(".3g")(value)


_FORMS: Final[tuple[Column[FormChoice], ...]] = (
    word("load", "load"),
    word("verdict", "verdict"),
    word("fitted", "fitted"),
    number("evidence ratio", "evidence_ratio", _ratio),
    word("runs", "runs", ", ".join),
    word("", "message"),
)
_OUTLIERS: Final[tuple[Column[Outlier], ...]] = (
    word("run", "run"),
    word("load", "load"),
    number("distance", "ratio", written(".3g"), "u"),
    number("limit", "limit", written(".3g")),
    word("", "message"),
)
_CHECKS: Final[tuple[Column[ConsistencyCheck], ...]] = (
    word("coefficient", "name"),
    word("unit", "unit"),
    number("first", "first_value", written(".5g")),
    number("second", "second_value", written(".5g")),
    Column("difference ± u",
           lambda check: f"{check.difference:+.2g} ± {check.standard_uncertainty:.2g}",
           number=True),
    Column("", lambda check: "agree" if check.agrees else "DIFFER"),
    Column("of", lambda check: f"{check.first}; {check.second}"),
)  # fmt: skip
_ARRANGEMENTS: Final[tuple[Column[OtherArrangement], ...]] = (
    word("key", "key"),
    word("stated", "stated"),
    word("other", "other"),
    word("the other", "verdict"),
    number("evidence ratio", "evidence_ratio", _ratio),
    number("largest move", "largest", written(".3g")),
    word("moved beyond half-width", "coefficients", lambda names: ", ".join(names) or NOT_KNOWN),
)
_REFERENCES: Final[tuple[Column[ReferenceRow], ...]] = (
    word("coefficient", "name"),
    word("unit", "unit"),
    number("f", "frequency_hz", frequency, "Hz"),
    number("U", "speed_m_s", written("g"), "m/s"),
    Column("measured", lambda row: rounded(row.measured, row.half_width), number=True),
    number("table", "expected", written(".5g")),
    number("off", "difference", written("+.3g")),
    Column("", lambda row: "within" if row.within else "OUTSIDE"),
    word("of", "reference"),
)


def findings(coefficients: CampaignCoefficients) -> Iterator[Content]:
    """Yield forms, outliers, what is missing, tables beside and checks, where there are any."""
    missing = (word("coefficient", "name"), word("why", "message"))
    yield Table("Which form the data support", _FORMS, coefficients.choices, titled=True)
    yield Table("Repeats that stand off", _OUTLIERS, coefficients.outliers, titled=True)
    yield Table("What these runs do not tell", missing, coefficients.missing, titled=True)
    yield from comparison_tables(coefficients)
    for kind in dict.fromkeys(check.kind for check in coefficients.checks):
        rows = [check for check in coefficients.checks if check.kind == kind]
        agree = sum(row.agrees for row in rows)
        name = f"Checks in SI units, {kind}: {agree} of {len(rows)} agree"
        yield Table(name, _CHECKS, rows, titled=True, folded=agree == len(rows))


def comparison_tables(coefficients: CampaignCoefficients) -> tuple[Content, ...]:
    """Return the values beside other arrangements' and tables' from elsewhere."""
    name = "Other arrangements of the rig"
    return (
        Table(name, _ARRANGEMENTS, coefficients.arrangements, titled=True, notes=(_LIKELIHOOD,)),
        Table("Beside tables from elsewhere", _REFERENCES, coefficients.references, titled=True),
    )
