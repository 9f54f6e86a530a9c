"""The plan language, for Hy and for Python.

``(require cramhy *)`` in a ``.hy`` file gives its macros: ``in-package``, after which the text is Common Lisp (see ``language.hy``), and
all operators and functions for plain Hy (see ``languages/hy/plan_macros.py``). ``import cramhy`` in Python lets Lisp systems and ``.lisp``
files be imported as modules. ``(cramhy.time "wall")``, after one or the other, says in which time the file's plans live. Errors that end
the program are told as ``cramhy run`` tells them. ``(import cramhy *)`` gives the functions as values: ``(map reference motions)``.
"""

import hy  # teaches Python to import .hy files

from . import language
from cramhy_runtime.cli import live_page
from cramhy_runtime.cpl import (  # noqa: F401  the classes of failures, by the names of Python
    CompositeFailure,
    PlanFailure,
    PolicyCheckConditionMet,
    PolicyFailure,
    PolicyInitFailed,
    PolicyNotFound,
    SimplePlanFailure,
)
from cramhy_runtime.languages.hy.plan_macros import functions
from cramhy_runtime.languages.hy.required_macros import RequiredMacros

# they are there when the language is
from cramhy_runtime.languages import kept_hy as kept_code  # the name that compiled code calls, also of older versions
from cramhy_runtime.languages.hy import calls, errors, keywords, malformed, module_names, patches
from cramhy_runtime.session.time_setting import time  # noqa: F401  cramhy.time; a star does not import it, since it would hide Python's module


live_page.offer()  # (turtlesim:view)
kept_code.watch()
keywords.install()
patches.require_quickly()
symbols = calls.Symbols()
branching = calls.Branching()
"""With `calls`, and `kept_code`: what the code calls that the macros of plain Hy expand into."""


def _time_form(kind):
    """``(cramhy.time "wall")`` in a file that has required ``cramhy`` and not imported it."""
    return hy.models.Expression([hy.read("hy.I.cramhy_runtime/session/time_setting.time"), kind])


def attend_prompt(modules=None):
    """Let the errors of the program, and of a prompt of Hy whose text is read now, be told in our words, and plans go on at the prompt."""
    errors.install()
    language.attend_prompt(modules)


def _required():
    """A file or a prompt asks for the macros: its errors are told in our words from then on."""
    attend_prompt()
    malformed.check(hy.reader.HyReader.current_reader(create=False))


_hy_macros = RequiredMacros({**language._hy_macros, "cramhy.time": _time_form, **module_names.MACROS}, required=_required)
_hy_export_macros = _hy_macros.keys()

_functions = functions()
globals().update(_functions)
__all__ = [name for name in _functions if len(name) > 1]  # x, y, z and w are named when they are wanted
