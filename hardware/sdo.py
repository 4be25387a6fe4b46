"""SDO transfers, guarded: one at a time, never from a receive callback, with typed errors."""

import struct
import threading
from collections.abc import Callable
from typing import Protocol, TypeVar

import can
import canopen
from canopen.objectdictionary import ObjectDictionaryError
from canopen.sdo.client import SdoClient
from canopen.sdo.exceptions import SdoAbortedError, SdoCommunicationError

from hardware.dictionary import Entry
from hardware.errors import SdoAbortError, SdoInCallbackError, SdoTimeoutError

Number = int | float
T = TypeVar("T")
_TIMEOUT_S = 0.3  # for each answer
_REQUEST, _RESPONSE = 0x600, 0x580
_WRONG_LENGTH = 0x06070010  # CiA 301: data type does not match, length of service parameter


class Carrier(Protocol):
    """What carries SDO frames: the master."""

    lock: threading.RLock
    delivering: bool
    clock: Callable[[], float]

    @property
    def network(self) -> canopen.Network:
        """What sends for canopen, and hands responses on."""
        ...

    def receive(self, timeout_s: float) -> can.Message | None:
        """Return the next frame of the bus."""
        ...

    def deliver(self, frame: can.Message) -> None:
        """Hand a frame to whom it concerns."""
        ...


class _Client(SdoClient):
    """canopen's client, but receiving through the carrier instead of blocking on a queue."""

    def __init__(self, node_id: int, dictionary: canopen.ObjectDictionary, by: Carrier) -> None:
        super().__init__(  # type: ignore[no-untyped-call]
            _REQUEST + node_id, _RESPONSE + node_id, dictionary
        )
        self.network = by.network
        self._carrier = by
        by.network.subscribe(self.tx_cobid, self.on_response)

    def read_response(self) -> bytes:
        deadline = self._carrier.clock() + self.RESPONSE_TIMEOUT
        while self.responses.empty():
            rest_s = deadline - self._carrier.clock()
            frame = self._carrier.receive(rest_s) if rest_s > 0 else None
            if frame is None:
                raise SdoCommunicationError("No SDO response received")
            self._carrier.deliver(frame)
        response: bytes = super().read_response()  # type: ignore[no-untyped-call]
        return response


class Sdo:
    """Reads and writes the objects of one node."""

    def __init__(
        self,
        name: str,
        node_id: int,
        dictionary: canopen.ObjectDictionary,
        carrier: Carrier,
    ) -> None:
        self._name = f"{name} (node {node_id})"
        self._carrier = carrier
        self._dictionary = dictionary
        self._client = _Client(node_id, dictionary, carrier)
        self._client.RESPONSE_TIMEOUT = _TIMEOUT_S

    def read(self, at: Entry) -> Number | str:
        """Return an object's value, decoded after the EDS.

        Raises
        ------
        SdoTimeoutError, SdoAbortError, SdoInCallbackError
            If the node does not answer, refuses, or the call comes from a receive callback.
        """
        raw = self._guarded(at, "read", lambda: self._client.upload(*at))
        try:
            value = self._variable(at).decode_raw(raw)
        except (ObjectDictionaryError, ValueError, struct.error) as error:
            raise SdoAbortError(
                self._name, f"answers {at} with {raw.hex() or 'nothing'}: {error}", _WRONG_LENGTH
            ) from error
        return value if isinstance(value, int | float | str) else bytes(value).hex()

    def read_raw(self, at: Entry) -> bytes:
        """Return an object's bytes, whatever the EDS says of it; raises as :meth:`read`."""
        return self._guarded(at, "read", lambda: bytes(self._client.upload(*at)))

    def write(self, at: Entry, value: Number | str) -> None:
        """Write an object's value, encoded after the EDS; raises as :meth:`read`."""
        data = self._variable(at).encode_raw(value)
        self._guarded(at, f"write {value!r} to", lambda: self._client.download(*at, data))

    def _variable(self, at: Entry) -> canopen.objectdictionary.ODVariable:
        od_variable = self._dictionary.get_variable(*at)
        if od_variable is None:
            raise SdoAbortError(self._name, f"object {at} is not in the EDS", 0x06020000)
        return od_variable

    def _guarded(self, at: Entry, action: str, transfer: Callable[[], T]) -> T:
        if self._carrier.delivering:
            raise SdoInCallbackError(
                self._name, f"cannot {action} {at} while frames are delivered; do it between cycles"
            )
        with self._carrier.lock:
            try:
                return transfer()
            except SdoAbortedError as error:
                raise SdoAbortError(
                    self._name, f"refused to {action} {at}: {error}", error.code
                ) from error
            except SdoCommunicationError as error:
                raise SdoTimeoutError(
                    self._name,
                    f"could not {action} {at} within {self._client.RESPONSE_TIMEOUT:g} s: {error}",
                ) from error


class GuardedNetwork(canopen.Network):
    """canopen's network without its thread: it sends through the guarded sender."""

    def __init__(self, send: Callable[[int, bytes], None]) -> None:
        super().__init__()
        self._send = send

    def send_message(self, can_id: int, data: bytes, remote: bool = False) -> None:
        """Send a frame; canopen asks for no remote ones here."""
        self._send(can_id, bytes(data))
