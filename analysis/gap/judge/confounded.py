"""Effects that no oscillation tells apart, or hardly one, and the measurement that does.

The classes of a campaign, and of pendulums and bodies under a known force, are computed from their
own records (:mod:`analysis.gap.judge.verdict`, :mod:`analysis.gap.pendulum.verdict`); this table
only says what to measure once a class has more than one member.
"""

from collections.abc import Sequence
from itertools import combinations
from typing import Final

_REST = "a record at rest, before and after: an offset stays, friction does not"
_WEIGHT = "a check weight: a gain shows in it, jitter does not"
_INJECTION = "a sine fed into all force amplifiers in place of the bridges"
_AIR = "the same runs in air, without the water's part"
_PRELOAD = "the same run with a dead weight that takes up the play"
_SPEED = "the same runs at another speed"
_LOOSE = "the same run with the cable disconnected"
_PUSH = "a push by hand in the positive direction: force and motion have to read positive"
_SCALES = "a known weight on the force gauge, and a known distance before the sensor"
_DEFLECTION = "the deflection at rest under known weights, which the restoring alone makes"
_OFF_RESONANCE = "a run far from resonance, where damping hardly shows"
_OTHER_SENSOR = "a second sensor of the same motion, with pmm compare"
_SLOW = "a record at rest over the same time: a drift goes on, waves die out"

_SEPARATED: Final = {
    frozenset(pair): how
    for how, pairs in {
        _REST: [("zero-offset", "coulomb-friction"), ("zero-offset", "surface-suction")],
        _WEIGHT: [
            ("gain-error", "trigger-jitter"),
            ("gain-error", "eccentricity-error"),
            ("gain-error", "cross-talk"),
        ],
        _INJECTION: [
            ("amplifier-lag", "channel-skew"),
            ("amplifier-lag", "photocell-delay"),
            ("channel-skew", "photocell-delay"),
            ("amplifier-lag", "viscous-guides"),
        ],
        _AIR: [
            ("mass-error", "added-mass-error"),
            ("inertia-error", "added-mass-error"),
            ("mass-error", "gauge-compliance"),
            ("viscous-guides", "damping-error"),
            ("guide-friction", "damping-error"),
            ("cable", "mass-error"),
            ("coulomb-friction", "quadratic-damping"),
            ("gauge-hysteresis", "quadratic-damping"),
        ],
        _SPEED: [("dynamic-trim", "restoring-error"), ("carriage-speed", "damping-error")],
        _LOOSE: [("cable", "coulomb-friction"), ("cable", "nonlinear-restoring")],
        _PRELOAD: [
            ("joint-play", "gear-backlash"),
            ("free-play", "joint-play"),
            ("free-play", "speed-ripple"),
        ],
        _SLOW: [("zero-drift", "residual-waves"), ("zero-drift", "temperature")],
        _PUSH: list(combinations(("force_sign", "sensor_delay", "sensor_sign"), 2)),
        _SCALES: [("force", "sensor_gain")],
        _DEFLECTION: [
            ("inertia", "restoring"),
            ("force", "restoring"),
            ("restoring", "sensor_gain"),
            ("force", "inertia"),
            ("inertia", "sensor_gain"),
        ],
        _OFF_RESONANCE: [
            (law, scale)
            for law in ("damping", "viscous_damping", "bearing_friction")
            for scale in ("force", "sensor_gain")
        ],
        _OTHER_SENSOR: [("sensor_delay", "sensor_lag")],
    }.items()
    for pair in pairs
}

_COEFFICIENTS: Final = {"a": "added-mass-error", "b": "damping-error", "c": "restoring-error"}


def coefficient_error(name: str) -> str:
    """Return what an error of a coefficient, ``a11`` or ``c12``, is called among the pairs."""
    return _COEFFICIENTS.get(name[:1], name)


def separating_measurements(names: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Return what to measure to tell members of a class apart, and which ones it tells.

    Empty where nothing is known.
    """
    told: dict[str, dict[str, None]] = {}
    for pair in combinations(sorted(names), 2):
        if frozenset(pair) in _SEPARATED:
            told.setdefault(_SEPARATED[frozenset(pair)], {}).update(dict.fromkeys(pair))
    return {measurement: tuple(pair) for measurement, pair in told.items()}
