"""All faces, in the order in which an image shows them: which modules say what Common Lisp sees of which room.

A module of a face only defines functions when it is imported. Its ``define`` makes the packages, lets their symbols name the room's
functions, and tells the printer how objects look; `Face.define` calls it, once.
"""

from __future__ import annotations

from types import ModuleType

from .cpl import package as cpl_package
from .cpl import printing as cpl_printing
from .designators import package as designators_package
from .designators import printing as designators_printing
from .episodes import offline, values_on_file
from .episodes import package as episodes_package
from .episodes import printing as episodes_printing
from .occasions import package as occasions_package
from .process_modules import package as process_modules_package
from .process_modules import printing as process_modules_printing
from .projection import package as projection_package
from .projection import printing as projection_printing
from .prolog import macro_support as prolog_macro_support
from .prolog import package as prolog_package
from .ros import macro_support as ros_macro_support
from .ros import message_printing, roslisp_printing
from .ros import package as ros_package
from .transforms import package as transforms_package
from .turtlesim import package as turtlesim_package
from .utilities import package as utilities_package


class Face:
    """What Common Lisp sees of ``room``: the modules whose ``define`` says it, in order."""

    def __init__(self, room: str, parts: tuple[ModuleType, ...]) -> None:
        self.room, self.parts = room, parts

    def define(self) -> None:
        """Let Common Lisp see the room."""
        for part in self.parts:
            part.define()


FACES = (
    Face("transforms", (transforms_package,)),
    Face("utilities", (utilities_package,)),
    Face("prolog", (prolog_package,)),
    Face("cpl", (cpl_printing, cpl_package)),
    Face("ros", (message_printing, roslisp_printing, ros_package)),
    Face("turtlesim", (turtlesim_package,)),
    Face("designators", (designators_printing, designators_package)),
    Face("episodes", (episodes_printing, offline, values_on_file, episodes_package)),
    Face("occasions", (occasions_package,)),
    Face("process_modules", (process_modules_printing, process_modules_package)),
    Face("projection", (projection_printing, projection_package)),
    Face("prolog", (prolog_macro_support,)),
    Face("ros", (ros_macro_support,)),
)
"""Those of an image. The packages of ``tf`` and ``actionlib`` are made when a program names them (`image`)."""
