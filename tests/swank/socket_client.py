"""A client at the other end of a socket, which says the secret as SLIME does."""

from __future__ import annotations

import os
import socket

from cramhy_runtime import kernel
from cramhy_runtime.swank import wire


def secret(home=None):
    """The first line of the secret of the user whose home that is."""
    with open(os.path.join(home or os.environ["HOME"], ".slime-secret"), encoding="utf-8") as file:
        return file.readline().rstrip("\n")


def said(home):
    """What a client of that user says first."""
    return wire.frame(secret(home))


class Client:
    """A client at the other end of a socket. It waits outside of the kernel, so the session goes on meanwhile."""

    def __init__(self, address, said=None):
        """said: what it sends first, bytes; ``None`` for the secret, ``b""`` for nothing."""
        at_path = isinstance(address, str)
        self.socket = socket.socket(socket.AF_UNIX if at_path else socket.AF_INET, socket.SOCK_STREAM)
        self.socket.settimeout(20)
        self.socket.connect(address if at_path else ("127.0.0.1", address))
        if said is None:
            said = wire.frame(secret())
        self.socket.sendall(said)

    def send(self, text):
        self.socket.sendall(wire.frame(text))

    def _read(self, count):
        data = b""
        while len(data) < count:
            try:
                more = self.socket.recv(count - len(data))
            except ConnectionError:
                more = b""
            if not more:
                return None
            data += more
        return data

    def _message(self):
        head = self._read(6)
        return None if head is None else wire.read(wire.text_of(self._read(wire.length_of(head))))

    def hear(self):
        """The next message; ``None`` when the server has ended the connection."""
        return kernel.run_blocking(self._message)

    def call(self, form):
        self.send(f"(:emacs-rex {form} nil t 1)")
        while (message := self.hear()) is not None:
            if message[0] == ":return":
                return message[1]
        return None


class PlainClient(Client):
    """A client in a process that has no kernel to wait for."""

    def hear(self):
        return self._message()
