"""The raw log of a CAN bus: frames into Vector's binary log (BLF).

A BLF is a header of 144 bytes and a row of objects. Those here are containers, each of zlib-packed
frames and readable by itself: what is cut off behind one does not touch it. They are kept small, so
that a cut costs little. python-can's own writer takes some 10 us a frame, this one about 1; its
reader reads both. :mod:`hardware.raw_log_reading` reads it here.
"""

import struct
import zlib
from typing import Final

import can

CONTAINER_BYTES: Final = 8192
_LEVEL: Final = 1  # zlib: five times smaller already, at a third of the time
HEADER_BYTES: Final = 144
_HEADER = struct.Struct("<4sI8BQQII16H72x")
OBJECT = struct.Struct("<4sHHII")  # signature, header's size and version, object's size, kind
PACKED = struct.Struct("<H6xI4x")  # method, size when unpacked
# An object, then: flags (nanoseconds), two unused, stamp; channel, flags, length, identifier, data.
FRAME = struct.Struct("<4sHHIIIHHQHBBI8s")
# The same head; channel, length, and of an error: flags, code, position, length, identifier, data.
ERROR = struct.Struct("<4sHHIIIHHQHHIBBBxIIH2x8s")
KIND_FRAME, KIND_CONTAINER, KIND_ERROR = 1, 10, 73
_NANOSECONDS, _CHANNEL, ZLIB = 2, 1, 2
SENT, REMOTE, EXTENDED = 0x01, 0x80, 0x80000000

Frame = can.Message


def file_header(size: int = 0, unpacked: int = 0, frames: int = 0) -> bytes:
    """Return the header; a log that was not closed says 0 of its size and frames."""
    objects = 0 if not size else frames
    return _HEADER.pack(
        b"LOGG", HEADER_BYTES, 0, 0, 0, 0, 2, 6, 8, 1, size, unpacked, objects, 0, *([0] * 16)
    )


def container(objects: bytes) -> bytes:
    """Return packed objects as one object of the file."""
    packed = zlib.compress(objects, _LEVEL)
    size = OBJECT.size + PACKED.size + len(packed)
    head = OBJECT.pack(b"LOBJ", OBJECT.size, 1, size, KIND_CONTAINER)
    return b"".join((head, PACKED.pack(ZLIB, len(objects)), packed, bytes(size % 4)))


class FramePacker:
    """Turns frames into objects of a log, a container's worth at a time.

    Sent frames bear the stamp of the last one received: the order is what counts.

    Attributes
    ----------
    frames
        How many were taken.
    unpacked_bytes
        How many bytes of objects they made.
    """

    def __init__(self) -> None:
        self.frames = 0
        self.unpacked_bytes = 0
        self._stamp_ns = 0
        self._pending = bytearray()
        self._full: list[bytes] = []

    def take(self, frame: Frame) -> None:
        """Pack a frame into the container that is being filled."""
        stamp_ns = int(frame.timestamp * 1e9)
        if stamp_ns > self._stamp_ns:
            self._stamp_ns = stamp_ns
        data = self._error(frame) if frame.is_error_frame else self._frame(frame)
        self.frames += 1
        self.unpacked_bytes += len(data)
        if len(self._pending) + len(data) > CONTAINER_BYTES:
            self._full.append(bytes(self._pending))
            self._pending.clear()
        self._pending += data

    def drain(self) -> list[bytes]:
        """Return what has come since the last call, in pieces for :func:`container`."""
        pieces, self._full = self._full, []
        if self._pending:
            pieces.append(bytes(self._pending))
            self._pending.clear()
        return pieces

    def _frame(self, frame: Frame) -> bytes:
        flags = (0 if frame.is_rx else SENT) | (REMOTE if frame.is_remote_frame else 0)
        identifier = frame.arbitration_id | (EXTENDED if frame.is_extended_id else 0)
        return FRAME.pack(
            b"LOBJ", 32, 1, FRAME.size, KIND_FRAME, _NANOSECONDS, 0, 0, self._stamp_ns,
            _CHANNEL, flags, frame.dlc, identifier, frame.data,
        )  # fmt: skip

    def _error(self, frame: Frame) -> bytes:
        identifier = frame.arbitration_id | (EXTENDED if frame.is_extended_id else 0)
        return ERROR.pack(
            b"LOBJ", 32, 1, ERROR.size, KIND_ERROR, _NANOSECONDS, 0, 0, self._stamp_ns,
            _CHANNEL, 0, 0, 0, 0, frame.dlc, 0, identifier, 0, frame.data,
        )  # fmt: skip
