"""What a console is asked for: the rig, where it listens, and who may command it."""

import errno
import ssl
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from socket import AF_INET, AF_INET6, EAI_AGAIN, EAI_NONAME, socket
from socket import create_server as listen
from typing import Final

from hardware.description.errors import ConfigurationError
from pmm.console.app_settings import ConsoleSettings
from pmm.console.live.live_settings import OutletSettings, live_settings
from pmm.console.plans import is_plan
from pmm.console.security import LOCAL, Door
from pmm.plan.rig_file import RigFile, is_simulated, read_rig_file

_LEAST_TOKEN: Final = 16
_PLAIN: Final = (
    "warning: --host {host} without --certificate: whoever is on the network between reads the "
    "token and may send commands of their own. Give --certificate and --key (docs/console.md: how "
    "to make them), or leave --host out and come by a tunnel from the other machine: "
    "ssh -L {port}:127.0.0.1:{port} USER@THIS-MACHINE"
)


@dataclass(frozen=True)
class ConsoleRequest:
    """The options of ``pmm console``, by their names there."""

    rig: str
    plans: str | None
    output: str | None
    host: str
    port: int
    token_file: str | None
    watch_token_file: str | None
    propose_token_file: str | None
    certificate: str | None
    key: str | None
    earlier: tuple[str, ...]
    reference: str | None
    speed: float
    mqtt: str | None
    mqtt_password_file: str | None
    mqtt_authority: str | None
    epics: str | None

    def rig_file(self) -> RigFile:
        """Read the rig's file, and refuse what cannot go together.

        Raises
        ------
        ConfigurationError
            If the rig's file is wrong or a plan, or listening there is not safe.
        """
        if Path(self.rig).is_file() and is_plan(Path(self.rig)):
            raise ConfigurationError(
                f"{self.rig}: is a plan, not a rig; give the rig's file that it names, and queue "
                "the plan on the page"
            )
        rig_file = read_rig_file(self.rig)
        if self.speed != 1.0 and not is_simulated(rig_file.hardware):
            raise ConfigurationError(
                f"--speed {self.speed:g}: {rig_file.path} is no simulated rig; only those run "
                "faster or slower than the clock"
            )
        folders = [("--plans", self.plans), *(("--earlier", folder) for folder in self.earlier)]
        for option, name in folders:
            if name is not None and not Path(name).is_dir():
                raise ConfigurationError(f"{option} {name}: no such folder")
        self._check_door()
        self._live(rig_file)
        return rig_file

    def _live(self, rig_file: RigFile) -> OutletSettings:
        return live_settings(
            rig_file.name, self.mqtt, self.mqtt_password_file, self.mqtt_authority, self.epics
        )

    def _check_door(self) -> None:
        if (self.certificate is None) != (self.key is None):
            raise ConfigurationError(
                "--certificate and --key belong together; give both or neither"
            )
        if self.host not in LOCAL and self.token_file is None:
            raise ConfigurationError(
                f"--host {self.host}: whoever reaches this address could move the rig; give "
                f"--token-file with a secret of at least {_LEAST_TOKEN} characters, or listen on "
                f"{LOCAL[0]}"
            )
        lesser = {
            "--watch-token-file": self.watch_token_file,
            "--propose-token-file": self.propose_token_file,
        }
        for option, name in lesser.items():
            if name is not None and self.token_file is None:
                raise ConfigurationError(
                    f"{option}: whoever has no token operates; give --token-file, too"
                )
        for option, name in (("--certificate", self.certificate), ("--key", self.key)):
            if name is not None and not Path(name).is_file():
                raise ConfigurationError(f"{option} {name}: no such file")
        if self.certificate is not None:
            _check_tls(self.certificate, str(self.key))

    @contextmanager
    def listening(self) -> Iterator[socket]:
        """Listen where it is asked for.

        Raises
        ------
        ConfigurationError
            If the address is taken or none of this machine's.
        """
        family = AF_INET6 if ":" in self.host else AF_INET
        try:
            listener = listen((self.host, self.port), family=family)
        except OSError as error:
            raise ConfigurationError(
                f"--host {self.host} --port {self.port}: {_not_listening(error)}"
            ) from error
        with listener:
            yield listener

    def settings(self, rig_file: RigFile, port: int) -> ConsoleSettings:
        """Return how the console is set up; it listens on ``port``."""
        output = None if self.output is None else Path(self.output)
        tokens = (
            _token("--token-file", self.token_file),
            _token("--watch-token-file", self.watch_token_file),
            _token("--propose-token-file", self.propose_token_file),
        )
        stated_tokens = [token for token in tokens if token]
        if len(set(stated_tokens)) < len(stated_tokens):
            raise ConfigurationError(
                "--token-file, --watch-token-file, --propose-token-file: two hold the same token, "
                "whose holder's rights would be unclear; make another"
            )
        return ConsoleSettings(
            rig_path=rig_file.path,
            rig_hashes=rig_file.hashes,
            plans=rig_file.path.parent if self.plans is None else Path(self.plans),
            output=output,
            log_folder=output or rig_file.path.parent / rig_file.recorder.folder,
            door=Door(self.host, port, tokens[0], self.certificate is not None, *tokens[1:]),
            earlier=tuple(Path(folder) for folder in self.earlier),
            reference=None if self.reference is None else Path(self.reference),
            live=self._live(rig_file),
        )

    def greeting(self, name: str, door: Door) -> Iterator[str]:
        """Yield where the console of a rig is, and what of that is not safe."""
        scheme = "https" if door.tls else "http"
        host = f"[{self.host}]" if ":" in self.host else self.host
        yield f"console of {name}: {scheme}://{host}:{door.port}/"
        if not door.tls and self.host not in LOCAL:
            yield _PLAIN.format(host=self.host, port=door.port)


def _check_tls(certificate: str, key: str) -> None:
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(certificate, key)
    except (OSError, ssl.SSLError) as error:
        raise ConfigurationError(
            f"--certificate {certificate}, --key {key}: not a certificate and its key in PEM "
            f"({error})"
        ) from error


def _token(option: str, file: str | None) -> str:
    if file is None:
        return ""
    if not Path(file).is_file():
        raise ConfigurationError(f"{option} {file}: no such file")
    try:
        token = Path(file).read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"{option} {file}: {error}") from error
    if len(token) < _LEAST_TOKEN:
        raise ConfigurationError(
            f"{option} {file}: {len(token)} characters (limit {_LEAST_TOKEN}); make one with "
            "python -c 'import secrets; print(secrets.token_urlsafe())'"
        )
    return token


def _not_listening(error: OSError) -> str:
    """Say why an address cannot be listened on, and what to do."""
    no_host = "no such host is known; give an address of this machine, such as 127.0.0.1"
    reasons = {
        EAI_NONAME: no_host,
        EAI_AGAIN: no_host,
        errno.EADDRINUSE: "the port is taken; is a console running already? --port 0 takes a free "
        "one",
        errno.EADDRNOTAVAIL: "not an address of this machine; give one of its own, or 127.0.0.1",
        errno.EACCES: "this port needs more rights; take one above 1023, or --port 0",
    }
    return reasons.get(error.errno or 0, str(error))
