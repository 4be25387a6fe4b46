"""The harmonic signature of an effect over frequency and amplitude, simulated and from theory."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.channels import FORCE_AFT, FORCE_FORE
from hardware.description.setpoint import SetPoint
from pmm.document.labels import display, shown_name
from pmm.document.style import PALETTE, new_figure, write_figure
from sim.effects.agreement import phasor
from sim.effects.effect import Effect
from sim.effects.situation import Situation
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig
from sim.run import steady_run
from sim.signals import recorded

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Key = tuple[str, int]

_FREQUENCIES: Final = 9
_AMPLITUDES: Final = (0.5, 1.0, 1.5)  # of the set-point's
_RANGE: Final = (0.5, 1.5)  # of the set-point's frequency
_ROWS: Final = 4
_HIGHEST: Final = 5
_NOTHING: Final = 1e-9  # of the nominal signal: no change but rounding
_RECORDED: Final = tuple(recorded(force).name for force in (FORCE_AFT, FORCE_FORE))


@dataclass(frozen=True, eq=False)
class SignatureGrid:
    """Signatures over frequency and amplitude.

    Attributes
    ----------
    frequencies_hz, amplitudes_m
        Shapes ``(f,)`` and ``(a,)``.
    simulated, theory
        ``S + i C`` by channel and order, shape ``(a, f)``; the mean as order 0.
    units
        Of the channels, by name.
    """

    frequencies_hz: FloatArray
    amplitudes_m: FloatArray
    simulated: dict[Key, ComplexArray]
    theory: dict[Key, ComplexArray]
    units: dict[str, str]


def signature_grid(effect: Effect, rig: SimulatedRig, set_point: SetPoint) -> SignatureGrid:
    """Solve the rig with and without the effect about a set-point, within the oscillator's limits.

    Harmonics that the effect changes by no more than rounding are left out.
    """
    limits = rig.oscillator
    low, high = limits.frequency_hz.low, limits.frequency_hz.high
    f = set_point.frequency_hz
    frequencies = np.linspace(max(low, _RANGE[0] * f), min(high, _RANGE[1] * f), _FREQUENCIES)
    a = np.array(_AMPLITUDES) * set_point.eccentricity_m
    amplitudes = np.unique(np.clip(a, limits.eccentricity_m.low, limits.eccentricity_m.high))
    shape = (amplitudes.size, frequencies.size)
    channels = channels_of(effect, rig, set_point)
    keys = [(name, order) for name in channels for order in range(_HIGHEST + 1)]
    simulated, stated = (
        {key: np.zeros(shape, dtype=np.complex128) for key in keys} for _ in range(2)
    )
    size = dict.fromkeys(channels, 0.0)
    for place in np.ndindex(shape):
        grid_point = replace(
            set_point,
            frequency_hz=float(frequencies[place[1]]),
            eccentricity_m=float(amplitudes[place[0]]),
        )
        situation = Situation.of(rig, grid_point)
        changed = steady_run(*switch_on((effect,), rig, grid_point))
        theory = effect.signature(situation)
        for key in keys:
            nominal = phasor(situation.nominal, *key)
            size[key[0]] = max(size[key[0]], abs(nominal))
            simulated[key][place] = phasor(changed, *key) - nominal
            stated[key][place] = theory.get(key, 0.0)
    drawn_keys = [key for key in keys if _is_there(simulated[key], stated[key], size[key[0]])]
    signals = {signal.name: signal.unit for signal in rig.chain(set_point).signals}
    return SignatureGrid(
        frequencies,
        amplitudes,
        {key: simulated[key] for key in drawn_keys},
        {key: stated[key] for key in drawn_keys},
        {name: signals[name] for name in channels},
    )


def channels_of(effect: Effect, rig: SimulatedRig, set_point: SetPoint) -> tuple[str, ...]:
    """Return the channels that theory names, forces first; recorded forces if it names none."""
    theory = effect.signature(Situation.of(rig, set_point))
    names = sorted({name for name, _ in theory}, key=lambda name: ("force" not in name, name))
    return tuple(names) or _RECORDED


def _is_there(simulated: ComplexArray, stated: ComplexArray, size: float) -> bool:
    return float(max(np.abs(simulated).max(), np.abs(stated).max())) > _NOTHING * size


def signature_figure(effect: Effect, grid: SignatureGrid, title: str) -> "Figure":
    """Draw the largest parts of a signature: one row a harmonic, in phase and quadrature.

    Circles are simulated, lines are theory; colours are amplitudes. An effect that does not repeat
    with the shaft has theory alone: what an analysis of its record then finds. What follows the
    displacement, the velocity or the acceleration shows it in how the curves fan out.
    """
    keys = _largest(grid)
    with new_figure(8.4, 1.4 + 1.9 * len(keys), f"{effect.code} {effect.title}\n{title}") as figure:
        axes = figure.subplots(len(keys), 2, squeeze=False, sharex=True)
        for row, key in zip(axes, keys, strict=True):
            _draw_row(row, key, grid, circles=effect.repeats)
        for axis in axes[-1]:
            axis.set_xlabel("frequency (Hz)")
        _legend(figure, grid, circles=effect.repeats)
    return figure


def _largest(grid: SignatureGrid) -> list[Key]:
    """Return the parts to draw, forces first; the strut that does not differ is left out."""
    keys = [key for key in grid.simulated if not _is_twin(key, grid)]
    for channel in dict.fromkeys(name for name, _ in keys):
        channel_keys = [key for key in keys if key[0] == channel]
        peak = max(_peak(grid, key) for key in channel_keys)
        keys = [key for key in keys if key[0] != channel or _peak(grid, key) > 1e-3 * peak]
    by_size = sorted(keys, key=lambda key: ("force" not in key[0], -_peak(grid, key)))
    order = list(grid.units)
    return sorted(by_size[:_ROWS], key=lambda key: (order.index(key[0]), key[1]))


def _peak(grid: SignatureGrid, key: Key) -> float:
    return float(max(np.abs(grid.simulated[key]).max(), np.abs(grid.theory[key]).max()))


def _is_twin(key: Key, grid: SignatureGrid) -> bool:
    name, order = key
    twin = (name.replace("_fore", "_aft"), order)
    if not name.endswith("_fore") or twin not in grid.simulated:
        return False
    gap = np.abs(grid.simulated[key] - grid.simulated[twin]).max()
    return bool(gap < 0.02 * _peak(grid, key))


def _draw_row(row: Sequence["Axes"], key: Key, grid: SignatureGrid, *, circles: bool) -> None:
    name, order = key
    unit = display(grid.units[name])
    parts = ("mean", "") if order == 0 else (f"in phase {order}", f"quadrature {order}")
    for axes, part, take in zip(row, parts, (np.real, np.imag), strict=True):
        if not part:
            axes.set_visible(False)
            continue
        for number in range(grid.amplitudes_m.size):
            color = PALETTE[number % len(PALETTE)]
            theory = unit.factor * take(grid.theory[key][number])
            simulated = unit.factor * take(grid.simulated[key][number])
            axes.plot(grid.frequencies_hz, theory, color=color)
            if circles:
                axes.plot(
                    grid.frequencies_hz, simulated, "o", color=color, markersize=4, fillstyle="none"
                )
        axes.set_title(f"{shown_name(name)}: {part}", loc="left")
        axes.set_ylabel(f"change ({unit.label})")
        _widen(axes, unit.factor * _peak(grid, key))


def _widen(axes: "Axes", peak: float) -> None:
    """Show zero, so that nothing looks like a trend that is none, and magnify no rounding."""
    low, high = axes.get_ylim()
    room = 0.05 * peak
    axes.set_ylim(min(low - room, -room), max(high + room, room))


def _legend(figure: "Figure", grid: SignatureGrid, *, circles: bool) -> None:
    from matplotlib.lines import Line2D

    entries = [
        Line2D([], [], color=PALETTE[number % len(PALETTE)], label=f"{1e3 * value:.3g} mm")
        for number, value in enumerate(grid.amplitudes_m)
    ]
    entries.append(Line2D([], [], color="#000000", label="theory"))
    if circles:
        entries.append(
            Line2D([], [], color="#000000", marker="o", fillstyle="none", ls="", label="simulated")
        )
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))


def save_signature_figure(
    effect: Effect, rig: SimulatedRig, set_point: SetPoint, folder: Path
) -> list[Path]:
    """Write the figure of an effect as ``<name>-signature.svg`` and ``.png``.

    The files written; none where the effect changes no harmonic.
    """
    grid = signature_grid(effect, rig, set_point)
    if not grid.simulated:
        return []
    values = ", ".join(
        f"{parameter.name} = {getattr(effect, parameter.name):g}"
        f"{'' if parameter.unit == '1' else f' {parameter.unit}'}"
        for parameter in effect.parameters()
    )
    figure = signature_figure(effect, grid, values)
    return write_figure(figure, folder, f"{effect.name}-signature")
