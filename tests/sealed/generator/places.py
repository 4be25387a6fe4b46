"""Places in the arrays that the compiled code works on."""

from enum import IntEnum


class Y(IntEnum):
    """Place of each state that is integrated."""

    MOTOR = 0
    MOTOR_SPEED = 1
    SERVO = 2
    CRANK = 3
    CRANK_SPEED = 4
    Q0 = 5
    Q1 = 6
    V0 = 7
    V1 = 8
    FRAME = 9
    FRAME_SPEED = 10
    SLOSH = 11
    SLOSH_SPEED = 12
    WAKE = 13
    WAKE_SPEED = 14


class H(IntEnum):
    """Place of what is held over a step."""

    CREPT = 0
    PLAY_AFT = 1
    PLAY_FORE = 2
    GUIDE_AFT = 3
    GUIDE_FORE = 4
    BRISTLE_AFT = 5
    BRISTLE_FORE = 6
    WOUND_AFT = 7
    WOUND_FORE = 8
    MEMORY_0 = 9
    MEMORY_1 = 10
    AIRED = 11
    FORCE_AFT = 12
    FORCE_FORE = 13


class W(IntEnum):
    """Place of each intermediate value of one evaluation."""

    M00 = 0
    M01 = 1
    M10 = 2
    M11 = 3
    WATER_0 = 4
    WATER_1 = 5
    WAY_AFT = 6  # displacement, slope, curvature
    WAY_FORE = 9
    LINE = 12  # angle of the line of the struts, slope, curvature
    SINE = 15  # of that angle
    COSINE = 16
    OWN_SINE = 17  # of the model's
    OWN_COSINE = 18
    SPIN = 19  # rate of both
    AT_AFT = 20  # displacement behind the gauge
    AT_FORE = 21
    RATE_AFT = 22
    RATE_FORE = 23
    AHEAD = 24  # velocity through the water along the model and across
    THROUGH = 25
    ACROSS = 26  # acceleration across the rig
    BESIDE_AFT = 27  # what a gauge reads beside the model's loads
    BESIDE_FORE = 28
