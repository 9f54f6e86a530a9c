"""The version of SLIME that Emacs compares with its own when it connects.

SLIME asks its user whether to go on when the two differ. cramhy speaks to all versions since 2.20, so it says the version that it finds:
that of the SLIME that started it, else of one that is installed where Debian and package.el put it.
"""

from __future__ import annotations

import glob
import os
import re

USUAL = "2.27"
PLACES = (
    "/usr/share/emacs/site-lisp/elpa*/slime-*/slime.el",
    "/usr/share/emacs/site-lisp/slime/slime.el",
    "~/.emacs.d/elpa/slime-*/slime.el",
    "~/.config/emacs/elpa/slime-*/slime.el",
    "~/quicklisp/dists/quicklisp/software/slime-*/slime.el",
)
_said = []


def started_from(loader):
    """Note that the file ``loader``, SLIME's swank-loader.lisp, was to be loaded."""
    _said[:] = [os.path.join(os.path.dirname(loader), "slime.el")]


def slime_version():
    """The version to tell, such as ``"2.27"``."""
    found = [*_said, *(path for place in PLACES for path in sorted(glob.glob(os.path.expanduser(place)), reverse=True))]
    for path in found:
        try:
            with open(path, encoding="utf-8", errors="replace") as file:
                head = file.read(4000)
        except OSError:
            continue
        version = re.search(r"^;; Version: *([\w.]+)", head, re.M)
        if version:
            return version[1]
    return USUAL
