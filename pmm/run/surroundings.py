"""What only people can change, asked for one by one: carriage, medium, loads, added mass."""

import json
import math
from collections.abc import Callable, Collection, Iterator
from dataclasses import asdict, dataclass
from functools import partial
from typing import Final

from analysis.kinematics.geometry import Geometry
from hardware.demand import Demand
from hardware.description.arrangement import DriftBy
from hardware.description.kinds import RunKind
from hardware.description.known_loads import KnownMass
from hardware.description.lines import Line
from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import SetPoint
from pmm.plan.run_plan import RunPlan

_CALM: Final = (0.0, 0.0, math.pi)
_WAVE_KEYS: Final = ("wave_frequency_hz", "wave_amplitude_m", "wave_heading_rad")


@dataclass
class Surroundings:
    """How things stand, as far as the operator has said that they are so.

    Each method yields what is to be done; it is taken as done when the next demand is asked for.

    Attributes
    ----------
    load
        Channel and newtons of the weight that hangs on a gauge.
    drift_rad
        Mean heading of the model to the tow, however it is set.
    rudder_angle_rad, revolutions_hz, heel_rad
        Of the rudder, of the propeller and of the model.
    carriage_speed_m_s
        Of a carriage that people drive; NaN from when they are asked for another until they answer.
    turn_rate_rad_s
        Of the carriage on a circle.
    release_rad
        Heel that the model was let go from.
    waves
        Frequency, amplitude and heading of the waves.
    lines
        That the struts follow.
    """

    medium: str = "water"
    carriage_speed_m_s: float = 0.0
    drift_rad: float = 0.0
    rudder_angle_rad: float = 0.0
    revolutions_hz: float = 0.0
    heel_rad: float = 0.0
    turn_rate_rad_s: float = 0.0
    release_rad: float = 0.0
    waves: tuple[float, float, float] = _CALM
    lines: tuple[Line, ...] = ()
    known_mass: KnownMass | None = None
    load: tuple[str, float] = ("", 0.0)

    def before(
        self, run: RunPlan, oscillator: Oscillator, by_axis: Collection[str] = ()
    ) -> Iterator[Demand]:
        """Yield what has to be done before a run, at rest.

        Parameters
        ----------
        by_axis
            Angles that an axis of the rig sets, and ``lines`` that its struts are told: nobody is
            asked for them.
        """
        yield from self._change_medium(str(run.set_point.medium))
        yield from self._change_mass(run)
        if self.release_rad:
            yield Demand(
                "release: hold the model in roll as before; press Enter when it is so",
                "release",
                0.0,
            )
            self.release_rad = 0.0
        yield from self._change_waves(run.set_point)
        if "drift" not in by_axis:
            yield from self._change_drift(run, oscillator)
        yield from self._change_settings(run.set_point, by_axis)
        if run.oscillates and "lines" not in by_axis:
            yield from self._change_lines(run.set_point)
        wanted = run.load if run.kind is RunKind.CHECK_WEIGHT else None
        yield from self._change_load(
            ("", 0.0) if wanted is None else (wanted.channel, wanted.force_n)
        )
        for text in run.prompts:
            yield Demand(f"{run.name}: {text}; press Enter when it is done", "prompt")

    def tow(self, speed_m_s: float, turn_rate_rad_s: float = 0.0) -> Iterator[Demand]:
        """Yield what brings the carriage to a speed, straight or round a circle; 0 stops it."""
        if (speed_m_s, turn_rate_rad_s) == (self.carriage_speed_m_s, self.turn_rate_rad_s):
            return
        text = "carriage: stop and go back; press Enter when it stands"
        if speed_m_s:
            way = f" {_circle(speed_m_s, turn_rate_rad_s)}" if turn_rate_rad_s else ""
            text = f"carriage: tow at {speed_m_s:g} m/s{way}; press Enter when the speed is steady"
        self.carriage_speed_m_s = math.nan
        yield Demand(text, "carriage", speed_m_s, turn_rate_rad_s=turn_rate_rad_s)
        self.carriage_speed_m_s, self.turn_rate_rad_s = speed_m_s, turn_rate_rad_s

    def forget_carriage(self) -> bool:
        """Take the speed of a carriage that people drive for unknown; return whether it may run."""
        if self.carriage_speed_m_s:
            self.carriage_speed_m_s = math.nan
        return self.carriage_speed_m_s != 0.0

    def fetch(self) -> Iterator[Demand]:
        """Yield what brings a carriage back that cannot go back by itself."""
        text = "carriage: bring it back to its start; press Enter when it stands there"
        yield Demand(text, "carriage", 0.0)

    def hold(self, release_rad: float) -> Iterator[Demand]:
        """Yield what has somebody heel a model and hold it."""
        to, by = _side_and_size(release_rad)
        text = f"release: free the model in roll, heel it to {to} by {by} and hold it still"
        yield Demand(f"{text}; press Enter when it is so", "hold", release_rad)

    def let_go(self, release_rad: float) -> Iterator[Demand]:
        """Yield what has somebody let go of the model."""
        text = "release: let go of the model and do not touch it; press Enter at once"
        yield Demand(text, "release", release_rad)
        self.release_rad = release_rad

    def push(self, channel: str, force_n: float) -> Iterator[Demand]:
        """Yield what has somebody push a gauge by hand, or let go."""
        yield from self._change_load((channel, force_n), by_hand=True)

    def _change_load(self, load: tuple[str, float], *, by_hand: bool = False) -> Iterator[Demand]:
        (before, held), (channel, force_n) = self.load, load
        if before and before != channel and held:
            yield Demand(
                f"load: take everything off {before}; press Enter", "load", 0.0, 1.0, before
            )
            self.load = "", 0.0
        if channel and (before != channel or held != force_n):
            how = ("push" if force_n else "let go of") if by_hand else "load"
            text = f"load: {how} {channel} with {force_n:g} N; press Enter when it is so"
            yield Demand(text, "load", force_n, 1.0, channel)
        self.load = load

    def _change_medium(self, medium: str) -> Iterator[Demand]:
        if medium != self.medium:
            yield Demand(f"medium: bring the model into {medium}; press Enter", "medium", medium)
            self.medium = medium

    def _change_mass(self, run: RunPlan) -> Iterator[Demand]:
        mass = run.known_mass
        if mass == self.known_mass:
            return
        mass_kg, at_m = (mass.mass_kg, mass.x_m) if mass is not None else (0.0, 0.0)
        request = f"put {mass_kg:g} kg on the model at x = {at_m:g} m" if mass else "take it off"
        yield Demand(f"mass: {request}; press Enter", "mass", mass_kg, at_m=at_m)
        self.known_mass = mass

    def _change_drift(self, run: RunPlan, oscillator: Oscillator) -> Iterator[Demand]:
        drift_rad = run.set_point.drift_rad
        if drift_rad != self.drift_rad:
            text = f"drift: {drift_prompt(Geometry.of(oscillator, run.set_point))}; press Enter"
            yield Demand(text, "drift", drift_rad)
            self.drift_rad = drift_rad

    def _change_waves(self, point: SetPoint) -> Iterator[Demand]:
        asked = {key: getattr(point, key) for key in _WAVE_KEYS}
        waves = (point.wave_frequency_hz, point.wave_amplitude_m, point.wave_heading_rad)
        if waves == self.waves:
            return
        text = "stop the wave maker; press Enter when the water is calm"
        if point.wave_frequency_hz:
            text = (
                f"run the wave maker at {waves[0]:g} Hz, {1e3 * waves[1]:g} mm amplitude (half the "
                f"height), {math.degrees(waves[2]):g} deg to the carriage's way (180: from ahead); "
                "press Enter when the waves are there"
            )
        yield Demand(f"waves: {text}", "waves", json.dumps(asked))
        self.waves = waves

    def _change_settings(self, point: SetPoint, by_axis: Collection[str]) -> Iterator[Demand]:
        for part, key, words in _SETTINGS:
            value = getattr(point, key)
            if part not in by_axis and value != getattr(self, key):
                yield Demand(f"{part}: {words(value)}", part, value)
                setattr(self, key, value)

    def _change_lines(self, point: SetPoint) -> Iterator[Demand]:
        if point.lines == self.lines:
            return
        orders = ", ".join(str(line.order) for line in point.lines)
        request = (
            f"let each strut follow its table of lines {orders} over a turn of the master angle, "
            "as the run's header.json has them"
            if orders
            else "let the struts follow a single sine again"
        )
        table = json.dumps([asdict(line) for line in point.lines])
        yield Demand(f"lines: {request}; press Enter when it is so", "lines", table)
        self.lines = point.lines


def drift_prompt(geometry: Geometry) -> str:
    """Return what an operator does to set the drift (trim) angle as the rig's ``drift_by`` says."""
    angle = _angle(geometry)
    match geometry.arrangement.drift_by:
        case DriftBy.RIG_TURNED:
            return f"turn the whole oscillator on the carriage: {angle}"
        case DriftBy.MODEL_TURNED:
            return f"turn the model on its struts: {angle}; the oscillator stays straight"
        case DriftBy.STRUTS_OFFSET if geometry.has_table:
            return f"set the turntable's mean angle: {angle}"
        case DriftBy.STRUTS_OFFSET:
            return f"set the struts' mean positions apart: {_offset_text(geometry)}, for {angle}"


def _turning_prompt(straight: str, turned: str, angle_rad: float) -> str:
    to, by = _side_and_size(angle_rad)
    return f"{f'{turned} {to} by {by}' if angle_rad else straight}; press Enter when it is so"


def _circle(speed_m_s: float, turn_rate_rad_s: float) -> str:
    to, _ = _side_and_size(turn_rate_rad_s)
    size = abs(turn_rate_rad_s)
    return (
        f"on a circle of {speed_m_s / size:.4g} m to {to}, {size:.4g} rad/s "
        f"({math.degrees(size):.3g} deg/s)"
    )


def _side_and_size(angle_rad: float) -> tuple[str, str]:
    size = abs(angle_rad)
    to = "port" if angle_rad < 0.0 else "starboard"
    return to, f"{size:.4f} rad ({math.degrees(size):.2f} deg)"


def _propeller(rate_hz: float) -> str:
    if not rate_hz:
        return "stop it; press Enter when it stands"
    return (
        f"turn it at {rate_hz:g} Hz ({60.0 * rate_hz:g} rpm); press Enter when the rate is steady"
    )


# What people set, the set-point's key for it, and what they are asked.
_SETTINGS: Final[tuple[tuple[str, str, Callable[[float], str]], ...]] = (
    ("heel", "heel_rad", partial(_turning_prompt, "set the model upright", "heel the model to")),
    (
        "rudder",
        "rudder_angle_rad",
        partial(_turning_prompt, "lay it amidships", "lay it to turn to"),
    ),
    ("propeller", "revolutions_hz", _propeller),
)


def _angle(geometry: Geometry) -> str:
    angle = float(geometry.drift_rad)
    if not angle:
        return "straight (0 rad)"
    to = ("up", "down") if geometry.plane is Plane.VERTICAL else ("to starboard", "to port")
    return f"{abs(angle):.4f} rad ({math.degrees(abs(angle)):.2f} deg), bow {to[angle < 0.0]}"


def _offset_text(geometry: Geometry) -> str:
    offset = float(geometry.offset_m)
    to = ("down", "up") if geometry.plane is Plane.VERTICAL else ("to starboard", "to port")
    fore, aft = to if offset >= 0.0 else to[::-1]
    return f"fore {1e3 * abs(offset):.2f} mm {fore}, aft as much {aft}"
