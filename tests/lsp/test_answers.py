"""Completion, hover, definitions, renaming, outlines and indentation, asked for by a real client in the course's package."""

from __future__ import annotations

import pytest
from lsprotocol import types as lsp

from .mistakes import CONTROL, COURSE, PLANS

SOURCE = PLANS.read_text(encoding="utf-8")
URI = PLANS.as_uri()
HERE = lsp.TextDocumentIdentifier(URI)


@pytest.fixture(scope="module", autouse=True)
def opened(editor):
    assert list(editor.checked(URI, SOURCE)) == []


def at(words, further=0):
    offset = SOURCE.index(words) + further
    return lsp.Position(SOURCE.count("\n", 0, offset), offset - SOURCE.rfind("\n", 0, offset) - 1)


def test_completion(editor):
    found = editor.ask("completion", lsp.CompletionParams(HERE, at("send-vel-cmd", 6)))
    assert found.items[0].label == "send-vel-cmd" and found.items[0].text_edit.new_text == "send-vel-cmd"


def test_hover_and_signature(editor):
    assert "evaporated" in editor.ask("hover", lsp.HoverParams(HERE, at("pursue", 2))).contents.value
    assert "ang-vel-factor" in editor.ask("hover", lsp.HoverParams(HERE, at("(calculate-angular-cmd goal 8", 3))).contents.value
    found = editor.ask("signature_help", lsp.SignatureHelpParams(HERE, at("(calculate-angular-cmd goal 8", 28)))
    assert found.signatures[0].label.startswith("(calculate-angular-cmd goal &optional")
    assert found.signatures[0].parameters[found.active_parameter].label == "(ang-vel-factor 4)"


def test_definition_in_another_file_and_of_a_local_name(editor):
    (found,) = editor.ask("definition", lsp.DefinitionParams(HERE, at("send-vel-cmd", 2)))
    lines = CONTROL.read_text(encoding="utf-8").splitlines()
    assert found.uri == CONTROL.as_uri() and "send-vel-cmd" in lines[found.range.start.line]
    (found,) = editor.ask("definition", lsp.DefinitionParams(HERE, at("(wait-for reached", 12)))
    assert found.range.start == at("reached (<")


def test_references_and_renaming(editor):
    found = editor.ask("references", lsp.ReferenceParams(lsp.ReferenceContext(True), HERE, at("send-vel-cmd", 2)))
    assert {each.uri.rpartition("/")[2] for each in found} >= {"simple-plans.hy", "control-turtlesim.hy", "high-level-plans.hy"}
    local = editor.ask("rename", lsp.RenameParams(HERE, at("reached (<", 1), "near")).changes
    assert list(local) == [URI] and [each.range.start for each in local[URI]] == [at("reached (<"), at("(wait-for reached", 10)]
    everywhere = editor.ask("rename", lsp.RenameParams(HERE, at("send-vel-cmd", 1), "go")).changes
    assert sum(map(len, everywhere.values())) == len(found)
    assert editor.ask("rename", lsp.RenameParams(HERE, at("unwind-protect", 1), "x")) is None, "Lisp's own names stay"
    assert editor.ask("rename", lsp.RenameParams(HERE, at("send-vel-cmd", 1), "a b")) is None


def test_outline_folds_and_kinds(editor):
    names = [each.name for each in editor.ask("document_symbol", lsp.DocumentSymbolParams(HERE))]
    assert names == ["pose-msg->transform", "relative-angle-to", "calculate-angular-cmd", "move-to", "rotate-to"]
    folds = editor.ask("folding_range", lsp.FoldingRangeParams(HERE))
    assert at("(defun move-to").line in [each.start_line for each in folds]
    data = editor.ask("semantic_tokens_full", lsp.SemanticTokensParams(HERE)).data
    assert len(data) % 5 == 0 and len({data[index] for index in range(3, len(data), 5)}) >= 4


INDENTED = [
    "(defun f (x)\n  (let ((a 1)\n        (b 2))\n    (if a\n        b\n        x)))\n",
    "(unwind-protect\n     (f 1)\n  (g 2))\n",
    "(f 1\n   2)\n",
    "(f\n 1\n 2)\n",
    '(when x\n  (print "a\n b"))\n',
    "(flet ((g (x)\n         (h x)))\n  (g 1))\n",
    "(pursue\n  (a)\n  (b))\n",
    "'(1\n  2)\n",
]


@pytest.mark.parametrize("text", INDENTED)
def test_indentation_brings_back_what_was_lost(editor, text):
    uri = f"untitled:indented-{INDENTED.index(text)}.lisp"
    text = f"(in-package :cpl)\n\n{text}"
    inside = text.count('"') > 0
    flat = text if inside else "\n".join(line.lstrip() for line in text.split("\n"))
    editor.open(uri, flat)
    edits = editor.ask("formatting", lsp.DocumentFormattingParams(lsp.TextDocumentIdentifier(uri), lsp.FormattingOptions(2, True)))
    lines = flat.split("\n")
    for edit in edits:
        start, end = edit.range.start, edit.range.end
        assert start.line == end.line
        lines[start.line] = lines[start.line][: start.character] + edit.new_text + lines[start.line][end.character :]
    assert "\n".join(lines) == text
    editor.close(uri)


def test_the_image_of_a_text_runs_nothing_of_it(editor, tmp_path):
    trace = tmp_path / "trace"
    form = f'(with-open-file (s "{trace}" :direction :output) (print 1 s))'
    text = f"(defvar *x* {form})\n(defun f () {form})\n{form}\n"
    editor.checked((tmp_path / "runs.lisp").as_uri(), text)
    assert not trace.exists()
    editor.checked((tmp_path / "runs.lisp").as_uri(), f"(defmacro m () {form} nil)\n(m)\n")
    assert trace.exists(), "macros run, as SECURITY.md says"


def test_a_missing_extra_is_named(monkeypatch, capsys):
    from cramhy_runtime.cli import lsp_command, servers

    monkeypatch.setattr(servers, "find_spec", lambda name: None)
    assert lsp_command.run() == 2
    assert "pygls" in capsys.readouterr().err
    assert COURSE.is_dir()


TWINS = {
    "package.lisp": """(defpackage :kitchen (:use :cl) (:export #:open-door))
(defpackage :garage (:use :cl))
(defpackage :hall (:use :cl :kitchen))
""",
    "kitchen.lisp": """(in-package :kitchen)
(defun open-door (x) x)
(defun enter () (open-door 1))
""",
    "garage.lisp": """(in-package :garage)
(defun open-door (x) (list x))
(defun enter () (open-door 2) (kitchen:open-door 3))
""",
    "hall.lisp": """(in-package :hall)
(defun enter () (open-door 4))
""",
    "twins.asd": '(defsystem twins :serial t :components ((:file "package") (:file "kitchen") (:file "garage") (:file "hall")))\n',
}


@pytest.mark.soak
def test_symbols_of_one_name_are_told_apart_by_their_packages(editor, tmp_path):
    for name, text in TWINS.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    for name in ("kitchen", "garage", "hall"):
        assert list(editor.checked((tmp_path / f"{name}.lisp").as_uri(), TWINS[f"{name}.lisp"])) == []

    def asked(name, line, column):
        document, position = lsp.TextDocumentIdentifier((tmp_path / f"{name}.lisp").as_uri()), lsp.Position(line, column)
        found = editor.ask("references", lsp.ReferenceParams(lsp.ReferenceContext(True), document, position))
        (defined,) = editor.ask("definition", lsp.DefinitionParams(document, position))
        changes = editor.ask("rename", lsp.RenameParams(document, position, "unlock")).changes
        assert sum(map(len, changes.values())) == len(found)
        return sorted((each.uri.rpartition("/")[2][:3], each.range.start.line) for each in found), defined.uri.rpartition("/")[2]

    of_kitchen = [("gar", 2), ("hal", 1), ("kit", 1), ("kit", 2)]
    assert asked("hall", 1, 18) == (of_kitchen, "kitchen.lisp")
    assert asked("kitchen", 2, 18) == (of_kitchen, "kitchen.lisp")
    assert asked("garage", 2, 40) == (of_kitchen, "kitchen.lisp")
    assert asked("garage", 2, 18) == ([("gar", 1), ("gar", 2)], "garage.lisp")


def test_a_copy_of_the_course_has_its_own_definitions(editor, tmp_path):
    import shutil

    copy = tmp_path / "course"
    shutil.copytree(COURSE, copy)
    file = copy / "src" / PLANS.name
    assert list(editor.checked(file.as_uri(), SOURCE)) == []
    (found,) = editor.ask("definition", lsp.DefinitionParams(lsp.TextDocumentIdentifier(file.as_uri()), at("send-vel-cmd", 2)))
    assert found.uri == (copy / "src" / CONTROL.name).as_uri()
