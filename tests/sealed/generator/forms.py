"""World D: every effect of the catalogue in other forms than the ones of world A, a draw of them.

Each is the effect of world A with changes; what no parameter of a shape changes, another share
between struts, terms or modes does.
"""

import math
from dataclasses import replace

import numpy as np

from tests.sealed.generator.catalogue import BY_NAME, CATALOGUE
from tests.sealed.generator.effect import Effect
from tests.sealed.generator.parameters import FloatArray, P


def _of(name: str, form: str, **changes: object) -> Effect:
    """Return the effect of world A in another form; ``more`` is set beside what that one sets."""
    own = BY_NAME[name]
    more = changes.pop("more", {})
    if more:
        changes["sets"] = {**own.sets, **more}  # type: ignore[dict-item]
    return replace(own, form=form, **changes)  # type: ignore[arg-type]


def _filtered(poles: float, shape: float, cutoff: float) -> "Effect":
    def change(p: FloatArray, size: float) -> None:
        if size > 0.0:
            # At low frequencies the delay is that of world A's two poles: ``size``.
            p[P.LAG_POLES], p[P.LAG_SHAPE] = poles, shape
            p[P.LAG_HZ] = cutoff / (2.0 * math.pi * size)

    names = {0.0: "one pole", 1.0: "Butterworth", 2.0: "Bessel"}
    return _of("amplifier-lag", f"{names[shape]}, {poles:g} poles", change=change)


def _clip(p: FloatArray, size: float) -> None:
    if size > 0.0:
        p[P.CLIP_HIGH], p[P.CLIP_LOW] = 1.0 / size, 1.1 / size
        p[P.CLIP_SOFT] = 0.15


def _give(p: FloatArray, size: float) -> None:
    BY_NAME["gauge-compliance"].change(p, size)  # type: ignore[misc]
    p[P.GAUGE_UNLIKE] = 0.25


def _droop(p: FloatArray, size: float) -> None:
    BY_NAME["speed-droop"].change(p, size)  # type: ignore[misc]
    p[P.SERVO_SOFT] = 0.3


def _coupled(p: FloatArray, size: float) -> None:
    BY_NAME["load-ripple"].change(p, size)  # type: ignore[misc]
    p[P.SERVO_P] *= 2.0


def _square(p: FloatArray, size: float) -> None:
    BY_NAME["torque-cogging"].change(p, size)  # type: ignore[misc]
    p[P.COGGING_SHAPE] = 1.0


def _random(p: FloatArray, size: float) -> None:
    BY_NAME["missed-pulse"].change(p, size)  # type: ignore[misc]
    p[P.MISSED_SHAPE] = 1.0


def _other_strut(p: FloatArray, size: float) -> None:
    BY_NAME["foreshortening"].change(p, size)  # type: ignore[misc]
    if size > 0.0:
        p[P.FORE_PIVOT] = 1.0 - p[P.FORE_PIVOT]


_RUBS = ((1.0, "hyperbolic tangent"), (2.0, "Bouc-Wen, n = 2"))

FORMS: tuple[Effect, ...] = (
    _of("speed-ripple", "triangular error of the teeth", more={P.TEETH_SHAPE: 1.0}),
    _of("torque-cogging", "cogging with its double and triple", change=_square),
    _of("speed-droop", "motor whose torque levels off", change=_droop),
    _of("load-ripple", "light shaft with a stiffer loop", change=_coupled),
    _of("gear-backlash", "clearance with a soft lining", more={P.CONTACT_SOFT: 1.0}),
    _of("frequency-error", "set speed off, mark with it", adds={P.SPEED_ERROR: 1.0, P.MARK: 0.02}),
    _of("connecting-rod", "rod beside the crank's centre", more={P.ROD_OFFSET: 0.01}),
    _of("slot-tilt", "both slots, unlike", adds={P.TILT_AFT: 1.0, P.TILT_FORE: 0.3}),
    _of("eccentricity-error", "both pins, unlike",
        adds={P.ECC_ERROR_AFT: 1.0, P.ECC_ERROR_FORE: -0.3}),
    _of("strut-phase-error", "phase shifter off, its pin with it",
        adds={P.PHASE_ERROR: 1.0, P.ECC_ERROR_FORE: 0.005}),
    _of("foreshortening", "joint that slides at its other end and strut", change=_other_strut),
    _of("joint-play", "play taken up at once", more={P.PLAY_SHAPE: 1.0}),
    _of("free-play", "clearance between soft contacts", more={P.CONTACT_SOFT: 1.0}),
    _of("gauge-compliance", "one gauge softer than the other", change=_give),
    _of("frame-compliance", "heavy frame on a spring", more={P.FRAME_MASS: 5000.0}),
    *(_of("coulomb-friction", form, more={P.BRISTLE_SHAPE: shape}) for shape, form in _RUBS),
    *(_of("stribeck-friction", f"{form}, a hyperbola of the speed", more={P.BRISTLE_SHAPE: shape})
      for shape, form in _RUBS),
    *(_of("load-friction", form, more={P.BRISTLE_SHAPE: shape}) for shape, form in _RUBS),
    _of("viscous-guides", "grease: a power of the speed", more={P.GUIDE_POWER: 0.85}),
    _of("cable", "loop on a hardening spring",
        sets={P.CABLE_SOFTENING: -60.0}, adds={P.CABLE_STIFFNESS: 3.0, P.CABLE_RUBBING: 1.5}),
    _of("mass-error", "lump ahead of the centre", adds={P.CG_X: 0.05}),
    _of("inertia-error", "inertia and centre ahead", adds={P.CG_X: 0.3}),
    _of("entrained-water", "damped water", sets={P.SLOSH_DAMPING: 0.3}),
    _of("strut-tare", "mostly mass",
        adds={P.TARE_MASS: 1.0, P.TARE_VISCOUS: 0.5, P.TARE_QUADRATIC: 1.0}),
    _of("added-mass-error", "mostly translation", scales={P.ADDED_00: 1.0, P.ADDED_11: 0.3}),
    _of("damping-error", "mostly translation", scales={P.DAMPING_00: 1.0, P.DAMPING_11: 0.3}),
    _of("quadratic-damping", "power 1.85", sets={P.DRAG_POWER: 1.85}),
    _of("quadratic-damping", "power 2.15", sets={P.DRAG_POWER: 2.15}),
    _of("quadratic-drift", "power 1.85 in a current", more={P.DRAG_POWER: 1.85}),
    _of("cubic-damping", "power 2.75", sets={P.CUBIC_POWER: 2.75}),
    _of("nonlinear-restoring", "flare above a knuckle", sets={P.FLARE_SHAPE: 1.0}),
    _of("memory", "slow tail, a power of the time", sets={P.MEMORY_SHAPE: 2.0}),
    _of("memory", "damped cosine", sets={P.MEMORY_SHAPE: 3.0}),
    _of("tank-walls", "standing wave", more={P.ECHO_SHAPE: 1.0}),
    _of("surface-suction", "cube of a gap", sets={P.GAP_SHAPE: 1.0}),
    _of("ground-suction", "exponential of the gap", sets={P.GAP_SHAPE: 1.0}),
    _of("blockage", "faster flow, more added mass", scales={P.ADDED_00: 1.0, P.ADDED_11: 1.0}),
    _of("residual-waves", "short waves that die soon", sets={P.WAVE_DECAY: 60.0}),
    _of("dynamic-trim", "trim that grows with heave",
        adds={P.TRIM_LOAD: 1.0, P.TRIM_1: 15.0, P.TRIM_2: 800.0}),
    _of("carriage-speed", "mean off, with a slow swell",
        adds={P.CARRIAGE_ERROR: 1.0, P.SURGE: 0.1}, sets={P.SURGE_HZ: 0.03}, settles=None),
    _of("carriage-fluctuation", "rail joints", draws={P.SURGE_HZ: (0.9, 2.5),
        P.SURGE_PHASE: (-math.pi, math.pi)}),
    _of("gain-error", "both gauges, unlike", adds={P.GAIN_AFT: 1.0, P.GAIN_FORE: 0.3}),
    _of("cross-talk", "one way more than the other", adds={P.TALK_AFT: 1.0, P.TALK_FORE: 0.2}),
    _of("quadratic-gauge", "even power 1.7", sets={P.CURVE_SHAPE: 1.0}),
    _of("gauge-hysteresis", "Bouc-Wen loop", sets={P.LOOP_SHAPE: 1.0}),
    _of("zero-offset", "both zeros, unlike", adds={P.ZERO_AFT: 1.0, P.ZERO_FORE: -0.3}),
    _of("zero-drift", "creep, a root of the time", sets={P.WARMING_SHAPE: 1.0}),
    _of("saturation", "soft and uneven range", change=_clip),
    _of("temperature", "warming that levels off", more={P.KELVIN_SHAPE: 1.0}),
    _filtered(1.0, 0.0, 1.0),
    _filtered(4.0, 1.0, 2.6131259297527527),
    _filtered(4.0, 2.0, 1.0),
    _of("channel-skew", "fore channel late, straight between samples", sets={P.SKEW_SHAPE: 1.0}),
    _of("hum", "rectified mains", sets={P.HUM_SHAPE: 1.0}),
    _of("photocell-angle", "mark beside its angle, unsharp", adds={P.MARK: 1.0, P.JITTER: 0.02}),
    _of("photocell-delay", "late by a time and an angle", adds={P.PULSE_DELAY: 1.0, P.MARK: 0.5}),
    _of("trigger-jitter", "even scatter", sets={P.JITTER_SHAPE: 1.0}),
    _of("missed-pulse", "pulses lost at random", change=_random),
)  # fmt: skip


def formed(rng: np.random.Generator) -> tuple[Effect, ...]:
    """Return the catalogue with one form drawn for each effect."""
    by_name: dict[str, list[Effect]] = {effect.name: [] for effect in CATALOGUE}
    for effect in FORMS:
        by_name[effect.name].append(effect)
    return tuple(several[int(rng.integers(len(several)))] for several in by_name.values())
