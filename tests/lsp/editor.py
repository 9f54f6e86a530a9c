"""An editor for tests: pygls' client, which starts ``cramhy lsp`` and keeps what it is told."""

from __future__ import annotations

import asyncio
import sys
import threading

from lsprotocol import types as lsp
from pygls.lsp.client import LanguageClient

LONG = 300  # seconds of the wall: only a server that hangs takes so long


class Editor:
    """A client with one server process. Its loop runs in a thread of its own."""

    def __init__(self, *words, folder=None):
        self.loop = asyncio.new_event_loop()
        self.thread = threading.Thread(target=self.loop.run_forever, daemon=True)
        self.thread.start()
        self.client = LanguageClient("tests", "1")
        self.told, self.arrived, self.versions = {}, asyncio.Event(), {}
        words = words or (sys.executable, "-m", "cramhy_runtime.cli", "lsp")

        @self.client.feature(lsp.TEXT_DOCUMENT_PUBLISH_DIAGNOSTICS)
        def told(params):
            self.told.setdefault(params.uri, []).append(params.diagnostics)
            self.arrived.set()

        self.shown, self.logged, self.news = [], [], threading.Condition()

        @self.client.feature(lsp.WINDOW_SHOW_MESSAGE)
        def shown(params):
            with self.news:
                self.shown.append(params)
                self.news.notify_all()

        @self.client.feature(lsp.WINDOW_LOG_MESSAGE)
        def logged(params):
            with self.news:
                self.logged.append(params.message)
                self.news.notify_all()

        self.run(self.client.start_io(*words))
        self.capabilities = self.run(
            self.client.initialize_async(
                lsp.InitializeParams(capabilities=lsp.ClientCapabilities(), root_uri=folder and folder.as_uri(), process_id=None)
            )
        ).capabilities
        self.loop.call_soon_threadsafe(self.client.initialized, lsp.InitializedParams())

    def run(self, work):
        """What the coroutine ``work`` gives. It runs in the editor's thread, since Playwright leaves its loop running in this one."""
        return asyncio.run_coroutine_threadsafe(asyncio.wait_for(work, LONG), self.loop).result()

    def tell(self, name, params):
        """Send the notification ``textDocument/name``; whatever writes to the server does so in the editor's thread."""
        self.loop.call_soon_threadsafe(getattr(self.client, f"text_document_{name}"), params)

    def open(self, uri, text, language="commonlisp"):
        self.versions[uri] = 1
        self.tell("did_open", lsp.DidOpenTextDocumentParams(lsp.TextDocumentItem(uri, language, 1, text)))

    def change(self, uri, text):
        self.versions[uri] += 1
        self.tell(
            "did_change",
            lsp.DidChangeTextDocumentParams(
                lsp.VersionedTextDocumentIdentifier(self.versions[uri], uri), [lsp.TextDocumentContentChangeWholeDocument(text)]
            ),
        )

    def close(self, uri):
        self.tell("did_close", lsp.DidCloseTextDocumentParams(lsp.TextDocumentIdentifier(uri)))

    def checked(self, uri, text):
        """The diagnostics that the compiler gives of ``text``. A save makes the server check; the last ones told are the compiler's."""
        self.told.pop(uri, None)
        if uri in self.versions:
            self.change(uri, text)
        else:
            self.open(uri, text)
        self.run(self._quiet(uri))
        return self.told[uri][-1]

    async def _quiet(self, uri):
        """Wait until the server has checked: it answers what is asked behind the pause after which it checks."""
        while not self.told.get(uri):
            self.arrived.clear()
            await self.arrived.wait()
        self.arrived.clear()
        mark = len(self.told[uri])
        await self.client.text_document_folding_range_async(lsp.FoldingRangeParams(lsp.TextDocumentIdentifier(uri)))
        if len(self.told[uri]) == mark and self._early(uri):  # brackets are told first; the compiler's answer follows within the pause
            try:
                await asyncio.wait_for(self.arrived.wait(), 30)
            except TimeoutError:
                pass

    def _early(self, uri):
        return len(self.told[uri]) == 1 and any("closed" in each.message or "closes" in each.message for each in self.told[uri][0])

    def wait_for(self, condition):
        """Wait until messages of the server make ``condition`` true."""
        with self.news:
            assert self.news.wait_for(condition, LONG)

    def ask(self, name, params):
        return self.run(getattr(self.client, f"text_document_{name}_async")(params))

    def end(self):
        async def leave():
            await self.client.shutdown_async(None)
            self.client.exit(None)
            await self.client._server.wait()

        try:
            self.run(leave())
        finally:
            self.run(self.client.stop())
            self.loop.call_soon_threadsafe(self.loop.stop)
            self.thread.join()
            self.loop.close()
