"""One row of the table of a plan's checks."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Check:
    """One row.

    Attributes
    ----------
    quantity
        What is looked at, with its unit; words in braces depend on plane or gauge.
    limit
        The verdict and where it begins, in words; ``{0}``, ``{1}`` stand for :attr:`numbers`.
    source
        Whose limit it is.
    reason
        Why, or what to do about it.
    moved
        What half the limit, or twice the limit, does.
    numbers
        Limits that do not come from the rig's file.
    """

    quantity: str
    limit: str
    source: str
    reason: str
    moved: str
    numbers: tuple[float, ...] = ()


Peak = tuple[Check, float, float, float, str]
"""What is looked at, its value, between which limits, and whose they are, with the place."""
