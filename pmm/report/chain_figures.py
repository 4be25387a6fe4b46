"""The chain's signals stage by stage for one run: nominal against with-effect."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np

from hardware.description.arrays import BoolArray, FloatArray
from hardware.description.channels import FORCE_AFT, FORCE_FORE
from hardware.description.setpoint import SetPoint
from pmm.campaign.campaign import Campaign
from pmm.campaign.order import place_in
from pmm.campaign.runs import Run
from pmm.document.labels import display, plain
from pmm.document.style import PALETTE, TRACE, new_figure, write_figure
from sim import signals
from sim.effects.effect import Effect
from sim.effects.switching import switch_on
from sim.rig import SimulatedRig
from sim.signals import Signals

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


_SHOWN_PERIODS: Final = 2
_AFT, _FORE = PALETTE[0], PALETTE[1]


@dataclass(frozen=True)
class _Panel:
    """One row of the figure: a stage, and the signals (of aft and fore strut) that are shown."""

    stage: str
    label: str
    unit: str
    names: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class Traces:
    """A stretch of a run, its time counted from the photocell's pulse before it.

    Attributes
    ----------
    time_s
        Shape ``(samples,)``.
    values
        Every sampled signal of the chain over the stretch, by name.
    edges_s
        The photocell's pulses.
    """

    time_s: FloatArray
    values: Signals
    edges_s: FloatArray

    def at(self, name: str, time_s: FloatArray) -> FloatArray:
        """Return a signal at other times, by a cubic spline where those are not its own."""
        if np.array_equal(time_s, self.time_s):
            return self.values[name]
        from scipy.interpolate import CubicSpline

        spline = CubicSpline(self.time_s, self.values[name])
        return np.asarray(spline(time_s), dtype=np.float64)


def traces(
    rig: SimulatedRig,
    set_point: SetPoint,
    *,
    sample_rate_hz: float,
    settling_periods: int,
    seed: int,
) -> Traces:
    """Simulate a run and return a little more than two periods after it has settled.

    Without a photocell time counts from the end of the settling.
    """
    chain = rig.chain(set_point)
    period_s = 1.0 / set_point.frequency_hz
    settled_s = settling_periods * period_s
    count = int(np.ceil((settled_s + (_SHOWN_PERIODS + 2.5) * period_s) * sample_rate_hz))
    _, run = chain.run(chain.start(sample_rate_hz, seed), count)
    time_s = np.arange(count) / sample_rate_hz
    edges_s = run.get(signals.PHOTOCELL_EDGE_TIME.name, np.array([settled_s]))
    after = edges_s[edges_s >= settled_s]
    origin_s = float(after[0]) if after.size else settled_s
    elapsed_s = time_s - origin_s
    window = (elapsed_s > -0.1 * period_s) & (elapsed_s < (_SHOWN_PERIODS + 0.1) * period_s)
    values = {
        signal.name: run[signal.name][window]
        for signal in chain.signals
        if signal.sampled and signal.name in run
    }
    return Traces(elapsed_s[window], values, edges_s - origin_s)


def chain_figure(
    nominal: Traces, changed: Traces | None, period_s: float, title: str, subtitle: str = ""
) -> "Figure":
    """Draw the signals from drive to recording, one row a stage.

    The left column has both runs, nominal in grey below; the right one what the effects change.
    Both runs are laid on the photocell's pulse, as an analysis does, so that what only moves the
    start of a run is no difference.

    Parameters
    ----------
    changed
        The run with effects; ``None`` for the nominal run alone.
    """
    panels = _panels(nominal.values)
    columns = 1 if changed is None else 2
    with new_figure(
        4.4 + 4.2 * (columns - 1),
        0.9 + 1.5 * len(panels),
        "\n".join(plain(line) for line in (title, subtitle) if line),
    ) as figure:
        grid = figure.subplots(len(panels), columns, squeeze=False, sharex=True)
        inside = (nominal.time_s >= 0.0) & (nominal.time_s <= _SHOWN_PERIODS * period_s)
        time_s = nominal.time_s[inside]
        for axes, panel in zip(grid, panels, strict=True):
            _draw_both(axes[0], panel, nominal, changed, inside)
            if changed is not None:
                _draw_difference(axes[1], panel, nominal, changed, inside)
        for axes in grid[-1]:
            axes.set_xlabel("time from the photocell's pulse (s)")
            axes.set_xlim(time_s[0], time_s[-1])
        _legend(figure, with_effect=changed is not None)
    return figure


def _panels(values: Signals) -> list[_Panel]:
    """Return the rows: what stands still (a carriage at rest) is left out."""
    recorded = tuple(signals.recorded(force).name for force in (FORCE_AFT, FORCE_FORE))
    rows = [
        _Panel("drive", "shaft speed", "rad/s", (signals.SHAFT_SPEED.name,)),
        _Panel("carriage", "speed", "m/s", (signals.CARRIAGE_SPEED.name,)),
        _Panel("mechanism", "displacement", "m", ("displacement_aft", "displacement_fore")),
        _Panel("mechanism", "acceleration", "m/s2", ("acceleration_aft", "acceleration_fore")),
        _Panel("model and water", "force", "N", ("force_aft", "force_fore")),
        _Panel("dynamometers", "reading", "N", ("dynamometer_force_aft", "dynamometer_force_fore")),
        _Panel("acquisition", "recorded force", "N", recorded),
    ]
    if not np.any(values[signals.CARRIAGE_SPEED.name]):
        del rows[1]
    present = [(row, tuple(name for name in row.names if name in values)) for row in rows]
    return [_Panel(row.stage, row.label, row.unit, names) for row, names in present if names]


def _color(name: str) -> str:
    return _FORE if name.endswith("fore") else _AFT


def _draw_both(
    axes: "Axes", panel: _Panel, nominal: Traces, changed: Traces | None, inside: BoolArray
) -> None:
    unit = display(panel.unit)
    time_s = nominal.time_s[inside]
    for name in panel.names:
        nominal_values = unit.factor * nominal.values[name][inside]
        if changed is None:
            axes.plot(time_s, nominal_values, color=_color(name), linestyle=_line(name))
            continue
        axes.plot(time_s, nominal_values, color="#BBBBBB", linewidth=2.6)
        changed_values = unit.factor * changed.at(name, nominal.time_s)[inside]
        axes.plot(time_s, changed_values, color=_color(name), linestyle=_line(name))
    axes.set_ylabel(f"{panel.label}\n({unit.label})")
    axes.set_title(panel.stage, loc="left")
    _draw_edges(axes, (changed or nominal).edges_s)


def _draw_difference(
    axes: "Axes", panel: _Panel, nominal: Traces, changed: Traces, inside: BoolArray
) -> None:
    unit = display(panel.unit)
    largest = 0.0
    for name in panel.names:
        nominal_values = nominal.values[name]
        gap = unit.factor * (changed.at(name, nominal.time_s) - nominal_values)[inside]
        scale = unit.factor * float(np.abs(nominal_values).max())
        largest = max(largest, float(np.abs(gap).max()) / scale if scale else 0.0)
        axes.plot(nominal.time_s[inside], gap, color=_color(name), linestyle=_line(name))
    axes.set_title(f"difference, {100.0 * largest:.2g} % of the nominal peak", loc="left")
    axes.set_ylabel(f"({unit.label})")
    if largest < 1e-9:
        axes.set_ylim(-1.0, 1.0)
        axes.set_yticks([0.0])
        axes.set_title("no difference", loc="left")


def _line(name: str) -> str:
    """Dash the fore strut, so that it is seen where it lies on the aft one."""
    return "--" if name.endswith("fore") else "-"


def _draw_edges(axes: "Axes", edges_s: FloatArray) -> None:
    for edge in edges_s:
        axes.axvline(edge, color=TRACE, linewidth=0.6, linestyle=":")


def _legend(figure: "Figure", *, with_effect: bool) -> None:
    from matplotlib.lines import Line2D

    entries = [
        Line2D([], [], color=_AFT, label="aft (or shaft)"),
        Line2D([], [], color=_FORE, linestyle="--", label="fore"),
        Line2D([], [], color=TRACE, linestyle=":", linewidth=0.8, label="photocell"),
    ]
    if with_effect:
        entries.insert(0, Line2D([], [], color="#BBBBBB", linewidth=2.6, label="nominal"))
    figure.legend(handles=entries, loc="outside lower center", ncols=len(entries))


def save_chain_figure(
    campaign: Campaign, run: Run, effects: Sequence[Effect], seed: int, folder: Path
) -> list[Path]:
    """Write the figure of one run of a campaign as ``<run>-chain.svg`` and ``.png``."""
    figure = run_figure(campaign, run, effects, seed)
    return write_figure(figure, folder, f"{run.name}-chain")


def run_figure(campaign: Campaign, run: Run, effects: Sequence[Effect], seed: int) -> "Figure":
    """Simulate a run of a campaign with and without effects, and draw its chain."""

    def simulated(rig: SimulatedRig, set_point: SetPoint) -> Traces:
        return traces(
            rig,
            set_point,
            sample_rate_hz=campaign.simulation.sample_rate_hz,
            settling_periods=campaign.simulation.settling_periods,
            seed=seed,
        )

    rig = campaign.rig()
    nominal = simulated(rig, run.set_point)
    changed = None
    if effects:
        changed = simulated(*switch_on(effects, rig, run.set_point, place_in(campaign, run)))
    names = ", ".join(effect.name for effect in effects)
    title = f"{run.name}: {run.frequency_hz:g} Hz, {1e3 * run.eccentricity_m:g} mm"
    return chain_figure(nominal, changed, 1.0 / run.frequency_hz, title, names)
