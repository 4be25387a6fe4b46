"""Comparison of two channels that show the same quantity, its derivative, or that with a lever."""

import math
from contextlib import suppress
from dataclasses import replace
from typing import Final

import numpy as np

from analysis.comparison.ambiguity import least_lag
from analysis.comparison.band import Band, find_band, track, without_line
from analysis.comparison.estimates import ComparedSignal, FittedComparison, channel_comparison
from analysis.comparison.even_grid import on_even_grid
from analysis.comparison.first_guess import Alignment, first_guess
from analysis.comparison.fit import ComparisonFit, fit
from analysis.comparison.linear import ComparisonProblem, Model, NothingInCommonError
from analysis.comparison.result import ChannelComparison
from analysis.comparison.settings import ComparisonSettings
from analysis.comparison.warp import Warped
from analysis.recording import Recording
from hardware.description.arrays import FloatArray
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity

_MOST_LAG_S: Final = 10.0
_ROUNDING: Final = 1e-9  # of a channel's values: less is no motion
_LEAST_SAMPLES: Final = 32
_SEEN: Final = 4.0  # uncertainties from which a dead band is taken for one
_EXPLAINS: Final = 0.5  # least part of the harmonics' misfit that a dead band must take away


def compare(
    first: Recording,
    first_channel: str,
    second: Recording,
    second_channel: str,
    settings: ComparisonSettings = ComparisonSettings(),  # noqa: B008
) -> ChannelComparison:
    """Return gain, lag, clock rate and dead band of the second channel over the first.

    ``second(t) = gain * first(t - lag(t))``, ``lag(t) = lag + clock_rate (t - mid)``: a positive
    lag is a second channel that comes later; both times are those of the recordings. Noise may be
    in both channels.

    Raises
    ------
    DataError
        If a channel is missing, does not move, is too short, or the second does not follow the
        first at any frequency.
    ConfigurationError
        If the settings cannot be.
    """
    settings.check()
    names = (first_channel, *settings.levers)
    first, second = on_even_grid(first, names), on_even_grid(second, (second_channel,))
    leading = [_signal(first, name, -math.inf, math.inf) for name in names]
    following = _signal(second, second_channel, settings.from_s, settings.to_s)
    most_lag_s = _most_lag(leading[0], following, settings)
    problem = _problem(leading, following, settings, most_lag_s)
    try:
        model, modulo_s = least_lag(problem, _fit_growing(problem, most_lag_s), most_lag_s)
        straight = _fit_all(problem, model)
        best, dead_band = straight, None
        if settings.order == 0 and not settings.levers:
            best, dead_band = _with_dead_band(problem, straight)
    except NothingInCommonError:
        raise DataError(
            f"{leading[0].name} and {following.name}: the second does not follow the first, no "
            "gain and lag explain half of its power; is it the same motion, at the same time? "
            "Allow a larger lag, or state the derivative, the band or the part of the record"
        ) from None
    fitted = FittedComparison(
        problem, best, modulo_s, dead_band, has_dead_band=best is not straight
    )
    return channel_comparison(fitted, leading, following, settings)


def _signal(recording: Recording, name: str, from_s: float, to_s: float) -> ComparedSignal:
    """Return the longest stretch of a channel without missing samples."""
    part = recording.between(max(from_s, recording.start_s), min(to_s, recording.end_s))
    values, unit = part.values(name), recording.channels[recording.index(name)].unit
    called = f"{recording.name}: {name}"
    missing = ~np.isfinite(values)
    moving = values[~missing]
    if not moving.size or np.ptp(moving) <= _ROUNDING * np.abs(moving).max():
        raise DataError(f"{called} does not move, so that nothing can be compared with it")
    if not missing.any():
        return ComparedSignal(called, without_line(values), part.sample_rate_hz, part.start_s, unit)
    bounds = np.flatnonzero(np.concatenate(([True], missing, [True])))
    longest = int(np.argmax(np.diff(bounds)))
    start, stop = int(bounds[longest]), int(bounds[longest + 1]) - 1
    start_s, end_s = part.start_s + np.array([start, stop - 1]) / part.sample_rate_hz
    message = (
        f"{int(missing.sum())} samples are missing; compared is the longest stretch without, "
        f"{start_s:.3f} s to {end_s:.3f} s"
    )
    flags = (Flag("longest_stretch", Severity.WARNING, message, name),)
    stretch_values = without_line(values[start:stop])
    return ComparedSignal(called, stretch_values, part.sample_rate_hz, float(start_s), unit, flags)


def _most_lag(
    leading: ComparedSignal, following: ComparedSignal, settings: ComparisonSettings
) -> float:
    shorter_s = min(len(signal.values) / signal.rate_hz for signal in (leading, following))
    return settings.most_lag_s or min(_MOST_LAG_S, shorter_s / 4.0)


def _problem(
    leading: list[ComparedSignal],
    following: ComparedSignal,
    settings: ComparisonSettings,
    most_lag_s: float,
) -> ComparisonProblem:
    lead = leading[0]
    ends_s = [a.start_s + len(a.values) / a.rate_hz + most_lag_s for a in (lead, following)]
    if not (lead.start_s < ends_s[1] and following.start_s < ends_s[0]):
        raise DataError(
            f"{lead.name} and {following.name}: the one begins at {lead.start_s:.3f} s and the "
            f"other at {following.start_s:.3f} s, more than the largest lag of {most_lag_s:g} s "
            "after its end; allow a larger one"
        )
    band = find_band(lead.values, following.values, (lead.rate_hz, following.rate_hz))
    low_hz, high_hz = settings.band_hz or (0.0, band.top_hz)
    if settings.band_hz is not None:
        band = Band(min(band.motion_hz, high_hz), max(high_hz, band.edge_hz), high_hz)
    order = settings.order
    first_orders = range(max(order, 0), max(order, 0) + 2)
    second_orders = range(max(-order, 0), max(-order, 0) + 1)
    tracks = [track(a.values, a.start_s, a.rate_hz, band, first_orders) for a in leading]
    second = track(following.values, following.start_s, following.rate_hz, band, second_orders)
    return ComparisonProblem(Warped(*tracks), len(tracks), second, band.motion_hz, low_hz, high_hz)


def _fit_growing(problem: ComparisonProblem, most_lag_s: float) -> ComparisonFit:
    """Fit where most happens, then on twice as much, until nothing is left out.

    From each length to the next the lag's error stays far below the quarter of a period that a
    linear step bears.
    """
    guess = first_guess(problem.first, problem.second, problem.motion_hz, most_lag_s)
    model = Model(guess, np.array([1.0] + [0.0] * (problem.channels - 1)))
    count = problem.second.derivatives.shape[1]
    while True:
        stretch_fit = fit(problem, model)
        model, stretch = stretch_fit.model, stretch_fit.model.alignment.stretch
        if stretch == slice(0, count):
            return stretch_fit
        margin = (stretch.stop - stretch.start) // 2 + 1
        wider = slice(max(0, stretch.start - margin), min(count, stretch.stop + margin))
        model = replace(model, alignment=replace(model.alignment, stretch=wider))


def _fit_all(problem: ComparisonProblem, model: Model) -> ComparisonFit:
    """Fit on all samples that both have, the lag that of their middle."""
    count = problem.second.derivatives.shape[1]
    where = replace(model.alignment, stretch=slice(0, count))
    time_s = problem.second.time_s
    covered = np.flatnonzero(problem.first.covers(where.times_s(time_s)))
    if len(covered) < _LEAST_SAMPLES:
        raise NothingInCommonError
    common = slice(int(covered[0]) + 2, int(covered[-1]) - 1)  # whatever the last digits of the lag
    mid_s = float(time_s[common].mean())
    lag_s = where.lag_s + where.rate * (mid_s - where.mid_s)
    return fit(problem, replace(model, alignment=Alignment(lag_s, where.rate, mid_s, common)))


def _with_dead_band(
    problem: ComparisonProblem, straight: ComparisonFit
) -> tuple[ComparisonFit, FloatArray]:
    """Return the fit with a dead band where one is seen, and its half and uncertainty.

    It is looked for from the width down that would leave what is left.
    """
    half, u = 0.0, straight.noise_spread / abs(straight.model.gains[0])
    with suppress(NothingInCommonError):
        narrow_fit = fit(problem, replace(straight.model, half=u), lines=True)
        half, u = _half(problem, narrow_fit)
        if half >= _SEEN * u:  # its noise is the lowest that there can be
            bent = fit(problem, narrow_fit.model)
            half, u = _half(problem, bent)
            if half >= _SEEN * u and _dead_band_explains(problem, straight, bent):
                u = math.hypot(u, bent.spread_of(bent.first_noise_power) / abs(bent.model.gains[0]))
                return bent.with_uncertainty(problem.channels + 2, u), np.array([half, u])
    return straight, np.array([half, math.hypot(u, half)])


def _dead_band_explains(
    problem: ComparisonProblem, straight: ComparisonFit, bent: ComparisonFit
) -> bool:
    """Tell whether a dead band explains most of what stands out where it makes something.

    Other things bend a sensor's line too, and a play that is wide enough swallows the noise of the
    channel that leads.
    """
    if bent.count != straight.count:
        return False
    noise = bent.noise + straight.first_noise_power
    bent_bins = np.abs(bent.columns[problem.channels + 2] * bent.model.parameters[-1]) ** 2 > noise
    before, after = (
        model_fit.squares_under(noise, bent_bins) - 2.0 * bent_bins.sum()
        for model_fit in (straight, bent)
    )
    return bool(before > 0.0 and after < _EXPLAINS * before)


def _half(problem: ComparisonProblem, fitted: ComparisonFit) -> tuple[float, float]:
    """Return half a dead band as it was fitted, and its uncertainty, the reversals' noise in it."""
    u = float(fitted.uncertainty[problem.channels + 2])
    spread = 0.5 * fitted.noise_spread / abs(fitted.model.gains[0])
    return float(fitted.model.half or 0.0), math.hypot(u, spread)
