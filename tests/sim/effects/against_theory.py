"""What the tests of the effects compare with: simulated signatures against stated ones."""

from sim.effects.agreement import mismatch, phasor

__all__ = ["mismatch", "phasor"]
