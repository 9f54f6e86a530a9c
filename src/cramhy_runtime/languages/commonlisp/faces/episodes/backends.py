"""Ways of the user's to write and read objects of a type in files of episodes.

``(defstore-episode-knowledge-backend (object type stream) form...)`` says what is written for objects of ``type``: the text that the
forms print to ``stream``. ``(defrestore-episode-knowledge-backend (type stream) form...)`` says how an object is made again: its
value is that of the forms, which read the same text from ``stream``. In the original, with ``cl-store``, these are methods that write
and read bytes; here a file is text. While an object is restored ``*read-eval*`` is nil. Source: projection-and-events.md C1.
"""

from __future__ import annotations

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.lisp_core.printing import prin1_to_string
from ...streams.basic_streams import StringInputStream, StringOutputStream
from ...types.types import typep

READ_EVAL = sym("*READ-EVAL*")
_stores, _restores = per_image({}), per_image({})


def define_store(type_, function):
    """Let ``function(object, stream)`` write the objects of ``type_``; the newest definition that fits counts. Returns ``type_``."""
    _stores.pop(type_, None)
    _stores[type_] = function
    return type_


def define_restore(type_, function):
    """Let ``function(stream)`` read what the store of ``type_`` wrote. Returns ``type_``."""
    _restores[type_] = function
    return type_


def backend_of(value):
    """The type under which ``value`` is stored by the user's code, or ``None``."""
    for type_ in reversed(_stores):
        if typep(value, type_):
            return type_
    return None


def stored(type_, value):
    """The text of ``value``."""
    stream = StringOutputStream()
    _stores[type_](value, stream)
    return stream.take()


def restored(type_, text, problem):
    """The object that the user's code for ``type_`` makes of ``text``; the exception ``problem`` when there is none."""
    function = _restores.get(type_)
    if function is None:
        raise problem(
            f"it has an object of the type {prin1_to_string(type_)}, whose (defrestore-episode-knowledge-backend "
            f"({prin1_to_string(type_)} stream) ...) is missing here"
        )
    with binding(READ_EVAL, None):
        return one(function(StringInputStream(text)))
