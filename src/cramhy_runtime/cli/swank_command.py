"""``cramhy swank`` and ``cramhy repl --swank``: a session that Emacs connects to."""

from __future__ import annotations

import socket
import sys

from cramhy_runtime import kernel

USUAL_PORT = 4005


def listen(made, address, port_file=None, alone=False):
    """Listen for Emacs in the session ``made``. What keeps it from listening ends the process with the status 2."""
    from cramhy_runtime.swank import package, server

    try:
        found = server.serve(made, package.log, address, port_file, alone)
    except server.ServerError as problem:
        print(f"cramhy: {problem}", file=sys.stderr)
        sys.exit(2)
    where = f"M-x slime-connect RET 127.0.0.1 RET {found.port} RET" if found.port is not None else f"the socket {found.address}"
    print(f"; Emacs connects by {where}", file=sys.stderr, flush=True)
    return found


def run(make_session, options):
    """Serve until a signal or Emacs ends the process."""
    made = make_session()
    address = options.socket or (USUAL_PORT if options.port is None and options.port_file is None else options.port)
    listen(made, address, options.port_file, alone=True)
    here, there = socket.socketpair()  # waiting for it is waiting for the end
    with here, there:
        while True:
            try:
                with kernel.woken_by(lambda: there.send(b"!")):
                    kernel.run_blocking(here.recv, 1)
                kernel.yield_()  # what woke us is raised here
            except (kernel.Interrupted, kernel.Abandoned):
                kernel.interrupt_over()
                return 130
