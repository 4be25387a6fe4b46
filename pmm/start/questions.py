"""What is asked before a first file is written, each with a default that works."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from hardware.description.errors import ConfigurationError

PLANES: Final = ("vertical", "horizontal")
AXES: Final = ("driven", "by-hand", "paths")


@dataclass(frozen=True)
class StartQuestion:
    """One question, which an option of the same name answers beforehand.

    Attributes
    ----------
    name
        Of the option and in the template, with its unit.
    default
        The answer of whoever does not know yet; its type is the answer's.
    choices
        The answers that are possible, where they are few.
    lowest
        Numbers have to be above it.
    """

    name: str
    text: str
    default: str | float
    choices: tuple[str, ...] = ()
    lowest: float | None = None

    def checked(self, answer: str | float) -> str | float:
        """Return an answer that can be.

        Raises
        ------
        ConfigurationError
            For a number that is not above ``lowest``, or none of ``choices``.
        """
        if self.choices and answer not in self.choices:
            choices = ", ".join(self.choices)
            raise ConfigurationError(f"{self.option} {answer}: should be one of {choices}")
        if isinstance(answer, float) and self.lowest is not None and not answer > self.lowest:
            raise ConfigurationError(f"{self.option} {answer:g}: should be above {self.lowest:g}")
        return answer

    @property
    def option(self) -> str:
        """The command line's name of it."""
        return f"--{self.name.replace('_', '-')}"


Ask = Callable[[StartQuestion], str | float]
NAME = StartQuestion("name", "What is it called", "first")
MODEL: Final = (
    StartQuestion("mass_kg", "Mass of the model with all below the gauges [kg]", 70.0, lowest=0.0),
    StartQuestion("inertia_kg_m2", "Its inertia about the midpoint of the struts [kg m2]", 27.5,
             lowest=0.0),
)  # fmt: skip
PLANE = StartQuestion("plane", "Plane of the oscillator: heave and pitch, or sway and yaw",
                      "vertical", PLANES)  # fmt: skip
SPACING = StartQuestion(
    "half_spacing_m", "Half the distance between the struts [m]", 0.5, lowest=0.0
)
RIG: Final = (
    NAME,
    PLANE,
    StartQuestion(
        "interface", "CAN interface (pmm-simulated: no hardware needed)", "pmm-simulated"
    ),
    StartQuestion("channel", "Its channel", "simulated.toml"),
    StartQuestion(
        "axes",
        "Eccentricity and strut phase are set (paths: each strut has a drive)",
        "driven",
        AXES,
    ),
    SPACING,
    *MODEL,
    StartQuestion("length_m", "Length of the model [m]", 2.5, lowest=0.0),
    StartQuestion("beam_m", "Its beam [m]", 0.36, lowest=0.0),
    StartQuestion("draught_m", "Its draught [m]", 0.13, lowest=0.0),
    StartQuestion("tank_length_m", "Length that the carriage may use [m]", 120.0, lowest=0.0),
    StartQuestion("tank_width_m", "Width of the tank [m]", 4.2, lowest=0.0),
    StartQuestion("tank_depth_m", "Depth of the water [m]", 2.5, lowest=0.0),
    StartQuestion("full_scale_n", "Full scale of a force gauge [N]", 500.0, lowest=0.0),
)
CAMPAIGN: Final = (NAME, PLANE, SPACING, *MODEL)
GRAVITY = StartQuestion("gravity_m_s2", "Gravity at the place [m/s2]", 9.81, lowest=0.0)
SWING: Final = (
    NAME,
    GRAVITY,
    StartQuestion("swing_mass_kg", "Mass of the empty swing [kg]", 42.28, lowest=0.0),
    StartQuestion("lever_m", "Lever of the tilting weights [m]", 0.2, lowest=0.0),
)
BIFILAR: Final = (
    NAME,
    GRAVITY,
    StartQuestion("half_spacing_m", "Half the distance between the lines [m]", 0.9, lowest=0.0),
    StartQuestion("line_m", "Length of the lines [m]", 3.477, lowest=0.0),
    StartQuestion("mass_kg", "Mass of what hangs on them [kg]", 603.2, lowest=0.0),
)
SHIP: Final = (
    NAME,
    StartQuestion("length_m", "Length of the model [m]", 2.5, lowest=0.0),
    StartQuestion("draught_m", "Its draught [m]", 0.1625, lowest=0.0),
    StartQuestion("mass_kg", "Its mass [kg]", 149.0, lowest=0.0),
    StartQuestion("inertia_kg_m2", "Its inertia about the vertical axis [kg m2]", 59.0, lowest=0.0),
    StartQuestion("speed_m_s", "Speed of the approach [m/s]", 0.7, lowest=0.0),
    StartQuestion("scale", "Ship over model", 128.0, lowest=0.0),
)
STEERING: Final = (
    StartQuestion("length_m", "Length of the model [m]", 7.0, lowest=0.0),
    StartQuestion("diameter_m", "Diameter of its propeller [m]", 0.216, lowest=0.0),
    StartQuestion("rudder_area_m2", "Area of its rudder [m2]", 0.0539, lowest=0.0),
    StartQuestion("rudder_height_m", "Height of its rudder [m]", 0.345, lowest=0.0),
)
JOBS: Final[Mapping[str, Sequence[StartQuestion]]] = {
    "rig": RIG,
    "campaign": CAMPAIGN,
    "swing": SWING,
    "bifilar": BIFILAR,
    "ship": SHIP,
    "steering": STEERING,
}


def answers(job: str, options: Mapping[str, Any], ask: Ask) -> dict[str, str | float]:
    """Return an answer to each question of a job: the one that was given, else that of ``ask``.

    Raises
    ------
    ConfigurationError
        If one cannot be.
    """
    replies: dict[str, str | float] = {}
    for question in JOBS[job]:
        option = options.get(question.name)
        if (
            option is None
            and question.name == "channel"
            and replies["interface"] != "pmm-simulated"
        ):
            question = StartQuestion("channel", question.text, "can0")
        replies[question.name] = question.checked(ask(question) if option is None else option)
    return replies
