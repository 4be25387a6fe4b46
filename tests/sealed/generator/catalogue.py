"""The catalogue's effects, each in this reality's own form; names are those of docs/effects.md.

Left out are two of them: the window of a non-integer number of cycles is an analysis, no rig, and
friction above the dynamometers is a case of its own that no channel shows.
"""

import math
from math import pi

from tests.sealed.generator.effect import Effect, heavier, inverse, slow_loop
from tests.sealed.generator.parameters import FloatArray, P

DRIVE, MECHANISM, STRUCTURE = "drive", "mechanism", "structure"
WATER, CARRIAGE = "model and water", "carriage"
GAUGE, CHAIN, PHOTOCELL = "dynamometers", "acquisition", "photocell"
# The frame is damped even where stiff, so that all with contacts share a base.
CONTACT = {P.GAUGE_STIFFNESS: 2e7, P.GAUGE_DAMPING: 2e4, P.FRAME_DAMPING: 4e3}
_TURN = (-pi, pi)
_FLYWHEEL = 1e5


def _droop(p: FloatArray, size: float) -> None:
    if size > 0.0:
        # What turns is heavy enough that the speed follows the torque in 4 ms at the quickest.
        heavier(p, max(100.0, 4e-3 / size) / p[P.MOTOR_INERTIA])
        p[P.SERVO_P], p[P.SERVO_I] = 1.0 / size, 0.0


def _load_ripple(p: FloatArray, size: float) -> None:
    if size > 0.0:
        heavier(p, 1.0 / size / (p[P.MOTOR_INERTIA] + p[P.CRANK_INERTIA]))
        slow_loop(p, 0.1)


def _cogging(p: FloatArray, size: float) -> None:
    # So heavy that the load, which such a loop does not hold, moves it by nothing that is seen.
    p[P.MOTOR_INERTIA] = 200.0 * _FLYWHEEL
    slow_loop(p, 0.15)
    p[P.COGGING] = size * _FLYWHEEL


def _lag(p: FloatArray, size: float) -> None:
    if size > 0.0:
        p[P.LAG_POLES], p[P.LAG_HZ] = 2.0, 1.0 / (pi * size)


def _give(p: FloatArray, size: float) -> None:
    if size > 0.0:
        stiffness = 1.0 / max(size, 1e-8)
        p[P.GAUGE_STIFFNESS] = stiffness
        p[P.GAUGE_DAMPING] = 0.2 * math.sqrt(40.0 * stiffness)


def _clip(p: FloatArray, size: float) -> None:
    if size > 0.0:
        p[P.CLIP_HIGH] = p[P.CLIP_LOW] = 1.0 / size


def _missed(p: FloatArray, size: float) -> None:
    p[P.MISSED] = round(1.0 / size) if size > 0.0 else 0.0


def _other_joint(p: FloatArray, size: float) -> None:
    if size > 0.0:
        p[P.SLIDES_ON_RIG] = 1.0 - p[P.SLIDES_ON_RIG]


_DRIVE = (
    Effect("speed-ripple", DRIVE, "transmission error of the teeth with its double", 5e-3, 0.03,
           {P.TEETH: 1.0}, draws={P.TEETH_ORDER: (0.5, 2.49), P.TEETH_PHASE: _TURN},
           parameter="relative"),
    Effect("torque-cogging", DRIVE, "cogging of a heavy motor with a slow speed loop", 5.0, 40.0,
           change=_cogging, draws={P.COGGING_ORDER: (0.5, 3.49), P.COGGING_PHASE: _TURN},
           settles=None, rebased=True),
    Effect("speed-droop", DRIVE, "motor without integral action, 100 kg m2", 0.01, 0.3,
           change=_droop, settles=None, parameter="droop_rad_s_n_m"),
    Effect("load-ripple", DRIVE, "light shaft with a loop of 0.1 Hz", 0.02, 0.5,
           change=_load_ripple, settles=None),
    Effect("gear-backlash", DRIVE, "impacts in the gear's clearance", 5e-4, 5e-3,
           {P.BACKLASH: 1.0},
           sets={P.CRANK_INERTIA: 120.0, P.GEAR_STIFFNESS: 6e7, P.GEAR_DAMPING: 6e4},
           settles=None, rebased=True),
    Effect("frequency-error", DRIVE, "set speed off", 1e-3, 0.01, {P.SPEED_ERROR: 1.0},
           signed=True, parameter="relative"),
)  # fmt: skip

_MECHANISM = (
    Effect("connecting-rod", MECHANISM, "crank and rod, exact geometry", 0.5, 2.0,
           change=inverse(P.ROD), needs="yoke"),
    Effect("slot-tilt", MECHANISM, "tilted slot", 5e-3, 0.02, {P.TILT_AFT: 1.0}, signed=True,
           parameter="tilt_aft_rad", needs="yoke"),
    Effect("eccentricity-error", MECHANISM, "aft eccentricity off", 1e-4, 1e-3,
           {P.ECC_ERROR_AFT: 1.0}, signed=True, parameter="error_aft_m"),
    Effect("strut-phase-error", MECHANISM, "phase shifter off", 5e-3, 0.02, {P.PHASE_ERROR: 1.0},
           signed=True, parameter="error_rad"),
    Effect("foreshortening", MECHANISM, "joint that slides at its other end", 1.0, 1.0,
           change=_other_joint, fixed=True),
    Effect("joint-play", MECHANISM, "play taken up exponentially with travel", 5e-5, 5e-4,
           {P.PLAY: 1.0}, sets=CONTACT, settles=1.5, parameter="half_play_m"),
    Effect("free-play", MECHANISM, "clearance with impacts that the load crosses", 5e-5, 5e-4,
           {P.KNOCK: 1.0}, sets=CONTACT, settles=1.5, parameter="half_play_m"),
)  # fmt: skip

_STRUCTURE = (
    Effect("gauge-compliance", STRUCTURE, "gauges as springs and dashpots", 2e-6, 2e-5,
           change=_give, settles=1.5),
    Effect("frame-compliance", STRUCTURE, "frame as one mass on a spring", 2e-7, 3e-6,
           change=inverse(P.FRAME_STIFFNESS), sets=CONTACT, settles=1.5),
    Effect("coulomb-friction", STRUCTURE, "LuGre bristles", 0.3, 5.0, {P.COULOMB: 1.0},
           settles=0.75),
    Effect("stribeck-friction", STRUCTURE, "LuGre bristles, Tustin's exponential", 0.15, 5.0,
           {P.STRIBECK: 1.0}, draws={P.STRIBECK_SPEED: (0.01, 0.04)}, settles=0.75),
    Effect("load-friction", STRUCTURE, "LuGre bristles under the strut's load", 0.01, 0.2,
           {P.LOAD_FRICTION: 1.0}, settles=0.75, parameter="friction"),
    Effect("viscous-guides", STRUCTURE, "oil that thins with speed", 2.0, 40.0,
           {P.GUIDE_BELOW: 1.0}),
    Effect("cable", STRUCTURE, "Bouc-Wen loop on a softening spring", 1.0, 15.0,
           {P.CABLE_STIFFNESS: 5.0, P.CABLE_RUBBING: 1.0}, sets={P.CABLE_SOFTENING: 20.0},
           settles=0.75),
)  # fmt: skip

_MODEL = (
    Effect("mass-error", WATER, "mass off", 5e-3, 0.04, scales={P.MASS: 1.0}, signed=True,
           parameter="relative"),
    Effect("inertia-error", WATER, "inertia and centre of gravity off", 0.01, 0.08,
           {P.CG_X: 0.2, P.CG_Z: 0.2}, {P.INERTIA: 1.0}, signed=True,
           parameter="inertia_relative"),
    Effect("entrained-water", WATER, "water on a hardening spring", 1.0, 8.0, {P.SLOSH_MASS: 1.0},
           sets={P.SLOSH_HARDENING: 60.0}, draws={P.SLOSH_OMEGA: (6.0, 14.0)}, settles=None),
    Effect("strut-tare", WATER, "wet struts: mass, oil film and drag", 0.5, 5.0,
           {P.TARE_MASS: 0.5, P.TARE_VISCOUS: 1.0, P.TARE_QUADRATIC: 2.5}),
    Effect("added-mass-error", WATER, "added mass off", 0.1, 0.8,
           scales={P.ADDED_00: 1.0, P.ADDED_11: 1.0}, signed=True),
    Effect("damping-error", WATER, "linear damping off", 0.2, 0.8,
           scales={P.DAMPING_00: 1.0, P.DAMPING_11: 1.0}, signed=True),
)  # fmt: skip

_WATER = (
    Effect("quadratic-damping", WATER, "drag, rounded at rest", 1.0, 15.0,
           {P.QUADRATIC_0: 100.0, P.QUADRATIC_1: 15.0}),
    Effect("quadratic-drift", WATER, "drag in a current", 1.0, 15.0, {P.QUADRATIC_0: 100.0},
           sets={P.DRIFT_SPEED: 0.02}),
    Effect("cubic-damping", WATER, "cubic drag that saturates", 1.0, 15.0,
           {P.CUBIC_0: 300.0, P.CUBIC_1: 40.0}),
    Effect("nonlinear-restoring", WATER, "flare as hyperbolic functions", 1.0, 10.0,
           {P.FLARE_2: 1000.0, P.FLARE_3: 1e4}, signed=True),
    Effect("memory", WATER, "convolution with a Gaussian retardation function", 1.0, 15.0,
           {P.MEMORY_0: 150.0, P.MEMORY_1: 40.0}, draws={P.MEMORY_RATE: (3.0, 8.0)},
           settles=1.5),
    Effect("tank-walls", WATER, "echoes by a delay line", 0.05, 0.6, {P.ECHO: 1.0},
           draws={P.ECHO_DELAY: (0.7, 2.2)}, settles=None),
    Effect("surface-suction", WATER, "square of a gap", 3.0, 60.0, {P.SUCTION: 1.0},
           draws={P.SUCTION_RATE: (4.0, 10.0)}, signed=True, needs="speed"),
    Effect("ground-suction", WATER, "square of the gap to the bottom", 3.0, 60.0, {P.GROUND: 1.0},
           draws={P.CLEARANCE: (0.3, 0.6)}, signed=True, needs="speed"),
    Effect("blockage", WATER, "faster flow and more added mass and damping", 0.01, 0.08,
           {P.BLOCKAGE: 1.0}, needs="speed"),
    Effect("residual-waves", WATER, "two waves that beat and die out", 10.0, 60.0, {P.WAVE: 1.0},
           draws={P.WAVE_HZ: (0.3, 1.4), P.WAVE_PHASE: _TURN}, settles=None),
    Effect("dynamic-trim", WATER, "restoring that saturates with the square of the speed", 1.0,
           15.0, {P.TRIM_LOAD: 1.0, P.TRIM_1: 50.0, P.TRIM_2: 250.0}, signed=True,
           needs="speed"),
    Effect("carriage-speed", CARRIAGE, "mean speed off", 5e-3, 0.05, {P.CARRIAGE_ERROR: 1.0},
           signed=True, parameter="relative", needs="speed"),
    Effect("carriage-fluctuation", CARRIAGE, "swell with a line at 1.41 times", 5e-3, 0.05,
           {P.SURGE: 1.0}, draws={P.SURGE_HZ: (0.13, 0.9), P.SURGE_PHASE: _TURN}, settles=None,
           parameter="relative", needs="speed"),
)  # fmt: skip

_MEASUREMENT = (
    Effect("gain-error", GAUGE, "gain of the aft gauge", 5e-3, 0.05, {P.GAIN_AFT: 1.0},
           signed=True, measured=True, parameter="aft"),
    Effect("cross-talk", GAUGE, "each gauge feels the other", 5e-3, 0.08,
           {P.TALK_AFT: 1.0, P.TALK_FORE: 1.0}, signed=True, measured=True, parameter="aft"),
    Effect("quadratic-gauge", GAUGE, "curved characteristic that levels off", 5e-6, 1e-4,
           {P.CURVATURE: 1.0}, signed=True, measured=True, parameter="curvature_1_n"),
    Effect("gauge-hysteresis", GAUGE, "sum of play operators", 5e-6, 1e-4, {P.HYSTERESIS: 1.0},
           settles=1.25, measured=True, parameter="beta_1_n"),
    Effect("zero-offset", GAUGE, "aft zero off", 0.3, 4.0, {P.ZERO_AFT: 1.0}, signed=True,
           measured=True, parameter="aft_n"),
    Effect("zero-drift", GAUGE, "zero that warms up exponentially", 5e-3, 0.05,
           {P.WARMING_AFT: 1.0}, signed=True, settles=None, measured=True),
    Effect("saturation", GAUGE, "range that ends in a bend", 0.01, 0.04, change=_clip,
           measured=True, fixed=True),
    Effect("temperature", GAUGE, "warming over the campaign", 0.5, 3.0, {P.KELVIN_HOUR: 1.0},
           sets={P.GAIN_KELVIN: 2e-4, P.ZERO_KELVIN: 0.05, P.DAMPING_KELVIN: -3e-3,
                 P.DENSITY_KELVIN: -2e-4}, signed=True, parameter="rate_k_h"),
    Effect("amplifier-lag", CHAIN, "two equal poles", 5e-3, 0.05, change=_lag, settles=1.0,
           measured=True),
    Effect("channel-skew", CHAIN, "fore channel late, cubic between samples", 1e-3, 0.02,
           {P.SKEW_FORE: 1.0}, settles=0.5, measured=True, parameter="fore_s"),
    Effect("hum", CHAIN, "mains with its third harmonic", 0.1, 5.0, {P.HUM: 1.0},
           draws={P.HUM_PHASE: _TURN}, settles=None, measured=True, parameter="amplitude_n"),
    Effect("photocell-angle", PHOTOCELL, "mark beside its angle", 5e-3, 0.1, {P.MARK: 1.0},
           signed=True, parameter="late_rad"),
    Effect("photocell-delay", PHOTOCELL, "pulses late", 1e-3, 0.03, {P.PULSE_DELAY: 1.0},
           measured=True, parameter="delay_s"),
    Effect("trigger-jitter", PHOTOCELL, "pulses scatter", 2e-3, 0.05, {P.JITTER: 1.0},
           settles=None, measured=True, parameter="jitter_rad"),
    Effect("missed-pulse", PHOTOCELL, "every so many pulses lost", 0.2, 0.2, change=_missed,
           settles=None, measured=True, fixed=True),
)  # fmt: skip

CATALOGUE: tuple[Effect, ...] = (
    *_DRIVE, *_MECHANISM, *_STRUCTURE, *_MODEL, *_WATER, *_MEASUREMENT
)  # fmt: skip
BY_NAME = {effect.name: effect for effect in CATALOGUE}
