"""Words that a prompt understands although they are no Lisp: ``help``, ``exit``, in the debugger ``backtrace``.

People type what they know from other programs: ``exit``, ``(exit)``, ``:quit``, ``?``. Each of these is understood unless the user has
given the name a meaning of its own: a variable ``help``, a function ``exit``. Nothing is interned by looking.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import UNBOUND, Cons, Symbol
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.tools.advice import elsewhere, is_operator

from cramhy_runtime.session.session import leaving

_QUOTES = (sym("QUOTE"), sym("FUNCTION"))
LEAVING = ("exit", "quit", "bye")
BACK = ("a", "abort")
"""In the debugger: one level back."""
OUT = ("q", *LEAVING)
"""In the debugger: back to the prompt, out of all levels. ``a`` and ``q`` are the keys of SLIME's debugger."""
KEYS = ("q",)
"""What is typed at the prompt by those who take it for the debugger."""
HELP = ("help", "?")
BACKTRACE = ("backtrace", "bt")

FOR_ALL = """\
Type a form of Lisp, such as (+ 1 2), and its values are printed. A form may have several lines.
  (load "plan.lisp")          loads a file; (ros-load:load-system "name") a package
  (in-package :tut)           goes into a package; its name is the prompt
  (help par)                  tells what a name means; (apropos "turtle") finds names
  (describe-task-tree)        shows what the plan is doing and has done
  * ** ***                    the last values; + the last form
  rostopic list, rosservice   and the other commands of ROS work here, too
  (turtlesim:view)            shows the turtle on a page, in the browser"""
WITH_EDITOR = "  TAB                         completes names, keywords and files; arrow keys bring back earlier forms"
WITHOUT_EDITOR = "  Ctrl-C                      ends the form that runs, through its cleanup"
END = """\
  (exit), or Ctrl-D           leaves, after the plans have cleaned up"""
IN_DEBUGGER = """\
The debugger waits where the error arose. Type
  a number, or :abort         to go on by one of the restarts above
  backtrace (bt)              to see the calls that led here
  a form                      to evaluate it here
  q                           to go back to the prompt; a: only one level back
  (exit)                      to leave the program"""


def word(text, among):
    """Which of the words ``among`` the ``text`` typed at the prompt is, also as ``:word``; ``None`` if it is Lisp."""
    text = text.strip()
    name = text.lower().removeprefix(":")
    if name not in among:
        return None
    symbol = None if text.startswith(":") else evaluator.PACKAGE.value.lookup(name.upper())[0]
    return None if isinstance(symbol, Symbol) and _is_variable(symbol) else name


def call(form, among):
    """Which of the words ``among`` the operator of ``form`` is, if nobody has defined it otherwise: ``(exit :code 3)``; or ``None``."""
    head = form.car if isinstance(form, Cons) else None
    if not isinstance(head, Symbol) or head.name.lower() not in among:
        return None
    return None if is_operator(head) else head.name.lower()


def leaving_form(form):
    """``form``, or if it is a call such as ``(exit :code 3)`` in a package that does not know that, one of the function of SB-EXT."""
    name = call(form, LEAVING)
    return form if name is None else Cons(leaving().intern("EXIT" if name == "exit" else "QUIT"), form.cdr)


def meant(form):
    """The symbol that ``(help name)`` is about, for ``name``, ``'name`` or ``#'name``; where it means nothing, that of another package."""
    if isinstance(form, Cons) and form.car in _QUOTES and isinstance(form.cdr, Cons):
        form = form.cdr.car
    if not isinstance(form, Symbol) or form.plist or is_operator(form) or _is_variable(form):
        return form
    return elsewhere(form) or form


def _is_variable(symbol):
    return symbol.value is not UNBOUND or symbol.special or bool(symbol.compiler_data and "symbol-macro" in symbol.compiler_data)


def help_text(editor, level):
    """What ``help`` shows. editor: whether keys such as TAB do something; level: of the debugger, 0 at the prompt."""
    if level:
        return IN_DEBUGGER
    return "\n".join([FOR_ALL, *([WITH_EDITOR] if editor else []), WITHOUT_EDITOR, END])
