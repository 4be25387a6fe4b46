"""A campaign: the rig, what the simulation believes of it, and the runs with their set-points.

``docs/campaigns.md`` describes the file for people; :mod:`pmm.campaign_file` reads it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from pathlib import Path
from typing import ClassVar

from analysis.readers import ColumnMap
from analysis.resolver.analyse import ResolverSettings
from analysis.resolver.choice import ReferenceChoice
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.kinds import Motion, RunKind
from hardware.description.known_loads import KnownMass, LoadStep
from hardware.description.oscillator import Oscillator
from hardware.description.setpoint import Medium, SetPoint
from pmm.model_uncertainty import ModelUncertainty
from sim.acquisition.channels import Acquisition
from sim.acquisition.photocell import PhotocellStage
from sim.drive.carriage import CarriageSettings
from sim.drive.prescribed import DriveSettings
from sim.effects.catalogue import build_from
from sim.effects.effect import Effect
from sim.gauges.dynamometer import Dynamometers
from sim.mechanism.linkage import Setting
from sim.model.acting import Acting
from sim.model.hull import HullCoefficients
from sim.model.mounting import Mounting
from sim.model.surge import SurgeForces
from sim.model.water.force_laws import CrossFlow
from sim.model.water.radiation_file import RadiationFile
from sim.rig import SimulatedRig

CAMPAIGN_FILE = "campaign.toml"
RUN_FILE = "run.nc"  # a recording in its run's own folder


@dataclass(frozen=True)
class RecordedWith:
    """What a run was recorded with where it is not what the campaign's tables say of the others.

    Attributes
    ----------
    oscillator, model, model_uncertainty, hull, reference
        As in :class:`Campaign`; ``None`` where that is right for the run.
    """

    oscillator: Oscillator | None = None
    model: Body | None = None
    model_uncertainty: ModelUncertainty | None = None
    hull: HullCoefficients | None = None
    reference: ReferenceChoice | None = None


@dataclass(frozen=True)
class Asked:
    """What a run of the oscillator was told to do, and what it is called."""

    name: str
    frequency_hz: float
    eccentricity_m: float
    strut_phase_rad: float = 0.0
    carriage_speed_m_s: float = 0.0
    medium: Medium = Medium.WATER
    periods: int = 10

    @property
    def set_point(self) -> SetPoint:
        """What the run was told to do."""
        return SetPoint(
            self.frequency_hz,
            self.eccentricity_m,
            self.strut_phase_rad,
            self.carriage_speed_m_s,
            self.medium,
        )


@dataclass(frozen=True)
class Run(Asked):
    """One run: its set-point, how long it is, and where its recording lies.

    Attributes
    ----------
    name
        Unique within the campaign; its recording is called so.
    frequency_hz, eccentricity_m, strut_phase_rad, carriage_speed_m_s, medium
        As in :class:`hardware.description.setpoint.SetPoint`.
    periods
        Whole periods wanted.
    file
        Recording of another system, beside the campaign file, or where run control has put its own;
        ``None`` for ``<name>.nc``.
    kind, motion, repeat, known_mass
        What the run was for; see :class:`pmm.plan.run_plan.RunPlan`.
    drift_rad
        Steady drift angle, positive for the bow to starboard.
    u_eccentricity_m, u_strut_phase_rad
        Standard uncertainties of how eccentricity and phase were set or read.
    zero_before, zero_after
        Names of the records at rest that tell the gauges' zero.
    number
        Place among all runs of the campaign, those at rest too, from 1.
    outcome
        ``"complete"``, ``"stopped"`` or ``"fault"``.
    differs
        What plan, rig, model and calibration said otherwise when it was recorded, in words.
    recorded_with
        Tables of the campaign that were others for it.
    """

    file: str | None = None
    kind: RunKind = RunKind.OSCILLATION
    motion: Motion | None = None
    repeat: int = 1
    drift_rad: float = 0.0
    u_eccentricity_m: float = 0.0
    u_strut_phase_rad: float = 0.0
    known_mass: KnownMass | None = None
    zero_before: str | None = None
    zero_after: str | None = None
    number: int | None = None
    outcome: str = "complete"
    differs: tuple[str, ...] = ()
    recorded_with: RecordedWith | None = None

    def recording_path(self, folder: Path) -> Path:
        """Return where the run's recording lies: ``<name>.nc`` if it is there, else ``file``."""
        return _recording_path(folder, self.name, self.file)


@dataclass(frozen=True)
class AtRest:
    """A record with the shaft at rest: a zero run, a load step, a push, a pluck, a tow.

    It carries no harmonics, so it stands beside the runs. Attributes are as in :class:`Run`; the
    file is beside the campaign file.

    Attributes
    ----------
    load
        Which gauge was loaded, and with what.
    """

    name: str
    kind: RunKind
    file: str
    duration_s: float
    carriage_speed_m_s: float = 0.0
    medium: Medium = Medium.WATER
    drift_rad: float = 0.0
    repeat: int = 1
    load: LoadStep | None = None
    known_mass: KnownMass | None = None
    zero_before: str | None = None
    zero_after: str | None = None
    number: int | None = None
    outcome: str = "complete"
    differs: tuple[str, ...] = ()
    recorded_with: RecordedWith | None = None

    def recording_path(self, folder: Path) -> Path:
        """Return where the recording lies, as for a run."""
        return _recording_path(folder, self.name, self.file)


def _recording_path(folder: Path, name: str, file: str | None) -> Path:
    own = folder / f"{name}.nc"
    return own if file is None or own.exists() else folder / file


@dataclass(frozen=True)
class Simulation:
    """How the runs are simulated; see :func:`sim.run.simulate`.

    Attributes
    ----------
    waiting_s
        From the end of a run to the beginning of the next: some effects die out or build up then.
    """

    sample_rate_hz: float = 200.0
    settling_periods: int = 3
    seed: int = 1
    waiting_s: float = 300.0


@dataclass(frozen=True)
class SwitchedOn:
    """An effect that is on in all runs, by its name in the catalogue, with its parameters."""

    name: str
    parameters: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Campaign:
    """A campaign file, read and checked.

    Attributes
    ----------
    name
        What the campaign is called.
    oscillator, model
        ``None`` where the file does not say; a simulation needs them, an analysis does not.
    hull, drive, dynamometers, acquisition, photocell, simulation
        What the simulation believes.
    radiation, carriage, linkage_aft, linkage_fore, mounting, forces, cross_flow, surge
        More of that, as in :class:`sim.rig.SimulatedRig`; the memory comes from a table.
    effects
        What is switched on besides, in this order.
    reference, analysis
        How the recordings are analysed, unless the command line says otherwise.
    columns
        Which column of the text recordings is what.
    model_uncertainty
        Standard uncertainties of the model's numbers, as ``pmm inertia`` writes them.
    at_rest
        Records without oscillation: zero runs, loads, tows.
    tared
        Whether the gauges' zeros were taken off the recordings before they were written, so that
        means are forces as they stand and no zero runs are needed.
    """

    name: str = "campaign"
    oscillator: Oscillator | None = None
    model: Body | None = None
    hull: HullCoefficients = field(default_factory=HullCoefficients)
    drive: DriveSettings = field(default_factory=DriveSettings)
    dynamometers: Dynamometers = field(default_factory=Dynamometers)
    acquisition: Acquisition = field(default_factory=Acquisition)
    photocell: PhotocellStage | None = field(default_factory=PhotocellStage)
    simulation: Simulation = field(default_factory=Simulation)
    radiation: RadiationFile | None = None
    carriage: CarriageSettings = field(default_factory=CarriageSettings)
    linkage_aft: Setting = field(default_factory=Setting)
    linkage_fore: Setting = field(default_factory=Setting)
    mounting: Mounting = field(default_factory=Mounting)
    forces: tuple[Acting, ...] = ()
    cross_flow: CrossFlow | None = None
    surge: SurgeForces | None = None
    effects: tuple[SwitchedOn, ...] = ()
    reference: ReferenceChoice = field(default_factory=ReferenceChoice)
    analysis: ResolverSettings = field(default_factory=ResolverSettings)
    columns: ColumnMap | None = None
    model_uncertainty: ModelUncertainty | None = None
    runs: tuple[Run, ...] = ()
    at_rest: tuple[AtRest, ...] = ()
    tared: bool = False

    # Holds for the classes of all tables: unknown keys, NaN and infinity are refused.
    __pydantic_config__: ClassVar = {"extra": "forbid", "allow_inf_nan": False}

    def rig(self) -> SimulatedRig:
        """Return the rig as the simulation believes it to be.

        Raises
        ------
        ConfigurationError
            If the oscillator or the model is not described.
        DataError
            If the radiation's table does not hold what is needed.
        """
        if self.oscillator is None or self.model is None:
            missing = [key for key in ("oscillator", "model") if getattr(self, key) is None]
            tables = " and ".join(f"[{key}]" for key in missing)
            raise ConfigurationError(
                f"campaign {self.name!r}: no table {tables}; the simulation needs it"
            )
        table = self.radiation
        memory = None if table is None else table.fitted(self.oscillator.plane)
        return SimulatedRig(
            oscillator=self.oscillator,
            body=self.model,
            water=self.hull,
            drive=self.drive,
            dynamometers=self.dynamometers,
            acquisition=self.acquisition,
            photocell=self.photocell,
            radiation=memory,
            carriage=self.carriage,
            linkage_aft=self.linkage_aft,
            linkage_fore=self.linkage_fore,
            mounting=self.mounting,
            forces=self.forces,
            cross_flow=self.cross_flow,
            surge=self.surge,
        )

    def as_recorded(self, name: str) -> "Campaign":
        """Return the campaign with the tables that a run or a record at rest was recorded with."""
        every: tuple[Run | AtRest, ...] = (*self.runs, *self.at_rest)
        own = next((one for one in every if one.name == name), None)
        if own is None or own.recorded_with is None:
            return self
        told = {one.name: getattr(own.recorded_with, one.name) for one in fields(RecordedWith)}
        return replace(self, **{key: one for key, one in told.items() if one is not None})

    def effects_on(self, more: Mapping[str, type[Effect]] | None = None) -> tuple[Effect, ...]:
        """Return the effects that the file switches on.

        Parameters
        ----------
        more
            Effects of the user's own, by name.

        Raises
        ------
        ConfigurationError
            If a name, a parameter or a value is wrong: all of them in one message.
        """
        built, faults = [], []
        for number, one in enumerate(self.effects, 1):
            try:
                built.append(build_from(one.name, one.parameters, dict(more or {})))
            except ConfigurationError as error:
                faults.append(f"effects[{number}]: {error}")
        if faults:
            raise ConfigurationError(f"campaign {self.name!r}: " + "; ".join(faults))
        return tuple(built)

    def run(self, name: str) -> Run:
        """Return the run of that name.

        Raises
        ------
        ConfigurationError
            If there is none; the message names the nearest.
        """
        names = [run.name for run in self.runs]
        if name in names:
            return self.runs[names.index(name)]
        hint = nearest_run(name, names)
        raise ConfigurationError(f"campaign {self.name!r}: no run {name!r}; {hint}")


def nearest_run(name: str, names: Sequence[str]) -> str:
    """Return which run may be meant by a name that there is not, or which there are."""
    from difflib import get_close_matches

    near = get_close_matches(name, names, n=1, cutoff=0.4)
    return f"did you mean {near[0]!r}?" if near else f"runs: {', '.join(names)}"
