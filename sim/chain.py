"""Stages in order, run whole or in blocks, with every signal between them kept."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from typing import Any

import numpy as np

from hardware.description.arrays import FloatArray
from hardware.description.errors import ConfigurationError, DataError
from sim.signals import Signal, Signals
from sim.stage import Block, Composite, Stage


@dataclass(frozen=True)
class ChainState:
    """State of a run between two blocks: an immutable value, so that a run can be taken back to it.

    Attributes
    ----------
    next_sample
        Number of the sample that the next block starts with.
    stages
        State of each stage, in the chain's order.
    """

    next_sample: int
    sample_rate_hz: float
    stages: tuple[Any, ...]


@dataclass(frozen=True)
class Chain:
    """Stages, each fed by those before it.

    Attributes
    ----------
    inputs
        Signals that no stage writes and that every call of :meth:`run` has to supply: commands to a
        drive, or the measured input of a chain cut off upstream.

    Raises
    ------
    ConfigurationError
        If a stage reads a signal that nothing before it writes, if two stages write the same
        signal, or if two have the same name.
    """

    stages: tuple[Stage[Any], ...]
    inputs: tuple[Signal, ...] = ()

    def __post_init__(self) -> None:
        signal_names = {signal.name for signal in self.inputs}
        names: set[str] = set()
        for stage in self.stages:
            _check_name(stage, names)
            _check_reads(stage, signal_names)
            _check_writes(stage, signal_names)
            names.add(stage.name)
            signal_names |= {signal.name for signal in stage.writes}

    @property
    def signals(self) -> tuple[Signal, ...]:
        """Every signal of the chain, in the order in which they come into being."""
        return self.inputs + tuple(signal for stage in self.stages for signal in stage.writes)

    def stage(self, name: str) -> Stage[Any]:
        """Return the stage called ``name``.

        Raises
        ------
        ConfigurationError
            If there is none; the message names those there are.
        """
        for stage in self.stages:
            if stage.name == name:
                return stage
        raise ConfigurationError(
            _unknown_name("stage", name, [stage.name for stage in self.stages])
        )

    def change(self, name: str, change: Callable[[Stage[Any]], Stage[Any]]) -> "Chain":
        """Return the chain with ``change`` applied to one stage: how an effect is switched on.

        A part of a stage that solves several together is changed like a stage of its own.
        """
        for stage in self.stages:
            if isinstance(stage, Composite) and name in (part.name for part in stage.parts):
                part = next(part for part in stage.parts if part.name == name)
                return self._with(stage, stage.with_part(name, change(part)))
        old = self.stage(name)
        return self._with(old, change(old))

    def _with(self, old: Stage[Any], new: Stage[Any]) -> "Chain":
        return replace(self, stages=tuple(new if s is old else s for s in self.stages))

    def start(self, sample_rate_hz: float, seed: int) -> ChainState:
        """Return the state before sample 0."""
        states = tuple(stage.start(sample_rate_hz, seed) for stage in self.stages)
        return ChainState(0, sample_rate_hz, states)

    def run(
        self, state: ChainState, count: int, substitute: Mapping[str, FloatArray] | None = None
    ) -> tuple[ChainState, Signals]:
        """Run the next ``count`` samples, the whole run or a block of it.

        Any way of cutting a run into blocks gives the same samples, and the same state and count
        always give the same samples.

        The results are state, signals: the state after the block, and every signal of the chain
        over the block, by name.

        Parameters
        ----------
        substitute
            Signals to use in place of the simulated ones, by name, over this block: shape
            ``(count,)`` for sampled ones. Every stage downstream is fed with them; the stage that
            would have written one still runs, and is handed them too, so that one that solves
            several parts together uses them between its parts. Displacement, velocity and
            acceleration of a strut are three signals: whoever substitutes a measured motion has to
            supply all three.

        Raises
        ------
        ConfigurationError
            If a substituted signal is not one of the chain's, or a chain input is missing.
        DataError
            If a substituted signal has the wrong shape or a value that is not finite.
        """
        supply = self._checked(substitute or {}, count)
        block = Block(state.next_sample, count, state.sample_rate_hz)
        signals: dict[str, FloatArray] = {
            signal.name: supply[signal.name] for signal in self.inputs
        }
        after: list[Any] = []
        for stage, before in zip(self.stages, state.stages, strict=True):
            fed = {signal.name: signals[signal.name] for signal in stage.reads}
            fed |= {
                signal.name: supply[signal.name] for signal in stage.writes if signal.name in supply
            }
            stage_state, written = stage.run(before, block, fed)
            after.append(stage_state)
            signals |= {name: supply.get(name, values) for name, values in written.items()}
        return ChainState(block.first + count, state.sample_rate_hz, tuple(after)), signals

    def _checked(self, supply: Mapping[str, FloatArray], count: int) -> dict[str, FloatArray]:
        """Return the substituted signals as float arrays after all checks."""
        signals = {signal.name: signal for signal in self.signals}
        for name in supply:
            if name not in signals:
                raise ConfigurationError(_unknown_name("signal", name, list(signals)))
        for signal in self.inputs:
            if signal.name not in supply:
                raise ConfigurationError(
                    f"signal {signal.name!r} ({signal.unit}) is an input of this chain and has to "
                    f"be supplied for every block"
                )
        return {name: _as_signal(signals[name], values, count) for name, values in supply.items()}


def _as_signal(signal: Signal, values: FloatArray, count: int) -> FloatArray:
    array = np.asarray(values, dtype=np.float64)
    if array.ndim != 1 or (signal.sampled and array.size != count):
        wanted = f"({count},)" if signal.sampled else "(events,)"
        raise DataError(
            f"signal {signal.name!r}: shape {array.shape} was given where {wanted} is needed; "
            f"supply one value per sample of the block"
        )
    bad = array.size - int(np.count_nonzero(np.isfinite(array)))
    if bad:
        raise DataError(
            f"signal {signal.name!r}: {bad} of {array.size} substituted values are not finite; "
            f"fill the gaps or choose a stretch without any"
        )
    return array


def _check_name(stage: Stage[Any], taken: set[str]) -> None:
    if stage.name in taken:
        raise ConfigurationError(f"two stages are called {stage.name!r}; rename one")


def _check_reads(stage: Stage[Any], names: set[str]) -> None:
    for signal in stage.reads:
        if signal.name not in names:
            raise ConfigurationError(
                f"stage {stage.name!r} reads {signal.name!r}, which nothing before it writes; "
                f"put the stage that writes it first, or declare it an input of the chain"
            )


def _check_writes(stage: Stage[Any], names: set[str]) -> None:
    for signal in stage.writes:
        if signal.name in names:
            raise ConfigurationError(
                f"stage {stage.name!r} writes {signal.name!r}, which is already there; "
                f"change the stage that writes it instead"
            )


def _unknown_name(kind: str, name: str, names: list[str]) -> str:
    near = get_close_matches(name, names, n=3, cutoff=0.4)
    hint = f"; did you mean {', '.join(near)}?" if near else ""
    return f"the chain has no {kind} {name!r}{hint} ({kind}s: {', '.join(names)})"
