"""Packages beyond ANSI that programs name: those of SBCL. Source: SBCL's manual.

What the runtime itself needs of SB-EXT and SB-MOP is made at the start. The rest is in the folder ``sbcl``, which is imported when a
program first names something of it: such a package is a `LatePackage`.
"""

from __future__ import annotations

import math

from cramhy_runtime.lisp_core import hash_tables
from cramhy_runtime.lisp_core.floats import SingleFloat
from .evaluation import environment
from .packages.face_definition import define_face
from .files import files
from .pathnames import pathnames
from .numbers import random_state
from .objects import protocol
from cramhy_runtime.lisp_core.packages import COMMON_LISP, Package, ensure_package, find_package, our_own, sym
from .packages import package_functions

INFINITIES = {
    f"{kind}-float-{sign}-infinity": value
    for sign, infinity in (("positive", math.inf), ("negative", -math.inf))
    for kind, value in (("short", SingleFloat(infinity)), ("single", SingleFloat(infinity)), ("double", infinity), ("long", infinity))
}
"""Constants of SB-EXT: what the printer writes for numbers without end must be read back."""


LATE = (
    "SB-THREAD",
    "SB-EXT",
    "SB-SYS",
    "SB-POSIX",
    "SB-DEBUG",
    "SB-GRAY",
    "SB-MOP",
    "SB-PCL",
    "SB-INT",
    "SB-INTROSPECT",
    "SB-KERNEL",
    "SB-IMPL",
    "SB-UNIX",
    "SB-VM",
    "SB-C",
)
"""The packages of SBCL of which a part comes late; so does the greater part of UIOP."""


class LatePackage(Package):
    """A package that is completed when somebody asks for a name that it does not have yet, or for all of them."""

    is_complete = False

    def lookup(self, name):
        found = super().lookup(name)
        if found[1] is None and not self.is_complete:
            self.complete()
            found = super().lookup(name)
        return found

    def complete(self):
        """Make sure that all external symbols are there."""
        if not self.is_complete:
            self.is_complete = True
            with our_own:
                if self.name == "UIOP":
                    from .uiop import names

                    names.complete()
                else:
                    from .sbcl import packages

                    packages.complete(self.name)


OF_STREAMS = ("CLOSE", "STREAM-ELEMENT-TYPE", "INPUT-STREAM-P", "OUTPUT-STREAM-P", "OPEN-STREAM-P", "INTERACTIVE-STREAM-P")
"""Functions that SB-GRAY opens to methods of users when it is completed."""


class _OpenedWithGrayStreams:
    """Stands for the `Opening` of a function of streams until SB-GRAY brings it: the first method on the function brings SB-GRAY."""

    generic = None

    def __init__(self, symbol):
        self.symbol = symbol

    def open(self):
        """Make the generic function."""
        find_package("SB-GRAY").complete()
        return self.symbol.function.opening.open()


def define_faces():
    """Declare the packages; called once, by `package.fill`."""
    define_face(
        "SB-EXT",
        functions={
            hash_tables: hash_tables.EXTENSION_NAMES,
            random_state: random_state.EXTENSION_NAMES,
            package_functions: package_functions.EXTENSION_NAMES,
            pathnames: pathnames.EXTENSION_NAMES,
            files: files.EXTENSION_NAMES,
            environment: environment.EXTENSION_NAMES,
        },
        variables={**INFINITIES, **environment.EXTENSION_VARIABLES},
        export="""muffle-conditions unmuffle-conditions disable-package-locks enable-package-locks without-package-locks
                with-unlocked-packages exit quit maybe-inline truly-dynamic-extent
                global always-bound freeze-type deprecated inhibit-warnings""",
    )
    for name in INFINITIES:
        sym(f"SB-EXT::{name.upper()}").constant = True
    define_face("SB-MOP", functions={protocol: protocol.MOP_NAMES})
    for name in LATE:
        come_late(name)
    for name in OF_STREAMS:
        sym(name).function.opening = _OpenedWithGrayStreams(sym(name))
    internals = ensure_package("SB-IMPL")  # programs write sb-impl::file-stream
    internals.built_in = True
    internals.use_package(COMMON_LISP)


def come_late(name):
    """Let the rest of the package ``name`` come when a program asks for it."""
    package = ensure_package(name)
    package.built_in, package.__class__ = True, LatePackage
