"""The process of a kernel: a session, and ipykernel's application in its main thread."""

from __future__ import annotations

import asyncio
import os
import sys
from types import SimpleNamespace

from ipykernel.kernelapp import IPKernelApp
from tornado import ioloop

from cramhy_runtime import kernel
from cramhy_runtime.storage import owners

from .notebook_kernel import CramhyKernel

LOOK = 1000  # ms between two looks whether Jupyter is still there


class Application(IPKernelApp):
    """ipykernel's application with our kernel. It does not end the process by force when Jupyter is gone: plans end in order."""

    name = "cramhy"
    kernel_class = CramhyKernel
    subapp = None

    def init_connection_file(self):
        """Read the file. Where others know the key, the process ends with the status 2, before anything listens."""
        super().init_connection_file()
        path = self.abs_connection_file
        if os.path.exists(path) and (problem := open_to_all(self.session.key, path)) is not None:
            print(f"cramhy: {problem}", file=sys.stderr)
            sys.exit(2)

    def init_io(self):
        """Programs print through the session, see `streams`; what libraries write to the descriptors goes to Jupyter's own terminal."""
        self.displayhook = SimpleNamespace()

    def init_signal(self):
        """SIGINT is the kernel's."""

    def init_poller(self):
        """Jupyter's end is looked for in the loop, see `run`."""

    def init_gui_pylab(self):
        """There is no IPython."""

    def init_extensions(self):
        """There is no IPython."""

    def init_code(self):
        """There is no IPython."""


def open_to_all(key, path):
    """Why anybody on this machine could run cells, a text for the user, or ``None``.

    key: with which messages are signed; Jupyter checks no signature where it is empty. path: of the file in which the key stands.
    """
    again = "Let Jupyter write the file, or write one of mode 0600 with a long random key."
    if not key:
        return f'the connection file {path} has an empty "key", so any user of this machine could run cells. {again}'
    status = os.stat(path)
    if not os.environ.get("JUPYTER_ALLOW_INSECURE_WRITES") and (not owners.trusted(status) or owners.open_to_others(status)):
        return f"the connection file {path} may be read or written by other users, so they could run cells. {again}"
    return None


def run(made, connection_file):
    """Serve notebooks in the session ``made`` until Jupyter ends the kernel. Returns the exit status.

    connection_file: the path of the file in which Jupyter says where to connect.
    """
    loop = asyncio.new_event_loop()
    asyncio.set_event_loop(loop)
    plans = kernel.active()
    app = Application.instance(connection_file=connection_file)
    app.initialize([])
    served = app.kernel
    served.plans, served.made = plans, made
    plans.count_outside(1)
    served.serve(loop)
    io_loop = ioloop.IOLoop.current()

    def stop():
        io_loop.add_callback_from_signal(io_loop.stop)

    served.end = stop
    parent = os.getppid()
    poller = ioloop.PeriodicCallback(lambda: stop() if os.getppid() != parent else None, LOOK)
    poller.start()
    try:
        with kernel.woken_by(stop):
            kernel.run_blocking(app.start)
        kernel.yield_()  # what woke us is raised here
    finally:
        plans.count_outside(-1)
    return served.leaving if isinstance(served.leaving, int) else int(served.leaving is not None)
