"""A stranger that means no good: it connects to a session without its token, in one of several ways, as fast as it can, until it is killed.

Arguments: the port, the way, the most connections that it holds."""

import select
import socket
import sys
import time

PORT, WAY, MOST = int(sys.argv[1]), sys.argv[2], int(sys.argv[3])
UPGRADE = (
    f"GET / HTTP/1.1\r\nHost: 127.0.0.1:{PORT}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\nSec-WebSocket-Version: 13\r\n\r\n"
).encode()
WRONG = b'\x81\x9d\0\0\0\0{"op": "auth", "token": "no"}'
SAYS = {
    "silent": b"",  # connects, and says nothing
    "half a request": b"GET / HTTP/1.1\r\nHost: ",  # and then a byte from time to time
    "half open": b"GET / HTTP/1.1\r\n",  # and closes its own side
    "connects and goes": b"",
    "no token": UPGRADE,  # a WebSocket that says nothing
    "half a token": UPGRADE + b"\x81\xfe\xff\0\0\0\0\0{",
    "wrong tokens": UPGRADE + WRONG,
    "requests": f"GET /app.js HTTP/1.1\r\nHost: 127.0.0.1:{PORT}\r\n\r\n".encode(),
    "does not read": f"GET /large HTTP/1.1\r\nHost: 127.0.0.1:{PORT}\r\n\r\n".encode() * 10,
}


def begin():
    made = socket.socket()
    made.setblocking(False)
    try:
        made.connect(("127.0.0.1", PORT))
    except BlockingIOError:
        pass
    return made


def main():
    held = {}
    print("begins", flush=True)
    while True:
        while len(held) < MOST:
            try:
                made = begin()
            except OSError:
                break
            held[made] = False
            if len(held) % 20 == 0:
                break
        polled = select.poll()
        files = {each.fileno(): each for each in held}
        for file, each in files.items():
            polled.register(file, select.POLLIN | (0 if held[each] else select.POLLOUT))
        for file, events in polled.poll(10):
            each = files[file]
            try:
                if events & select.POLLOUT and not held[each]:
                    held[each] = True
                    each.send(SAYS[WAY])
                    if WAY == "half open":
                        each.shutdown(socket.SHUT_WR)
                    if WAY == "connects and goes":
                        raise OSError
                elif WAY != "does not read" and events & select.POLLIN and not each.recv(1 << 16):
                    raise OSError
                elif events & (select.POLLHUP | select.POLLERR):
                    raise OSError
                elif WAY == "requests" and events & select.POLLIN:
                    each.send(SAYS[WAY])
            except OSError:
                del held[each]
                each.close()
        if WAY == "half a request":
            for each in list(held):
                try:
                    if held[each] and time.monotonic() % 0.2 < 0.02:
                        each.send(b"a")
                except OSError:
                    pass


main()
