"""Random numbers whose generator is a value: carried in a stage's state, never shared."""

from dataclasses import dataclass

import numpy as np

from hardware.description.arrays import FloatArray


@dataclass(frozen=True)
class NoiseState:
    """State of a stream of random numbers: that of its PCG64 generator."""

    position: int
    increment: int


def start_stream(seed: int, *names: str) -> NoiseState:
    """Return the beginning of the stream that belongs to a seed and a path of names.

    Streams of different names are independent; the same seed and names always give the same one.
    """
    entropy = [seed, *"/".join(names).encode()]
    return _state_of(np.random.PCG64(np.random.SeedSequence(entropy)))


def draw_normal(state: NoiseState, count: int) -> tuple[NoiseState, FloatArray]:
    """Draw ``count`` standard normal numbers and return the state after them.

    Draws of n and then m numbers give the numbers of one draw of n + m.
    """
    generator = np.random.PCG64(0)
    generator.state = {
        "bit_generator": "PCG64",
        "state": {"state": state.position, "inc": state.increment},
        "has_uint32": 0,
        "uinteger": 0,
    }
    values = np.random.Generator(generator).standard_normal(count)
    return _state_of(generator), values


def _state_of(generator: np.random.PCG64) -> NoiseState:
    inner = generator.state["state"]
    return NoiseState(inner["state"], inner["inc"])
