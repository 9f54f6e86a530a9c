"""A text that is open in an editor, with what is known of it."""

from __future__ import annotations

from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.languages.commonlisp.systems.loader import is_plain_hy
from cramhy_runtime.session.arglists import symbol_named
from cramhy_runtime.session.lookup import bare_name

from . import checking, hy_files, manifests, neighbours, plan_checks
from .budget import OutOfTime, budget
from .findings import WARNING, Finding
from .hy_files import plan_macros
from .meanings import package_at
from .surroundings import session_in
from .texts import Text

_OUR_PACKAGES = frozenset(
    """COMMON-LISP ROSLISP CRAM-LANGUAGE CRAM-LANGUAGE-IMPLEMENTATION CRAM-DESIGNATORS CRAM-PROCESS-MODULES CRAM-EXECUTIVE
    CRAM-PROLOG""".split()
)
SECONDS = 10.0
"""Processor time that macros of a text get each time that it is checked."""


class Document:
    """uri: its name in the protocol. path: of its file, or ``None``. surroundings: see `surroundings.Surroundings`."""

    def __init__(self, uri, path, source, surroundings):
        self.uri, self.path, self.surroundings = uri, path, surroundings
        self.filename = path or uri
        self.image, self._inside = None, False
        self.findings = []
        self.took = 0.1  # seconds, the last time that it was checked
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
            more += [] if found else self.in_image(lambda: self._of_plans(more), [])
        else:
            image = self.surroundings.image_for(self.path)
            try:
                with budget(SECONDS):
                    more, _ = checking.compiled(self.text, self.path, self.filename, image, () if found else self._of_plans)
            except OutOfTime:
                message = f"Compiling this text was stopped after {SECONDS:.0f} s of processor time. Does a macro of it never end?"
                return [*found, Finding(0, 1, WARNING, message)]
            self._keep(image)
        brackets = bool(found)
        return found + [each for each in more if not (brackets and _of_reader(each))]

    def _of_plans(self, others):
        """The `Finding`s of names that are data in plans, where nothing else is told; to be called in the image."""
        if self.kind == "asd":
            return []
        before, self._inside = self._inside, True
        try:
            texts = [self.text, *(text for _, text in neighbours.texts(self))]
            found = plan_checks.check(self.text, texts, self._resolve_in_hy if self.kind == "hy" else self._resolve)
        finally:
            self._inside = before
        told = {each.start for each in others}
        return [each for each in found if each.start not in told]

    def _resolve(self, token, own=False):
        symbol = symbol_named(token.text.lstrip("#'"), self.package_at(token.start))
        if own:
            return symbol
        package = getattr(symbol, "package", None)
        return (symbol.name, symbol) if package is not None and package.name in _OUR_PACKAGES else None

    def _resolve_in_hy(self, token, own=False):
        import hy

        known = not own and hy.mangle(token.text) in plan_macros()
        return (bare_name(token.text), None) if known else None

    def _keep(self, image):
        old, self.image = self.image, image
        if old is not None:
            old.forget()

    def in_image(self, thunk, otherwise=None):
        """The value of ``thunk()`` in the image that has the definitions of this text."""
        if self.image is None:
            self._keep(self.surroundings.image_for(None))
        if self._inside:
            return thunk()
        with session_in(self.image):
            self._inside = True
            try:
                return thunk()
            except Condition:
                return otherwise
            finally:
                self._inside = False

    def package_at(self, offset):
        """The package that is current at ``offset``; to be called in the image."""
        if self.kind in ("hy", "xml"):
            return None
        return package_at(self.text, offset, self.kind == "asd")

    def close(self):
        self._keep(None)


_OF_READER = ("end of file", "unmatched", "closes nothing", "never closed", "ends inside", "too many, or one", "closed too early")


def _of_reader(finding):
    words = finding.message.lower()
    return any(part in words for part in _OF_READER)
