"""What a name means in a macro: in the template of a declaration, and in what an expander written in Hy returns."""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import COMMON_LISP, intern


def symbol_in(text, package):
    """The symbol that ``text`` means in a macro of ``package``: one of Common Lisp if there is one, ``%name`` one of CRAMHY."""
    if text == ".":
        return intern(".", "CRAMHY")
    if text.startswith("%"):
        return intern(text[1:].upper(), "CRAMHY")
    head, colons, name = text.partition("::") if "::" in text else text.partition(":")
    if colons and head and name:
        return intern(name.upper(), head.upper())
    standard, found = COMMON_LISP.lookup(text.upper())
    return standard if found == "external" else package.intern(text.upper())
