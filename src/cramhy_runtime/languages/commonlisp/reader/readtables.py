"""Readtables: which characters are white space, which call a function, and what case symbols get.

A `Readtable` maps characters to reader macro functions, called with the stream (a `Reader`) and the `Character`. From it comes
a regular expression that skips white space and comments and takes a token at one go, so the common case runs at the speed of
``re``; a change of the table throws the expression away. Source: ANSI 2.1 and 23.2.
"""

from __future__ import annotations

import re

from cramhy_runtime.lisp_core.condition_types import SimpleError
from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import Character, Keyword, MultipleValues, Symbol, boolean
from cramhy_runtime.storage.dependency_tracing import run
from cramhy_runtime.lisp_core.dynamic import special
from cramhy_runtime.lisp_core.packages import keyword

UPCASE = keyword("UPCASE")
INVALID = " \t\n\r\f\b\x7f"
"""Characters that no token contains without an escape, even if the readtable makes them constituents (ANSI 2.1.4.2)."""
WHITESPACE = " \t\n\r\f\xa0\ufeff"
"""White space of the standard readtable. The last two come with text copied from web pages and editors; no name contains them."""


class DispatchTable:
    """The functions of a dispatching macro character by sub-character; callable as a reader macro function itself."""

    __slots__ = ("functions",)

    def __init__(self, functions=None):
        self.functions = dict(functions or {})

    def __call__(self, stream, character):
        from .dispatch_macros import dispatch

        return dispatch(self, stream, character)

    def copy(self):
        return DispatchTable(self.functions)


class Readtable:
    """Syntax types of characters. ``case`` is one of :upcase, :downcase, :preserve, :invert.

    ``scanner``: the pattern of white space and comments, then (1) the plain part of a token, if any, (2) an escape right after it; ``None``
    until `compiled` makes it.
    """

    lisp_name = "READTABLE"

    def __init__(self):
        self.whitespace = set(WHITESPACE)
        self.macros = {}
        self.non_terminating = set()
        self.single_escapes = {"\\"}
        self.multiple_escapes = {"|"}
        self.case = UPCASE
        self.scanner = None

    def copy(self):
        other = Readtable()
        other.assume(self)
        return other

    def assume(self, other):
        """Become equal to ``other``."""
        self.whitespace = set(other.whitespace)
        self.macros = {key: value.copy() if isinstance(value, DispatchTable) else value for key, value in other.macros.items()}
        self.non_terminating = set(other.non_terminating)
        self.single_escapes, self.multiple_escapes = set(other.single_escapes), set(other.multiple_escapes)
        self.case = other.case
        self.scanner = None

    def reads_as(self, other: Readtable) -> bool:
        """Whether each character means what it means in ``other``; ``case`` does not count."""
        return (
            self.macros.keys() == other.macros.keys()
            and all(
                function.functions == other.macros[char].functions
                if isinstance(function, DispatchTable) and isinstance(other.macros[char], DispatchTable)
                else function is other.macros[char]
                for char, function in self.macros.items()
            )
            and all(
                getattr(self, syntax) == getattr(other, syntax)
                for syntax in ("whitespace", "non_terminating", "single_escapes", "multiple_escapes")
            )
        )

    def compiled(self):
        """Make the ``scanner``, and return it."""
        from .standard_syntax import read_comment  # first of all: that module fills the tables with the standard syntax

        white = _set(self.whitespace)
        # an invalid character is looked at where escapes are
        escapes = _set(self.single_escapes | self.multiple_escapes | set(INVALID) - self.whitespace - set(self.macros))
        ending = _set(set(self.macros) - self.non_terminating)
        begin = f"[^{white}{escapes}{ending}{_set(self.non_terminating)}]"
        skip = f"[{white}]+"
        if self.macros.get(";") is read_comment:
            skip += r"|;[^\n]*"
        within = f"[^{white}{escapes}{ending}]"
        escape = f"[{escapes}]" if escapes else "(?!)"
        self.scanner = re.compile(f"(?:{skip})*((?:{begin}{within}*)?)({escape}?)")
        return self.scanner

    def end_of_blank(self, text, offset):
        """Where white space and comments that begin at ``offset`` end. If the text ends in a comment, which may go on when more of the text
        arrives, it is where that comment begins."""
        end = (self.scanner or self.compiled()).match(text, offset).start(1)
        if end < len(text):
            return end
        comment = text.find(";", max(offset, text.rfind("\n") + 1))
        return end if comment < 0 else comment

    def set_macro(self, char, function, non_terminating=False):
        self.forget(char)
        self.macros[char] = function
        if non_terminating:
            self.non_terminating.add(char)

    def forget(self, char):
        """Make ``char`` a constituent."""
        self.macros.pop(char, None)
        for syntax in (self.whitespace, self.non_terminating, self.single_escapes, self.multiple_escapes):
            syntax.discard(char)
        self.scanner = None

    def terminates(self, char):
        """Whether ``char`` ends a token before it."""
        return char in self.whitespace or (char in self.macros and char not in self.non_terminating)


def _set(characters):
    return "".join([re.escape(character) for character in sorted(characters)])


STANDARD = Readtable()
SUPPRESS = special("*READ-SUPPRESS*")
READTABLE = special("*READTABLE*", STANDARD.copy())


def call(function, *arguments):
    """Call a reader macro function, which may be given as a symbol."""
    return run(function.function if isinstance(function, Symbol) else function, *arguments)


# ---------------------------------------------------------------------------------------------- the functions of chapter 23


def _table(designator):
    if designator is None:
        return STANDARD
    return designator if isinstance(designator, Readtable) else type_error(designator, "(OR READTABLE NULL)")


def _char(character):
    return character.char if isinstance(character, Character) else type_error(character, "CHARACTER")


def _current(readtable):
    return READTABLE.value if readtable is True else _table(readtable)


def copy_readtable(from_readtable=True, to_readtable=None):
    """``cl:copy-readtable``: from ``*readtable*`` by default, from the standard readtable when given nil."""
    source = _current(from_readtable)
    if to_readtable is None:
        return source.copy()
    _writable(to_readtable).assume(source.copy())
    return to_readtable


def readtablep(obj):
    return boolean(isinstance(obj, Readtable))


def readtable_case(readtable):
    return readtable.case if isinstance(readtable, Readtable) else type_error(readtable, "READTABLE")


def _writable(readtable):
    """The readtable to be changed; the standard one, which ``nil`` stands for, is not."""
    table = _current(readtable)
    if table is STANDARD:
        error(SimpleError("The standard readtable cannot be modified. Change a copy of it: (setf *readtable* (copy-readtable nil))."))
    return table


def _given(readtable):
    return type_error(readtable, "READTABLE") if readtable is None else readtable


def set_readtable_case(case, readtable):
    """``(setf readtable-case)``."""
    if not isinstance(case, Keyword) or case.name not in ("UPCASE", "DOWNCASE", "PRESERVE", "INVERT"):
        return type_error(case, "(MEMBER :UPCASE :DOWNCASE :PRESERVE :INVERT)")
    if readtable is True or not isinstance(readtable, Readtable):
        return type_error(readtable, "READTABLE")
    _writable(readtable).case = case
    return case


def set_macro_character(character, function, non_terminating_p=None, readtable=True):
    """``cl:set-macro-character``: reading ``character`` calls ``function`` with the stream and the character."""
    _writable(readtable).set_macro(_char(character), function, non_terminating_p is not None)
    return True


def get_macro_character(character, readtable=True):
    """Two values: the function of a macro character or nil, and whether the character may be inside a token."""
    table = _current(readtable)
    char = _char(character)
    return MultipleValues((table.macros.get(char), boolean(char in table.non_terminating)))


def make_dispatch_macro_character(character, non_terminating_p=None, readtable=True):
    """``cl:make-dispatch-macro-character``: ``character`` then a sub-character calls the function set for the two."""
    _writable(_given(readtable)).set_macro(_char(character), DispatchTable(), non_terminating_p is not None)
    return True


def _dispatch_table(character, readtable):
    found = _current(readtable).macros.get(_char(character))
    if isinstance(found, DispatchTable):
        return found
    return error(SimpleError("~S is not a dispatching macro character.", character))


def set_dispatch_macro_character(character, sub_character, function, readtable=True):
    """``cl:set-dispatch-macro-character``: ``function`` gets the stream, the sub-character and the number between, or nil."""
    sub = _char(sub_character)
    if sub.isdigit():
        return error(SimpleError("SUB-CHAR must not be a decimal digit: ~S", sub_character))
    functions = _dispatch_table(character, _writable(readtable)).functions
    if function is None:
        functions.pop(sub.upper(), None)
    else:
        functions[sub.upper()] = function
    return True


def get_dispatch_macro_character(character, sub_character, readtable=True):
    return _dispatch_table(character, readtable).functions.get(_char(sub_character).upper())


def set_syntax_from_char(to_character, from_character, to_readtable=True, from_readtable=None):
    """``cl:set-syntax-from-char``: the first character gets the syntax type that the second has."""
    table, source = _writable(_given(to_readtable)), _table(from_readtable)
    to, origin = _char(to_character), _char(from_character)
    table.forget(to)
    function = source.macros.get(origin)
    if function is not None:
        table.set_macro(to, function.copy() if isinstance(function, DispatchTable) else function, origin in source.non_terminating)
    for attribute in ("whitespace", "single_escapes", "multiple_escapes"):
        if origin in getattr(source, attribute):
            getattr(table, attribute).add(to)
    return True


LISP_NAMES = (
    "copy-readtable readtablep readtable-case set-macro-character get-macro-character make-dispatch-macro-character "
    "set-dispatch-macro-character get-dispatch-macro-character set-syntax-from-char"
)
SETTERS = {"READTABLE-CASE": set_readtable_case}
