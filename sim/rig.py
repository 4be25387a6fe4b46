"""A simulated rig: the parameters of all its stages, and two nominal ones as data."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from hardware.description.attitude import AttitudeSensors
from hardware.description.body import Body
from hardware.description.channels import COMMANDS, POSITIONS
from hardware.description.heel import Heel
from hardware.description.motor import UNKNOWN_KEYS_REFUSED
from hardware.description.oscillator import HORIZONTAL_1963, VERTICAL_1963, Oscillator
from hardware.description.setpoint import Medium, SetPoint, check_within
from sim.acquisition.channels import Acquisition, Digitiser
from sim.acquisition.photocell import PhotocellStage
from sim.chain import Chain
from sim.coupled.stage import Coupled, reflected_inertia
from sim.drive.carriage import CarriageMotion, CarriageSettings
from sim.drive.loaded_drive import LoadedDrive
from sim.drive.prescribed_drive import ConstantSpeedDrive, DriveSettings
from sim.gauges.dynamometer import Dynamometer, Dynamometers
from sim.mechanism.command import StrutCommand
from sim.mechanism.geometry import AT_REST
from sim.mechanism.linkage import Mechanism, Setting
from sim.model.attitude import PositionSensors, Squat
from sim.model.heel import Heeling
from sim.model.heel_terms import HeelTerms
from sim.model.hull import Hull, HullCoefficients
from sim.model.law_point import Acting
from sim.model.mounting import Mounting
from sim.model.steering import Steering
from sim.model.water.force_laws import CrossFlow, SurgeForces
from sim.model.water.radiation import Radiation
from sim.model.waves import Waves
from sim.rig_checks import check_run, recorded

if TYPE_CHECKING:
    from sim.stage import Stage


@dataclass(frozen=True)
class SimulatedRig:
    """Parameters of a simulated rig, its model and the water.

    Attributes
    ----------
    body
        The model, measured about the midpoint between the struts.
    water
        What the water does to the model; ignored for runs in air.
    drive
        With a motor in it the drive feels the struts' load, and is solved together with mechanism
        and model.
    linkage_aft, linkage_fore
        How each strut's linkage differs from what was set.
    radiation
        The water's memory, with its added mass at infinite frequency, which adds to ``water``; in
        air what of it is on board.
    mounting
        Stiffness of gauges and frame.
    forces, cross_flow
        Forces that depend on the motion at once; those of the water are ignored in air.
    flow_factor
        Mean flow past the model over the carriage's speed: more than 1 where the tank is narrow
        (:func:`sim.model.water.tank.blockage_speed_factor`).
    photocell
        ``None`` for a rig without one.
    surge
        Forces along the model; they are there to be measured where ``acquisition.force_x`` is.
    steering
        Propeller and rudder, in water.
    attitude, squat
        Sensors of position on the model, and how it sinks and trims in water where it is free to.
    waves
        What waves do to the model; the run says which there are.
    heel, heel_loads
        How the model heels, and the terms of the water's loads on it then
        (:class:`sim.model.heel_terms.HeelTerms`).
    """

    oscillator: Oscillator
    body: Body
    water: HullCoefficients = field(default_factory=HullCoefficients)
    drive: DriveSettings = field(default_factory=DriveSettings)
    carriage: CarriageSettings = field(default_factory=CarriageSettings)
    linkage_aft: Setting = field(default_factory=Setting)
    linkage_fore: Setting = field(default_factory=Setting)
    radiation: Radiation | None = None
    mounting: Mounting = field(default_factory=Mounting)
    forces: tuple[Acting, ...] = ()
    cross_flow: CrossFlow | None = None
    flow_factor: float = 1.0
    dynamometers: Dynamometers = field(default_factory=Dynamometers)
    acquisition: Acquisition = field(default_factory=Acquisition)
    photocell: PhotocellStage | None = field(default_factory=PhotocellStage)
    surge: SurgeForces | None = None
    steering: Steering | None = None
    attitude: AttitudeSensors | None = None
    squat: Squat | None = None
    waves: Waves | None = None
    heel: Heel | None = None
    heel_loads: Mapping[str, float] = field(default_factory=dict, hash=False)

    __pydantic_config__ = UNKNOWN_KEYS_REFUSED

    def chain(self, set_point: SetPoint) -> Chain:
        """Return the chain of this rig's :meth:`stages`, set for one run."""
        return Chain(self.stages(set_point))

    def stages(self, set_point: SetPoint) -> "tuple[Stage[Any], ...]":
        """Return the stages of this rig, set for one run.

        Raises
        ------
        ConfigurationError
            If the oscillator cannot run the set-point, or has a turntable, or the struts would move
            further apart than the model's attachments can reach.
        """
        check_run(self, set_point)
        check_within(self.oscillator, set_point)
        carriage = CarriageMotion(
            set_point.carriage_speed_m_s, self.carriage, set_point.turn_rate_rad_s
        )
        mechanism = Mechanism(
            set_point.eccentricity_m,
            set_point.strut_phase_rad,
            self.oscillator.rod_length_m,
            self.linkage_aft,
            self.linkage_fore,
            set_point.lines,
        )
        prescribed = self.drive.motor is None and self.drive.gear is None
        hull = self._hull(set_point, carriage, prescribed)
        stages: tuple[Stage[Any], ...]
        if prescribed:
            drive = ConstantSpeedDrive(set_point.frequency_hz, self.drive)
            stages = (drive, carriage, mechanism, hull)
        else:
            loaded = LoadedDrive(
                set_point.frequency_hz,
                self.drive,
                self.drive.motor,
                reflected_inertia(hull.system.mass, set_point),
                self.lifted_n(hull),
            )
            stages = (carriage, Coupled(loaded, mechanism, hull))
        commands = self._command_stages(mechanism, set_point.frequency_hz)
        behind = (*commands, *self._sensed(hull), self.dynamometers, self.acquisition)
        pulses = () if self.photocell is None else (self.photocell,)
        return (*stages, *behind, *pulses)

    def lifted_n(self, hull: Hull) -> tuple[float, float]:
        """Return what the shaft lifts of what gauges are tared of, aft and fore, in N."""
        aft_n, fore_n = (self.oscillator.lifted * hull.system.numbers[AT_REST, :2]).tolist()
        return aft_n, fore_n

    def _command_stages(
        self, mechanism: Mechanism, frequency_hz: float
    ) -> tuple["Stage[Any]", ...]:
        """Return the stage of the commands, where they are recorded."""
        names = recorded(self.acquisition, COMMANDS)
        return (StrutCommand(mechanism, self.drive, frequency_hz),) if names else ()

    def _sensed(self, hull: Hull) -> tuple["Stage[Any]", ...]:
        """Return the stage of sinkage and trim, where they are recorded."""
        if self.attitude is None or not recorded(self.acquisition, POSITIONS):
            return ()
        squat = self.squat if hull.afloat else None
        return (PositionSensors(self.attitude, squat or Squat(), hull),)

    def heeling(self, set_point: SetPoint) -> Heeling | None:
        """Return how the model heels in a run; ``None`` where it cannot."""
        if self.heel is None:
            return None
        in_water, terms = set_point.medium is Medium.WATER, HeelTerms.of(self.heel_loads)
        rest, release = set_point.heel_rad, set_point.release_rad
        return Heeling(self.heel, self.body, terms, rest, in_water, release)

    def _hull(self, set_point: SetPoint, carriage: CarriageMotion, surges: bool) -> Hull:
        in_water = set_point.medium is Medium.WATER
        return Hull(
            self.oscillator.plane,
            self.oscillator.half_spacing_m,
            self.body,
            self.water if in_water else HullCoefficients(),
            self.radiation if in_water or self.radiation is None else self.radiation.on_board,
            self.mounting,
            tuple(force for force in self.forces if in_water or not force.in_water),
            self.cross_flow if in_water else None,
            carriage.mean_m_s * self.flow_factor,
            self.flow_factor,
            set_point.drift_rad,
            self.oscillator.arrangement,
            self.surge if in_water else None,
            in_water,
            None if self.steering is None else self.steering.set_for(set_point),
            self.heeling(set_point),
            carriage.mean_turn_rad_s,
            None if self.waves is None else self.waves.met_in(set_point),
            surges,
        )

    def ideal(self) -> "SimulatedRig":
        """Return the same rig with perfect sensors: no noise, drift, rounding, gain or delay.

        The channels that it records stay the same.
        """
        perfect = {line.channel.name: Digitiser() for line in self.acquisition.lines}
        return replace(
            self,
            dynamometers=Dynamometers(),
            acquisition=replace(self.acquisition, **perfect),
            photocell=None if self.photocell is None else PhotocellStage(),
        )


# A model of 2.5 m, 0.36 m beam and 0.13 m draught; magnitudes as strip theory gives them for such a
# hull near 1 Hz. They serve examples and tests, not any real ship.
MODEL_2M5 = Body(mass_kg=70.0, inertia_kg_m2=27.5, cg_x_m=-0.02, cg_z_m=0.02)
WATER_VERTICAL = HullCoefficients(
    added_mass=((75.0, 3.0), (3.0, 22.0)),
    damping=((190.0, 12.0), (12.0, 55.0)),
    restoring=((6900.0, 345.0), (345.0, 2400.0)),
)
WATER_HORIZONTAL = HullCoefficients(
    added_mass=((62.0, 2.0), (2.0, 18.0)),
    damping=((120.0, -15.0), (40.0, 35.0)),
)
_DYNAMOMETERS = Dynamometers(Dynamometer(full_scale_n=500.0), Dynamometer(full_scale_n=500.0))


def vertical_rig() -> SimulatedRig:
    """Return a nominal heave and pitch rig: the oscillator of 1963 and a model of 2.5 m."""
    return SimulatedRig(
        oscillator=VERTICAL_1963,
        body=MODEL_2M5,
        water=WATER_VERTICAL,
        dynamometers=_DYNAMOMETERS,
        acquisition=_acquisition(displacement_noise_m=5e-6),
    )


def horizontal_rig(rod_length_m: float | None = None) -> SimulatedRig:
    """Return a nominal sway and yaw rig; with a rod length it has cranks in place of yokes."""
    return SimulatedRig(
        oscillator=replace(HORIZONTAL_1963, rod_length_m=rod_length_m),
        body=MODEL_2M5,
        water=WATER_HORIZONTAL,
        dynamometers=_DYNAMOMETERS,
        acquisition=_acquisition(displacement_noise_m=2e-5),
    )


def _acquisition(displacement_noise_m: float) -> Acquisition:
    """Return 16 bit channels with the noise of good amplifiers, and an encoder of 2^16 steps."""
    displacement = Digitiser(noise_rms=displacement_noise_m)
    force = Digitiser(noise_rms=0.05, resolution=1000.0 / 2**16, full_scale=500.0)
    return Acquisition(
        shaft_angle=Digitiser(resolution=2.0 * math.pi / 2**16),
        displacement_aft=displacement,
        displacement_fore=displacement,
        force_aft=force,
        force_fore=force,
        carriage_speed=Digitiser(noise_rms=1e-3),
    )
