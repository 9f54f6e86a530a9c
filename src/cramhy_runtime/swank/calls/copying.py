"""Calls that name an object that Emacs shows, in order to copy it into the REPL buffer, to describe it, or to print it.

``M-RET`` on a part in the inspector, or on a variable in the debugger, makes it the newest result of the REPL. The menu of a result
describes and prints it.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.packages.package_functions import delete_package
from cramhy_runtime.languages.commonlisp.tools.describing import description
from cramhy_runtime.session.session import HISTORY

from .. import presentations
from ..inspector import text_of
from ..packages import package_called
from ..rpcs import Refused, inner, rpc, text
from .debugging import frame_at, variable_at
from .evaluating import show
from .inspecting import inspector_of

GONE = object()
"""What stands for a presented object that is not kept any more."""


_VALUES = {"inspector-nth-part": lambda call, index: inspector_of(call).part(index), "frame-var-value": variable_at}
"""The functions that may say which object to copy."""


@rpc("listener-save-value")
def save_value(call, function, *which):
    """Keep an object for `get_value`: ``(swank-repl:listener-save-value 'swank:inspector-nth-part 2)``."""
    find = _VALUES.get(text(function).rpartition(":")[2])
    if find is None:
        raise Refused(f"cramhy cannot copy what {function} gives.")
    call.connection.saved = [find(call, *which)]
    return True


@rpc("listener-get-value", evaluates=True)
def get_value(call):
    """Make the kept object the newest result of the REPL, as if a form had returned it."""
    if not call.connection.saved:
        raise Refused("Nothing was copied.")
    value = call.connection.saved[0]
    HISTORY[0].value, HISTORY[1].value, HISTORY[2].value = value, HISTORY[0].value, HISTORY[1].value
    with binding(evaluator.PACKAGE, call.connection.package):
        show(call.connection, [value])
    return True


@rpc("swank/backend:frame-call")
def frame_call(call, index):
    """The call of a frame as text: ``C-y`` in the debugger writes it into the REPL buffer."""
    return frame_at(call, index).text


@inner("lookup-presented-object lookup-presented-object-or-lose")
def presented_object(call, number):
    return presentations.of(call.connection).objects.get(number, GONE)


def _there(obj):
    if obj is GONE:
        raise Refused("This object is not kept any more.")
    return obj


@rpc("cl:nth-value")
def nth_value(call, index, obj):
    """``(cl:nth-value 1 (swank:lookup-presented-object 3))``: whether the object is there."""
    return obj is not GONE


@rpc("describe-to-string")
def describe_to_string(call, obj):
    return description(_there(obj))


@rpc("swank-pprint")
def pprint(call, objects):
    return "".join(text_of(_there(each), pretty=True) + "\n" for each in objects or ())


@rpc("menu-choices-for-presentation-id")
def menu_choices(call, number):
    """What the menu of a result offers beside SLIME's own choices: nothing."""
    return None


@inner("guess-package")
def guess_package(call, name):
    """The package that ``name`` means, or ``None``."""
    return package_called(text(name))


@rpc("cl:packagep")
def packagep(call, package):
    return package is not None


@rpc("cl:delete-package", evaluates=True)
def delete(call, package):
    if package is None:
        raise Refused("There is no such package.")
    return bool(delete_package(package))
