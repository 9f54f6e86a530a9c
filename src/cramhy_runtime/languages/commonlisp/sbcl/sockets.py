"""What the library ``sb-bsd-sockets`` asks of the system: calls of Python's sockets, and streams on them.

A call that waits lets the other tasks of the session go on. An error of the system is told as a value; the library makes a condition of it.
"""

from __future__ import annotations

import io
import select
import socket

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import list_from, lisp_list, truth
from cramhy_runtime.lisp_core.packages import keyword, symbol_name
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

from ..files.file_streams import FileStream, element_of
from ..streams.external_formats import external_format

if TYPE_CHECKING:
    from collections.abc import Callable


def make(family: str, kind: str) -> object:
    """(t socket) or (nil errno text): a socket of the address family "INET", "INET6" or "UNIX", for a "STREAM" or a "DGRAM"."""
    return attempt(lambda: socket.socket(getattr(socket, f"AF_{family}"), getattr(socket, f"SOCK_{kind}")))


def attempt(function: Callable[[], Any]) -> object:
    """(t value) of a call of the system, or (nil errno text) if it fails."""
    try:
        return lisp_list(True, _told(kernel.run_blocking(function)))
    except socket.gaierror as problem:
        return lisp_list(None, problem.errno, problem.strerror)
    except (OSError, OverflowError) as problem:
        return lisp_list(None, getattr(problem, "errno", None) or 0, getattr(problem, "strerror", None) or str(problem))


def _told(value: Any) -> object:
    if isinstance(value, bytes):
        return list(value)
    return list_from([_told(each) for each in value]) if isinstance(value, (tuple, list)) else value


def call(handle: Any, method: str, *arguments: Any) -> object:
    """`attempt` a method of a socket."""
    return attempt(lambda: getattr(handle, method)(*arguments))


def call_with_address(handle: Any, method: str, *address: Any) -> object:
    """`attempt` a method of a socket that takes an address: a path, or a host and a port."""
    return attempt(lambda: getattr(handle, method)(address[0] if len(address) == 1 else address))


def send(handle: Any, octets: Any, *address: Any) -> object:
    """`attempt` to send octets, to an address if there is one."""
    data = bytes(octets)
    return attempt(lambda: handle.sendto(data, address) if address else handle.send(data))


def receive(handle: Any, length: int, peek: object, do_not_wait: object, wait_for_all: object) -> object:
    """`attempt` to receive; the value is (octets address)."""
    flags = (socket.MSG_PEEK if truth(peek) else 0) | (socket.MSG_WAITALL if truth(wait_for_all) else 0)
    return attempt(lambda: handle.recvfrom(length, flags | (getattr(socket, "MSG_DONTWAIT", 0) if truth(do_not_wait) else 0)))


def option(handle: Any, level: str, name: str, *value: Any) -> object:
    """`attempt` to ask for an option of a socket, or to set it."""
    numbers = getattr(socket, level), getattr(socket, name)
    return attempt(lambda: handle.setsockopt(*numbers, *value) if value else handle.getsockopt(*numbers))


def host_by_name(name: str) -> object:
    """(t (name aliases addresses)) of a host."""
    return attempt(lambda: socket.gethostbyname_ex(name))


def host_by_address(address: str) -> object:
    """(t (name aliases addresses)) of the host at an address as "127.0.0.1"."""
    return attempt(lambda: socket.gethostbyaddr(address))


def protocol_by_name(name: str) -> object:
    """(t number) of a protocol such as "tcp"."""
    return attempt(lambda: socket.getprotobyname(name))


def shutdown(handle: Any, reads: object, writes: object) -> object:
    """`attempt` to end reading, writing or both."""
    how = socket.SHUT_RDWR if truth(reads) and truth(writes) else socket.SHUT_RD if truth(reads) else socket.SHUT_WR
    return call(handle, "shutdown", how)


def ready(descriptor: Any, writes: object, seconds: Any) -> object:
    """Whether a descriptor can be read, or written, within so many seconds; nil for as long as it takes."""
    files: list[Any] = [descriptor]
    empty: list[Any] = []
    sets = (empty, files, empty) if truth(writes) else (files, empty, empty)
    return True if any(kernel.run_blocking(select.select, *sets, None if seconds is None else float(seconds))) else None


class SocketStream(FileStream):
    """A stream on a socket. What was fetched as text and not read is read as bytes, if bytes are read next."""

    def __init__(self, handle: Any, reads: bool, writes: bool, element: tuple[Any, int, bool], format_: Any, seconds: Any) -> None:
        super().__init__(_Octets(handle, seconds), None, "a socket", reads, writes, *element, format_=format_)
        self.waits = True

    def _forget_fetched(self) -> None:
        if self._position < len(self._text):
            self.file.put_back(self._text[self._position :].encode(self.format.codec))
        self._text, self._position = "", 0

    def _undecodable(self, octets: bytes, bad: int, after: int, start: int) -> Any:
        if bad:
            self.file.put_back(octets[bad:])
            return octets[:bad].decode(self.format.codec)
        self.file.put_back(octets[after:])
        return self.format.replacement or "\N{REPLACEMENT CHARACTER}"

    def listen(self) -> Any:
        """Whether something can be read without waiting."""
        return self._position < len(self._text) or self.file.listen()

    def length(self) -> Any:
        """A socket has no length."""
        return None


class _Octets(io.RawIOBase):
    """The file that `SocketStream` reads and writes; ``seconds``: how long it waits for bytes at most."""

    def __init__(self, handle: Any, seconds: Any) -> None:
        super().__init__()
        if seconds is not None:
            handle.settimeout(float(seconds))
        self._handle, self._pair, self._back = handle, handle.makefile("rwb"), b""

    def put_back(self, octets: bytes) -> None:
        """Let these bytes be read next."""
        self._back = octets + self._back

    def listen(self) -> bool:
        """Whether a byte is there."""
        return bool(self._back) or bool(select.select([self._handle], [], [], 0)[0])

    def read(self, size: int = -1) -> bytes:
        """``size`` bytes; fewer at the end."""
        taken, self._back = self._back[:size], self._back[size:]
        return taken if len(taken) == size else taken + self._pair.read(size - len(taken))

    def readline(self, size: int | None = -1) -> bytes:
        """The bytes up to a newline."""
        if not self._back:
            return self._pair.readline()
        end = self._back.find(b"\n") + 1 or len(self._back)
        taken, self._back = self._back[:end], self._back[end:]
        return taken if taken.endswith(b"\n") else taken + self._pair.readline()

    def write(self, octets: Any) -> int:
        """Send bytes when the buffer is full, or flushed."""
        return self._pair.write(octets)

    def flush(self) -> None:
        """Send what is buffered."""
        if not self.closed:
            self._pair.flush()

    def fileno(self) -> int:
        """The number of the descriptor."""
        return self._handle.fileno()

    def close(self) -> None:
        """Close the file and the socket."""
        if not self.closed:
            super().close()
            self._pair.close()
            self._handle.close()


def stream(handle: Any, reads: object, writes: object, element_type: Any, format_: Any, seconds: Any) -> SocketStream:
    """A stream on a socket. element_type: as `open`'s, or "DEFAULT". seconds: how long an operation waits at most; nil without end."""
    element = element_of(keyword(element_type) if isinstance(element_type, str) else element_type)
    return SocketStream(handle, truth(reads), truth(writes), element, external_format(keyword(format_.upper())), seconds)


def is_errno(number: int, names: Any) -> object:
    """Whether the number of an error is one of those named, such as ECONNREFUSED."""
    import errno

    return True if any(getattr(errno, symbol_name(name), None) == number for name in names) else None


__all__ = ["attempt", "make", "ready", "stream"]
