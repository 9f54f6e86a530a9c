"""The executables of the package. ``rosrun turtlesim …`` and launch files start them.

`start` makes a node in the active graph and returns the running `Program`. Call it in the kernel (from outside with
``kernel.post``). The caller prints the log (``echo``) and ends the program with `Program.shutdown`. Source: turtlesim.md 1.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import SimpleError
from .draw_square import DrawSquare
from .mimic import Mimic
from .node import Turtlesim
from .teleop import Teleop
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Literal, overload

if TYPE_CHECKING:
    from ..ros.signatures import Echo, Words
    from ..ros.roscpp import Program


PROGRAMS: dict[str, type[Turtlesim | Teleop | DrawSquare | Mimic]] = {
    "turtlesim_node": Turtlesim,
    "turtle_teleop_key": Teleop,
    "draw_square": DrawSquare,
    "mimic": Mimic,
}


@overload
def start(executable: Literal["turtlesim_node"], arguments: Words = (), echo: Echo = None) -> Turtlesim: ...
@overload
def start(executable: Literal["turtle_teleop_key"], arguments: Words = (), echo: Echo = None) -> Teleop: ...
@overload
def start(executable: Literal["draw_square"], arguments: Words = (), echo: Echo = None) -> DrawSquare: ...
@overload
def start(executable: Literal["mimic"], arguments: Words = (), echo: Echo = None) -> Mimic: ...
@overload
def start(executable: str, arguments: Words = (), echo: Echo = None) -> Program: ...
def start(executable: str, arguments: Words = (), echo: Echo = None) -> Program:
    """Start an executable of the package and return its `Program`. An unknown executable is a simple error.

    ``arguments``: the words of its command line (``__name:=x``, ``__ns:=/y``, ``a:=b``, ``_p:=v``). ``echo``: see `Program`.
    """
    program = PROGRAMS.get(executable)
    if program is None:
        conditions.error(
            SimpleError("~a", f"The package turtlesim has no executable {executable}. Executables: {' '.join(sorted(PROGRAMS))}.")
        )
    return program(arguments=arguments, echo=echo)
