"""Every check of a plan in one table: what is looked at, its limit, whose it is, and what moves it.

The checks read their numbers, names and advice here; ``docs/plan-checks.md`` is made of it.

The pages of ITTC 7.5-02-06-02 were not at hand: that it asks for a number, and the bounds of
w L / U and w U / g, are told at second hand. Where no limit of it is known, none is stated.
"""

from typing import Final

from hardware.bus import LARGEST_LOAD
from pmm.plan.check import Check
from pmm.plan.echoes import echo_limit

_RIG = "the rig's file"
_OURS = "this project"
_ITTC = "ITTC 7.5-02-06-02"


def _rig_limit(quantity: str, rule: str, reason: str) -> Check:
    """Return a check by a limit that the rig's file states."""
    moved = (
        "twice: what the rig allows is allowed twice as far, at the rig's risk; half: fewer runs"
    )
    return Check(quantity, rule, _RIG, reason, moved)


def _stated(quantity: str, reason: str, which: str = "", source: str = _ITTC) -> Check:
    """Return a check of what is stated and not judged, of the motions that ``which`` names."""
    moved = "nothing: it is stated, not judged"
    return Check(quantity, f"{which}note; no limit stated", source, reason, moved)


FREQUENCY: Final = _rig_limit(
    "frequency [Hz]",
    "refuse outside `oscillator.frequency_hz` or the shaft drive's range",
    "choose another frequency",
)
AMPLITUDE: Final = _rig_limit(
    "amplitude [m]",
    "refuse outside `oscillator.eccentricity_m` or the eccentricity axis's range",
    "choose another amplitude; it is half the stroke",
)
STROKE: Final = _rig_limit(
    "stroke [m]",
    "refuse above `limits.stroke_m`",
    "choose another amplitude; it is half the stroke",
)
STRUT_PHASE: Final = _rig_limit(
    "strut phase [rad]",
    "refuse outside the phase axis's range",
    "choose another phase, or another speed or frequency",
)
VELOCITY: Final = _rig_limit(
    "strut velocity [m/s]",
    "refuse above `limits.velocity_m_s`",
    "lower the frequency or the amplitude",
)
ACCELERATION: Final = _rig_limit(
    "strut acceleration [m/s^2]",
    "refuse above `limits.acceleration_m_s2`",
    "lower the frequency or the amplitude",
)
STRUT_FORCE: Final = _rig_limit(
    "strut force, estimate [N]",
    "refuse above `oscillator.force_per_strut_n`",
    "lower the frequency or the amplitude, or tow slower or at less drift",
)
GAUGE_FORCE: Final = Check(
    "gauge force, estimate [N]",
    "of each strut: refuse above its gauge's full scale; warn above {0:.0%} of what rest leaves",
    f"{_RIG}; the share is {_OURS}",
    "lower the frequency or the amplitude, or tow slower or at less drift: the estimate may be "
    "short of the truth",
    "half: warned of from 40 % on; twice: never warned of",
    (0.8,),
)
LOAD: Final = _rig_limit(
    "load on {channel} [N]", "refuse above the gauge's full scale", "load it less"
)
SPEED: Final = _rig_limit(
    "speed [m/s]",
    "refuse above `tank.highest_speed_m_s`, or the carriage's own `highest_speed_m_s`",
    "tow slower",
)
LED_SPEED: Final = Check(
    "slowest speed of a carriage that is led [m/s]",
    "`steady_ahead`: refuse below 0, and without drivers that lead struts and carriage",
    "the carriage, which does not turn back within a run",
    "tow faster, or lower the frequency or the amplitude",
    "nothing: below 0 it would turn back",
)
LED_ACCELERATION: Final = _rig_limit(
    "carriage acceleration [m/s^2]",
    "`steady_ahead`: refuse above the carriage's own `acceleration_m_s2`, or the tank's",
    "lower the frequency or the amplitude",
)
STATIC_ANGLE: Final = _rig_limit(
    "{channel} [rad]",
    "refuse outside the range of the axis that sets it",
    "choose another angle, or have it set by hand: leave the axis's table out",
)
WAY: Final = _rig_limit(
    "tank length [m]",
    "refuse above `tank.length_m` or the carriage's `track_m`, from rest to rest",
    "tow slower, or ask for fewer periods or less settling",
)
TURN_RATE: Final = _rig_limit(
    "rate of turn [rad/s]",
    "refuse above the carriage's own `highest_turn_rate_rad_s`",
    "tow slower, choose a larger radius, or have the circle driven by hand: leave the carriage's "
    "table out",
)
RADIUS: Final = _rig_limit(
    "radius of the circle [m]", "refuse outside `tank.radius_m`", "choose another radius"
)
TURNS: Final = Check(
    "turns of the circle",
    "warn above {0:g}",
    _OURS,
    "the model meets its own wake; ask for a shorter duration_s, or a larger radius",
    "half: warned of after half a circle, though its water is calm; twice: a second turn in the "
    "wake of the first is let go by",
    (1.0,),
)
BUS: Final = Check(
    "bus load",
    "refuse above {0:.0%}, when the rig's file is read; else note",
    _OURS,
    "frames that wait for the bus come late; lower the cycle rate",
    "half: half as many devices or cycles; twice: more than the bus carries",
    (LARGEST_LOAD,),
)

ROTATION: Final = _stated(
    "largest {rotation} [deg]",
    "drift is part of it; of the exact motion, by the joint's sine or tangent",
)
ANGLE_TO_FLOW: Final = _stated(
    "largest angle to the flow [deg]",
    "the drift angle beta, or the angle of attack; coefficients hold within it",
)
FROUDE: Final = _stated(
    "Froude number Fn = U / sqrt(g L)", "waves are those of the ship at the same number"
)
REYNOLDS: Final = _stated(
    "Reynolds number Re = U L / nu",
    "friction is that of the ship at the same number only",
    source=f"{_ITTC}; nu by ITTC 7.5-02-01-03",
)
TURNING: Final = _stated(
    "{rate}' = {rate} L / U", "the turns of the ship that it spans; coefficients hold within it"
)
REDUCED_SWAY: Final = Check(
    "w' = w L / U",
    "sway: warn above {1:g}; note below, kept up to {0:g} where possible",
    f"{_ITTC}, practice",
    "the wake of the periods before comes in: lower the frequency or tow faster",
    "half: slower runs, longer tanks; twice: loads of the motion's history count as coefficients",
    (1.0, 2.0),
)
REDUCED_YAW: Final = Check(
    REDUCED_SWAY.quantity,
    "yaw: warn above {1:g}; note below, kept up to {0:g} where possible",
    REDUCED_SWAY.source,
    REDUCED_SWAY.reason,
    REDUCED_SWAY.moved,
    (2.0, 3.0),
)
REDUCED: Final = _stated(REDUCED_SWAY.quantity, "it is asked for", "other motions: ")
WAVE_FREQUENCY: Final = _stated("w sqrt(L / g)", "the smaller, the less waves the motion makes")
TAU_SWAY: Final = Check(
    "w U / g",
    "sway and yaw: warn from {0:g} less a clearance of {1:g}, which is ours; note below",
    f"{_ITTC}; Brard 1948",
    "at 1/4 the waves travel with the model: lower the frequency or the speed",
    "half the clearance: runs nearer to 1/4 pass; twice: warned of from 0.15 on",
    (0.25, 0.05),
)
TAU_HEAVE: Final = Check(
    "w U / g (keep off 1/4)",
    "heave and pitch: warn within {1:g} of {0:g}, a clearance of ours; note outside",
    "Brard 1948",
    "at 1/4 the waves travel with the model: choose another frequency or speed",
    "half the clearance: runs nearer to 1/4 pass; twice: warned of from 0.15 to 0.35",
    TAU_SWAY.numbers,
)
ECHO: Final = Check(
    "w U / g for the walls' echoes",
    "heave and pitch at speed: note below {0:g} at W / L = 0.5 to {1:g} at W / L = 4",
    "ITTC 7.5-02-07-02.1, table 1",
    "what the walls send back reaches the model: raise the frequency or the speed",
    "half: echoes pass unsaid; twice: said of runs that outrun their echoes",
    (echo_limit(0.5), echo_limit(4.0)),
)
REACH: Final = Check(
    "reach to the side [m]",
    "sway and yaw: refuse from half of `tank.width_m`; note within",
    "the tank's wall",
    "midpoint, half the model's length and its beam, swung; without model.beam_m a line",
    "half: twice the room is asked for; twice: the model strikes the wall",
)
KEEL: Final = Check(
    "reach down [m]",
    "heave and pitch: refuse from `tank.depth_m`; note within",
    "the tank's bottom",
    "draught, heave and half the model's length, pitched",
    "half: twice the water is asked for; twice: the model strikes the bottom",
)
BLOCKAGE: Final = Check(
    "blockage B T / (W h)",
    "warn from {0:g}; note below",
    f"{_OURS}, by continuity",
    "the flow past the model is faster by it, loads that go with U^2 by twice as much; "
    "the section is at most B T",
    "half: warned of where loads grow by 1 %; twice: by 4 %",
    (0.01,),
)
DEPTH: Final = Check(
    "depth over draught h / T",
    "note; shallow from {0:g} down",
    "PIANC 1992 (deep water above 3)",
    "in less water added mass and damping grow, as at that depth only",
    "half: medium deep water is called deep; twice: deep water is called shallow",
    (3.0,),
)
DEPTH_FROUDE: Final = Check(
    "depth Froude number",
    "warn from {0:g}; note below",
    "long waves: U = sqrt(g h)",
    "at 1 a wave travels with the model: tow slower",
    "half: runs at half the critical speed warn; twice: the critical speed passes",
    (1.0,),
)
TANK_MODE: Final = Check(
    "distance to a tank mode",
    "warn within {0:.0%}, wavelength 2 W / n; at speed note",
    _OURS,
    "standing waves answer: choose another frequency",
    "half: the flank of a mode with a damping ratio of 0.02 passes; twice: n above 4 unsaid",
    (0.03,),
)
STRUCTURE: Final = Check(
    "distance to a structural mode",
    "of n w, n to 6: within {0:.0%}, or {1:g} damping ratios if more: warn to n = 3, else note",
    _OURS,
    "the structure amplifies that harmonic: choose another frequency",
    "half: what is amplified tenfold passes (now fivefold); twice: nearly threefold",
    (0.1, 3.0),
)
CYCLES: Final = Check(
    "periods after the transient",
    "warn below {0:g}",
    f"practice; {_ITTC} asks for the number",
    "scatter needs them",
    "half: no scatter, so no interval; twice: longer runs, for shorter intervals",
    (3.0,),
)
SETTLING: Final = Check(
    "settling periods",
    "warn below {0:g}",
    f"{_OURS}; {_ITTC} leaves the transient out",
    "the gate would open in the transient",
    "half: a part of the transient counts; twice: a period more of tank",
    (1.0,),
)
RIPPLE: Final = Check(
    "speed ripple, estimate",
    "with `[campaign.drive.motor]`: warn above {0:.1%}; note below",
    f"{_OURS}: twice a turn it changes the first harmonic of the motion by a quarter of it",
    "the shaft gives way to its load: a heavier flywheel, or gains by `pmm devices tune`",
    "half: warned of where the amplitude is off by 0.1 %; twice: by 0.5 %",
    (0.01,),
)
SAMPLING: Final = Check(
    "6th harmonic [Hz]",
    "warn from half the sample rate",
    "Nyquist",
    "raise bus.sync_rate_hz or lower the frequency",
    "half: a filter has room; twice: harmonics fold onto each other",
)
CHANNEL: Final = Check(
    "channel that a run is analysed by",
    "warn where no amplifier's channel is `wave_probe` and a run is made in waves, or `heel_angle` "
    "and a run is a free decay",
    "the analysis, which takes the wave from the probe and a decay from the heel",
    "give a channel of an amplifier that name, or record it by another system",
    "nothing: it is there or not",
)
CALIBRATION: Final = Check(
    "calibration [days past expiry]",
    "warn above 0",
    "the calibration's own date",
    "calibrate again",
    "nothing: the date is the laboratory's",
)

CHECKS: Final = tuple(check for check in tuple(vars().values()) if isinstance(check, Check))
"""In the order of the page."""
