"""Which symbol a word of a text means. The current package decides, so words of one spelling may mean different things.

A package that is not loaded is known by its ``defpackage`` form, if one of the texts has it.
"""

from __future__ import annotations

import re

from cramhy_runtime.lisp_core.packages import COMMON_LISP_USER, find_package
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.session.arglists import symbol_named
from cramhy_runtime.session.lookup import bare_name

from .texts import Form

_IN_PACKAGE = re.compile(r"""^[ \t]*\((?:cl:|common-lisp:)?in-package\s+[#:'"]*([^\s()"]+)"?\s*\)""", re.M | re.I)


def package_name_at(text, offset):
    """The name of the package that is current at ``offset`` of a `Text`, in capitals; ``None`` before any ``in-package``."""
    if text.packages is None:
        text.packages = [(match.start(), match[1].upper()) for match in _IN_PACKAGE.finditer(text.text)]
    name = None
    for start, each in text.packages:
        if start >= offset:
            break
        name = each
    return name


def package_at(text, offset, asd=False):
    """The package that is current at ``offset``; the one of the beginning if it is not loaded. To be called in an image."""
    first = systems.asdf_user() if asd else COMMON_LISP_USER
    package = first
    if package_name_at(text, offset) is not None:
        for start, name in text.packages:
            if start >= offset:
                break
            package = find_package(name) or package
    return package


class Meanings:
    """What words mean in several texts of one system; to be used in an image. texts: all of them."""

    def __init__(self, texts):
        self.texts, self._written = texts, None

    def of(self, text, token):
        """What the word ``token`` of ``text`` means: a symbol, or (package, name) where it is not loaded, or the bare name in a text
        that is not Lisp's."""
        word = token.text.lstrip("#'`,@")
        name = package_name_at(text, token.start)
        if word.startswith(":") or name is None and ":" not in word:
            return bare_name(word)
        prefix, colons, short = word.rpartition(":")
        home = prefix.rstrip(":").upper() if colons else name
        return self._in(home, bare_name(short), set())

    def _in(self, home, short, seen):
        package = find_package(home)
        if package is not None:
            return symbol_named(short, package) or (package.name, short)
        form = self._definition(home)
        if form is None or home in seen:
            return home, short
        seen.add(home)
        for option in form.items[2:]:
            if not isinstance(option, Form):
                continue
            names = [bare_name(item.text.strip('"')) for item in option.items[1:] if not isinstance(item, Form)]
            kind = option.word(0).lower()
            if kind in (":import-from", ":shadowing-import-from") and short in names[1:]:
                return self._in(names[0], short, seen)
            if kind == ":shadow" and short in names:
                return home, short
        for option in form.items[2:]:
            if isinstance(option, Form) and option.word(0).lower() == ":use":
                for used in option.items[1:]:
                    package = None if isinstance(used, Form) else find_package(bare_name(used.text.strip('"')))
                    if package is not None and short in package.external:
                        return package.external[short]
        return home, short

    def _definition(self, home):
        """The ``defpackage`` form of the package ``home`` in the texts, or ``None``."""
        if self._written is None:
            self._written = {}
            for text in self.texts:
                for form in text.forms:
                    if form.word(0).lower().rpartition(":")[2] == "defpackage":
                        for name in _names(form):
                            self._written.setdefault(name, form)
        return self._written.get(home)


def _names(form):
    yield bare_name(form.word(1).strip('"'))
    for option in form.items[2:]:
        if isinstance(option, Form) and option.word(0).lower() == ":nicknames":
            yield from (bare_name(item.text.strip('"')) for item in option.items[1:] if not isinstance(item, Form))
