"""Everything that the reality is made of, as one flat vector: one name for each number.

SI units and radians. Names that end in ``_AFT`` are followed by their ``_FORE``, and ``_0``
(translation) by ``_1`` (rotation), so that compiled code may add 0 or 1.
"""

from enum import IntEnum, auto

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


class P(IntEnum):
    """Place of each number in the vector."""

    @staticmethod
    def _generate_next_value_(
        name: str,
        start: int,
        count: int,
        last_values: list[int],
    ) -> int:
        return count

    # The run.
    OMEGA = auto()
    ECCENTRICITY = auto()
    STRUT_PHASE = auto()
    SPEED = auto()
    WATER = auto()  # 1 in water, 0 in air
    PRELOAD = auto()  # dead weight on the model
    WAITED = auto()  # seconds since the run before
    HOUR = auto()  # hours since the campaign began
    # Geometry.
    LEVER = auto()  # struts stand at +-LEVER
    AFT_SIGN = auto()  # +1: a positive rotation moves the aft strut forward along d
    INCIDENCE = auto()  # +1 or -1: velocity through the water is v + INCIDENCE * U * rotation
    GRAVITY = auto()  # 0 in the horizontal plane
    ROD = auto()  # length of the connecting rod; 0 is a yoke
    ROD_OFFSET = auto()
    TILT_AFT = auto()
    TILT_FORE = auto()
    ECC_ERROR_AFT = auto()
    ECC_ERROR_FORE = auto()
    PHASE_ERROR = auto()
    # Drive, all seen from the crank's shaft.
    MOTOR_INERTIA = auto()
    CRANK_INERTIA = auto()
    SERVO_P = auto()
    SERVO_I = auto()
    SPEED_ERROR = auto()
    GEAR_STIFFNESS = auto()
    GEAR_DAMPING = auto()
    BACKLASH = auto()  # half the clearance
    TEETH = auto()  # transmission error, relative speed
    TEETH_ORDER = auto()
    TEETH_PHASE = auto()
    COGGING = auto()
    COGGING_ORDER = auto()
    COGGING_PHASE = auto()
    CREEP = auto()  # belt: lost speed per torque
    GUIDE_COULOMB = auto()  # above the dynamometers
    GUIDE_VISCOUS = auto()
    # Joints, gauges, frame.
    GAUGE_STIFFNESS = auto()  # 0 is rigid
    GAUGE_DAMPING = auto()
    KNOCK = auto()  # half the clearance of a joint that the load throws about
    PLAY = auto()  # half the clearance of a joint that friction holds
    FRAME_STIFFNESS = auto()  # 0 is rigid
    FRAME_MASS = auto()
    FRAME_DAMPING = auto()
    FRAME_SHAKE = auto()  # force on the frame from wheels and rails
    FRAME_SHAKE_HZ = auto()
    # Friction and springs between model and carriage, below the dynamometers.
    COULOMB = auto()
    UNEVEN = auto()  # friction forward less friction backward
    STRIBECK = auto()
    STRIBECK_SPEED = auto()
    LOAD_FRICTION = auto()
    SIDE_LOAD = auto()
    GUIDE_BELOW = auto()
    CABLE_STIFFNESS = auto()
    CABLE_RUBBING = auto()
    CABLE_PRELOAD = auto()
    CABLE_SOFTENING = auto()
    # Model.
    MASS = auto()
    INERTIA = auto()
    CG_X = auto()
    CG_Z = auto()
    SLOSH_MASS = auto()
    SLOSH_OMEGA = auto()
    SLOSH_DAMPING = auto()
    SLOSH_HARDENING = auto()
    TARE_MASS = auto()
    TARE_VISCOUS = auto()
    TARE_QUADRATIC = auto()
    # Water.
    ADDED_00 = auto()
    ADDED_01 = auto()
    ADDED_10 = auto()
    ADDED_11 = auto()
    DAMPING_00 = auto()
    DAMPING_01 = auto()
    DAMPING_10 = auto()
    DAMPING_11 = auto()
    RESTORING_00 = auto()
    RESTORING_01 = auto()
    RESTORING_10 = auto()
    RESTORING_11 = auto()
    QUADRATIC_0 = auto()
    QUADRATIC_1 = auto()
    DRIFT_SPEED = auto()
    CUBIC_0 = auto()
    CUBIC_1 = auto()
    FLARE_2 = auto()
    FLARE_3 = auto()
    SUCTION = auto()
    SUCTION_RATE = auto()
    GROUND = auto()
    CLEARANCE = auto()
    BLOCKAGE = auto()
    TRIM_LOAD = auto()
    TRIM_1 = auto()
    TRIM_2 = auto()
    MEMORY_0 = auto()
    MEMORY_1 = auto()
    MEMORY_RATE = auto()
    MEMORY_SHAPE = auto()  # 0: exponential kernel, 1: Gaussian
    ECHO = auto()
    ECHO_DELAY = auto()
    ECHO_DECAY = auto()
    WAVE = auto()
    WAVE_HZ = auto()
    WAVE_DECAY = auto()
    WAVE_PHASE = auto()
    WAKE = auto()
    WAKE_DIAMETER = auto()
    STROUHAL = auto()
    VENTILATION = auto()
    VENTILATION_SPEED = auto()
    # Carriage.
    CARRIAGE_ERROR = auto()
    SURGE = auto()
    SURGE_HZ = auto()
    SURGE_PHASE = auto()
    # Dynamometers.
    GAIN_AFT = auto()
    GAIN_FORE = auto()
    TALK_AFT = auto()
    TALK_FORE = auto()
    DRAG_TALK = auto()
    CURVATURE = auto()
    HYSTERESIS = auto()
    ZERO_AFT = auto()
    ZERO_FORE = auto()
    WARMING_AFT = auto()  # slope of the zero at the start of a record
    WARMING_FORE = auto()
    CLIP_HIGH = auto()
    CLIP_LOW = auto()
    KELVIN_HOUR = auto()
    GAIN_KELVIN = auto()
    ZERO_KELVIN = auto()
    DAMPING_KELVIN = auto()
    DENSITY_KELVIN = auto()
    CHECK_AFT = auto()  # known weight on a dynamometer
    CHECK_FORE = auto()
    INJECTED = auto()  # sine in place of the bridges
    # Amplifiers, converter, photocell.
    LAG_HZ = auto()  # 0: none
    LAG_POLES = auto()
    SKEW_AFT = auto()
    SKEW_FORE = auto()
    HUM = auto()
    HUM_HZ = auto()
    HUM_PHASE = auto()
    SCALE_AFT = auto()  # of the displacement sensors
    SCALE_FORE = auto()
    MARK = auto()
    PULSE_DELAY = auto()
    JITTER = auto()
    MISSED = auto()  # one pulse in so many; 0: none
    # How the rig is arranged.
    SLIDES_ON_RIG = auto()  # 0: one attachment slides on the model; 1: one strut on the rig
    FORE_PIVOT = auto()
    RIG_GAUGES = auto()
    RIG_TURNED = auto()  # rad, from ahead to across, as all of these
    STRUTS_OFFSET = auto()
    MODEL_TURNED = auto()
    SURGE_UU = auto()  # force along the model by u |u|; resistance is negative
    # Always on.
    RIPPLE_1S = auto()  # relative speed, by the sine's and the cosine's transmission error
    RIPPLE_1C = auto()
    RIPPLE_2S = auto()
    RIPPLE_2C = auto()
    # Water that varies with frequency and speed.
    KERNEL_0 = auto()
    KERNEL_1 = auto()
    KERNEL_RATE = auto()
    KERNEL_OMEGA = auto()
    MIDDLE_HZ = auto()
    ADDED_SLOPE_0 = auto()  # relative per octave
    ADDED_SLOPE_1 = auto()
    DAMPING_SLOPE_0 = auto()
    DAMPING_SLOPE_1 = auto()
    ADDED_BEND_0 = auto()  # relative per octave squared
    ADDED_BEND_1 = auto()
    DAMPING_BEND_0 = auto()
    DAMPING_BEND_1 = auto()
    MIDDLE_SPEED = auto()
    ADDED_SPEED = auto()  # relative per relative change of speed
    DAMPING_SPEED = auto()
    # Other forms; 0 is the one that the names above mean.
    TEETH_SHAPE = auto()
    COGGING_SHAPE = auto()
    SERVO_SOFT = auto()  # rad/s at which the torque levels off
    CONTACT_SOFT = auto()
    GAUGE_UNLIKE = auto()
    BRISTLE_SHAPE = auto()  # 1: hyperbolic tangent, 2: Bouc-Wen with n = 2
    PLAY_SHAPE = auto()
    GUIDE_POWER = auto()
    DRAG_POWER = auto()
    CUBIC_POWER = auto()
    FLARE_SHAPE = auto()
    GAP_SHAPE = auto()
    ECHO_SHAPE = auto()
    CURVE_SHAPE = auto()
    LOOP_SHAPE = auto()
    WARMING_SHAPE = auto()
    KELVIN_SHAPE = auto()
    CLIP_SOFT = auto()
    LAG_SHAPE = auto()  # 1: Butterworth, 2: Bessel
    SKEW_SHAPE = auto()
    HUM_SHAPE = auto()
    JITTER_SHAPE = auto()
    MISSED_SHAPE = auto()


_NEUTRAL = {
    P.WATER: 1.0,
    P.LEVER: 0.5,
    P.AFT_SIGN: 1.0,
    P.INCIDENCE: 1.0,
    P.GRAVITY: 9.80665,
    P.WAITED: 300.0,
    P.MOTOR_INERTIA: 20.0,
    P.CRANK_INERTIA: 8.0,
    P.SERVO_P: 8.4e3,
    P.SERVO_I: 8.0e5,
    P.GEAR_STIFFNESS: 5e5,
    P.GEAR_DAMPING: 1100.0,
    P.TEETH_ORDER: 1.0,
    P.COGGING_ORDER: 1.0,
    P.GAUGE_DAMPING: 3e4,
    P.FRAME_MASS: 500.0,
    P.STRIBECK_SPEED: 0.02,
    P.SLOSH_OMEGA: 7.0,
    P.SLOSH_DAMPING: 0.05,
    P.CLEARANCE: 1.0,
    P.SUCTION_RATE: 8.0,
    P.MEMORY_RATE: 5.0,
    P.MEMORY_SHAPE: 1.0,
    P.ECHO_DELAY: 1.0,
    P.ECHO_DECAY: 0.5,
    P.WAVE_HZ: 0.6,
    P.WAVE_DECAY: 200.0,
    P.WAKE_DIAMETER: 0.04,
    P.STROUHAL: 0.2,
    P.VENTILATION_SPEED: 0.9,
    P.GAIN_AFT: 1.0,
    P.GAIN_FORE: 1.0,
    P.CLIP_HIGH: 1e9,
    P.CLIP_LOW: 1e9,
    P.LAG_POLES: 1.0,
    P.HUM_HZ: 50.0,
    P.SCALE_AFT: 1.0,
    P.SCALE_FORE: 1.0,
    P.KERNEL_RATE: 3.0,
    P.MIDDLE_HZ: 0.6,
    P.MIDDLE_SPEED: 1.0,
    P.CLIP_SOFT: 0.03,
}


def neutral() -> FloatArray:
    """Return the vector of a rig without model, water, effects or flaws."""
    vector = np.zeros(len(P))
    for place, value in _NEUTRAL.items():
        vector[place] = value
    return vector
