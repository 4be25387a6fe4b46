"""What ``pmm console`` does: open the rig, start the web server beside it, and run the loop."""

import errno
import ssl
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from multiprocessing import get_context
from multiprocessing.connection import Connection
from pathlib import Path
from socket import AF_INET, AF_INET6, EAI_AGAIN, EAI_NONAME, socket
from socket import create_server as listen
from typing import Final

from hardware.description.errors import ConfigurationError
from hardware.pacing import RealTime
from hardware.rig import Rig
from pmm.cli.folders import check_folder
from pmm.cli.screen import messages
from pmm.cli.terminal import Terminal
from pmm.console.answers import BrowserAnswers
from pmm.console.app_settings import ConsoleSettings
from pmm.console.link import Link
from pmm.console.pacing import CountingPacer
from pmm.console.plans import is_plan
from pmm.console.quick_stop import QuickStop
from pmm.console.security import LOCAL, Door
from pmm.console.station import Station
from pmm.plan.rig_file import RigFile, is_simulated, read_rig_file
from pmm.real_time import Priority, before_others, step_back
from pmm.run.journal import Taps
from pmm.run.operator import Interrupts
from pmm.run.rehearsal import rehearse
from pmm.run.states import Command, RunStateError

_LEAST_TOKEN: Final = 16
_WINDOW_S: Final = 10.0  # of the statistics of the loop's cycles
_JOIN_S: Final = 10.0
_PLAIN: Final = (
    "warning: --host {host} without --certificate: whoever is on the network between reads the "
    "token and may send commands of their own. Give --certificate and --key (docs/console.md: how "
    "to make them), or leave --host out and come by a tunnel from the other machine: "
    "ssh -L {port}:127.0.0.1:{port} USER@THIS-MACHINE"
)


@dataclass(frozen=True)
class ConsoleOptions:
    """The options of ``pmm console``, by their names there."""

    rig: str
    plans: str | None
    output: str | None
    host: str
    port: int
    token_file: str | None
    certificate: str | None
    key: str | None
    earlier: tuple[str, ...]
    reference: str | None
    speed: float


def work(request: ConsoleOptions) -> None:
    """Run the console until Ctrl-C.

    Raises
    ------
    ConfigurationError
        If the rig's file is wrong, the address is taken, or listening there is not safe.
    """
    _check_no_plan(Path(request.rig))
    rig_file = read_rig_file(request.rig)
    _check(request, rig_file)
    interrupts = Interrupts()
    # The terminal is waited for last: the rig is left by then.
    with ExitStack() as shown, ExitStack() as stack:
        stack.enter_context(interrupts.counted())
        listening = stack.enter_context(_listening(request))
        quick_stop = QuickStop()
        connection = stack.enter_context(_server(request, rig_file, listening, quick_stop))
        station = stack.enter_context(_station(request, rig_file, connection, quick_stop))
        terminal = shown.enter_context(Terminal())
        _loop(station, interrupts, terminal)
        if station.control.fault is not None:
            terminal.say(f"fault: {station.control.fault}")


def _loop(station: Station, interrupts: Interrupts, terminal: Terminal) -> None:
    """Step until Ctrl-C, and then until everything rests."""
    heard, told = 0, False
    while True:
        station.step()
        if interrupts.count > heard:
            heard += 1
            with suppress(RunStateError):
                command = Command.STOP if heard == 1 else Command.QUICK_STOP
                station.control.request(command)
        if heard and station.at_rest:
            return
        if station.deserted and not told:
            told = True
            terminal.say("the web server has ended; the rig runs on. Ctrl-C stops it")


def _check(request: ConsoleOptions, rig_file: RigFile) -> None:
    if request.speed != 1.0 and not is_simulated(rig_file.hardware):
        raise ConfigurationError(
            f"--speed {request.speed:g}: {rig_file.path} is no simulated rig; only those run "
            "faster or slower than the clock"
        )
    if request.output is not None:
        check_folder(Path(request.output), "--output")
    folders = [("--plans", request.plans), *(("--earlier", one) for one in request.earlier)]
    for option, name in folders:
        if name is not None and not Path(name).is_dir():
            raise ConfigurationError(f"{option} {name}: no such folder")
    _check_reference(request.reference, rig_file)
    _check_door(request)


def _check_no_plan(path: Path) -> None:
    """Refuse a plan in the rig's place, in one line instead of a list of unknown keys."""
    if path.is_file() and is_plan(path):
        raise ConfigurationError(
            f"{path}: is a plan, not a rig; give the rig's file that it names, and queue the plan "
            "on the page"
        )


def _check_reference(file: str | None, rig_file: RigFile) -> None:
    """Read a table before it is needed: it is shown only when runs have ended."""
    if file is None:
        return
    from pmm.coefficients.references import read_references
    from pmm.coefficients.settings import ReferenceFile, Settings

    read_references((ReferenceFile(file),), rig_file.oscillator.plane, Settings().form)


def _check_door(request: ConsoleOptions) -> None:
    if (request.certificate is None) != (request.key is None):
        raise ConfigurationError("--certificate and --key belong together; give both or neither")
    if request.host not in LOCAL and request.token_file is None:
        raise ConfigurationError(
            f"--host {request.host}: whoever reaches this address could move the rig; give "
            f"--token-file with a secret of at least {_LEAST_TOKEN} characters, or listen on "
            f"{LOCAL[0]}"
        )
    for option, name in (("--certificate", request.certificate), ("--key", request.key)):
        if name is not None and not Path(name).is_file():
            raise ConfigurationError(f"{option} {name}: no such file")
    if request.certificate is not None:
        _check_tls(request.certificate, str(request.key))


def _check_tls(certificate: str, key: str) -> None:
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(certificate, key)
    except (OSError, ssl.SSLError) as error:
        raise ConfigurationError(
            f"--certificate {certificate}, --key {key}: not a certificate and its key in PEM "
            f"({error})"
        ) from error


def _token(file: str | None) -> str:
    if file is None:
        return ""
    if not Path(file).is_file():
        raise ConfigurationError(f"--token-file {file}: no such file")
    try:
        token = Path(file).read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"--token-file {file}: {error}") from error
    if len(token) < _LEAST_TOKEN:
        raise ConfigurationError(
            f"--token-file {file}: {len(token)} characters (limit {_LEAST_TOKEN}); make one with "
            "python -c 'import secrets; print(secrets.token_urlsafe())'"
        )
    return token


@contextmanager
def _listening(request: ConsoleOptions) -> Iterator[socket]:
    family = AF_INET6 if ":" in request.host else AF_INET
    try:
        found = listen((request.host, request.port), family=family)
    except OSError as error:
        raise ConfigurationError(
            f"--host {request.host} --port {request.port}: {_not_listening(error)}"
        ) from error
    with found:
        yield found


def _not_listening(error: OSError) -> str:
    """Say why an address cannot be listened on, and what to do."""
    no_host = "no such host is known; give an address of this machine, such as 127.0.0.1"
    known = {
        EAI_NONAME: no_host,
        EAI_AGAIN: no_host,
        errno.EADDRINUSE: "the port is taken; is a console running already? --port 0 takes a free "
        "one",
        errno.EADDRNOTAVAIL: "not an address of this machine; give one of its own, or 127.0.0.1",
        errno.EACCES: "this port needs more rights; take one above 1023, or --port 0",
    }
    return known.get(error.errno or 0, str(error))


@contextmanager
def _server(
    request: ConsoleOptions, rig_file: RigFile, listening: socket, quick_stop: QuickStop
) -> Iterator[Connection]:
    """Start the server's process; end it when the loop has ended."""
    from pmm.console.server import serve

    settings = _settings(request, rig_file, listening.getsockname()[1])
    context = get_context("spawn")
    ours, theirs = context.Pipe()
    files = [None if one is None else Path(one) for one in (request.certificate, request.key)]
    process = context.Process(
        target=serve, args=(settings, listening, theirs, quick_stop, *files), name="console server"
    )
    process.start()
    theirs.close()
    scheme = "https" if settings.door.tls else "http"
    host = f"[{request.host}]" if ":" in request.host else request.host
    messages().print(f"console of {rig_file.name}: {scheme}://{host}:{settings.door.port}/")
    if not settings.door.tls and request.host not in LOCAL:
        messages().print(_PLAIN.format(host=request.host, port=settings.door.port))
    try:
        yield ours
    finally:
        ours.close()
        process.join(_JOIN_S)
        if process.is_alive():
            process.kill()
            process.join()


def _settings(request: ConsoleOptions, rig_file: RigFile, port: int) -> ConsoleSettings:
    output = None if request.output is None else Path(request.output)
    return ConsoleSettings(
        rig_path=rig_file.path,
        rig_hashes=rig_file.hashes,
        plans=rig_file.path.parent if request.plans is None else Path(request.plans),
        output=output,
        log_folder=output or rig_file.path.parent / rig_file.recorder.folder,
        door=Door(request.host, port, _token(request.token_file), request.certificate is not None),
        earlier=tuple(Path(one) for one in request.earlier),
        reference=None if request.reference is None else Path(request.reference),
    )


@contextmanager
def _station(
    request: ConsoleOptions, rig_file: RigFile, connection: Connection, quick_stop: QuickStop
) -> Iterator[Station]:
    from importlib.metadata import version

    period_s = 1.0 / rig_file.sample_rate_hz / request.speed
    pacer = CountingPacer(
        RealTime(period_s, time.monotonic, time.sleep), period_s, round(_WINDOW_S / period_s)
    )
    taps, answers = Taps(), BrowserAnswers()
    with ExitStack() as stack:
        priority = _priority(stack, request.speed)
        link = Link(connection)
        stack.callback(link.close)
        closing = ThreadPoolExecutor(1, thread_name_prefix="closing", initializer=step_back)
        executor = stack.enter_context(closing)
        rig = stack.enter_context(
            Rig(
                rig_file.hardware,
                time.monotonic,
                pacer,
                answers,
                observers=(taps.frame,),
                line_observers=(taps.line,),
            )
        )
        rig.prepare()
        for note in rig.notes:
            messages().print(f"note: {note}")
        station = Station(
            rig, rig_file, link, quick_stop, answers, pacer, taps, time.monotonic, _utc,
            {"program": f"pmm {version('pmm')}"}, executor, request.speed,
        )  # fmt: skip
        link.tell(replace(station.hello(), priority=str(priority)))
        yield station
        for one in station.close():
            messages().print(one)


def _priority(stack: ExitStack, speed: float) -> Priority:
    """Put the loop first; one that runs faster than the clock would leave nothing to others."""
    if speed != 1.0:
        return Priority.ORDINARY
    rehearse()
    found = stack.enter_context(before_others())
    if found.advice:
        messages().print(found.advice)
    return found.priority


def _utc() -> str:
    return datetime.now(UTC).isoformat(timespec="seconds")
