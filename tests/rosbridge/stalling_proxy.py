"""A network that can be made to carry nothing: a TCP proxy between a session and its robot."""

from __future__ import annotations

import contextlib
import socket
import threading


class StallingProxy:
    """Listens at ``port`` and carries bytes to and from the port TO of this machine, unless it is made to `stall`."""

    def __init__(self, to):
        self.to = to
        self.flows = threading.Event()
        self.flows.set()
        self.sockets = set()
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.port = self.listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def stall(self):
        """Carry nothing from now on. The connections stay, and new ones come about, as where packets are lost."""
        self.flows.clear()

    def resume(self):
        self.flows.set()

    def cut(self):
        """Reset all connections."""
        for each in list(self.sockets):
            with contextlib.suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)

    def close(self):
        self.listener.close()
        self.resume()
        self.cut()

    def _accept(self):
        with contextlib.suppress(OSError):
            while True:
                near, _ = self.listener.accept()
                threading.Thread(target=self._connect, args=(near,), daemon=True).start()

    def _connect(self, near):
        self.flows.wait()
        try:
            far = socket.create_connection(("127.0.0.1", self.to))
        except OSError:
            return near.close()
        for source, drain in ((near, far), (far, near)):
            self.sockets.add(source)
            threading.Thread(target=self._carry, args=(source, drain), daemon=True).start()

    def _carry(self, source, drain):
        with contextlib.suppress(OSError):
            while True:
                octets = source.recv(65536)
                self.flows.wait()
                if not octets:
                    break
                drain.sendall(octets)
        for each in (source, drain):
            self.sockets.discard(each)
            with contextlib.suppress(OSError):
                each.shutdown(socket.SHUT_RDWR)
