"""Hooks: places where the runtime calls out to whoever wants to know.

In CRAM a hook is a generic function (``cut:define-hook``) whose applicable methods *all* run, and whose value is the list of their
results (prolog.md 13.1, cpl.md section 11). Nothing is called, and nothing is paid for, when nobody has added a method. From Lisp:
``(defmethod on-fail my-name ((datum t)) ...)``, whose qualifier may be any symbol. From Python: ``on_fail.add(function)``.
"""

from __future__ import annotations

from .data import Symbol, one
from .dispatch.generic_functions import add_method, generic, remove_method


class Hook:
    """The hook ``name`` (``"PACKAGE::NAME"``). True when it has ``methods``; calling it runs them, the most specific first.

    ordered: methods with a number behind their name run before the others, the lowest number first.
    """

    def __init__(self, name, lambda_list, *, ordered=False):
        self.function = generic(name, lambda_list, combination="COMMON-LISP::ORDERED-HOOKS" if ordered else "COMMON-LISP::HOOKS")
        self.methods = self.function.methods  # that very list: to look at it is faster than to ask the hook whether it is true
        self.name = self.function.__lisp_name__
        self._added = {}

    def add(self, function, key=None, user=True):
        """Run ``function`` whenever the hook is called. A method with the same ``key`` is replaced. ``user``: in this image only."""
        key = function if key is None else key
        self.remove(key)
        specializers = [object] * self.function.shape.required
        self._added[key] = add_method(self.function, [Symbol(str(key))], specializers, function, uses_next=False, user=user)
        return function

    def remove(self, key):
        """Forget the method added under ``key`` (or the function itself); unknown ones are ignored."""
        method = self._added.pop(key, None)
        if method is not None:
            remove_method(self.function, method)

    def __bool__(self):
        return bool(self.methods)

    def __call__(self, *arguments):
        """The list of the methods' results (a Python list)."""
        return list(one(self.function(*arguments)) or ()) if self.methods else []

    def first(self, *arguments):
        """Run all methods; the first result, or ``None``: the id that the matching end hook gets."""
        results = self(*arguments)
        return results[0] if results else None
