"""The world outside of the kernel, as the tests need it: threads; in WebAssembly, where there are none, turns of the event loop."""

from systems import IN_WEBASSEMBLY

if IN_WEBASSEMBLY:
    from js import setTimeout
    from pyodide.ffi import create_once_callable

    from cramhy_runtime.kernel.backends.jspi import Bell

    def in_a_thread(fn, *args):
        """Call FN(*ARGS) outside of all tasks, soon."""
        setTimeout(create_once_callable(lambda: fn(*args)), 0)

    class Event:
        """As `threading.Event`; it waits for promises, so that others go on."""

        def __init__(self):
            self._bells, self._is_set = [], False

        def is_set(self):
            return self._is_set

        def set(self):
            self._is_set = True
            for bell in self._bells:
                bell.ring()

        def wait(self, seconds):
            bell = Bell()
            self._bells.append(bell)
            for _ in range(int(seconds / 0.01)):
                if self._is_set:
                    break
                bell.wait(0.05)
            return self._is_set

    class Barrier:
        """As `threading.Barrier`."""

        def __init__(self, parties):
            self._missing, self._all = parties, Event()

        def wait(self, seconds):
            self._missing -= 1
            number = self._missing
            if not number:
                self._all.set()
            assert self._all.wait(seconds)
            return number

else:
    import threading
    from threading import Barrier, Event

    def in_a_thread(fn, *args):
        """Call FN(*ARGS) outside of all tasks, soon. Returns the thread."""
        thread = threading.Thread(target=fn, args=args, daemon=True)
        thread.start()
        return thread


__all__ = ["Barrier", "Event", "in_a_thread"]
