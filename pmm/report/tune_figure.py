"""Figures of a speed loop: Bode, step, and the record that it was found from."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, Protocol

import numpy as np

from analysis.speed_loop.identification import IdentifiedLoop, SpeedRecord
from analysis.speed_loop.loop import ShaftLoop
from pmm.document.style import FIT, PALETTE, TRACE, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_DECADES: Final = (-2.0, 3.0)  # of the frequency, Hz
_POINTS: Final = 600
_SPANS: Final = 5.0  # of one over the slowest crossover, that a step is shown for


class NamedLoop(Protocol):
    """A setting of the loop and its name."""

    @property
    def name(self) -> str:
        """What it is called."""

    @property
    def loop(self) -> ShaftLoop:
        """The loop."""


def bode_figure(settings: Sequence[NamedLoop]) -> "Figure":
    """Draw magnitude and phase of the open loops, and the speed per load torque."""
    frequency_hz = np.logspace(*_DECADES, _POINTS)
    omega = 2.0 * np.pi * frequency_hz
    with new_figure(9.0, 8.0) as figure:
        magnitude, phase, load = figure.subplots(3, 1, sharex=True)
        for setting, color in zip(settings, PALETTE, strict=False):
            load.loglog(frequency_hz, np.abs(setting.loop.load_response(omega)), color=color)
            if not setting.loop.closed:
                continue
            response = setting.loop.open_response(omega)
            magnitude.loglog(frequency_hz, np.abs(response), color=color, label=setting.name)
            phase.semilogx(frequency_hz, np.degrees(np.unwrap(np.angle(response))), color=color)
        magnitude.axhline(1.0, color=FIT, lw=0.6)
        phase.axhline(-180.0, color=FIT, lw=0.6)
        phase.set_ylim(-270.0, 0.0)
        for axis in (magnitude.yaxis, load.yaxis, load.xaxis):
            axis.set_major_formatter(lambda value, _: f"{value:g}")
        magnitude.set_ylabel("open loop")
        phase.set_ylabel("phase (deg)")
        load.set_ylabel("speed per load\n(rad/s per N m)")
        load.set_xlabel("frequency (Hz)")
        magnitude.legend()
    return figure


def step_figure(settings: Sequence[NamedLoop]) -> "Figure":
    """Draw the speed after a step of the set-point, and after a load of 1 N m."""
    import control  # type: ignore[import-untyped]

    stable_settings = [
        setting for setting in settings if setting.loop.closed and setting.loop.stable
    ]
    slowest = min((setting.loop.margins.crossover_hz for setting in stable_settings), default=1.0)
    time_s = np.linspace(0.0, _SPANS / slowest, _POINTS)
    with new_figure(9.0, 5.5) as figure:
        setpoint, load = figure.subplots(2, 1, sharex=True)
        for setting, color in zip(settings, PALETTE, strict=False):
            if setting in stable_settings:
                _, speed = control.step_response(setting.loop.speed_per_setpoint, time_s)
                setpoint.plot(time_s, speed, color=color, label=setting.name)
            if setting in stable_settings or not setting.loop.closed:
                _, response = control.step_response(setting.loop.speed_per_load, time_s)
                load.plot(time_s, 1e3 * response, color=color)
        setpoint.axhline(1.0, color=FIT, lw=0.6)
        setpoint.set_ylabel("speed per set-point")
        load.set_ylabel("speed after 1 N m\n(mrad/s)")
        load.set_xlabel("time (s)")
        setpoint.legend()
    return figure


def record_figure(record: SpeedRecord, loop: IdentifiedLoop) -> "Figure":
    """Draw by how much the shaft is behind its trapezoid, and what the loop found leaves."""
    since = record.time_s - record.time_s[0]
    with new_figure(9.0, 5.0) as figure:
        lag, residual = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
        lag.plot(since, 1e3 * loop.lag_rad, color=TRACE, label="measured")
        lag.plot(since, 1e3 * loop.fitted_rad, "--", color=FIT, label="loop found")
        lag.set_ylabel("behind the trapezoid (mrad)")
        lag.legend()
        residual.plot(since, 1e3 * (loop.lag_rad - loop.fitted_rad), color=PALETTE[0], lw=0.6)
        residual.set_ylabel("left (mrad)")
        residual.set_xlabel("time (s)")
    return figure
