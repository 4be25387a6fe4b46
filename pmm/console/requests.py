"""What the page may post: each a frozen model that takes nothing it does not know."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field

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


class TakePosted(Posted):
    """The wish to have control, said in so many words."""

    confirm: Literal[True]


class TokenPosted(Posted):
    """The token."""

    token: str = Field(max_length=500)
