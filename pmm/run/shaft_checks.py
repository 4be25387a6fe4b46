"""Whether the shaft turns as the run wants it: at its frequency while measured, else not at all."""

import math

from hardware.errors import NotAtRestError
from hardware.limits import FREQUENCY_S, FREQUENCY_SHARE, RESTLESS_S, SHAFT_REST_SHARE
from pmm.run.conduct import Conduct
from pmm.run.errors import FrequencyError


def check_frequency(c: Conduct) -> None:
    """Compare the frequency by the encoder, and that by the gate's pulses, with the run's.

    Raises
    ------
    FrequencyError
        If one is further off than the tolerance for longer than its time.
    """
    shaft, wanted_hz = c.rig.shaft, c.present.set_point.frequency_hz
    if shaft is None or not c.present.oscillates:
        return
    allowed_hz = FREQUENCY_SHARE * wanted_hz + SHAFT_REST_SHARE * shaft.frequency_hz.high
    gate = c.recording.gate
    by_pulses = gate.periods / (gate.last_s - gate.opened_s) if gate.periods else math.nan
    off = [
        (measured_hz, by)
        for measured_hz, by in ((shaft.measured_frequency_hz, "encoder"), (by_pulses, "photocell"))
        if abs(measured_hz - wanted_hz) > allowed_hz
    ]
    c.astray = c.astray + 1 if off else 0
    if c.astray > FREQUENCY_S * c.rate_hz:
        measured_hz, by = off[0]
        raise FrequencyError(
            shaft.name,
            f"turns at {measured_hz:.4g} Hz by its {by} where the run wants {wanted_hz:g} Hz "
            f"(limit {allowed_hz:.2g} Hz off); check the drive, and counts_per_turn",
        )


def check_standing(c: Conduct, ramp_s: float = 0.0) -> None:
    """Look whether the shaft stands, as it has to while axes are homed and set and water calms.

    One that is not heard is a fault of its own; a hand-set one is asked for first.

    Parameters
    ----------
    ramp_s
        For a shaft that may turn when it is enabled: it runs down first.

    Raises
    ------
    NotAtRestError
        If it has been seen to turn for longer than a drive takes to hold it.
    """
    shaft, allowed_s = c.rig.shaft, RESTLESS_S + ramp_s
    turns = shaft is not None and shaft.moving and not math.isnan(shaft.measured_frequency_hz)
    c.restless = c.restless + 1 if turns else 0
    if shaft is not None and c.restless > allowed_s * c.rate_hz:
        raise NotAtRestError(
            shaft.name,
            f"moves for {allowed_s:g} s ({shaft.measured_frequency_hz:.3g} Hz) though nothing "
            "told it to; look at it, and use the emergency stop if it turns",
        )
