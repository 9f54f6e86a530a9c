"""Lisp text as a user types it, for tests: what it gives, prints, warns of, or fails with."""

import pytest

from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string, princ_to_string
from cramhy_runtime.languages.commonlisp.streams.streams import StringOutputStream
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for
from cramhy_runtime.repl.session import condition_of


class LispText:
    """``lisp(text)``: the values of the last form of ``text``, printed, with one blank between two.

    prelude: text that is evaluated first, from which the package stays the current one. What is printed is left to the session;
    `warnings` of a text are what it writes to ``*error-output*``. ``name``: what the text is called in errors.
    """

    name = None

    def __init__(self, session, prelude):
        self.session = session
        session.evaluate_text(prelude)

    def values(self, text):
        """The values of the last form of ``text`` themselves."""
        return self.session.evaluate_text(text, self.name)

    def __call__(self, text):
        values = self.values(text)
        with binding(sym("*PRINT-PRETTY*"), None):
            return " ".join(map(prin1_to_string, values))

    def value(self, text):
        """The first value itself."""
        return self.values(text)[0]

    def error(self, text, kind=None):
        """The whole text of the condition that ``text`` ends with; it is of the class ``kind``, a Lisp name without its package."""
        condition = self.condition(text)
        if kind is not None:
            names = [getattr(cls, "lisp_name", "").rpartition(":")[2] for cls in type(condition).__mro__]
            assert kind.upper() in names, f"{condition} is a {names[0]}"
        return princ_to_string(condition)

    def condition(self, text):
        """The condition that ``text`` ends with."""
        with pytest.raises(BaseException) as problem:
            self.values(text)
        return condition_of(problem.value)

    def hint(self, text):
        """What the REPL shows below the text of that condition."""
        return hint_for(self.condition(text))

    def warnings(self, text):
        """What ``text`` warns of, as it is shown."""
        errors = sym("*ERROR-OUTPUT*")
        saved, errors.value = errors.value, StringOutputStream()
        try:
            self.values(text)
            return errors.value.take()
        finally:
            errors.value = saved


class LispLine(LispText):
    """The same in one line: what is printed on several is joined, and between two values stands `` ; ``."""

    def __call__(self, text):
        return " ; ".join(" ".join(prin1_to_string(value).split()) for value in self.values(text))

    def error(self, text, kind=None):
        return " ".join(super().error(text, kind).split())
