"""Files that cramhy writes: the whole of a file or nothing of it, whatever the disk does. Beside the kernel; it knows nothing of Lisp.

    from cramhy_runtime import storage

    storage.write_whole("turtle.svg", text)          # the old file stays as it is until the new one is complete
    with storage.writing("turtle.gif") as file:      # the same for what is made piece by piece
        file.write(...)

A file is written under another name in the same folder, checked (`write`, `fsync` and `close` may each be the call that says that the disk
is full), and renamed. So a reader sees the old file or the new one, and an error or a jump leaves the old one. A symbolic link is
followed, and an existing file keeps its mode and its owner, as when a file is simply opened and written to. Terminals, pipes and devices
are written to as they are. A file with several names (hard links) becomes a file of its own.

A process that is killed has no time to tidy up. The name of an unfinished file is held by a lock of the operating system, which ends
with the process, also in another container. An unfinished file without a lock is removed by the next start, or by the next write into
that folder.

`partial_files` writes a file, in one go or for hours; `partial_names` gives it its names and locks meanwhile. `atomic_write` replaces a
file at once, `file_transactions` several. `leftovers` removes or recovers what killed processes left. `backups` keeps the older version
of a file. `kept_code` is the keeper of compiled code: `checksummed_code` proves whose a file is and that it is undamaged before anybody
reads it, `kept_files` says where such files are, `digests` has the sum. `dependency_tracing` notes what a compilation asks of the world,
and `dependencies` tells whether the answers are still the same. `owners` says whose a file is, and `system_errors` what to try.
"""

from .leftovers import tidy, tidy_once
from .partial_files import Part, growing
from .system_errors import why
from .file_transactions import Tree
from .atomic_write import write_new, write_whole, writing

__all__ = ["Part", "Tree", "growing", "tidy", "tidy_once", "why", "write_new", "write_whole", "writing"]
