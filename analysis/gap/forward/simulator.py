"""The simulator asked for what the recordings show, with any effects on.

What repeats with the shaft comes from the exact periodic steady state, at about half a millisecond
a run. What does not (jitter, missed pulses, hum, drift) is simulated in time and observed as a
recording is; only what such effects change is taken from there, with and without them on the same
noise. What noise does by itself is taken from several draws of it.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Final

import numpy as np

from analysis.gap.forward.dead_weight import with_dead_weight
from analysis.gap.forward.powers import on_noise
from analysis.gap.forward.stages import Solved
from analysis.gap.observe.at_rest import record_at_rest, steady_at_rest
from analysis.gap.observe.components import GapRun, Layout, Observation, Part, Stack
from analysis.gap.observe.observation import observe
from analysis.recording import Recording
from analysis.resolver.reference_choice import ReferenceChoice
from hardware.description.arrays import ComplexArray, FloatArray
from hardware.description.channels import FORCES
from hardware.description.setpoint import SetPoint
from sim.effects.effect import Effect
from sim.effects.switching import switch_on
from sim.periodic import SteadyState
from sim.rig import SimulatedRig
from sim.run import edges_of, full_scale, signals_of_run
from sim.signals import recorded
from sim.solve.period import Period

Records = dict[tuple[str, tuple[Effect, ...], int], FloatArray]

ORDERS: Final = 8  # of a steady state, and points of its period
POINTS: Final = 64
_SEED: Final = 20091
_SETTLING: Final = 3
DRAWS: Final = 4  # of the noise: one may be odd, and would be so in every campaign
_APART: Final = 100  # seeds between two draws, more than a campaign has runs


@dataclass(frozen=True, eq=False)
class Simulator:
    """A rig as it is believed to be, asked for the runs of a campaign.

    Attributes
    ----------
    active_effects
        Effects that are known and always on.
    reference_channel
        The channel whose fundamental is phase 0; ``None`` for the photocell.
    frequency_ratio
        At which every run is made, over the frequency that was set.
    stage_cache
        Stages that were solved already; shared by all that are made from this one.
    """

    rig: SimulatedRig
    stack: Stack
    active_effects: tuple[Effect, ...] = ()
    reference_channel: str | None = None
    frequency_ratio: float = 1.0
    stage_cache: Solved = field(default_factory=Solved, repr=False)
    # Runs that were simulated in time, by name, what does not repeat, and draw; of this rig alone.
    _records: Records = field(default_factory=dict, init=False, repr=False)
    _means: dict[str, FloatArray] = field(default_factory=dict, init=False, repr=False)

    @cached_property
    def nominal(self) -> FloatArray:
        """What the simulation says without any further effect, shape ``(observations,)``."""
        return self.predict(())

    @cached_property
    def _repeating(self) -> tuple[Effect, ...]:
        """Of what is always on, without what only luck makes of it: a steady state has none."""
        return tuple(effect for effect in self.active_effects if not effect.by_chance)

    def with_rig(self, rig: SimulatedRig) -> "Simulator":
        """Return the simulator of another rig."""
        return replace(self, rig=rig)

    def predict(self, effects: Sequence[Effect]) -> FloatArray:
        """Return every component of every run, shape ``(observations,)``.

        Raises
        ------
        ConfigurationError
            If an effect cannot act on this rig.
        """
        alike = all(effect.repeats for effect in effects)
        parts = [
            self._run(number, effects) if alike else self._not_repeating(number, effects)
            for number in range(len(self.stack.runs))
        ]
        return np.concatenate(parts)

    def _run(self, number: int, effects: Sequence[Effect]) -> FloatArray:
        run = self.stack.runs[number]
        steady = self._steady(run, (*self._repeating, *effects))
        repeats = run.observed.layout.steady
        return steady if repeats.all() else np.where(repeats, steady, self._typical_in_time(number))

    def _not_repeating(self, number: int, effects: Sequence[Effect]) -> FloatArray:
        """Return what repeats with the effects that do, and on it what the others change alone."""
        run = self.stack.runs[number]
        moving = tuple(effect for effect in effects if not effect.repeats)
        sure = tuple(effect for effect in moving if not effect.by_chance)
        repeating = (effect for effect in effects if effect.repeats)
        steady = self._steady(run, (*self._repeating, *repeating))
        if sure and run.applied is None:  # of what is done to a standing rig, what repeats is told
            steady = steady + np.nan_to_num(self._record(number, sure) - self._record(number))
        repeats = run.observed.layout.steady
        if repeats.all():
            return steady
        alone, base = self._record(number, moving), self._record(number)
        usual = self._typical_in_time(number)
        noisy = on_noise(run.observed.components, alone, base, usual)
        return np.where(repeats, steady, np.where(np.isfinite(noisy), noisy, usual))

    def steady(self, effects: Sequence[Effect]) -> FloatArray:
        """Return the components that repeat with the shaft; 0 for all others."""
        on = (*self._repeating, *effects)
        return np.concatenate([self._steady(run, on) for run in self.stack.runs])

    def _record(self, number: int, moving: tuple[Effect, ...] = (), draw: int = 0) -> FloatArray:
        run, seed = self.stack.runs[number], _SEED + _APART * draw
        key = (run.name, moving, draw)
        if key not in self._records:
            self._records[key] = self._in_time(run, (*self.active_effects, *moving), seed)
        return self._records[key]

    def _typical_in_time(self, number: int) -> FloatArray:
        """Return what a run shows in time without what does not repeat, as noise has it at mean.

        What no draw has, for want of lines or of a period, is as it was measured: what cannot be
        compared is no gap.
        """
        run = self.stack.runs[number]
        if run.name not in self._means:
            draws = np.array([self._record(number, (), draw) for draw in range(DRAWS)])
            there = np.isfinite(draws)
            count = np.count_nonzero(there, axis=0)
            total = np.sum(draws, axis=0, where=there)
            mean = np.divide(total, count, out=run.observed.values.copy(), where=count > 0)
            self._means[run.name] = mean
        return self._means[run.name]

    def state(self, run: GapRun, effects: Sequence[Effect]) -> SteadyState:
        """Return the steady state of a run that turns, with these effects and no others."""
        return self._state(*self._set(run, effects))

    def lifted_n(self, run: GapRun) -> tuple[float, float]:
        """Return what the struts hold at rest in a run, aft and fore, in N: gauges are tared."""
        rig, set_point = self._set(run, self._repeating)
        hull: Any = next(stage for stage in rig.stages(set_point) if stage.name == "hull")
        return rig.lifted_n(hull)

    def _state(self, rig: SimulatedRig, set_point: SetPoint) -> SteadyState:
        period = Period(set_point.frequency_hz, ORDERS, POINTS)
        return self.stage_cache.steady_state(rig.stages(set_point), period)

    def _steady(self, run: GapRun, effects: Sequence[Effect]) -> FloatArray:
        rig, set_point = self._set(run, effects)
        if run.turns:
            state = self._state(rig, set_point)
            steady = read_steady(state, run.observed.layout, run.set_point, self.reference_channel)
        else:
            steady = steady_at_rest(rig, set_point, run)
        middle_s = run.lead_s + 0.5 * run.periods / run.set_point.frequency_hz
        return steady + _drifted(rig, run.observed, middle_s)

    def _set(self, run: GapRun, effects: Sequence[Effect]) -> tuple[SimulatedRig, SetPoint]:
        set_point = run.set_point
        if self.frequency_ratio != 1.0:
            set_point = replace(
                set_point, frequency_hz=set_point.frequency_hz * self.frequency_ratio
            )
        return switch_on(*with_dead_weight(effects, self.rig, run), set_point, run.place)

    def _in_time(self, run: GapRun, effects: Sequence[Effect], seed: int) -> FloatArray:
        acting, believed = with_dead_weight(effects, self.rig, run)
        rig, set_point = switch_on(acting, believed, run.set_point, run.place)
        if not run.turns:
            observation = record_at_rest(rig, set_point, run, seed + run.place.index)
            return align(observation, run.observed)
        # The run has been made: whatever the strut may carry, it did.
        oscillator = replace(rig.oscillator, force_per_strut_n=float("inf"))
        record = _recorded(
            replace(rig, oscillator=oscillator), set_point, run, seed + run.place.index
        )
        phase = ReferenceChoice(channel=self.reference_channel)
        observed = observe(
            record, phase, wanted={component.part for component in run.observed.components}
        )
        later_s = run.lead_s - observed.lead_s
        return align(observed.observation, run.observed) + _drifted(rig, run.observed, later_s)


def _recorded(rig: SimulatedRig, set_point: SetPoint, run: GapRun, seed: int) -> Recording:
    """Return a simulated record of a run, as long and as fast as the one that was made."""
    rate_hz, lines = run.sample_rate_hz, rig.acquisition.lines
    series, skipped = signals_of_run(rig, set_point, run.periods, _SETTLING, rate_hz, seed)
    channels = tuple(
        replace(
            line.channel, full_scale=full_scale(rig, line.channel.name, line.digitiser.full_scale)
        )
        for line in lines
    )
    samples = np.array([series[recorded(line.channel).name][skipped:] for line in lines])
    edges_s = edges_of(series, skipped, rate_hz)
    return Recording(run.name, channels, samples, rate_hz, 0.0, edges_s, run.set_point)


def _drifted(rig: SimulatedRig, measured: Observation, later_s: float) -> FloatArray | float:
    """Return what the forces' zeros drift by in some time, as a change of their means."""
    gauges = zip(FORCES, (rig.dynamometers.aft, rig.dynamometers.fore), strict=True)
    drift = {
        name: (gauge.zero_drift_n_s + _stated_drift(rig, name)) * later_s for name, gauge in gauges
    }
    if not any(drift.values()):
        return 0.0
    components = measured.components
    return np.array(
        [
            drift.get(component.channel, 0.0) * (component.part is Part.MEAN)
            for component in components
        ]
    )


def _stated_drift(rig: SimulatedRig, channel: str) -> float:
    digitiser = getattr(rig.acquisition, channel)
    return 0.0 if digitiser is None else float(digitiser.drift_per_s)


def align(simulated: Observation, measured: Observation) -> FloatArray:
    """Return a simulated observation's values in the order of a measured one's components.

    Those that the simulated record does not have, for want of lines or of a period, are no numbers.
    """
    at = dict(zip(simulated.components, simulated.values, strict=True))
    return np.array([at.get(component, math.nan) for component in measured.components])


def read_steady(
    state: SteadyState,
    layout: Layout,
    set_point: SetPoint,
    reference_channel: str | None,
) -> FloatArray:
    """Return a steady state's components as the resolver would find them; 0 for what has none.

    Parameters
    ----------
    set_point
        What the run was told to do: its frequency is what the measured one is held against.
    """
    ratio = float(np.log(state.period.frequency_hz / set_point.frequency_hz))
    values = layout.read(state.spectra, reference_turn(state, reference_channel))
    return values + ratio * layout.frequency


def reference_turn(state: SteadyState, reference_channel: str | None) -> ComplexArray:
    """Return by what each order is turned for time to count from the phase reference."""
    if reference_channel is None:
        return np.exp(state.period.s * state.reference_s)
    first = state.spectra[f"recorded_{reference_channel}"][1]
    # A sin(theta + phi) has X_1 = -i A exp(i phi): turned back by phi it is in phase.
    phase = float(np.angle(first * 1j))
    orders: ComplexArray = np.exp(-1j * phase * np.arange(len(state.period.s)))
    return orders
