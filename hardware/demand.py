"""A question to the operator that also says in numbers what it asks for.

A person reads the text. An operator that is a program (that of a simulated rig) reads the rest, so
that no program has to understand sentences.
"""


class Demand(str):
    """A question with what is to be done.

    Attributes
    ----------
    part
        What is to be changed: an axis by its name, ``"carriage"``, ``"medium"``, ``"mass"``,
        ``"release"`` (the heel that the model is let go from, 0 where it is held again), or
        ``"load"`` of the channel in :attr:`channel`; ``"lines"``, whose value is a JSON list of
        :class:`hardware.description.lines.Line`.
    value
        The wanted value in SI units (a word for the medium); ``None`` where something is read only.
    per_unit
        Divisions of the answer per SI unit: 1000 where millimetres are read off a dial.
    channel
        The gauge that a load is for.
    at_m
        Where a mass goes, forward of the midpoint between the struts.
    turn_rate_rad_s
        Of the circle that a carriage drives, positive to starboard; 0 for a straight way.
    """

    __slots__ = ("at_m", "channel", "part", "per_unit", "turn_rate_rad_s", "value")

    part: str
    value: float | str | None
    per_unit: float
    channel: str
    at_m: float
    turn_rate_rad_s: float

    def __new__(
        cls,
        text: str,
        part: str,
        value: float | str | None = None,
        per_unit: float = 1.0,
        channel: str = "",
        at_m: float = 0.0,
        turn_rate_rad_s: float = 0.0,
    ) -> "Demand":
        """Make a question from its text and what it asks for."""
        made = super().__new__(cls, text)
        made.part, made.value, made.per_unit = part, value, per_unit
        made.channel, made.at_m, made.turn_rate_rad_s = channel, at_m, turn_rate_rad_s
        return made
