"""What was known after a run and what was decided then; the campaign's folder keeps all of it."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from enum import StrEnum
from pathlib import Path
from typing import Final

from hardware.description.errors import ConfigurationError
from hardware.description.kinds import Motion
from hardware.description.setpoint import Medium
from pmm.configuration import Fault, as_error, validate
from pmm.plan.run_plan import RunPlan
from pmm.whole_file import write_whole

DECISIONS: Final = "decisions.json"


class Ending(StrEnum):
    """Why a campaign needs no further runs, or gets none."""

    MET = "all targets are met"
    KNOWN = "the cause is known"
    TIME = "the time is used up"
    EXHAUSTED = "nothing left would help"
    REJECTED = "the operator did not approve"


@dataclass(frozen=True)
class KnownTarget:
    """How well one target is known.

    Attributes
    ----------
    name
        Of the coefficient, with frequency and speed where it holds at some.
    value, standard_uncertainty
        ``None`` where the runs do not determine it.
    wanted
        Largest standard uncertainty that meets it.
    mostly
        What most of its variance comes from, with its share; empty where that is not known.
    """

    name: str
    unit: str
    value: float | None
    standard_uncertainty: float | None
    wanted: float
    mostly: str = ""

    @property
    def met(self) -> bool:
        """Whether it is known as well as is wanted."""
        return self.standard_uncertainty is not None and self.standard_uncertainty <= self.wanted


@dataclass(frozen=True)
class KnownCause:
    """How probable one cause of a gap is.

    Attributes
    ----------
    name
        Its effects, or a verdict such as ``"none"`` or ``"unknown"``.
    probability
        Of the most probable cause with all that is alike, of the others by themselves.
    wanted
        Probability above which it is known.
    alike
        What these runs cannot tell from it.
    """

    name: str
    probability: float
    wanted: float
    alike: tuple[str, ...] = ()

    @property
    def met(self) -> bool:
        """Whether it is known."""
        return self.probability > self.wanted


@dataclass(frozen=True)
class Decision:
    """What was known, and what was decided.

    Attributes
    ----------
    runs
        Oscillations that were made and are complete, in their order.
    time_s
        Tank time of all runs made, as planned.
    kept
        Planned runs that stay, by name.
    added
        Runs that are planned anew, in words.
    left_s
        Tank time of the runs that are planned.
    approved
        Who approved of the change; empty where there was none.
    ending
        Of the campaign; empty where it goes on.
    remark
        The ending, or the reason of a change, in words.
    notes
        Runs that cannot be used, targets that cannot be met, and what repeats are taken to differ
        by, each in a sentence; of a gap what is said of it.
    causes
        Of a gap that is pursued, the most probable first.
    """

    runs: tuple[str, ...]
    time_s: float
    known: tuple[KnownTarget, ...]
    kept: tuple[str, ...] = ()
    added: tuple[str, ...] = ()
    left_s: float = 0.0
    approved: str = ""
    ending: str = ""
    remark: str = ""
    notes: tuple[str, ...] = ()
    causes: tuple[KnownCause, ...] = ()

    @property
    def is_decided(self) -> bool:
        """Whether nothing that was proposed waits for an answer."""
        return bool(self.approved or self.ending or not self.added)


@dataclass(frozen=True, eq=False)
class Look:
    """What a goal says after the runs that were made.

    Attributes
    ----------
    kept_runs
        Planned runs that stay; none where ``proposed`` takes their place.
    proposed, costs_s, reasons
        Runs that are to be planned anew, not named yet, the tank time that each adds with its zero
        and control runs, and why each is proposed; no reasons where all serve the same.
    left_s
        Tank time of all that is left to make then, runs that are made in any case among it.
    before, before_s
        Planned runs that ``proposed`` would take the place of, and their tank time.
    ending
        ``None`` where the campaign goes on.
    """

    runs: tuple[str, ...]
    time_s: float
    known_targets: tuple[KnownTarget, ...]
    kept_runs: tuple[RunPlan, ...] = ()
    proposed: tuple[RunPlan, ...] = ()
    costs_s: tuple[float, ...] = ()
    left_s: float = 0.0
    before: tuple[RunPlan, ...] = ()
    before_s: float = 0.0
    ending: Ending | None = None
    remark: str = ""
    notes: tuple[str, ...] = ()
    causes: tuple[KnownCause, ...] = ()
    reasons: tuple[str, ...] = ()

    @property
    def whys(self) -> tuple[str, ...]:
        """Why each run is proposed; empty texts where all serve the same."""
        return self.reasons or ("",) * len(self.proposed)

    @property
    def as_before(self) -> "Look":
        """The same with the plan as it was."""
        return replace(
            self, kept_runs=self.before, proposed=(), costs_s=(), reasons=(), left_s=self.before_s,
            remark="the plan stays",
        )  # fmt: skip

    def chosen(self, numbers: Sequence[int]) -> "Look | None":
        """Return the same with some of the proposed runs alone, in an order of one's own.

        Parameters
        ----------
        numbers
            Of the runs, from 1; ``None`` is returned where one is not proposed or stands twice.
        """
        if len(set(numbers)) < len(numbers) or not set(numbers) <= {
            *range(1, len(self.proposed) + 1)
        }:
            return None
        costs_s = tuple(self.costs_s[k - 1] for k in numbers)
        left_s = self.left_s - math.fsum(self.costs_s) + math.fsum(costs_s)
        return replace(
            self, proposed=tuple(self.proposed[k - 1] for k in numbers), costs_s=costs_s,
            reasons=tuple(self.reasons[k - 1] for k in numbers if self.reasons),
            left_s=left_s,
        )  # fmt: skip

    def decision(self, approved: str = "") -> Decision:
        """Return it as it is kept."""
        ended = self.ending
        return Decision(
            self.runs, self.time_s, self.known_targets, tuple(run.name for run in self.kept_runs),
            tuple(map(in_words, self.proposed)), self.left_s, approved,
            "" if ended is None else str(ended), self.remark, self.notes, self.causes,
        )  # fmt: skip


@dataclass(frozen=True)
class _DecisionFile:
    decisions: tuple[Decision, ...] = field(default_factory=tuple)


def in_words(run: RunPlan) -> str:
    """Return motion, settings and length of a run."""
    point = run.set_point
    words = [str(run.motion), f"{point.frequency_hz:g} Hz", f"{1e3 * point.eccentricity_m:.4g} mm"]
    if run.motion is Motion.PHASE:
        words += [f"strut phase {math.degrees(point.strut_phase_rad):.4g} deg"]
    words += ["in air"] if point.medium is Medium.AIR else []
    words += [f"{point.carriage_speed_m_s:g} m/s"] if point.carriage_speed_m_s else []
    words += [f"drift {point.drift_rad:.3g} rad"] if point.drift_rad else []
    return ", ".join([*words, f"{run.periods} periods"])


def read_decisions(folder: Path) -> tuple[Decision, ...]:
    """Return what was decided in a campaign's folder; nothing where no campaign chose its runs.

    Raises
    ------
    ConfigurationError
        If the file is damaged.
    """
    path = folder / DECISIONS
    if not path.is_file():
        return ()
    faults: list[Fault] = []
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
    except ValueError as error:
        raise ConfigurationError(f"{path}: damaged ({error}); take it out to go on") from error
    content = validate(_DecisionFile, table, faults) if isinstance(table, Mapping) else None
    if content is None or faults:
        raise as_error(path, faults or [Fault((), "holds no decisions")], {})
    return content.decisions


def keep_decision(folder: Path, decision: Decision) -> None:
    """Keep a decision in place of those after the same runs, or more.

    A plan that was approved of after the same runs and stays is no new decision: who was
    interrupted before the next run keeps what was decided.
    """
    before = read_decisions(folder)
    older = [entry for entry in before if len(entry.runs) < len(decision.runs)]
    same = [
        entry
        for entry in before
        if len(entry.runs) == len(decision.runs) and entry.is_decided and not entry.ending
    ]
    stays = bool(same) and not (decision.added or decision.ending)
    _write(folder, [*older, same[-1] if stays else decision])


def _write(folder: Path, decisions: Sequence[Decision]) -> None:
    text = json.dumps({"decisions": [asdict(decision) for decision in decisions]}, indent=1)
    write_whole(folder / DECISIONS, text + "\n")
