"""From a fit to what is told of it: estimates with their units, and what was noticed."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from analysis.comparison.fit import ComparisonFit
from analysis.comparison.linear import ComparisonProblem, play_at
from analysis.comparison.parts import Parts, over_frequency, over_time
from analysis.comparison.result import ChannelComparison, ComparedTrace
from analysis.comparison.settings import ComparisonSettings
from analysis.uncertainty.estimate import Estimate
from hardware.description.arrays import FloatArray
from hardware.description.flags import Flag, Severity

_STRONG: Final = 0.01  # of the highest power
_UNEXPLAINED: Final = 0.03  # of the second's power there
_WIDE: Final = 1.2  # frequencies of which the last is so much above the first have a slope
_WRONG_ORDER: Final = 0.7  # power of the frequency with which a gain grows: another derivative


@dataclass(frozen=True)
class ComparedSignal:
    """A channel's samples without gaps, without their mean and slope."""

    name: str
    values: FloatArray
    rate_hz: float
    start_s: float
    unit: str
    flags: tuple[Flag, ...] = ()


@dataclass(frozen=True, eq=False)
class FittedComparison:
    """A fit, the period by which its lag may be off, half the dead band with its uncertainty."""

    problem: ComparisonProblem
    fit: ComparisonFit
    modulo_s: float | None
    dead_band: FloatArray | None
    has_dead_band: bool


def channel_comparison(
    fitted: FittedComparison,
    leading: Sequence[ComparedSignal],
    following: ComparedSignal,
    settings: ComparisonSettings,
) -> ChannelComparison:
    """Return the comparison; intervals are widened where parts scatter more than they should."""
    problem, fit = fitted.problem, fitted.fit
    model, u = fit.model, fit.uncertainty
    channels, where = problem.channels, model.alignment
    times, frequencies = over_time(problem, fit), over_frequency(problem, fit)
    in_time = times.excess(times.lag_s, times.lag_uncertainty_s, 2)
    wider = max(in_time, frequencies.excess(frequencies.lag_s, frequencies.lag_uncertainty_s, 1))
    gain_wider = max(times.gain_excess, frequencies.gain_excess)
    stretched = (1.0 - where.rate) ** min(settings.order, 0)  # a derivative on the other's clock
    unit = following.unit or "1"
    gains = [
        _gain(fit, k, gain_wider, stretched, _gain_unit(unit, signal.unit or "1", settings.order))
        for k, signal in enumerate(leading)
    ]
    band = None
    if fitted.dead_band is not None:
        half, half_u = fitted.dead_band.tolist()
        band = Estimate.of(2.0 * half, 2.0 * half_u, leading[0].unit or "1", fit.freedom)
    time_s = problem.second.time_s[fit.start : fit.start + fit.count]
    bins = (np.flatnonzero(fit.stands_out) + fit.first_bin) * problem.second.rate_hz / fit.count
    return ChannelComparison(
        first=leading[0].name,
        second=following.name,
        unit=_per_second(unit, max(-settings.order, 0)),
        order=settings.order,
        from_s=float(time_s[0]),
        to_s=float(time_s[-1]),
        mid_s=where.mid_s,
        motion_hz=problem.motion_hz,
        band_hz=(float(bins[0]), float(bins[-1])),
        gain=gains[0],
        lag_s=Estimate.of(where.lag_s, wider * u[channels], "s", fit.freedom),
        modulo_s=fitted.modulo_s,
        clock_rate=Estimate.of(where.rate, in_time * u[channels + 1], "s/s", fit.freedom),
        levers=dict(zip(settings.levers, gains[1:], strict=True)),
        dead_band=band,
        dead_band_found=fitted.has_dead_band,
        over_time=times,
        over_frequency=frequencies,
        trace=_trace(problem, fit, time_s),
        flags=(
            *(flag for signal in (*leading, following) for flag in signal.flags),
            *_unsteady(times, in_time),
            *_by_frequency(frequencies),
            *_in_part(fit, settings.order),
            *_periodic(fitted.modulo_s),
        ),
    )


def _gain(fit: ComparisonFit, row: int, wider: float, stretched: float, unit: str) -> Estimate:
    """Return a gain; noise in the first channel draws it down, by no more than all the noise does.

    How much of the noise is whose is not known: the middle is taken, and the rest is an input of
    its own, as likely anywhere between none and all.
    """
    value, u = fit.model.gains[row] * stretched, abs(stretched) * fit.uncertainty[row] * wider
    drawn = float(fit.stands_out.sum() / (fit.power / fit.noise)[fit.stands_out].sum())
    middle = Estimate.of(float(value * (1.0 + drawn / 2.0)), float(u), unit, fit.freedom)
    return middle.widened(float(abs(value) * drawn / 2.0 / np.sqrt(3.0)))


def _gain_unit(second: str, first: str, order: int) -> str:
    """Return the unit of a gain."""
    first_unit, second_unit = _per_second(first, max(order, 0)), _per_second(second, max(-order, 0))
    return "1" if first_unit == second_unit else f"{second_unit} per {first_unit}"


def _per_second(unit: str, order: int) -> str:
    """Return the unit of a derivative."""
    present = 2 if unit.endswith("/s2") else int(unit.endswith("/s"))
    bare, total = unit.removesuffix("/s2").removesuffix("/s"), present + order
    return f"{bare}/s{total if total > 1 else ''}" if total else bare


def _trace(problem: ComparisonProblem, fit: ComparisonFit, time_s: FloatArray) -> ComparedTrace:
    where, gains = fit.model.alignment, fit.model.gains
    asked_s = where.times_s(time_s)
    leaders = [problem.first.values(asked_s, 0, k) for k in range(problem.channels)]
    play = play_at(problem, fit.model, time_s)
    if play is not None:
        leaders[0] = play.values
    shown = problem.second.derivatives[0][fit.start : fit.start + fit.count]
    expected = gains @ np.array(leaders)
    line = np.polynomial.Polynomial.fit(time_s, shown - expected, 1)
    highest = 2 * int(np.flatnonzero(fit.stands_out)[-1] + fit.first_bin)
    traces = (_low_pass(wave, highest) for wave in (shown, expected + line(time_s)))
    return ComparedTrace(time_s, *traces)


def _low_pass(values: FloatArray, highest: int) -> FloatArray:
    """Return values without what lies above a bin."""
    from scipy.fft import irfft, rfft

    spectrum = rfft(values)
    spectrum[highest + 1 :] = 0.0
    return np.asarray(irfft(spectrum, len(values)))


def _unsteady(times: Parts, excess: float) -> tuple[Flag, ...]:
    flags = []
    if excess > 1.0:
        worst = int(np.argmax(np.abs(times.lag_s)))
        flags.append(
            Flag(
                "lag_unsteady",
                Severity.WARNING,
                f"the lag does not run along a line: at {times.at[worst]:.3f} s it is off by "
                f"{1e3 * times.lag_s[worst]:.3g} ms, and the parts of the record scatter "
                f"{excess:.3g} times as much as their intervals say; the intervals of lag and "
                "clock rate are wider by that",
            )
        )
    if times.gain_excess > 1.0:
        flags.append(
            Flag(
                "gain_unsteady",
                Severity.WARNING,
                f"the gain changes along the record, from {times.gain.min():.5g} to "
                f"{times.gain.max():.5g} times its mean; its interval is "
                f"{times.gain_excess:.3g} times as wide for it",
            )
        )
    return tuple(flags)


def _by_frequency(parts: Parts) -> tuple[Flag, ...]:
    excess = max(parts.gain_excess, parts.excess(parts.lag_s, parts.lag_uncertainty_s, 1))
    if excess <= 1.0 or len(parts.at) < 2:
        return ()
    message = (
        f"gain and lag depend on frequency: from {parts.at[0]:.3g} Hz to {parts.at[-1]:.3g} Hz the "
        f"gain is {parts.gain.min():.5g} to {parts.gain.max():.5g} times its mean, the lag "
        f"{1e3 * parts.lag_s.min():+.3g} to {1e3 * parts.lag_s.max():+.3g} ms beside it; the "
        f"intervals are {excess:.3g} times as wide for it. One of the two filters, or they do not "
        "show the same"
    )
    return (Flag("depends_on_frequency", Severity.WARNING, message),)


def _in_part(fit: ComparisonFit, order: int) -> tuple[Flag, ...]:
    """Say where gain and lag explain little, and whether another derivative would explain more."""
    power, residual_power = np.abs(fit.shape) ** 2, np.abs(fit.residual) ** 2
    shown = np.abs(fit.shape + fit.residual)
    frequency = fit.first_bin + np.arange(len(power), dtype=np.float64)
    recorded = power / frequency ** (2 * order)  # a derivative makes noise strong, not the channel
    strong = recorded >= _STRONG * recorded.max()
    part = float(residual_power[strong].sum() / (shown[strong] ** 2).sum())
    if part < _UNEXPLAINED:
        return ()
    message = (
        f"gain and lag do not explain {100.0 * part:.2g} % of the second channel's power where the "
        "first is strong; the intervals hold only if that is noise"
    )
    frequency = frequency[strong]
    if frequency[-1] > _WIDE * frequency[0]:
        ratio = np.log(shown[strong] / np.sqrt(power[strong]))
        weights = np.sqrt(power[strong])
        slope = float(np.polyfit(np.log(frequency), ratio, 1, w=weights)[0])
        if abs(slope) > _WRONG_ORDER:
            message += f"; as derivative {order + round(slope):+d} it would explain more"
    return (Flag("explained_in_part", Severity.WARNING, message),)


def _periodic(modulo_s: float | None) -> tuple[Flag, ...]:
    if modulo_s is None:
        return ()
    message = (
        f"the motion repeats after {modulo_s:.4g} s: the lag is known but for whole multiples of "
        "that, and the one nearest to zero is stated; gain and clock rate do not depend on it"
    )
    return (Flag("lag_modulo", Severity.NOTE, message),)
