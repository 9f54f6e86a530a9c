"""Grading without processes: a submission runs in an image of this process, for a student's own check in a browser.

There is no sandbox and no limit of processor time, so a submission can do what this process can do, and an endless loop does not end unless
the turtle's time does. Points that count come from the fork server's processes. The verdict is the same for a submission that means no
harm.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from . import schema
from .performing import lay_out, perform


class Here:
    """Takes the place of a `ForkServer`: it performs a job when the answer is taken, in an image of its own."""

    def close(self):
        """There is nothing to end."""

    def ask(self, job):
        """Give it a job."""
        self.job = job

    def take(self):
        """What came of the job, as from a fork server (see `fork_server`)."""
        job = self.job
        from cramhy_runtime.session import Image

        reports, modules, path = [], set(sys.modules), list(sys.path)

        def tell(kind, **facts):
            reports.append(schema.line(job["nonce"], kind, facts))

        with tempfile.TemporaryDirectory(prefix="cramhy-") as folder:
            lay_out(job, folder)
            try:
                with Image():
                    perform(job, folder, tell, apart=False)
            finally:
                sys.path[:] = path
                for name in [Path(name).stem for name in job["files"] if name.endswith(".py")]:
                    if name not in modules:
                        sys.modules.pop(name, None)
        return {"reports": reports, "output": "", "ended": "left", "signal": 0}
