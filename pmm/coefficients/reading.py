"""One recording becomes one cycle: what a worker does, in whichever process or machine it is."""

from collections.abc import Callable
from dataclasses import replace

from analysis.coefficients.body_cycle import BodyCycle
from analysis.coefficients.corrections import (
    AmplifierFilter,
    Delay,
    Response,
    zero_reading,
)
from analysis.coefficients.resistance_form import PROPELLED
from analysis.coefficients.steady_turns import by_radius, turn_of
from analysis.coefficients.strut_cycle import StrutCycle, measured_cycle, static_cycle
from analysis.recording import Recording
from analysis.resolver.analysis import analyse
from analysis.resolver.first_harmonics import first_harmonics
from analysis.response.waves import in_waves
from hardware.description.arrangement import Joint
from hardware.description.carriage_path import CarriagePath
from hardware.description.channels import (
    CARRIAGE_SPEED,
    DISPLACEMENTS,
    FORCE_X,
    FORCES,
    HEEL_ANGLE,
    HEELING,
    ROLL_MOMENT,
    units_on,
)
from hardware.description.errors import DataError, PmmError
from hardware.description.flags import Flag, Severity
from hardware.description.kinds import RunKind
from pmm.campaign.calibrated_recording import applied_calibration
from pmm.campaign.recording_source import RAW, open_recording
from pmm.coefficients.attitude import attitude_of, rest_of
from pmm.coefficients.followed_runs import as_driven, carriage_of, following_of, speed_age_u_s
from pmm.coefficients.mean_place import place_flags
from pmm.coefficients.settings import AmplifierTable
from pmm.coefficients.tasks import FailedRecording, ReadRecording, Task, Zero
from pmm.coefficients.zeros import utc_s, zeroed
from pmm.recorder.files import sha256

_USED = (*DISPLACEMENTS, *FORCES)
_SPEED_OFF = 0.01


def read_zero(task: Task) -> ReadRecording | FailedRecording:
    """Read what the gauges show at rest."""
    return _tried(task, _at_rest)


def read_cycle(task: Task) -> ReadRecording | FailedRecording:
    """Read a run and return motion and loads of the model, zeros taken off."""
    return _tried(task, _turning if task.kind.oscillates else _towed)


def _tried(
    task: Task, work: Callable[[Task, Recording], ReadRecording]
) -> ReadRecording | FailedRecording:
    """Read a recording and do the work; if that fails, what is damaged of the file is named."""
    damaged: list[str] = []
    try:
        recording = _opened(task)
        damaged += [flag.message for flag in recording.flags if flag.damaged]
        _check(recording, task)
        return work(task, recording)
    except PmmError as error:
        message = "; ".join([str(error), *damaged])
        return FailedRecording(task.name, str(task.source.path), message, error.exit_status)


def _opened(task: Task) -> Recording:
    """Open a recording, in newtons by its own calibration unless the settings give another."""
    chain = task.chain
    calibration = chain.calibration if chain.matrix is None else RAW
    return open_recording(replace(task.source, calibration=calibration))


def _check(recording: Recording, task: Task) -> None:
    """Refuse a recording that lacks a channel, or whose numbers are not in its unit."""
    _check_channels(recording, task)
    _check_heel(recording, task)
    if task.chain.matrix is None:
        _check_units(recording, task.oscillator.joint)
    elif applied_calibration(recording) is not None:
        raise DataError(
            f"{task.name}: a calibration was applied to it already; take calibration_matrix out of "
            "the settings, or the recording that pmm run made"
        )


def _check_channels(recording: Recording, task: Task) -> None:
    missing = [name for name in FORCES if name not in recording.channel_names]
    if missing:
        hint = "; with one force, pmm analyse and pmm gap still work" if len(missing) == 1 else ""
        raise DataError(
            f"{recording.name}: no channel {' or '.join(missing)}; coefficients need the forces at "
            f"both struts (channels: {', '.join(recording.channel_names)}). Name the columns in "
            f"[columns] of the campaign file{hint}"
        )
    missing_motions = [name for name in DISPLACEMENTS if name not in recording.channel_names]
    if missing_motions and task.kind.oscillates and task.oscillator.joint is Joint.YAW_TABLE:
        raise DataError(
            f"{recording.name}: no channel {' or '.join(missing_motions)}; the set-point has no "
            "angle of a "
            'turntable (joint = "yaw_table"), so its sway and its angle have to be recorded'
        )


def _check_heel(recording: Recording, task: Task) -> None:
    """Refuse a heel that nothing tells of, and roll channels in another unit."""
    if task.heel is None and task.set_point.heel_rad:
        raise DataError(
            f"{task.name}: it has a heel, and the campaign file has no table [heel]: say how the "
            "model is held"
        )
    faults = [
        f"{channel.name} is in {channel.unit}, not in {heel_channel.unit}"
        for heel_channel in HEELING
        for channel in recording.channels
        if channel.name == heel_channel.name and channel.unit not in ("", heel_channel.unit)
    ]
    if faults and task.heel is not None:
        raise DataError(f"{recording.name}: {'; '.join(faults)}; name the right unit in [columns]")


def _check_units(recording: Recording, joint: Joint) -> None:
    """Refuse a stated unit that the rig's channel cannot have; a calibration makes its own."""
    is_calibrated = applied_calibration(recording) is not None
    faults = [
        f"{channel.name} is in {channel.unit}, not in {unit}"
        for name, unit in units_on(joint).items()
        for channel in recording.channels
        if channel.name == name
        and channel.unit not in ("", unit)
        and not (is_calibrated and name not in DISPLACEMENTS)
    ]
    if faults:
        raise DataError(
            f'{recording.name}: {"; ".join(faults)}, as joint = "{joint}" has it; name the right '
            "column and its unit in [columns.channels], or correct joint in [oscillator]"
        )


def _at_rest(task: Task, recording: Recording) -> ReadRecording:
    reading = zero_reading(recording, (*FORCES, *_other_channels(task, recording)))
    point = task.set_point
    position, flags = rest_of(task, recording)
    zero = Zero(
        task.name,
        utc_s(recording),
        task.number,
        reading,
        point.drift_rad,
        position,
        point.heel_rad,
    )
    return _read_recording(task, recording, None, zero, flags=flags)


def _turning(task: Task, recording: Recording) -> ReadRecording:
    names = (*_USED, *_other_channels(task, recording))
    if task.set_point.steady_ahead:
        names = (*names, CARRIAGE_SPEED.name)
    channels = tuple(name for name in names if name in recording.channel_names)
    settings, waves = replace(task.settings, channels=channels), None
    analysis = analyse(recording, task.choice, settings)
    if task.set_point.wave_frequency_hz:
        waves, recording = in_waves(recording, analysis, task.set_point, task.depth_m)
        analysis = analyse(recording, task.choice, settings)
    struts = measured_cycle(analysis, task.oscillator, set_point=task.set_point)
    struts, flags = zeroed(struts, task, recording)
    new_flags = tuple(flag for flag in analysis.flags if flag not in recording.flags)
    attitude, attitude_flags = attitude_of(task, recording)
    following, following_flags = following_of(task, recording)
    if waves is not None:  # what they add to the mean is no load of calm water
        struts, flags = replace(struts, mean_known=False), (*flags, *waves.flags)
    reading = analysis.readings[0]
    gate = recording.between(reading.opened_s, reading.closed_s)
    flags = (*new_flags, *flags, *_speed_flags(task, gate), *attitude_flags, *following_flags)
    flags = (*flags, *place_flags(struts))
    result = _read_recording(task, recording, _model(task, struts), None, reading.periods, flags)
    lines = reading if task.set_point.lines else None
    return replace(
        result,
        run_harmonics=first_harmonics(recording, analysis),
        attitude=attitude,
        lines=lines,
        following=following,
        carriage=carriage_of(task, recording, gate),
        speed_age_u_s=speed_age_u_s(task, gate),
        waves=waves,
    )


def _towed(task: Task, recording: Recording) -> ReadRecording:
    spread = (0.0, 0.0)
    if task.kind is RunKind.CIRCLE:
        task, spread = as_driven(task, recording)
    reading = zero_reading(recording, (*FORCES, *_other_channels(task, recording)))
    struts = static_cycle(task.name, reading, task.oscillator, task.set_point)
    struts, flags = zeroed(struts, task, recording)
    if not struts.mean_known:
        raise DataError(
            f"{task.name}: its mean force is all that it tells, and no zero run is named; make one "
            "before and after, and name them as zero_before and zero_after; or say tared = true in "
            "the campaign file, where zeros were taken off before it was recorded"
        )
    attitude, attitude_flags = attitude_of(task, recording)
    cycle, turn = _model(task, struts), None
    if task.kind is RunKind.CIRCLE:
        turn = turn_of(cycle, *spread)
        cycle = cycle if CARRIAGE_SPEED.name in recording.channel_names else by_radius(cycle)
    else:
        flags = (*flags, *_speed_flags(task, recording))
    result = _read_recording(task, recording, cycle, None, 0, (*flags, *attitude_flags))
    return replace(result, attitude=attitude, turn=turn)


def _model(task: Task, struts: StrutCycle) -> BodyCycle:
    chain = task.chain
    if chain.matrix is not None:
        struts = struts.calibrated(chain.matrix)
    names = set(struts.phasors.names)
    responses = {
        name: response_of(amplifier)
        for name, amplifier in chain.amplifiers.items()
        if f"{name} 0" in names
    }
    if responses:
        struts = struts.without_response(responses)
    if task.heel is not None:
        struts = struts.heeled(task.heel)
    cycle = replace(struts.model(), rudder_rad=task.set_point.rudder_angle_rad)
    rate = task.set_point.revolutions_hz
    return replace(cycle, flags=(*cycle.flags, *((_propelled(rate),) if rate else ())))


def _propelled(rate_hz: float) -> Flag:
    text = (
        f"its propeller turned at {rate_hz:g} 1/s: X_0 is no resistance, it has the propeller's "
        "thrust in it, and all terms are those of model, propeller and rudder together"
    )
    return Flag(PROPELLED, Severity.NOTE, text, FORCE_X.name)


def response_of(amplifier: AmplifierTable) -> Response:
    """Return an amplifier's response: its lag, gain and filter in a chain."""
    delay = Delay(amplifier.lag_s, amplifier.gain)
    if amplifier.cutoff_hz is None:
        return delay
    filtered = AmplifierFilter(amplifier.cutoff_hz, amplifier.order, amplifier.kind)
    return lambda s: delay(s) * filtered(s)


def _other_channels(task: Task, recording: Recording) -> tuple[str, ...]:
    """The surge gauge and, of a model that heels, roll gauge and inclinometer: those there are."""
    names = (FORCE_X.name, *((ROLL_MOMENT.name, HEEL_ANGLE.name) if task.heel is not None else ()))
    return tuple(name for name in names if name in recording.channel_names)


def _speed_flags(task: Task, recording: Recording) -> tuple[Flag, ...]:
    """Say where the carriage did not do what the campaign says."""
    if CARRIAGE_SPEED.name not in recording.channel_names:
        return ()
    path = CarriagePath.of(task.oscillator, task.set_point)
    stated_m_s = task.set_point.carriage_speed_m_s if path is None else path.mean_m_s
    measured_m_s = float(recording.values(CARRIAGE_SPEED.name).mean())
    if abs(measured_m_s - stated_m_s) <= _SPEED_OFF * max(abs(stated_m_s), 0.1):
        return ()
    text = (
        f"the carriage ran at {measured_m_s:.4g} m/s on average, the campaign says "
        f"{stated_m_s:.4g} m/s (limit {100.0 * _SPEED_OFF:g} %); correct carriage_speed_m_s in the "
        "campaign file"
    )
    return (Flag("speed_differs", Severity.WARNING, text, CARRIAGE_SPEED.name),)


def _read_recording(
    task: Task,
    recording: Recording,
    cycle: BodyCycle | None,
    zero: Zero | None,
    periods: int = 0,
    flags: tuple[Flag, ...] = (),
) -> ReadRecording:
    return ReadRecording(
        task.name,
        str(task.source.path),
        cycle,
        zero,
        periods,
        recording.sample_rate_hz,
        recording.end_s - recording.start_s,
        tuple(flag.of(task.name) for flag in (*recording.flags, *flags)),
        sha256(task.source.path) if task.hashed else "",
        applied_calibration(recording),
    )
