"""Lines that prompt_toolkit edits: a form is one text, however many lines it has, in which the cursor moves, and which comes back as one.

Enter ends the form when nothing is open in it, and begins another line otherwise. Alt and Enter end it in any case. The prompt of a line
that goes on says what is open there. The parenthesis at the cursor and its partner are marked.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache

from prompt_toolkit import PromptSession
from prompt_toolkit.application import get_app, run_in_terminal
from prompt_toolkit.completion import CompleteEvent, Completer, Completion
from prompt_toolkit.document import Document
from prompt_toolkit.enums import DEFAULT_BUFFER
from prompt_toolkit.filters import has_focus
from prompt_toolkit.history import InMemoryHistory
from prompt_toolkit.key_binding import KeyBindings
from prompt_toolkit.layout.processors import Processor, Transformation, TransformationInput
from prompt_toolkit.layout.utils import explode_text_fragments

from cramhy_runtime.kernel.standard_input import drop_unfinished
from cramhy_runtime.kernel.terminals import ctrl_c_as_a_key, typed_ahead

from cramhy_runtime.session.completion import completions
from .file_names import begun_string, file_names
from .history import History, place
from .line_input import BROKEN_OFF, Lines
from .open_forms import OpenForms, Pairs, of_lisp


class EditedLines(Lines):
    """Texts that prompt_toolkit edits."""

    interactive = True
    shows_open = True
    edits = True

    def __init__(self):
        super().__init__()
        self._history = History(place("lisp-history"))
        self._recalled = Recalled(self._history.forms)
        self._editor = PromptSession(
            history=self._recalled,
            completer=Names(),
            complete_while_typing=False,
            multiline=True,
            key_bindings=_keys(self._forgotten),
            prompt_continuation=self._continuation,
            input_processors=[Partners()],
        )
        self._woken = False
        self._loop = self._application = None  # in which the editor runs, and what it runs there

    def wait(self, prompt):
        if self._woken:
            self._woken = False
            return BROKEN_OFF
        try:
            with ctrl_c_as_a_key(self._editor.input.fileno()):  # before the prompt stands there
                line = self._editor.prompt(prompt, pre_run=lambda: self._begun(self._editor.app), handle_sigint=False)
        except KeyboardInterrupt:  # the key, or `wake`
            self._woken = False
            return BROKEN_OFF
        except (EOFError, OSError):  # the user ends the session, or the terminal was closed
            return None
        finally:
            self._loop = None
        self._look_for_ctrl_c()
        return line

    def _continuation(self, width, line, wrapped):
        """The prompt of line number ``line`` of a text; nothing for the rest of a line that is too long for the terminal."""
        return "" if wrapped else _prompts(self._editor.default_buffer.text)[line - 1]

    def _begun(self, application):
        import asyncio

        self._application, self._loop = application, asyncio.get_running_loop()
        if self._woken:
            self._leave()

    def _leave(self):
        application = self._application
        if application.is_running and application.future is not None and not application.future.done():
            application.exit(exception=KeyboardInterrupt())

    def remember(self, text):
        if self._history.add(text):
            self._recalled.add(self._history.forms[-1])

    def _forgotten(self, buffer):
        """Ask ``heed`` about the lines of an open form, and tell above it what that says. Whether the last line was forgotten."""
        lines = buffer.text.split("\n")
        if self.heed is None or len(lines) < 2 or not buffer.document.is_cursor_at_the_end:
            return False
        told, forget = self.heed(lines)
        if told is not None:
            run_in_terminal(lambda: print(told))
        if forget:
            buffer.document = Document("\n".join([*lines[:-1], ""]))
        return forget

    def wake(self):
        self._woken = True
        loop = self._loop
        if loop is not None:
            try:
                loop.call_soon_threadsafe(self._leave)
            except RuntimeError:
                pass  # it is closed: the line was read

    def dealt_with(self):
        self._woken = False

    def _look_for_ctrl_c(self):
        """The editor reads keys in advance, and a key that is pressed before the terminal makes signals again sends none. If Ctrl-C is
        among these keys it is for the form that comes now."""
        from prompt_toolkit.input.typeahead import get_typeahead, store_typeahead
        from prompt_toolkit.keys import Keys

        source = self._editor.input
        keys = get_typeahead(source)
        with typed_ahead(source.fileno()):
            keys += source.read_keys() + source.flush_keys()
        pressed = [index for index, key in enumerate(keys) if key.key == Keys.ControlC]
        if pressed:
            keys = drop_unfinished(keys[: pressed[-1]], lambda key: key.key in (Keys.ControlM, Keys.ControlJ)) + keys[pressed[-1] + 1 :]
            keys = [key for key in keys if key.key != Keys.ControlC]
        store_typeahead(source, keys)
        if pressed:
            self.press()


class Recalled(InMemoryHistory):
    """What the arrow keys bring back. The editor adds what it has read, which may be a part of a form; only `add` counts."""

    def append_string(self, string: str) -> None:
        pass

    def add(self, form: str) -> None:
        super().append_string(form)


class Names(Completer):
    """What the Tab key offers."""

    def get_completions(self, document: Document, complete_event: CompleteEvent) -> Iterator[Completion]:
        text = document.text_before_cursor
        typed = begun_string(text)
        if typed is not None:
            begin = len(typed.rpartition("/")[0]) if "/" in typed else 0
            for name in file_names(typed):
                yield Completion(name, start_position=-len(typed), display=name[begin:].removeprefix("/") or name)
            return
        found, length = completions(text)
        for name, known in found:
            yield Completion(name, start_position=-length, display_meta=known)


def _keys(forgotten):
    """What keys do. forgotten: see `EditedLines._forgotten`."""
    keys = KeyBindings()

    @keys.add("enter", filter=has_focus(DEFAULT_BUFFER))
    def _(event):
        buffer, opened = event.current_buffer, of_lisp()
        if buffer.complete_state is not None and buffer.complete_state.current_completion is not None:
            buffer.complete_state = None  # it is chosen from the menu
            return
        if opened is not None:
            opened.read(f"{buffer.text}\n")
            if opened.something:
                return None if forgotten(buffer) else buffer.insert_text("\n")
        buffer.validate_and_handle()

    return keys


@lru_cache(maxsize=2)
def _prompts(text):
    """For each line of ``text`` the prompt of the one behind it."""
    opened, found = OpenForms(), []
    for line in text.split("\n"):
        opened.read(f"{line}\n")
        found.append(opened.prompt())
    return found


class Partners(Processor):
    """Marks the parenthesis at the cursor, or in front of it, and the other one of the pair."""

    def apply_transformation(self, transformation_input: TransformationInput) -> Transformation:
        document, fragments = transformation_input.document, transformation_input.fragments
        if not get_app().is_done:  # what stays in the terminal is not marked
            partner = _partners(document.text)
            at = next((place for place in (document.cursor_position, document.cursor_position - 1) if place in partner), None)
            for place, style in () if at is None else ((at, "cursor"), (partner[at], "other")):
                line, column = document.translate_index_to_position(place)
                if line == transformation_input.lineno:
                    fragments = explode_text_fragments(fragments)
                    column = transformation_input.source_to_display(column)
                    if column < len(fragments):
                        fragments[column] = (f"{fragments[column][0]} class:matching-bracket.{style} ", *fragments[column][1:])
        return Transformation(fragments)


@lru_cache(maxsize=2)
def _partners(text):
    pairs = Pairs()
    pairs.read(text)
    return pairs.partner


__all__ = ["EditedLines"]
