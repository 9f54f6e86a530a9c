"""Python code prints Lisp objects at any time, also when no kernel runs."""

from cramhy_runtime.lisp_core.floats import SingleFloat
from cramhy_runtime import kernel
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.languages.commonlisp.format.format import format_to_string
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string, princ_to_string


def test_printing_needs_no_kernel():
    if kernel.active() is not None:
        kernel.stop()
    assert prin1_to_string(lisp_list("a", SingleFloat(1.5))) == '("a" 1.5)'
    assert princ_to_string(lisp_list("a", SingleFloat(1.5))) == "(a 1.5)"
    assert format_to_string("~{~s~^ ~}", lisp_list("a", SingleFloat(1.5))) == '"a" 1.5'
