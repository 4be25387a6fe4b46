"""A campaign: the rig, what the simulation believes of it, and the runs with their set-points.

``docs/campaigns.md`` describes the file for people; :mod:`pmm.campaign.campaign_file` reads it.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING

from analysis.gap.forward.tolerances import Tolerances
from analysis.readers import ColumnMap
from analysis.resolver.reference_choice import ReferenceChoice
from analysis.resolver.settings import ResolverSettings
from hardware.description.attitude import AttitudeSensors
from hardware.description.body import Body
from hardware.description.errors import ConfigurationError
from hardware.description.heel import Heel
from hardware.description.oscillator import Oscillator
from pmm.campaign.model_uncertainty import ModelUncertainty
from pmm.campaign.runs import AtRest, RecordedWith, Run, nearest_run
from pmm.campaign.water import TankWater
from pmm.configuration import STRICT_TABLE
from sim.acquisition.channels import Acquisition
from sim.acquisition.photocell import PhotocellStage
from sim.drive.carriage import CarriageSettings
from sim.drive.prescribed_drive import DriveSettings
from sim.effects.catalogue import build_from
from sim.effects.effect import Effect
from sim.gauges.dynamometer import Dynamometers
from sim.mechanism.linkage import Setting
from sim.model.attitude import Squat
from sim.model.hull import HullCoefficients
from sim.model.law_point import Acting
from sim.model.mounting import Mounting
from sim.model.steering import Steering
from sim.model.water.force_laws import CrossFlow, SurgeForces
from sim.model.water.radiation_file import RadiationFile
from sim.model.waves import Waves
from sim.rig import SimulatedRig

if TYPE_CHECKING:
    from sim.model.water.fitted_memory import FittedMemory


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
    model_name
        What its model is called; empty where the file does not say.
    oscillator, model
        ``None`` where the file does not say; a simulation needs them, an analysis does not.
    hull, drive, dynamometers, acquisition, photocell, simulation
        What the simulation believes.
    radiation, carriage, linkage_aft, linkage_fore, mounting, forces, cross_flow, surge, steering,
    squat, waves, heel_loads
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
    tolerances
        What the simulation and the rig's settings may be off by: no gap within them.
    water
        What the model was tested in; ``None`` where the file does not say.
    attitude
        The sensors of sinkage and trim; ``None`` where there are none.
    heel
        How the model heels; ``None`` where it does not.
    """

    name: str = "campaign"
    model_name: str = ""
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
    steering: Steering | None = None
    squat: Squat | None = None
    waves: Waves | None = None
    heel: Heel | None = None
    heel_loads: Mapping[str, float] = field(default_factory=dict, hash=False)
    effects: tuple[SwitchedOn, ...] = ()
    reference: ReferenceChoice = field(default_factory=ReferenceChoice)
    analysis: ResolverSettings = field(default_factory=ResolverSettings)
    columns: ColumnMap | None = None
    model_uncertainty: ModelUncertainty | None = None
    runs: tuple[Run, ...] = ()
    at_rest: tuple[AtRest, ...] = ()
    tared: bool = False
    tolerances: Tolerances = field(default_factory=Tolerances)
    water: TankWater | None = None
    attitude: AttitudeSensors | None = None

    __pydantic_config__ = STRICT_TABLE

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
        memory = self.memory
        return SimulatedRig(
            oscillator=self.oscillator,
            body=self.model,
            water=self.hull,
            drive=self.drive,
            dynamometers=self.dynamometers,
            acquisition=self.acquisition,
            photocell=self.photocell,
            radiation=None if memory is None else memory.radiation,
            carriage=self.carriage,
            linkage_aft=self.linkage_aft,
            linkage_fore=self.linkage_fore,
            mounting=self.mounting,
            forces=self.forces,
            cross_flow=self.cross_flow,
            surge=self.surge,
            steering=self.steering,
            attitude=self.attitude,
            squat=self.squat,
            waves=self.waves,
            heel=self.heel,
            heel_loads=self.heel_loads,
        )

    @property
    def memory(self) -> "FittedMemory | None":
        """The water's memory, as fitted to the table of ``[radiation]``; ``None`` without one.

        It raises what :meth:`sim.model.water.radiation_file.RadiationFile.fitted` raises.
        """
        if self.radiation is None or self.oscillator is None:
            return None
        return self.radiation.fitted(self.oscillator.plane)

    def as_recorded(self, name: str) -> "Campaign":
        """Return the campaign with the tables that a run or a record at rest was recorded with."""
        entries: tuple[Run | AtRest, ...] = (*self.runs, *self.at_rest)
        record = next((entry for entry in entries if entry.name == name), None)
        if record is None or record.recorded_with is None:
            return self
        tables = {
            field.name: getattr(record.recorded_with, field.name) for field in fields(RecordedWith)
        }
        return replace(self, **{key: table for key, table in tables.items() if table is not None})

    def effects_on(
        self, user_effects: Mapping[str, type[Effect]] | None = None
    ) -> tuple[Effect, ...]:
        """Return the effects that the file switches on.

        Parameters
        ----------
        user_effects
            Effects of the user's own, by name.

        Raises
        ------
        ConfigurationError
            If a name, a parameter or a value is wrong: all of them in one message.
        """
        effects, faults = [], []
        for number, effect in enumerate(self.effects, 1):
            try:
                effects.append(build_from(effect.name, effect.parameters, dict(user_effects or {})))
            except ConfigurationError as error:
                faults.append(f"effects[{number}]: {error}")
        if faults:
            raise ConfigurationError(f"campaign {self.name!r}: " + "; ".join(faults))
        return tuple(effects)

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
