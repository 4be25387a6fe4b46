"""The shape of every job that swings or hangs a body: read, measure, gather, conclude."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Generic, TypeVar

from analysis.inertia.hanging import HangingCentre
from analysis.inertia.lengthening import Lengthening
from analysis.inertia.result import MassProperties
from analysis.uncertainty.budget import Budget
from analysis.uncertainty.estimate import Estimate
from analysis.uncertainty.redundancy import Redundancy
from hardware.description.errors import ConfigurationError
from hardware.description.flags import Flag
from hardware.description.oscillator import Plane
from pmm.inertia.job_table import JobTable
from pmm.inertia.outcome import Finding, Outcome, PlaneAxes, StaticTest, compare, without_repeats
from pmm.inertia.properties import properties
from pmm.inertia.reading import Job, read_job
from pmm.inertia.sketch import Sketch
from pmm.inertia.sources import PeriodRuns, read_period
from pmm.inertia.stated_values import flags_of

_PICTURES: Final = (".jpg", ".jpeg", ".png")

TableT = TypeVar("TableT", bound=JobTable)


@dataclass
class Experiment(Generic[TableT]):
    """What a job has found so far, and the outcome that it ends in.

    Attributes
    ----------
    missing
        What the mass properties lack while ``body`` is ``None``.
    sketches
        Its set-ups, as far as the geometry is known.
    centre
        Of gravity by plumb lines, once they are asked for.
    """

    job: Job[TableT]
    findings: list[Finding] = field(default_factory=list)
    flags: list[Flag] = field(default_factory=list)
    periods: list[PeriodRuns] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)
    redundancy: list[Redundancy] = field(default_factory=list)
    statics: list[StaticTest] = field(default_factory=list)
    sketches: list[Sketch] = field(default_factory=list)
    centre: HangingCentre | None = None
    body: MassProperties | None = None
    missing: tuple[str, ...] = ()

    @classmethod
    def of(cls, path: str, kind: type[TableT]) -> "Experiment[TableT]":
        """Read a job's file; its stated air and gravity may have flags already.

        Raises
        ------
        ConfigurationError
            If the file is wrong.
        """
        job = read_job(path, kind)
        return cls(job, flags=[*flags_of(job.table)])

    @property
    def table(self) -> TableT:
        """What the job's file says."""
        return self.job.table

    @property
    def photo(self) -> Path | None:
        """The file's picture of the set-up.

        Raises
        ------
        ConfigurationError
            If it is not there, or no picture that is shown.
        """
        if self.table.photo is None:
            return None
        path = self.job.path_beside(self.table.photo)
        if path.suffix.lower() not in _PICTURES:
            raise ConfigurationError(
                f"{self.job.path}: photo {self.table.photo}: name a file {' or '.join(_PICTURES)}"
            )
        if not path.is_file():
            raise ConfigurationError(f"{self.job.path}: photo {path}: there is no such file")
        return path

    def period(
        self, source: Any, where: str, *, lengthens: Lengthening | None = None
    ) -> PeriodRuns:
        """Read a period of the file, with its flags.

        Raises
        ------
        ConfigurationError, DataError
            If it is not there, or its records do not carry it.
        """
        runs = read_period(self.job, source, where, lengthens=lengthens)
        self.periods.append(runs)
        self.flags += runs.flags
        return runs

    def plumb(self) -> None:
        """Take the centre of gravity from the plumb lines, where the file has them."""
        if self.table.hanging is None:
            return
        self.centre = self.table.hanging.centre()
        self.findings += [
            Finding("cg_x_m", "CG forward of the datum, by plumb lines", self.centre.x),
            Finding("cg_z_m", "CG below the datum, by plumb lines", self.centre.z),
        ]
        self.flags += self.centre.redundancy.flags()

    def weigh(
        self,
        gyradii: Mapping[str, Estimate],
        budgets: Sequence[Budget],
        flags: Sequence[Flag],
        cg_z: Estimate | None = None,
    ) -> None:
        """Bring gyradii by axis, mass and centre of gravity together, or note what is missing."""
        self.body, self.missing = properties(
            self.table.name,
            self.table.model,
            gyradii,
            take_off=self.table.take_off,
            budgets=budgets,
            flags=flags,
            centre=self.centre,
            cg_z=cg_z,
        )

    def outcome(
        self,
        name: str,
        plane: Plane | None,
        *,
        next_step: str | None = None,
        axes: PlaneAxes | None = None,
    ) -> Outcome:
        """Return all that was found, held against the file's targets.

        Parameters
        ----------
        name
            Of the job: ``swing``, ``bifilar`` or ``pendulum``.
        plane
            That was measured; the file may name another one.

        Raises
        ------
        ConfigurationError
            If a target names what was not found.
        """
        table, centre = self.table, self.centre
        return Outcome(
            name,
            table.name,
            tuple(self.findings),
            without_repeats(self.flags),
            tuple(self.periods),
            self.body,
            self.missing,
            table.plane or plane,
            compare(self.findings, table.targets),
            tuple(self.notes),
            next_step,
            axes=axes,
            statics=tuple(self.statics),
            redundancy=(*self.redundancy, *((centre.redundancy,) if centre else ())),
            sketches=tuple(self.sketches),
            photo=self.photo,
        )
