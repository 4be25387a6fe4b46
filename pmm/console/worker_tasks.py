"""What the workers do for the server: plans are read, folders are looked at, texts are made."""

from dataclasses import dataclass
from pathlib import Path

from pmm.console.encoding import EncodedText, encode
from pmm.console.messages import PackedPlan
from pmm.console.packing import pack
from pmm.console.pages import pages_in
from pmm.console.plans import Plans, plan_picture


@dataclass(frozen=True)
class ReadyPlan:
    """A plan that may be queued, and its picture."""

    packed: PackedPlan
    picture: EncodedText


def check_plan_text(plans: Plans, name: str, text: str) -> EncodedText:
    """Return the picture of a plan; raises ConfigurationError for what is wrong with it."""
    return EncodedText(encode(plan_picture(plans.check(name, text))))


def ready_plan(plans: Plans, name: str, text: str) -> ReadyPlan:
    """Return a plan that is to be run.

    Raises
    ------
    ConfigurationError, PlanRefusedError
        If it is wrong, or the rig cannot run it.
    """
    found = plans.queue(name, text)
    return ReadyPlan(pack(found.waiting), EncodedText(encode(plan_picture(found))))


def look_around(plans: Plans, folders: tuple[Path, ...]) -> tuple[list[str], dict[Path, list[str]]]:
    """Return the names of the plans, and the pages in each of the campaigns' folders."""
    return plans.names(), pages_in(folders)
