"""What is read of a run that was led: its struts, how old its speed is, the circle it went."""

import math
from dataclasses import replace

from analysis.coefficients.corrections import zero_reading
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.response.following import (
    Following,
    carriage_following,
    led_struts,
    recorded_age,
    strut_following,
)
from hardware.description.carriage_path import CarriagePath
from hardware.description.channels import CARRIAGE_SPEED, TURN_RATE
from hardware.description.errors import DataError
from hardware.description.flags import Flag, Severity
from pmm.coefficients.tasks import Task


def following_of(
    task: Task, recording: Recording
) -> tuple[tuple[Following, ...], tuple[Flag, ...]]:
    """Return how each strut followed its set-points, or why that is not told."""
    names = [name for pair in led_struts(recording) for name in pair]
    if not names:
        return (), ()
    order = max(task.set_point.every_line, key=lambda line: line.share).order
    settings = replace(
        task.settings, channels=tuple(names), harmonics=max(order, task.settings.harmonics)
    )
    try:
        reading = analyse(recording, task.choice, settings).readings[0]
        return tuple(strut_following(recording, reading, order)), ()
    except DataError as error:
        text = f"how the struts followed their set-points is not told: {error}"
        return (), (Flag("following_unknown", Severity.NOTE, text),)


def carriage_of(task: Task, recording: Recording, gate: Recording) -> tuple[Following, ...]:
    """Return how a led carriage followed its path; nothing of others."""
    path = CarriagePath.of(task.oscillator, task.set_point)
    if path is None or CARRIAGE_SPEED.name not in recording.channel_names:
        return ()
    age_s, _ = recorded_age(gate)
    try:
        following = carriage_following(recording, path, age_s, task.choice, task.settings)
    except DataError:
        return ()  # what the struts' gate says of it is flagged there
    return () if following is None else (following,)


def speed_age_u_s(task: Task, gate: Recording) -> float:
    """Return what is not known of the age of a led carriage's recorded speed; 0 of others."""
    is_led = task.set_point.steady_ahead and CARRIAGE_SPEED.name in gate.channel_names
    return recorded_age(gate)[1] if is_led else 0.0


def as_driven(task: Task, recording: Recording) -> tuple[Task, tuple[float, float]]:
    """Return a run on a circle as speed and rate of turn were recorded.

    Without a speed it is that of the circle's radius. Beside it the standard uncertainties of
    radius and rate by the scatter of what was recorded.
    """
    point, spread = task.set_point, [0.0, 0.0]
    means = [point.carriage_speed_m_s, point.turn_rate_rad_s]
    for k, name in enumerate((CARRIAGE_SPEED.name, TURN_RATE.name)):
        if name in recording.channel_names:
            mean = zero_reading(recording, (name,)).real
            means[k] = float(mean.values[0])
            spread[k] = float(mean.standard_uncertainty[0])
    speed, rate = means
    if not rate * point.turn_rate_rad_s > 0.0:
        raise DataError(
            f"{task.name}: the rate of turn is {rate:.4g} rad/s on average where the run asks for "
            f"{point.turn_rate_rad_s:.4g}; correct the sign of the channel {TURN_RATE.name}, or "
            "turn_rate_deg_s in the campaign file"
        )
    if CARRIAGE_SPEED.name not in recording.channel_names:
        driven = replace(point, carriage_speed_m_s=speed * rate / point.turn_rate_rad_s)
        return replace(task, set_point=replace(driven, turn_rate_rad_s=rate)), (0.0, spread[1])
    u_radius = math.hypot(spread[0] / rate, speed * spread[1] / rate**2)
    driven = replace(point, carriage_speed_m_s=speed, turn_rate_rad_s=rate)
    return replace(task, set_point=driven), (u_radius, spread[1])
