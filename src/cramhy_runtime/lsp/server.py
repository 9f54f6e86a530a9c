"""The language server: which messages of the protocol are answered, by pygls.

Messages are answered one after the other, in the main thread. Brackets are looked at when the text changes; the compiler is asked when
nothing has been typed for a moment (`WITHIN`).
"""

from __future__ import annotations

import asyncio
import logging
import sys
from pathlib import Path

from lsprotocol import types as lsp
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path, to_fs_path

import cramhy_runtime
from cramhy_runtime.lisp_core.condition_types import Condition

from . import answers, hy_files, lenses, outlines, stdio, system_files
from .documents import Document
from .indentation import indented
from .running import Runs
from .surroundings import Surroundings

WITHIN = 0.25
"""Seconds after the last key within which diagnostics are to be told. The compiler is asked so much earlier as it took the last time,"""
SHORTEST = 0.05
"""but not before nothing has been typed for so many seconds."""
PAUSE = 0.02
_LEGEND = lsp.SemanticTokensLegend(token_types=outlines.KINDS, token_modifiers=[])
_SYMBOL_KINDS = (
    ("defclass", lsp.SymbolKind.Class), ("defstruct", lsp.SymbolKind.Struct), ("define-condition", lsp.SymbolKind.Class),
    ("defpackage", lsp.SymbolKind.Package), ("defvar", lsp.SymbolKind.Variable), ("defparameter", lsp.SymbolKind.Variable),
    ("defconstant", lsp.SymbolKind.Constant), ("defsystem", lsp.SymbolKind.Module), ("defmethod", lsp.SymbolKind.Method),
)  # fmt: skip


class Server(LanguageServer):
    """The server and the documents that are open."""

    def __init__(self):
        super().__init__("cramhy", cramhy_runtime.__version__, lsp.TextDocumentSyncKind.Incremental)
        self.documents = {}
        self.surroundings = Surroundings()
        self._waiting = {}
        self.runs = Runs(self)

    def report_server_error(self, error, source):
        """One line in the log; the session goes on."""
        print(f"cramhy lsp: {type(error).__name__}: {str(error).splitlines()[0][:300] if str(error) else ''}", file=sys.stderr, flush=True)

    def prepare(self):
        """Load, before the first text is opened, what the systems in the editor's folder depend on, between two messages each."""
        root = self.workspace.root_path
        waiting = iter(system_files.below(root) if root else ())

        def one():
            asd = next(waiting, None)
            if asd is None:
                hy_files.plan_macros()
                return
            try:
                self.surroundings.warm(asd)
            except (Exception, Condition) as problem:
                self.report_server_error(problem, None)
            asyncio.get_running_loop().call_later(PAUSE, one)

        asyncio.get_running_loop().call_later(PAUSE, one)

    def document(self, uri):
        """The `Document` of that name with its present text, or ``None``."""
        return self.documents.get(uri)

    def renew(self, uri):
        """The text of ``uri`` has changed: tell of its brackets now, and of the rest when the user pauses."""
        known = self.workspace.text_documents.get(uri)
        if known is None:
            return
        document = self.documents.get(uri)
        if document is None:
            path = to_fs_path(uri) if uri.startswith("file:") else None
            document = self.documents[uri] = Document(uri, path, known.source, self.surroundings)
        else:
            document.renew(known.source)
        found = document.parse()
        if found:
            self.tell(document, found)
        self.later(uri)

    def later(self, uri):
        waiting = self._waiting.pop(uri, None)
        if waiting is not None:
            waiting.cancel()
        document = self.documents.get(uri)
        pause = max(SHORTEST, WITHIN - (document.took if document is not None else WITHIN))
        self._waiting[uri] = asyncio.get_running_loop().call_later(pause, self.check, uri)

    def check(self, uri):
        """Compile the text of ``uri``, and tell what was found."""
        self._waiting.pop(uri, None)
        document = self.documents.get(uri)
        if document is None:
            return
        clock = asyncio.get_running_loop().time
        begin = clock()
        try:
            found = document.compile()
        except (Exception, Condition) as problem:
            self.report_server_error(problem, None)
            found = document.parse()
        document.took = clock() - begin
        self.tell(document, found)

    def tell(self, document, found):
        document.findings = found
        self.text_document_publish_diagnostics(
            lsp.PublishDiagnosticsParams(uri=document.uri, diagnostics=[_diagnostic(document.text, each) for each in found])
        )

    def close(self, uri):
        waiting = self._waiting.pop(uri, None)
        if waiting is not None:
            waiting.cancel()
        document = self.documents.pop(uri, None)
        if document is not None:
            document.close()
            self.text_document_publish_diagnostics(lsp.PublishDiagnosticsParams(uri=uri, diagnostics=[]))

    def others(self, uri):
        """{path: Text} of the open texts but the one of ``uri``."""
        return {each.path: each.text for each in self.documents.values() if each.path and each.uri != uri}


def _range(text, start, end):
    return lsp.Range(lsp.Position(*text.place(start)), lsp.Position(*text.place(end)))


def _diagnostic(text, finding):
    return lsp.Diagnostic(
        range=_range(text, finding.start, finding.end),
        severity=lsp.DiagnosticSeverity(finding.severity),
        source="cramhy",
        message=finding.message,
    )


def made():
    """The server with all that it answers."""
    server = Server()

    def answering(method, options=None, otherwise=None):
        """Register a function of the document and the parameters. A text that is not open, or too long, is answered by ``otherwise``."""

        def register(function):
            def answer(params):
                document = server.document(params.text_document.uri)
                if document is None or document.too_long:
                    return otherwise
                try:
                    return function(document, params)
                except (Exception, Condition) as problem:
                    server.report_server_error(problem, None)
                    return otherwise

            server.feature(method, options)(answer)
            return function

        return register

    def offset(document, params):
        return document.text.offset(params.position.line, params.position.character)

    def location(document, spot):
        return lsp.Location(from_fs_path(spot.path) if spot.path else document.uri, _range(spot.text, spot.start, spot.end))

    server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)(lambda params: server.renew(params.text_document.uri))
    server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)(lambda params: server.renew(params.text_document.uri))
    server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)(lambda params: server.close(params.text_document.uri))

    @server.feature(lsp.INITIALIZED)
    def initialized(params):
        server.prepare()

    @server.feature(lsp.TEXT_DOCUMENT_DID_SAVE)
    def saved(params):
        for uri in server.documents:  # the others may use what this one defines
            server.later(uri)

    @answering(lsp.TEXT_DOCUMENT_COMPLETION, lsp.CompletionOptions(trigger_characters=[":", "("]))
    def complete(document, params):
        at = offset(document, params)
        found, start = answers.completions(document, at)
        place = _range(document.text, start, at)
        written = document.text.text[start:at]
        cased = str.upper if written.isupper() else str
        return lsp.CompletionList(
            is_incomplete=len(found) >= answers.MOST,
            items=[
                lsp.CompletionItem(
                    label=name,
                    detail=known or None,
                    sort_text=f"{number:04}",
                    filter_text=name,
                    text_edit=lsp.TextEdit(range=place, new_text=cased(name)),
                )
                for number, (name, known) in enumerate(found)
            ],
        )

    @answering(lsp.TEXT_DOCUMENT_HOVER)
    def hover(document, params):
        found = answers.hover(document, offset(document, params))
        if found is None:
            return None
        told, start, end = found
        return lsp.Hover(lsp.MarkupContent(lsp.MarkupKind.PlainText, told), _range(document.text, start, end))

    @answering(lsp.TEXT_DOCUMENT_SIGNATURE_HELP, lsp.SignatureHelpOptions(trigger_characters=[" "]))
    def signature(document, params):
        found = answers.signature(document, offset(document, params))
        if found is None:
            return None
        call, parts, place = found
        information = lsp.SignatureInformation(label=call, parameters=[lsp.ParameterInformation(label=part) for part in parts])
        return lsp.SignatureHelp(signatures=[information], active_signature=0, active_parameter=place)

    @answering(lsp.TEXT_DOCUMENT_DEFINITION, otherwise=[])
    def definition(document, params):
        return [location(document, spot) for spot in answers.definitions(document, offset(document, params))]

    @answering(lsp.TEXT_DOCUMENT_REFERENCES, otherwise=[])
    def references(document, params):
        found = answers.references(document, offset(document, params), server.others(document.uri))
        return [location(document, spot) for spot in found]

    @answering(lsp.TEXT_DOCUMENT_RENAME)
    def rename(document, params):
        found = answers.renaming(document, offset(document, params), server.others(document.uri))
        if not found or not params.new_name or any(c.isspace() or c in "()[]{}\"';`,|:#" for c in params.new_name):
            return None
        changes = {}
        for spot in found:
            place = location(document, spot)
            changes.setdefault(place.uri, []).append(lsp.TextEdit(place.range, params.new_name))
        return lsp.WorkspaceEdit(changes=changes)

    @answering(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL, otherwise=[])
    def symbols(document, params):
        return [
            lsp.DocumentSymbol(
                name=name,
                detail=operator,
                kind=next((kind for start_, kind in _SYMBOL_KINDS if operator.endswith(start_)), lsp.SymbolKind.Function),
                range=_range(document.text, start, end),
                selection_range=_range(document.text, *place),
            )
            for operator, name, start, end, *place in outlines.definitions(document.text)
        ]

    @answering(lsp.TEXT_DOCUMENT_FOLDING_RANGE, otherwise=[])
    def folds(document, params):
        return [
            lsp.FoldingRange(first, last, kind=lsp.FoldingRangeKind.Comment if comment else lsp.FoldingRangeKind.Region)
            for first, last, comment in outlines.folds(document.text)
        ]

    @answering(lsp.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, _LEGEND, lsp.SemanticTokens(data=[]))
    def kinds(document, params):
        data, line, column = [], 0, 0
        for at, start, length, kind in document.in_image(lambda: outlines.kinds(document.text, document.package_at), []):
            data += [at - line, start - column if at == line else start, length, kind, 0]
            line, column = at, start
        return lsp.SemanticTokens(data=data)

    def edits(document, first=0, last=None):
        if document.kind == "xml":
            return []
        changes = document.in_image(lambda: indented(document.text, answers.body_starts(document), first, last), [])
        return [lsp.TextEdit(_range(document.text, start, end), new) for start, end, new in changes]

    @answering(lsp.TEXT_DOCUMENT_FORMATTING, otherwise=[])
    def formatting(document, params):
        return edits(document)

    @answering(lsp.TEXT_DOCUMENT_RANGE_FORMATTING, otherwise=[])
    def range_formatting(document, params):
        return edits(document, params.range.start.line, params.range.end.line)

    @answering(lsp.TEXT_DOCUMENT_ON_TYPE_FORMATTING, lsp.DocumentOnTypeFormattingOptions("\n"), [])
    def typed(document, params):
        return edits(document, params.position.line, params.position.line)

    @answering(lsp.TEXT_DOCUMENT_CODE_ACTION, lsp.CodeActionOptions([lsp.CodeActionKind.QuickFix]), [])
    def fixes(document, params):
        text = document.text
        first = text.offset(params.range.start.line, params.range.start.character)
        last = text.offset(params.range.end.line, params.range.end.character)
        return [
            lsp.CodeAction(
                title=title,
                kind=lsp.CodeActionKind.QuickFix,
                diagnostics=[_diagnostic(text, finding)],
                edit=lsp.WorkspaceEdit(changes={document.uri: [lsp.TextEdit(_range(text, start, end), new)]}),
            )
            for finding in document.findings
            if finding.start <= last and finding.end >= first
            for title, start, end, new in finding.fixes
        ]

    @answering(lsp.TEXT_DOCUMENT_CODE_LENS, otherwise=[])
    def above(document, params):
        return [
            lsp.CodeLens(
                range=_range(document.text, lens.start, document.text.end_of_line(lens.start)),
                command=lsp.Command(lens.title, f"cramhy.{lens.title.lower()}", arguments=[document.uri, lens.name]),
            )
            for lens in lenses.lenses(document)
        ]

    def starting(title):
        async def start(*arguments):
            uri, name = (list(arguments[0] if len(arguments) == 1 and isinstance(arguments[0], list) else arguments) + [None, None])[:2]
            document = server.document(uri) if isinstance(uri, str) else None
            if document is None or not isinstance(name, str):
                return server.runs.refuse("Open the file first.")
            if document.path is None or not _saved(document):
                return server.runs.refuse("Save the file first: what runs is what is on the disk.")
            try:
                return await server.runs.run(lenses.errand(document, title, name))
            except (LookupError, OSError, Condition) as problem:
                return server.runs.refuse(str(problem))

        server.command(f"cramhy.{title.lower()}")(start)

    starting(lenses.RUN)
    starting(lenses.TEST)

    @server.command("cramhy.interrupt")
    def interrupt(*arguments):
        return server.runs.interrupt()

    @server.feature(lsp.SHUTDOWN)
    async def shutdown(*arguments):
        await server.runs.end()

    return server


def _saved(document):
    try:
        return Path(document.path).read_text(encoding="utf-8") == document.text.text
    except (OSError, UnicodeDecodeError):
        return False


def run():
    """Serve the editor at standard input and output until it ends. Returns the status of the process."""
    logging.getLogger("pygls").setLevel(logging.CRITICAL)
    logging.getLogger("cramhy.lsp").setLevel(logging.CRITICAL)
    source, target = stdio.own_pipes()
    try:
        asyncio.run(stdio.serve(made(), source, target))
    except (BrokenPipeError, KeyboardInterrupt):
        pass
    return 0
