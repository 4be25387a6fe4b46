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
_NONE = "no limit stated"
_ONLY_STATED = "nothing: it is stated, not judged"
_OWN = "twice: what the rig allows is allowed twice as far, at the rig's risk; half: fewer runs"


FREQUENCY: Final = Check(
    "frequency [Hz]",
    "refuse outside `oscillator.frequency_hz` or the shaft drive's range",
    _RIG,
    "choose another frequency",
    _OWN,
)
AMPLITUDE: Final = Check(
    "amplitude [m]",
    "refuse outside `oscillator.eccentricity_m` or the eccentricity axis's range",
    _RIG,
    "choose another amplitude; it is half the stroke",
    _OWN,
)
STROKE: Final = Check(
    "stroke [m]",
    "refuse above `limits.stroke_m`",
    _RIG,
    "choose another amplitude; it is half the stroke",
    _OWN,
)
STRUT_PHASE: Final = Check(
    "strut phase [rad]",
    "refuse outside the phase axis's range",
    _RIG,
    "choose another phase, or another speed or frequency",
    _OWN,
)
VELOCITY: Final = Check(
    "strut velocity [m/s]",
    "refuse above `limits.velocity_m_s`",
    _RIG,
    "lower the frequency or the amplitude",
    _OWN,
)
ACCELERATION: Final = Check(
    "strut acceleration [m/s^2]",
    "refuse above `limits.acceleration_m_s2`",
    _RIG,
    "lower the frequency or the amplitude",
    _OWN,
)
STRUT_FORCE: Final = Check(
    "strut force, estimate [N]",
    "refuse above `oscillator.force_per_strut_n`",
    _RIG,
    "lower the frequency or the amplitude",
    _OWN,
)
GAUGE_FORCE: Final = Check(
    "gauge force, estimate [N]",
    "refuse above the gauges' full scale; warn above {0:.0%} of it",
    f"{_RIG}; the share is {_OURS}",
    "lower the frequency or the amplitude: the estimate may be short of the truth",
    "half: warned of from 40 % on; twice: never warned of",
    (0.8,),
)
LOAD: Final = Check(
    "load on {channel} [N]", "refuse above the gauge's full scale", _RIG, "load it less", _OWN
)
SPEED: Final = Check(
    "speed [m/s]",
    "refuse above `tank.highest_speed_m_s`, or the carriage's own `highest_speed_m_s`",
    _RIG,
    "tow slower",
    _OWN,
)
LED_SPEED: Final = Check(
    "slowest speed of a carriage that is led [m/s]",
    "`steady_ahead`: refuse below 0, and without drivers that lead struts and carriage",
    "the carriage, which does not turn back within a run",
    "tow faster, or lower the frequency or the amplitude",
    "nothing: below 0 it would turn back",
)
LED_ACCELERATION: Final = Check(
    "carriage acceleration [m/s^2]",
    "`steady_ahead`: refuse above the carriage's own `acceleration_m_s2`, or the tank's",
    _RIG,
    "lower the frequency or the amplitude",
    _OWN,
)
STATIC_ANGLE: Final = Check(
    "{channel} [rad]",
    "refuse outside the range of the axis that sets it",
    _RIG,
    "choose another angle, or have it set by hand: leave the axis's table out",
    _OWN,
)
WAY: Final = Check(
    "tank length [m]",
    "refuse above `tank.length_m` or the carriage's `track_m`, from rest to rest",
    _RIG,
    "tow slower, or ask for fewer periods or less settling",
    _OWN,
)
TURN_RATE: Final = Check(
    "rate of turn [rad/s]",
    "refuse above the carriage's own `highest_turn_rate_rad_s`",
    _RIG,
    "tow slower, choose a larger radius, or have the circle driven by hand: leave the carriage's "
    "table out",
    _OWN,
)
RADIUS: Final = Check(
    "radius of the circle [m]",
    "refuse outside `tank.radius_m`",
    _RIG,
    "choose another radius",
    _OWN,
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

ROTATION: Final = Check(
    "largest {rotation} [deg]",
    f"note; {_NONE}",
    _ITTC,
    "drift is part of it; of the exact motion, by the joint's sine or tangent",
    _ONLY_STATED,
)
ANGLE_TO_FLOW: Final = Check(
    "largest angle to the flow [deg]",
    f"note; {_NONE}",
    _ITTC,
    "the drift angle beta, or the angle of attack; coefficients hold within it",
    _ONLY_STATED,
)
FROUDE: Final = Check(
    "Froude number Fn = U / sqrt(g L)",
    f"note; {_NONE}",
    _ITTC,
    "waves are those of the ship at the same number",
    _ONLY_STATED,
)
REYNOLDS: Final = Check(
    "Reynolds number Re = U L / nu",
    f"note; {_NONE}",
    f"{_ITTC}; nu by ITTC 7.5-02-01-03",
    "friction is that of the ship at the same number only",
    _ONLY_STATED,
)
TURNING: Final = Check(
    "{rate}' = {rate} L / U",
    f"note; {_NONE}",
    _ITTC,
    "the turns of the ship that it spans; coefficients hold within it",
    _ONLY_STATED,
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
REDUCED: Final = Check(
    REDUCED_SWAY.quantity, f"other motions: note; {_NONE}", _ITTC, "it is asked for", _ONLY_STATED
)
WAVE_FREQUENCY: Final = Check(
    "w sqrt(L / g)",
    f"note; {_NONE}",
    _ITTC,
    "the smaller, the less waves the motion makes",
    _ONLY_STATED,
)
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

CHECKS: Final = (
    FREQUENCY, AMPLITUDE, STROKE, STRUT_PHASE, VELOCITY, ACCELERATION, STRUT_FORCE, GAUGE_FORCE,
    LOAD, SPEED, LED_SPEED, LED_ACCELERATION, STATIC_ANGLE, WAY, TURN_RATE, RADIUS, TURNS, BUS,
    ROTATION, ANGLE_TO_FLOW, FROUDE, REYNOLDS, TURNING, REDUCED_SWAY, REDUCED_YAW, REDUCED,
    WAVE_FREQUENCY, TAU_SWAY, TAU_HEAVE, ECHO, REACH, KEEL, BLOCKAGE, DEPTH, DEPTH_FROUDE,
    TANK_MODE, STRUCTURE, CYCLES, SETTLING, RIPPLE, SAMPLING, CHANNEL,
    CALIBRATION,
)  # fmt: skip
"""In the order of the page."""
