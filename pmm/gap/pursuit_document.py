"""How a pursuit went, as a document."""

from collections.abc import Sequence
from typing import Final

from pmm.document.content import Data, Document, Section, Table, Text, data_only, number, word
from pmm.gap.pursuit_rounds import Look, Pursuit

SCHEMA: Final = "pmm-gap-pursue-1"


def pursuit_document(name: str, pursuit: Pursuit) -> Document:
    """Return what was known after each round, and how the pursuit ended."""
    columns = (
        number("runs", "runs"),
        word("answer", "answer"),
        number("probability", "probability", "{:.3f}".format),
        number("of its class", "class_probability", "{:.3f}".format),
        word("next", "proposed", proposed_text),
        *data_only("verdict", "said"),
    )
    said = pursuit.looks[-1].said if pursuit.looks else ()
    contents = (
        Text(said),
        Text((pursuit.remark,), strong=True),
        Table("rounds", columns, pursuit.looks, key="rounds"),
        Data("ending", pursuit.ending),
        Data("remark", pursuit.remark),
        Data("measures", pursuit.measures),
    )
    return Document(name, "pursuit of the gap", (Section("", contents),), SCHEMA)


def proposed_text(proposed: Sequence[tuple[str, float]]) -> str:
    """Return proposed runs with what they are worth, in words."""
    return "; ".join(f"{what} ({gain:.1f} log odds)" for what, gain in proposed) or "-"


def look_lines(look: Look) -> tuple[str, ...]:
    """Return what people read of a look before they approve of the next runs."""
    return (*look.said, f"Proposed: {proposed_text(look.proposed)}")
