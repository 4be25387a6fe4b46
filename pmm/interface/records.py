"""What is opened: a recording, a campaign, a design or a pendulum test, and what it answers."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

from hardware.description.errors import ConfigurationError
from pmm.harmonics.request import HarmonicsRequest
from pmm.harmonics.sources import find_sources
from pmm.interface.arguments import Count, FilePath, Level, checked, text_of

if TYPE_CHECKING:
    from pmm.interface.coefficients import CoefficientsResult
    from pmm.interface.design import DesignResult
    from pmm.interface.gap import GapResult
    from pmm.interface.harmonics import HarmonicsResult
    from pmm.interface.inertia import InertiaResult

Job: TypeAlias = Literal["swing", "bifilar", "pendulum", "incline", "combine", "ballast", "plan"]


class RecordKind(StrEnum):
    """What lies at a path: a recording, a campaign, or a file of one of several kinds."""

    RECORDING = "a recording"
    CAMPAIGN = "a campaign"
    PENDULUM = "the file of a pendulum test"
    DESIGN = "the design of a plan"
    PLAN = "a plan, or the file of a simulated rig"
    RIG = "the file of a rig"


@dataclass(frozen=True)
class Records:
    """A recording, the recordings of a campaign or of a pendulum test, or a plan's design."""

    path: Path
    kind: RecordKind

    def _require(self, *kinds: RecordKind) -> None:
        if self.kind not in kinds:
            raise ConfigurationError(
                f"{self.path}: this is {self.kind}, and what you ask is told by "
                + " or ".join(kinds)
            )

    @checked
    def harmonics(
        self,
        *,
        reference: str | None = None,
        frequency_hz: float | None = None,
        edges_file: FilePath | None = None,
        channels: Sequence[str] = (),
        harmonics: int | None = None,
        gate_periods: int | None = None,
        opens_at_s: float | None = None,
        periods: int | None = None,
        take_out_drift: bool = True,
        local_polynomials: bool = False,
        response_to: str | None = None,
        lines: Sequence[int] = (),
        column_map: FilePath | None = None,
        calibration: FilePath | None = None,
        level: Level = 0.95,
    ) -> "HarmonicsResult":
        """Resolve into mean and harmonics, as ``pmm analyse`` does.

        Parameters
        ----------
        reference
            Channel that the phase is taken from; by default the photocell, else the encoder, else
            ``displacement_aft``, else ``displacement_fore``, else the set-point's frequency.
        frequency_hz
            A known frequency in its place.
        edges_file
            File of the photocell's edge times in its place.
        channels
            To resolve; by default all but the reference and the shaft angle.
        harmonics
            Highest order; 3 by default.
        gate_periods
            Periods of a gate; by default the steady stretch.
        opens_at_s, periods
            Where the first gate opens, and how many periods are used after it.
        take_out_drift
            Whether a linear drift is taken out.
        local_polynomials
            Whether what a transient leaks is taken off each harmonic.
        response_to, lines
            Channel on which the others' response is wanted, and the harmonics that it was given;
            by default those at which it moves.
        column_map
            TOML that says which column of a text file is what.
        calibration
            File of the gauges' calibration, or ``"none"``; by default the recording's own.
        level
            Probability of the intervals.

        Raises
        ------
        ConfigurationError
            If what is asked cannot be.
        DataError
            If the data say no; of a campaign, if they do for each run.
        """
        from pmm.interface.harmonics import harmonics_of

        self._require(RecordKind.RECORDING, RecordKind.CAMPAIGN)
        request = HarmonicsRequest(
            reference=reference,
            frequency=frequency_hz,
            edges=text_of(edges_file),
            channels=tuple(channels),
            harmonics=harmonics,
            gate=gate_periods,
            opens_at=opens_at_s,
            periods=periods,
            no_drift=not take_out_drift,
            local_polynomials=local_polynomials,
            response_to=response_to,
            lines=tuple(lines),
            column_map=text_of(column_map),
            calibration=text_of(calibration),
            level=level,
        )
        return harmonics_of(find_sources([str(self.path)]), request)

    @checked
    def coefficients(
        self,
        *,
        settings: FilePath | None = None,
        form: Literal["manoeuvring", "seakeeping"] | None = None,
        system: Literal["dimensional", "prime", "bis", "mmg", "seakeeping"] | None = None,
        names: Literal["plain", "abkowitz", "gertler-hagen"] | None = None,
        with_mass: bool = False,
        inertia: FilePath | None = None,
        wanted: Sequence[str] = (),
        leave_out: Sequence[str] = (),
        references: Sequence[FilePath] = (),
        trials: Count = 0,
        seed: Count | None = None,
        level: Level | None = None,
        jobs: int | None = 1,
    ) -> "CoefficientsResult":
        """Find added mass, damping and derivatives, as ``pmm coefficients`` does.

        Parameters
        ----------
        settings
            Settings file; ``coefficients.toml`` beside the campaign's if it is there.
        form, system, names, with_mass
            Names and signs; units; whose names and factors; whether the model's mass is added to
            the derivatives of yaw or pitch rate.
        inertia
            What is taken off: ``"model"``, ``"dry"`` or a file of ``pmm inertia``.
        wanted
            Coefficients that have to be there.
        leave_out
            Runs not to use.
        references
            Tables to hold the values against.
        trials, seed
            Of a Monte Carlo beside the linear budget; none if 0.
        level
            Probability of the intervals.
        jobs
            Processes; ``None`` takes one for each core, which a script has to guard by
            ``if __name__ == "__main__":``.

        Raises
        ------
        ConfigurationError, DataError
            As :func:`pmm.coefficients.workflow.coefficients_of` does.
        """
        from pmm.coefficients.request import campaign_folder
        from pmm.interface.coefficients import campaign_coefficients

        self._require(RecordKind.CAMPAIGN)
        options: dict[str, Any] = {
            "settings": text_of(settings),
            "form": form,
            "system": system,
            "names": names,
            "with_mass": with_mass,
            "inertia": text_of(inertia),
            "wanted": tuple(wanted),
            "leave_out": tuple(leave_out),
            "references": tuple(map(str, references)),
            "uncertainty": "monte-carlo" if trials else None,
            "trials": trials or None,
            "seed": seed,
            "level": level,
        }
        return campaign_coefficients(campaign_folder(str(self.path)), options, jobs)

    @checked
    def gap(
        self,
        *,
        effects: Sequence[str] = (),
        without: Sequence[str] = (),
        sensors: Sequence[str] = (),
        hold_out: Sequence[str] = (),
        jobs: int | None = 1,
    ) -> "GapResult":
        """Say where rig and simulation differ and why, as ``pmm gap`` does.

        Parameters
        ----------
        effects, without
            To restrict the catalogue to, or Python files with effects of your own; to take out.
        sensors
            Channels to use; all if not given.
        hold_out
            Runs that nobody looks at until the end, as ``frequency=1.1``.
        jobs
            As of :meth:`coefficients`.

        Raises
        ------
        ConfigurationError, DataError
            As :func:`pmm.gap.examination.examine` does.
        """
        from pmm.gap.examination import Options
        from pmm.interface.gap import campaign_gap

        self._require(RecordKind.CAMPAIGN)
        options = Options(tuple(effects), tuple(without), tuple(sensors), tuple(hold_out))
        return campaign_gap(self.path, options, jobs)

    @checked
    def inertia(self, job: Job) -> "InertiaResult":
        """Find mass, centre of gravity, inertia and gyradii, as ``pmm inertia JOB`` does.

        Parameters
        ----------
        job
            Which test the file is of, by the command's name for it.

        Raises
        ------
        ConfigurationError, DataError
            If the file is wrong, or the data do not carry what is asked.
        """
        from pmm.inertia.jobs import do_job
        from pmm.interface.inertia import InertiaResult

        self._require(RecordKind.PENDULUM)
        return InertiaResult(do_job(job, str(self.path)))

    @checked
    def design(self, *, after: Sequence[FilePath] = ()) -> "DesignResult":
        """Choose the runs that make coefficients as well known as is asked.

        Parameters
        ----------
        after
            Campaigns' folders whose runs count as made.

        Raises
        ------
        ConfigurationError, DataError
            As :func:`pmm.design.design_file.read_design` and
            :func:`pmm.design.run_selection.design` do.
        """
        from pmm.interface.design import designed

        self._require(RecordKind.DESIGN)
        return designed(self.path, after)
