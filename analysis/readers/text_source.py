"""A text file as a stream of lines: unpacked, decoded, its line ends made one kind, and hashed."""

import codecs
import gzip
import hashlib
import zlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import IO, cast

from analysis.reading_limits import LONGEST_LINE, limits
from hardware.description.errors import DataError

Progress = Callable[[float], None]  # told which part of the file has been read, 0 to 1

_GZIP_MARK = b"\x1f\x8b"
_UTF16_MARKS = (b"\xff\xfe", b"\xfe\xff")
_UTF8_MARK = b"\xef\xbb\xbf"
_BLOCK = 1 << 22  # bytes read at a time
_HEAD = 1 << 24  # bytes in which a header is looked for


@dataclass(frozen=True)
class TextSource:
    """A file of text, plain or gzip; UTF-8 (with or without mark), UTF-16 or Latin-1.

    Nothing of it is kept: each :meth:`lines` reads it anew.
    """

    path: Path
    progress: Progress = lambda _: None

    def head(self, lines: int) -> str:
        """Return the first lines, all where there are fewer.

        Raises
        ------
        DataError
            If the file cannot be read, is empty, its gzip stream is cut short or damaged, or it is
            not text.
        """
        stream, content, count = LineStream(self), b"", 0
        try:
            while count < lines and len(content) < _HEAD and (block := stream.read()):
                content += block
                count += block.count(b"\n")
            content += stream.last_row + stream.line_end
        finally:
            stream.close()
        if not content.strip():
            raise DataError(f"{self.path}: the file is empty")
        return decoded(content)

    def lines(self, skip: int = 0) -> "LineStream":
        """Open the file behind its first ``skip`` lines."""
        return LineStream(self, skip)


class LineStream:
    """Whole lines of a text source, as bytes.

    The last line with anything in it is held back, for the caller to judge: it may be cut short.

    Attributes
    ----------
    last_row, line_end
        What was held back, once all is read: that line, and the line ends behind it.
    """

    def __init__(self, source: TextSource, skip: int = 0) -> None:
        self._source, self._skip = source, skip
        self._hash = hashlib.sha256()
        self._decoder: codecs.IncrementalDecoder | None = None
        self._first, self._over = True, False
        self._held = self._carriage_return = b""
        self._limits, self._count = limits(), 0
        self.last_row = self.line_end = b""
        try:
            self._size = source.path.stat().st_size
            self._raw: IO[bytes] = source.path.open("rb", buffering=0)
        except OSError as error:
            raise DataError(f"{source.path}: cannot be read: {error.strerror}") from None
        counted = _HashedFile(self._raw, self._hash)
        packed = source.path.suffix.lower() == ".gz" and self._size > 0
        self._file = gzip.GzipFile(fileobj=cast("IO[bytes]", counted)) if packed else counted

    @property
    def sha256(self) -> str:
        """Of the file's bytes, as far as they have been read."""
        return self._hash.hexdigest()

    def close(self) -> None:
        """Let go of the file."""
        self._raw.close()

    def read(self) -> bytes:
        """Return some more whole lines, as many as come; nothing at the end."""
        while not self._over:
            block = self._unpacked()
            self._over = not block
            text = self._held + self._as_lines(block)
            text = self._without_skipped(text)
            stripped = text.rstrip(b"\n")
            cut = stripped.rfind(b"\n") + 1
            self._held = text[cut:]
            if self._over:
                self.last_row = stripped[cut:]
                self.line_end = text[len(stripped) :]
            if cut:
                return text[:cut]
        return b""

    def _unpacked(self) -> bytes:
        path = self._source.path
        try:
            block = self._file.read(max(_BLOCK, len(_UTF8_MARK)))  # a mark comes whole
            if self._size:
                self._source.progress(min(1.0, self._raw.tell() / self._size))
        except EOFError:
            raise DataError(f"{path}: the gzip file is cut short; copy it again") from None
        except (gzip.BadGzipFile, zlib.error) as error:
            if not _starts_as_gzip(path):
                raise DataError(f"{path}: not a gzip file, whatever its name says") from None
            raise DataError(f"{path}: not a sound gzip file ({error}); copy it again") from None
        except OSError as error:
            raise DataError(f"{path}: cannot be read: {error.strerror}") from None
        self._check_size(len(block))
        return block

    def _check_size(self, count: int) -> None:
        self._count += count
        most, path = self._limits.text_bytes, str(self._source.path)
        if self._count > most:
            raise self._limits.too_large(path, f"more than {most} bytes of text")
        if len(self._held) > LONGEST_LINE:
            raise DataError(
                f"{path}: a line of more than {LONGEST_LINE} bytes; not a table of text"
            )

    def _as_lines(self, block: bytes) -> bytes:
        """Make UTF-8 of it, with line ends of one kind."""
        if self._first:
            self._first = False
            if block.startswith(_UTF16_MARKS):
                self._decoder = codecs.getincrementaldecoder("utf-16")(errors="replace")
            block = block.removeprefix(_UTF8_MARK)
        if self._decoder is not None:
            block = self._decoder.decode(block, final=not block).encode()
        elif b"\0" in block:
            raise DataError(f"{self._source.path}: not a text file (it holds zero bytes)")
        block = self._carriage_return + block
        split = block.endswith(b"\r") and not self._over  # its line feed may come with the next
        self._carriage_return = b"\r" if split else b""
        if b"\r" not in block:
            return block
        block = block[:-1] if split else block
        return block.replace(b"\r\n", b"\n").replace(b"\r", b"\n")

    def _without_skipped(self, text: bytes) -> bytes:
        while self._skip and (end := text.find(b"\n") + 1):
            text, self._skip = text[end:], self._skip - 1
        return b"" if self._skip and self._over else text


def decoded(text: bytes) -> str:
    """Return lines of a stream as text."""
    try:
        return text.decode("utf-8")
    except UnicodeDecodeError:
        return text.decode("latin-1")


class _HashedFile:
    """A file whose bytes are hashed as they are read."""

    def __init__(self, raw: IO[bytes], digest: "hashlib._Hash") -> None:
        self._raw, self._found = raw, digest

    def read(self, size: int = -1) -> bytes:
        block = self._raw.read(size)
        self._found.update(block)
        return block


def _starts_as_gzip(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(len(_GZIP_MARK)) == _GZIP_MARK
