"""The acquisition: from sensors to samples and pulses."""
