"""A text that is open in an editor, with what is known of it."""

from __future__ import annotations

import re

from cramhy_runtime.ground.condition_types import Condition
from cramhy_runtime.ground.packages import COMMON_LISP_USER, find_package
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.languages.commonlisp.systems.loader import is_plain_hy

from . import checking, hy_files, manifests
from .budget import OutOfTime, budget
from .findings import WARNING, Finding
from .surroundings import session_in
from .texts import Text

SECONDS = 10.0
"""Processor time that macros of a text get each time that it is checked."""
_IN_PACKAGE = re.compile(r"""^\s*\((?:cl:|common-lisp:)?in-package\s+[#:'"]*([^\s()"]+)"?\s*\)""", re.M | re.I)


class Document:
    """uri: its name in the protocol. path: of its file, or ``None``. surroundings: see `surroundings.Surroundings`."""

    def __init__(self, uri, path, source, surroundings):
        self.uri, self.path, self.surroundings = uri, path, surroundings
        self.filename = path or uri
        self.image = None
        self.findings = []
        self.renew(source)

    def renew(self, source):
        """Its text is ``source`` now. What was compiled of the text before stays until `compile` is called."""
        self.text = Text(source)
        self.too_long = checking.too_long(self.text)

    @property
    def kind(self):
        """``"xml"``, ``"asd"``, ``"hy"`` for plain Hy, or ``"lisp"``."""
        if self.filename.endswith(".xml"):
            return "xml"
        if self.filename.endswith(".asd"):
            return "asd"
        return "hy" if self.filename.endswith(".hy") and is_plain_hy(self.text.text) else "lisp"

    def parse(self):
        """The `Finding`s that take no time: those of brackets, or of a manifest."""
        if self.too_long:
            return [self.too_long]
        return manifests.check(self.text) if self.kind == "xml" else checking.parsed(self.text)

    def compile(self):
        """All `Finding`s. Where brackets are wrong, what the readers say of them is left out: it is the same."""
        found = self.parse()
        if self.too_long or self.kind == "xml":
            return found
        if self.kind == "hy":  # of which no macro of the user runs
            more = hy_files.check(self.text, self.filename)
        else:
            image = self.surroundings.image_for(self.path)
            try:
                with budget(SECONDS):
                    more, _ = checking.compiled(self.text, self.path, self.filename, image)
            except OutOfTime:
                message = f"Compiling this text was stopped after {SECONDS:.0f} s of processor time. Does a macro of it never end?"
                return [*found, Finding(0, 1, WARNING, message)]
            self._keep(image)
        brackets = bool(found)
        return found + [each for each in more if not (brackets and _of_reader(each))]

    def _keep(self, image):
        old, self.image = self.image, image
        if old is not None:
            old.forget()

    def in_image(self, thunk, otherwise=None):
        """The value of ``thunk()`` in the image that has the definitions of this text."""
        if self.image is None:
            self._keep(self.surroundings.image_for(None))
        with session_in(self.image):
            try:
                return thunk()
            except Condition:
                return otherwise

    def package_at(self, offset):
        """The package that is current at ``offset``; to be called in the image."""
        if self.kind in ("hy", "xml"):
            return None
        package = systems.asdf_user() if self.kind == "asd" else COMMON_LISP_USER
        for match in _IN_PACKAGE.finditer(self.text.text):
            if match.start() >= offset:
                break
            package = find_package(match[1].upper()) or package
        return package

    def close(self):
        self._keep(None)


_OF_READER = ("end of file", "unmatched", "closes nothing", "never closed", "ends inside", "too many, or one", "closed too early")


def _of_reader(finding):
    words = finding.message.lower()
    return any(part in words for part in _OF_READER)
