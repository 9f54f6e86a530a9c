"""A kernel of Jupyter's for many tests, and a client that says what comes back."""

from __future__ import annotations

import os
import sys
from dataclasses import dataclass, field

import pytest

PATIENCE = 120  # s for an answer; each comes as soon as it is there


@dataclass
class Answer:
    """What came for one cell: the reply, and the messages of all kinds that it sent, in their order."""

    reply: dict = field(default_factory=dict)
    messages: list = field(default_factory=list)

    def of(self, kind):
        return [content for name, content in self.messages if name == kind]

    @property
    def printed(self):
        return "".join(content["text"] for content in self.of("stream"))

    @property
    def text(self):
        (result,) = self.of("execute_result")
        return result["data"]["text/plain"]

    @property
    def html(self):
        (result,) = self.of("execute_result")
        return result["data"].get("text/html")


class Notebook:
    """A client of a kernel process."""

    def __init__(self, folder, *words):
        from jupyter_client.kernelspec import KernelSpec
        from jupyter_client.manager import KernelManager

        argv = [sys.executable, "-m", "cramhy_runtime.cli", "jupyter", "kernel", *words, "-f", "{connection_file}"]
        self.manager = KernelManager()
        self.manager._kernel_spec = KernelSpec(argv=argv, language="common-lisp", display_name="cramhy", interrupt_mode="signal")
        self.manager.start_kernel(cwd=str(folder), env={**os.environ, "PYTHONDONTWRITEBYTECODE": ""})
        self.client = self.manager.client()
        self.client.start_channels()
        self.client.wait_for_ready(timeout=PATIENCE)

    def run(self, code, typed=None, on_message=None, **more):
        """The `Answer` to a cell. typed: lines for its input, or ``None`` where there is none. on_message: is told (kind, content)."""
        answer = Answer()
        lines = iter(typed or ())

        def note(message):
            answer.messages.append((message["msg_type"], message["content"]))
            if on_message is not None:
                on_message(message["msg_type"], message["content"])

        def asked(message):
            answer.messages.append(("input_request", message["content"]))
            self.client.input(next(lines))

        answer.reply = self.client.execute_interactive(
            code, allow_stdin=typed is not None, timeout=PATIENCE, output_hook=note, stdin_hook=asked, **more
        )["content"]
        return answer

    def completeness(self, code):
        """What the kernel says of the parentheses of ``code``."""
        asked = self.client.is_complete(code)
        while (reply := self.client.get_shell_msg(timeout=PATIENCE))["parent_header"].get("msg_id") != asked:
            pass
        return reply["content"]["status"]

    def end(self):
        self.client.stop_channels()
        self.manager.shutdown_kernel()


@pytest.fixture(scope="package")
def notebook(tmp_path_factory):
    for module in ("ipykernel", "jupyter_client"):
        pytest.importorskip(module, reason="the extra jupyter is not installed")
    made = Notebook(tmp_path_factory.mktemp("notebook"))
    yield made
    made.end()


@pytest.fixture
def cells(notebook):
    """The notebook, in Lisp and in CL-USER, whatever a test before has left."""
    notebook.run("%%hy\n(in-package :cl-user)")
    return notebook
