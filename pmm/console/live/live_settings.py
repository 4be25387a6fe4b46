"""Where live values go, from the options of ``pmm console``."""

import re
import ssl
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from typing import Final
from urllib.parse import unquote, urlsplit

from hardware.description.errors import ConfigurationError
from hardware.description.version import installing

_PORTS: Final = {"mqtt": 1883, "mqtts": 8883}
_EPICS_PREFIX: Final = re.compile(r"[A-Za-z0-9_:-]{1,28}")  # with the longest name 60 characters
_TOPIC: Final = re.compile(r"[^+#\x00-\x1f]{1,200}")


@dataclass(frozen=True)
class BrokerSettings:
    """A broker, and the topic under which values are published there.

    Attributes
    ----------
    url
        As it was given, for messages.
    certificate
        The file of the authority that is trusted; ``None`` for those of the system.
    """

    url: str
    host: str
    port: int
    prefix: str
    user: str = ""
    password: str = field(default="", repr=False)
    tls: bool = False
    certificate: str | None = None


@dataclass(frozen=True)
class OutletSettings:
    """Where live values go.

    Attributes
    ----------
    broker
        ``None`` without MQTT.
    epics_prefix
        Before the name of each process variable; empty without EPICS.
    """

    broker: BrokerSettings | None = None
    epics_prefix: str = ""

    @property
    def any(self) -> bool:
        """Whether live values go to a broker or to EPICS."""
        return self.broker is not None or bool(self.epics_prefix)


def live_settings(
    rig: str, mqtt: str | None, password_file: str | None, authority: str | None, epics: str | None
) -> OutletSettings:
    """Return where live values of a rig go.

    Raises
    ------
    ConfigurationError
        If an option is wrong, or what it needs is not installed.
    """
    for option, value in (("--mqtt-password-file", password_file), ("--mqtt-authority", authority)):
        if value is not None and mqtt is None:
            raise ConfigurationError(f"{option}: belongs to --mqtt; give that, too")
    broker = None if mqtt is None else _broker(rig, mqtt, password_file, authority)
    if epics is not None:
        _require("--epics", "epics", "caproto")
        if not _EPICS_PREFIX.fullmatch(epics):
            raise ConfigurationError(
                f"--epics {epics!r}: a prefix has 1 to 28 letters, digits and _ : -, such as PMM"
            )
    return OutletSettings(broker, epics or "")


def _broker(rig: str, url: str, password_file: str | None, authority: str | None) -> BrokerSettings:
    _require("--mqtt", "mqtt", "aiomqtt")
    try:
        parts = urlsplit(url)
        port = parts.port
    except ValueError as error:
        raise ConfigurationError(f"--mqtt {url}: {error}") from error
    if parts.scheme not in _PORTS or not parts.hostname or parts.query or parts.fragment:
        raise ConfigurationError(
            f"--mqtt {url}: write mqtt://HOST, or mqtts://USER@HOST:PORT/TOPIC with TLS"
        )
    if parts.password is not None:
        raise ConfigurationError(
            "--mqtt: a password in the address is seen by whoever lists the processes; write it "
            "into a file and give --mqtt-password-file"
        )
    tls = parts.scheme == "mqtts"
    _check_authority(authority, tls=tls)
    if password_file is not None and not parts.username:
        raise ConfigurationError(f"--mqtt {url}: a password needs a user; write mqtt://USER@HOST")
    topic = unquote(parts.path).strip("/") or f"pmm/{re.sub(r'[^A-Za-z0-9_-]+', '-', rig)}"
    if not _TOPIC.fullmatch(topic):
        raise ConfigurationError(
            f"--mqtt {url}: a topic has neither + nor # nor control characters, and at most 200"
        )
    password = "" if password_file is None else _password(password_file)
    return BrokerSettings(
        url, parts.hostname, _PORTS[parts.scheme] if port is None else port, topic,
        unquote(parts.username or ""), password, tls, authority,
    )  # fmt: skip


def _check_authority(authority: str | None, *, tls: bool) -> None:
    if authority is None:
        return
    if not tls:
        raise ConfigurationError("--mqtt-authority: mqtt:// has no TLS; write mqtts://")
    try:
        ssl.create_default_context(cafile=authority)
    except (OSError, ssl.SSLError) as error:
        raise ConfigurationError(
            f"--mqtt-authority {authority}: not a certificate in PEM ({error})"
        ) from error


def _password(file: str) -> str:
    try:
        return Path(file).read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigurationError(f"--mqtt-password-file {file}: {error}") from error


def _require(option: str, extra: str, package: str) -> None:
    if find_spec(package) is None:
        raise ConfigurationError(f"{option} needs the extra {extra!r}: {installing(extra)}")
