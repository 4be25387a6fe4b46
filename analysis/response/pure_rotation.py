"""Struts that move a model in a pure rotation: a sinusoidal angle, and no drift at any size of it.

With ``psi`` the heading, ahead towards across, ``U`` the carriage's speed and ``l`` half the
spacing, the speed across the model at its reference point is zero
(:mod:`analysis.kinematics.motion` solved for the struts) where

    d_held' cos psi + p l psi' = U sin psi

of the strut at the pivot, ``p`` = 1 aft and -1 fore. Hence

    d_held = U integral of tan psi dt - p l gd^-1(psi),    d_fore - d_aft = 2 l tan psi

with ``gd^-1`` the inverse Gudermannian, and ``sin`` in place of ``tan`` where a strut slides on the
rig. For small angles both struts are sines with ``tan(phi / 2) = omega l / U`` between them.

With a carriage whose speed follows the path (:mod:`hardware.description.carriage_path`), so that
``U`` is that of the model along itself, the same two conditions give

    d_held = U integral of sin psi dt - p l sin psi.
"""

import cmath
import math
from collections.abc import Callable

import numpy as np

from hardware.description.arrangement import Joint, Pivot
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.errors import ConfigurationError
from hardware.description.lines import Line
from hardware.description.oscillator import Oscillator

LARGEST_ANGLE_RAD = 1.0
"""Of the rotation: 57 degrees. Twice it is beyond any oscillator, half of it below some of today's
yaw amplitudes."""

LEAST_SHARE = 1e-7
"""Of the peak, below which a harmonic is left out: 0.03 micrometres of 0.3 m, less than a count of
any encoder. Ten times as much leaves a drift of a millionth of the speed."""

_INSTANTS = 512  # of a turn
_TURN = 2.0 * math.pi


def pure_rotation(
    oscillator: Oscillator,
    frequency_hz: float,
    speed_m_s: float,
    eccentricity_m: float,
    *,
    steady_ahead: bool = False,
) -> tuple[Line, ...]:
    """Return the lines of a sinusoidal pitch or yaw without any heave or drift velocity.

    The first is the motion; the others, marked as corrections, make it pure. Its angle is as large
    as lets the struts move by the eccentricity at most.

    Parameters
    ----------
    speed_m_s
        Of the carriage; of the model along itself with ``steady_ahead``: the carriage then follows.

    Raises
    ------
    ConfigurationError
        For a turntable, or if the angle would be above :data:`LARGEST_ANGLE_RAD`.
    """
    if oscillator.joint is Joint.YAW_TABLE:
        raise ConfigurationError(
            "an exact rotation is that of two struts: leave exact out with a turntable, whose yaw "
            "is a sine by itself"
        )
    omega = _TURN * frequency_hz

    def struts(angle: float) -> FloatArray:
        return _struts(oscillator, omega, speed_m_s, angle, steady_ahead=steady_ahead)

    angle = _angle_rad(struts, speed_m_s, eccentricity_m)
    phasors = _phasors(struts(angle)) / eccentricity_m
    return _as_lines(phasors)


def _angle_rad(struts: Callable[[float], FloatArray], speed_m_s: float, wanted_m: float) -> float:
    from scipy.optimize import brentq

    def beyond(angle: float) -> float:
        return float(np.abs(struts(angle)).max()) - wanted_m

    largest_m = beyond(LARGEST_ANGLE_RAD) + wanted_m
    if largest_m < wanted_m:
        raise ConfigurationError(
            f"an amplitude of {1e3 * wanted_m:g} mm at {speed_m_s:g} m/s asks for an angle above "
            f"{math.degrees(LARGEST_ANGLE_RAD):.0f} deg, of which the amplitude is "
            f"{1e3 * largest_m:.4g} mm; lower the amplitude"
        )
    return float(brentq(beyond, 0.0, LARGEST_ANGLE_RAD, xtol=1e-14, rtol=1e-14))


def _struts(
    oscillator: Oscillator, omega: float, speed_m_s: float, angle: float, *, steady_ahead: bool
) -> FloatArray:
    """Return both struts over a turn, aft and fore, of a heading ``angle sin(theta)``."""
    half, aft_held = oscillator.half_spacing_m, oscillator.pivot is Pivot.AFT
    heading = angle * np.sin(_TURN * np.arange(_INSTANTS) / _INSTANTS)
    sine, tangent = np.sin(heading), np.tan(heading)
    spectrum = np.fft.rfft(sine if steady_ahead else tangent)
    order = np.arange(len(spectrum))
    spectrum[1:] /= 1j * order[1:] * omega
    spectrum[0] = 0.0
    carriage = speed_m_s * np.fft.irfft(spectrum, _INSTANTS)
    turned = half * (sine if steady_ahead else np.arctanh(sine))
    on_model = oscillator.joint is Joint.SLIDES_ON_MODEL
    spacing = 2.0 * half * (tangent if on_model else sine)
    held = carriage - turned if aft_held else carriage + turned
    return np.array([held, held + spacing] if aft_held else [held - spacing, held])


def _phasors(struts: FloatArray) -> ComplexArray:
    """Return ``H`` of ``d = sum of Im(H[n] exp(i n theta))``, shape ``(orders, 2)``.

    The angle is counted from where the aft strut's first harmonic rises through zero.
    """
    raw = 2j * np.fft.rfft(struts, axis=1).T / _INSTANTS
    phase = cmath.phase(raw[1, 0])
    return np.asarray(raw * np.exp(-1j * phase * np.arange(len(raw)))[:, None])


def _as_lines(phasors: ComplexArray) -> tuple[Line, ...]:
    """Return both struts' phasors as lines, in each of which they move equally far."""
    aft, fore = phasors[1]
    ahead = cmath.phase(fore / aft) % _TURN
    first = Line(1, float(abs(aft) + abs(fore)) / 2.0, 0.0, ahead)
    remainder = phasors.copy()
    remainder[1] -= first.share * np.array([1.0, cmath.exp(1j * ahead)])
    mean, half_difference = remainder.mean(axis=1), (remainder[:, 0] - remainder[:, 1]) / 2.0
    rest = [
        Line(n, float(abs(size)), cmath.phase(size), strut_phase_rad, correction=True)
        for n in range(1, len(remainder))
        for size, strut_phase_rad in ((mean[n], 0.0), (half_difference[n], math.pi))
        if abs(size) > LEAST_SHARE
    ]
    return first, *rest
