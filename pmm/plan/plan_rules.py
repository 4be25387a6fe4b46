"""What an entry of each kind needs, and what is of no use to it."""

from collections.abc import Iterator, Sequence
from typing import Any, Final

from hardware.description.kinds import Motion, RunKind
from hardware.description.oscillator import Oscillator, Plane
from hardware.description.setpoint import path_faults as struts_faults
from pmm.configuration import Fault, Place, unknown
from pmm.plan.plan_tables import ControlTable, Defaults, PlanEntry, first_of

_KEYS: Final = tuple(PlanEntry.__dataclass_fields__)
_ALWAYS: Final = {"kind", "name", "repeats", "pause_s", "prompt"}
_GATE: Final = {"periods", "settling_periods", "target_relative", "max_periods"}
_SET: Final = {"rudder_angles_rad", "revolutions_hz", "heels_rad"}
_MATRIX: Final = _GATE | {
    "motion",
    "frequencies_hz",
    "amplitudes_m",
    "speeds_m_s",
    "strut_phases_rad",
    "drifts_rad",
}
_REST: Final = {"duration_s", "medium"}
_WAVES: Final = {"wave_frequency_hz", "wave_amplitude_m", "wave_heading_rad"}
_PATHS: Final = {"lines", "sweep", "recorded", "highest", "exact"}
_TAKES: Final[dict[RunKind, set[str]]] = {
    RunKind.OSCILLATION: _MATRIX | _SET | _PATHS | _WAVES | {"steady_ahead"},
    RunKind.DRY: (_MATRIX - {"drifts_rad"}) | _PATHS,
    RunKind.KNOWN_MASS: (_MATRIX - {"drifts_rad"}) | {"known_mass"},
    RunKind.RESTORING: _MATRIX - {"speeds_m_s", "drifts_rad"},
    RunKind.CHECK_WEIGHT: _REST | {"channels", "loads_n"},
    RunKind.PUSH: _REST | {"channels", "loads_n"},
    RunKind.PLUCK: _REST,
    RunKind.ZERO: _REST,
    RunKind.STATIC_DRIFT: {"duration_s", "speeds_m_s", "drifts_rad"} | _SET,
    RunKind.STRAIGHT_TOW: {"duration_s", "speeds_m_s"} | _SET,
    RunKind.CIRCLE: {"duration_s", "speeds_m_s", "drifts_rad", "radii_m"} | _SET,
    RunKind.FREE_DECAY: {"duration_s", "speeds_m_s", "releases_rad"} | _SET,
}
_NEEDS: Final[dict[RunKind, tuple[str, ...]]] = {
    RunKind.OSCILLATION: ("motion", "frequencies_hz", "amplitudes_m"),
    RunKind.DRY: ("motion", "frequencies_hz", "amplitudes_m"),
    RunKind.KNOWN_MASS: ("motion", "frequencies_hz", "amplitudes_m", "known_mass"),
    RunKind.RESTORING: ("motion", "amplitudes_m"),
    RunKind.CHECK_WEIGHT: ("loads_n",),
    RunKind.PUSH: ("loads_n",),
    RunKind.STATIC_DRIFT: ("speeds_m_s", "drifts_rad"),
    RunKind.STRAIGHT_TOW: ("speeds_m_s",),
    RunKind.CIRCLE: ("speeds_m_s", "radii_m"),
    RunKind.FREE_DECAY: ("releases_rad",),
}
_SHOWN: Final = {
    "amplitudes_m": "amplitudes_mm",
    "drifts_rad": "drifts_deg",
    "rudder_angles_rad": "rudder_angles_deg",
    "heels_rad": "heels_deg",
    "releases_rad": "releases_deg",
    "strut_phases_rad": "strut_phases_deg",
}
_SINGLE: Final = {"strut_phases_deg": "strut_phase_deg", "drifts_deg": "drift_deg"}
_ABOVE_0: Final = ("frequencies_hz", "amplitudes_m")
_NOT_BELOW_0: Final = ("speeds_m_s", "loads_n", "revolutions_hz")
_PLANES: Final = {
    Motion.HEAVE: Plane.VERTICAL,
    Motion.PITCH: Plane.VERTICAL,
    Motion.SWAY: Plane.HORIZONTAL,
    Motion.YAW: Plane.HORIZONTAL,
    Motion.YAW_DRIFT: Plane.HORIZONTAL,
}


def entry_faults(table: dict[str, Any], entry: PlanEntry, place: Place) -> Iterator[Fault]:
    """Yield what is wrong with an entry that is right key by key.

    Parameters
    ----------
    table
        The entry as written, in SI.
    """
    kind = entry.kind
    if kind is RunKind.CONTROL:
        yield Fault((*place, "kind"), '= "control" belongs into the table [control]')
        return
    for key in table:
        if key in _KEYS and key not in _ALWAYS | _TAKES[kind]:
            yield Fault((*place, _SHOWN.get(key, key)), f"is of no use to a run of kind {kind}")
    for key in _NEEDS.get(kind, ()):
        if not table.get(key) and table.get(key) != 0:
            yield Fault(place, f"needs {_SHOWN.get(key, key)} for a run of kind {kind}")
    yield from _number_faults(entry, place)
    yield from _motion_faults(entry, place)


def _number_faults(entry: PlanEntry, place: Place) -> Iterator[Fault]:
    for key in (*_ABOVE_0, *_NOT_BELOW_0):
        strict = key in _ABOVE_0
        for value in getattr(entry, key):
            if value < 0.0 or (strict and value == 0.0):
                asked = "above 0" if strict else "0 or more"
                if key == "loads_n":
                    asked += "; the sign of a load is that of its channel"
                yield Fault((*place, key), f"has {value:g}, which should be {asked}")
    if entry.kind is RunKind.PUSH and len(entry.loads_n) > 1:
        yield Fault((*place, "loads_n"), "should be one number: about how hard the push is")
    yield from _nothing_faults(entry, place)
    yield from _line_faults(entry, place)
    yield from gate_faults(entry, place)


def _nothing_faults(entry: PlanEntry, place: Place) -> Iterator[Fault]:
    """Yield what is 0 where that would be no such run."""
    for key in ("wave_frequency_hz", "wave_amplitude_m"):
        if getattr(entry, key) < 0.0:
            yield Fault((*place, key), f"= {getattr(entry, key):g} should be above 0")
    if (entry.wave_frequency_hz > 0.0) != (entry.wave_amplitude_m > 0.0):
        yield Fault(place, "needs wave_frequency_hz and wave_amplitude_mm for waves; give both")
    if 0.0 in entry.releases_rad:
        yield Fault((*place, "releases_deg"), "has 0; a model is let go from a heel")
    if 0.0 in entry.radii_m:
        yield Fault((*place, "radii_m"), "has 0; a circle has a radius, below 0 to port")
    if entry.kind.towed and 0.0 in entry.speeds_m_s:
        yield Fault((*place, "speeds_m_s"), "has 0; a tow needs a speed above 0")


def _line_faults(entry: PlanEntry, place: Place) -> Iterator[Fault]:
    if entry.lines and (entry.lines[0] < 1 or list(entry.lines) != sorted(set(entry.lines))):
        yield Fault((*place, "lines"), "should be rising harmonics, each from 1 on and once")
    if entry.highest < 1:
        yield Fault((*place, "highest"), f"= {entry.highest} should be a harmonic from 1 on")
    if entry.sweep and not (len(entry.sweep) == 2 and 1 <= entry.sweep[0] < entry.sweep[1]):
        yield Fault((*place, "sweep"), "should be two harmonics, from 1 on and rising: [3, 17]")
    several = [key for key in ("lines", "sweep", "recorded") if getattr(entry, key)]
    for key in several[1:]:
        yield Fault((*place, key), f"and {several[0]} are both given; one is enough")


def gate_faults(entry: PlanEntry | Defaults, place: Place) -> Iterator[Fault]:
    """Yield a target that cannot be reached."""
    target = entry.target_relative
    if target is not None and not 0.0 < target < 1.0:
        yield Fault((*place, "target_relative"), f"= {target:g} should be between 0 and 1")


def control_faults(control: ControlTable, place: Place) -> Iterator[Fault]:
    """Yield what is wrong with the control condition."""
    for fault in _motion_faults(control.entry(), place):
        message = fault.message
        for many, single in _SINGLE.items():
            message = message.replace(many, single)
        yield Fault(tuple(_SINGLE.get(str(key), key) for key in fault.place), message)


def end_faults(entry: PlanEntry, defaults: Defaults, place: Place) -> Iterator[Fault]:
    """Yield what is wrong with an end by target, defaults included."""
    if entry.motion is None:
        return
    target = first_of(entry.target_relative, defaults.target_relative)
    fewest = entry.periods or defaults.periods
    most = first_of(entry.max_periods, defaults.max_periods)
    if target is not None and most is None:
        yield Fault(place, "has a target_relative and needs max_periods, where it ends at last")
    elif target is None and most is not None:
        yield Fault(place, "has max_periods and needs target_relative, or periods alone")
    elif most is not None and most < fewest:
        yield Fault(place, f"has max_periods = {most}, which is below periods = {fewest}")


def _motion_faults(entry: PlanEntry, place: Place) -> Iterator[Fault]:
    motion = entry.motion
    if motion is Motion.NONE:
        yield Fault((*place, "motion"), '= "none" is for runs at rest, which need no motion')
    phases = bool(entry.strut_phases_rad)
    if motion is Motion.PHASE and not phases:
        yield Fault(place, 'needs strut_phases_deg for the motion "phase"')
    elif phases and motion is not Motion.PHASE:
        reason = "follows from the motion" if motion else "goes with a motion"
        yield Fault((*place, "strut_phases_deg"), f'{reason}; give it with motion = "phase"')
    drifts = bool(entry.drifts_rad)
    if motion is Motion.YAW_DRIFT and not drifts:
        yield Fault(place, 'needs drifts_deg for the motion "yaw-drift"')
    elif motion in (Motion.HEAVE, Motion.PITCH, Motion.YAW) and drifts:
        yield Fault((*place, "drifts_deg"), f"is of no use to {motion}; yaw-drift has a drift")


def circle_faults(entry: PlanEntry, oscillator: Oscillator | None, place: Place) -> Iterator[Fault]:
    """Yield a circle on a rig that does not measure what turning does."""
    vertical = oscillator is not None and oscillator.plane is Plane.VERTICAL
    if entry.kind is RunKind.CIRCLE and vertical:
        yield Fault((*place, "kind"), '= "circle" is for the horizontal oscillator')


def rig_faults(
    motion: Motion | None, oscillator: Oscillator | None, place: Place
) -> Iterator[Fault]:
    """Yield a motion that the rig's plane does not have."""
    plane = _PLANES.get(motion) if motion is not None else None
    if oscillator is not None and plane is not None and plane is not oscillator.plane:
        motions = ", ".join(name for name, its in _PLANES.items() if its is oscillator.plane)
        yield Fault(
            (*place, "motion"),
            f'= "{motion}" is a motion of the {plane} oscillator; the rig\'s is '
            f"{oscillator.plane}: {motions}, phase",
        )


def path_faults(entry: PlanEntry, oscillator: Oscillator | None, place: Place) -> Iterator[Fault]:
    """Yield paths that go with nothing else there, or that the rig's struts do not follow."""
    if entry.exact:
        if entry.many_lines:
            text = f"is for one frequency at a time; leave {entry.many_lines} out"
            yield Fault((*place, "exact"), text)
        if entry.motion in (Motion.PHASE, Motion.YAW_DRIFT) or any(entry.drifts_rad):
            yield Fault((*place, "exact"), "is for heave, pitch, sway and yaw without a drift")
    if entry.steady_ahead and not entry.exact:
        yield Fault((*place, "steady_ahead"), "goes with exact = true; say both")
    elif entry.steady_ahead and not all(speed > 0.0 for speed in entry.speeds_m_s or (0.0,)):
        yield Fault((*place, "steady_ahead"), "needs speeds_m_s above 0: it keeps that speed")
    key = "exact" if entry.exact else entry.many_lines
    if key and oscillator is not None:
        yield from (Fault((*place, key), f": {text}") for text in struts_faults(oscillator))


def channel_faults(
    entry: PlanEntry, channels: Sequence[str] | None, place: Place
) -> Iterator[Fault]:
    """Yield channels that the rig does not have."""
    if channels is None:
        return
    for name in entry.channels:
        if name not in channels:
            said = unknown((name,), channels).replace("a known key", "a force channel of the rig")
            yield Fault((*place, "channels"), f"has {name!r}, which {said}")
