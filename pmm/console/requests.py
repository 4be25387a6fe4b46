"""What the page may post: each a frozen model that takes nothing it does not know."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from pmm.console.limits import LARGEST_PLAN
from pmm.run.states import Command


class Posted(BaseModel):
    """The body of a request."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class CommandPosted(Posted):
    """A command to run control."""

    command: Command


class AnswerPosted(Posted):
    """An answer to the rig's question, which is named so that no other one gets it."""

    question: str = Field(max_length=2000)
    answer: str = Field(max_length=1000)  # an approval names runs by their numbers


class PlanPosted(Posted):
    """A plan: the name of a file, or the text of one."""

    name: str = Field(default="", max_length=200)
    text: str = Field(default="", max_length=LARGEST_PLAN)


class DropPosted(Posted):
    """The number of a plan that is to be taken out of the queue."""

    number: int = Field(ge=1)


class RunPosted(Posted):
    """What is to be changed of a queued plan: of one of its runs, or of the whole plan."""

    number: int = Field(ge=1)
    run: str = Field(default="", max_length=200)


class EditPosted(RunPosted):
    """Other settings of a planned run; what is not given stays."""

    run: str = Field(min_length=1, max_length=200)
    frequency_hz: float | None = None
    eccentricity_m: float | None = None
    strut_phase_rad: float | None = None
    carriage_speed_m_s: float | None = None
    drift_rad: float | None = None
    periods: int | None = None


class MovePosted(RunPosted):
    """By how many places a run, or a plan that waits, is moved: later, or earlier if negative."""

    by: int = Field(ge=-10_000, le=10_000)


class HoldPosted(RunPosted):
    """Whether a run, or all of a plan, is passed over until it is released."""

    held: bool


class NotePosted(RunPosted):
    """A line on a run, or on the campaign, kept beside its recordings."""

    text: str = Field(min_length=1, max_length=2000)
    author: str = Field(min_length=1, max_length=100)


class DecisionPosted(Posted):
    """The number of a proposal that is approved or refused."""

    number: int = Field(ge=1)


class TakePosted(Posted):
    """The wish to have control, said in so many words."""

    confirm: Literal[True]


class GivePosted(Posted):
    """Nothing: the session that gives control back is in the header."""


class TokenPosted(Posted):
    """The token, and the name that the log has for whoever gives it."""

    token: str = Field(max_length=500)
    name: str = Field(default="", max_length=100)


def validation_message(error: ValidationError) -> str:
    """Return what is wrong with a body in a line; what was posted is not repeated."""
    return "; ".join(
        f"{'.'.join(map(str, fault['loc'])) or 'body'}: {fault['msg']}"
        for fault in error.errors(include_url=False, include_input=False)
    )
