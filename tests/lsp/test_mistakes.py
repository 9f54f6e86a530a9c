"""Mistakes put into the files of the course: each is told at its place, and the files as they are have none."""

from __future__ import annotations

import pytest
from lsprotocol import types as lsp

from .mistakes import MISTAKES, ROOT


def test_enough_kinds():
    assert len(MISTAKES) >= 40 and all(word for *_, word, _ in MISTAKES)


def place(text, offset):
    return lsp.Position(text.count("\n", 0, offset), offset - text.rfind("\n", 0, offset) - 1)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("number", range(len(MISTAKES)), ids=lambda number: MISTAKES[number][5][:40].replace("/", " "))
def test_mistake(editor, number):
    file, old, new, at, severity, word, fix = MISTAKES[number]
    source = file.read_text(encoding="utf-8")
    assert old in source
    changed = source.index(old)
    text = source.replace(old, new, 1)
    found = editor.checked(file.as_uri(), text)
    fitting = [each for each in found if word in each.message]
    assert fitting, [each.message for each in found]
    (told, *_) = fitting
    assert told.severity == severity and told.source == "cramhy"
    line = text.split("\n")[told.range.start.line]
    if at is None:  # the first line of the form that was changed
        begin = text.rfind("\n(", 0, changed + 1) + 1 if line.startswith("(") else text.index("(", text.rindex("\n", 0, changed))
        start, end = place(text, begin), lsp.Position(told.range.start.line, len(line))
        assert told.range == lsp.Range(start, end)
    else:
        mark, count = at if isinstance(at, tuple) else (at, 0)
        written = text.split("\n")[told.range.start.line][told.range.start.character : told.range.end.character]
        assert told.range.start.line == told.range.end.line and written == mark
        if len(mark) > 2 and mark in new:
            begin = changed + new.index(mark)
            for _ in range(count):
                begin = text.index(mark, begin + 1)
            assert told.range.start == place(text, begin)
    if fix is not None:
        params = lsp.CodeActionParams(lsp.TextDocumentIdentifier(file.as_uri()), told.range, lsp.CodeActionContext(diagnostics=[]))
        actions = editor.ask("code_action", params)
        edits = [edit.new_text for action in actions for edits in action.edit.changes.values() for edit in edits]
        assert fix in edits, edits


FILES = sorted(ROOT.rglob("*.hy")) + sorted(ROOT.rglob("*.asd")) + sorted(ROOT.rglob("package.xml"))


@pytest.mark.soak
@pytest.mark.parametrize("file", FILES, ids=lambda file: f"{file.parent.name}-{file.name}")
def test_the_course_has_none(editor, file):
    assert [(each.range.start, each.message) for each in editor.checked(file.as_uri(), file.read_text(encoding="utf-8"))] == []
