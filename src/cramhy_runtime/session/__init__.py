"""The session: all rooms together in an `Image`, as a Lisp image has all packages loaded.

``boot`` makes the packages of all rooms, ``image`` more than one image of them in a process. The surfaces (prompt, command line, page,
notebook, Emacs, editors, tests) stand on this room; nobody below it knows all rooms. What several surfaces need is here, too: requests,
completion, arglists, lookup, inspection, what has moved.
"""

from cramhy_runtime.kernel.images import outside

from .boot import boot, fresh_start
from .image import Image

__all__ = ["Image", "boot", "fresh_start", "outside"]
