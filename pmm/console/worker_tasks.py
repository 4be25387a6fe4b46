"""What the workers do for the server: plans are read, folders are looked at, texts are made."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from pathlib import Path

from hardware.description.errors import ConfigurationError
from pmm.archive.notebook import NoteLine, write_note
from pmm.console.encoding import EncodedText, encode
from pmm.console.pages import pages_in
from pmm.console.plans import CheckedPlan, Plans, plan_picture
from pmm.console.queue_journal import KeptPlan
from pmm.console.queued_plan import PackedPlan, pack, unpack
from pmm.console.requests import NotePosted, RunPosted
from pmm.recorder.files import is_run
from pmm.run.campaign_folder import check_names


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
    return _ready(plans.queue(name, text))


def possible_plan(plans: Plans, name: str, text: str) -> ReadyPlan:
    """Return a plan that might be run; raises as :func:`ready_plan` does, and keeps nothing."""
    return _ready(plans.possible(name, text))


def restored_plan(plans: Plans, plan: KeptPlan) -> ReadyPlan | None:
    """Return a plan as it was in the queue, or nothing if all its runs are complete.

    Raises
    ------
    ConfigurationError, PlanRefusedError
        If its file is another one or wrong by now, or the rig cannot run it any more.
    """
    checked = plans.queue(plan.name, "")
    if checked.waiting.plan.sha256 != plan.sha256:
        raise ConfigurationError(
            f"{checked.waiting.plan.path}: is not the file that was queued; look at what was "
            "changed, then queue it anew"
        )
    for change in plan.changes:
        checked = plans.changed(checked.waiting, change)
    waiting = checked.waiting
    return _ready(checked) if waiting.runs or waiting.chooses else None


def _ready(checked: CheckedPlan) -> ReadyPlan:
    return ReadyPlan(pack(checked.waiting), EncodedText(encode(plan_picture(checked))))


def changed_plan(plans: Plans, packed: PackedPlan, posted: RunPosted) -> ReadyPlan:
    """Return a queued plan with what was posted changed in it.

    Raises
    ------
    ConfigurationError, PlanRefusedError
        If that cannot be.
    """
    return _ready(plans.changed(unpack(packed), posted))


def keep_note(packed: PackedPlan, posted: NotePosted, utc: str) -> None:
    """Write a line on a run, or on the campaign, into the campaign's folder.

    Raises
    ------
    ConfigurationError
        If there is no such run, or the text is none of one line.
    """
    if posted.run and not is_run(packed.bare.folder / posted.run):
        check_names(unpack(packed).plan, [posted.run])
    write_note(packed.bare.folder, NoteLine(utc, posted.run, posted.author, posted.text))


def look_around(plans: Plans, folders: tuple[Path, ...]) -> tuple[list[str], dict[Path, list[str]]]:
    """Return the names of the plans, and the pages in each of the campaigns' folders."""
    return plans.names(), pages_in(folders)


class QueuedPlans:
    """Keeps plans by their numbers, which are never used twice.

    A plan has its runs, and its picture too, some megabytes. Both are kept while the plan is under
    way or waits, and until a frame tells of it; its folder is kept, for what was recorded there.
    """

    def __init__(self) -> None:
        self._plans: dict[int, ReadyPlan] = {}
        self._folders: dict[Path, None] = {}
        self._changes: dict[int, tuple[RunPosted, ...]] = {}
        self._order: tuple[int, ...] = ()
        self._count = self._told = 0

    @property
    def count(self) -> int:
        """The number that was given last."""
        return self._count

    def add(self, plan: ReadyPlan, changes: tuple[RunPosted, ...] = ()) -> int:
        """Keep a plan that is about to be queued; return its number.

        Parameters
        ----------
        changes
            Of its file, as they were made before.
        """
        self._count += 1
        self._plans[self._count] = replace(plan, packed=plan.packed.numbered(self._count))
        self._changes[self._count] = changes
        self._folders[plan.packed.bare.folder] = None
        return self._count

    def kept_plans(self) -> tuple[KeptPlan, ...]:
        """Return what is to be queued again after a restart, in the order of the queue."""
        later = [number for number in self._plans if number not in self._order]
        return tuple(
            self._kept_plan(number) for number in (*self._order, *later) if number in self._plans
        )

    def _kept_plan(self, number: int) -> KeptPlan:
        plan = self._plans[number].packed.bare.plan
        return KeptPlan(number, plan.path.name, plan.sha256, self._changes[number])

    def drop(self, number: int) -> None:
        """Forget a plan that was refused or taken out of the queue."""
        self._plans.pop(number, None)

    def plan(self, number: int) -> PackedPlan:
        """Return a plan that is at hand.

        Raises
        ------
        ConfigurationError
            If there is none of that number.
        """
        ready = self._plans.get(number)
        if ready is None:
            numbers = ", ".join(map(str, self._plans)) or "none"
            raise ConfigurationError(f"no plan {number} is in the queue; there are: {numbers}")
        return ready.packed

    def change(self, plan: ReadyPlan, posted: RunPosted) -> None:
        """Keep a plan as it is from now on, if it is still at hand."""
        number = plan.packed.bare.number
        if number in self._plans:
            self._plans[number] = plan
            self._changes[number] += (posted,)

    def at_hand(self, numbers: Collection[int]) -> None:
        """Forget the others, by what the latest frame tells of; it may not know the newest yet."""
        self._told, self._order = max(self._told, *numbers), tuple(numbers)
        self._plans = {
            number: plan
            for number, plan in self._plans.items()
            if number > self._told or number in numbers
        }
        self._changes = {number: self._changes[number] for number in self._plans}

    def folder(self, number: int) -> Path | None:
        """Return the folder of a plan that is at hand."""
        ready = self._plans.get(number)
        return None if ready is None else ready.packed.bare.folder

    def folders(self) -> list[Path]:
        """Return the folders of all campaigns that were queued, each once."""
        return list(self._folders)

    def pictures(self) -> dict[str, EncodedText]:
        """Return the pictures of the plans at hand, by their numbers."""
        return {str(number): plan.picture for number, plan in self._plans.items()}
