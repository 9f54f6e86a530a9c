"""Packages beyond ANSI that programs name: SB-EXT and SB-MOP of SBCL. Only what plan code uses is here. Source: SBCL's manual."""

from __future__ import annotations

import math

from cramhy_runtime.ground import hash_tables
from cramhy_runtime.ground.data import DoubleFloat
from .evaluation import environment
from .packages.face_definition import define_face
from .files import files
from .pathnames import pathnames
from .numbers import random_state
from .objects import protocol
from cramhy_runtime.ground.packages import sym
from .packages import package_functions

INFINITIES = {
    f"{kind}-float-{sign}-infinity": value
    for sign, infinity in (("positive", math.inf), ("negative", -math.inf))
    for kind, value in (("short", infinity), ("single", infinity), ("double", DoubleFloat(infinity)), ("long", DoubleFloat(infinity)))
}
"""Constants of SB-EXT: what the printer writes for numbers without end must be read back."""


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
        export="""muffle-conditions unmuffle-conditions disable-package-locks enable-package-locks
                maybe-inline truly-dynamic-extent global always-bound freeze-type deprecated inhibit-warnings""",
    )
    for name in INFINITIES:
        sym(f"SB-EXT::{name.upper()}").constant = True
    define_face("SB-MOP", functions={protocol: protocol.MOP_NAMES})
