"""The parts of the body of a definition (ANSI 3.4.11): its documentation and its declarations, in either order, and its forms."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.packages import sym

DECLARE = sym("DECLARE")


def body_parts(body):
    """(documentation or ``None``, list of declarations, list of the other forms) of ``body``, an iterable of forms.

    A string is documentation if a form follows it and no string came before it.
    """
    forms, documentation, declarations = list(body or ()), None, []
    while forms:
        head = forms[0]
        if isinstance(head, str) and documentation is None and len(forms) > 1:
            documentation = forms.pop(0)
        elif isinstance(head, Cons) and head.car is DECLARE:
            declarations.append(forms.pop(0))
        else:
            break
    return documentation, declarations, forms
