"""Mistakes put into the files of the course: each is told at its place, and the files as they are have none."""

from __future__ import annotations

from pathlib import Path

import pytest
from lsprotocol import types as lsp
from systems import takes_long

ROOT = Path(__file__).parents[2] / "tutorials"
COURSE = ROOT / "cram_my_beginner_tutorial"
PLANS, CONTROL, ACTIONS = (COURSE / "src" / f"{name}.hy" for name in ("simple-plans", "control-turtlesim", "action-designators"))
SYSTEM, MANIFEST, PACKAGE = COURSE / "cram-my-beginner-tutorial.asd", COURSE / "package.xml", COURSE / "src" / "package.hy"
HY = ROOT / "turtlesim_in_hy" / "simple_plans.hy"

MISTAKES = [
    # file, what is replaced, by what, what the diagnostic stands at (the line of this text), a word of its message, the text of a fix
    (
        PLANS,
        "(axis-angle->quaternion (make-3d-vector 0 0 1) theta))))",
        "(axis-angle->quaternion (make-3d-vector 0 0 1) theta)))",
        "(defun pose-msg->transform",
        "never closed",
        ")",
    ),
    (PLANS, "(send-vel-cmd 0 0))))\n\n", "(send-vel-cmd 0 0)))))\n\n", "(send-vel-cmd 0 0)))))", "closes nothing", ""),
    (PLANS, "(in-package :tut)", "(in-package :tutt)", "(in-package :tutt)", "does not designate any package", "tut"),
    (PLANS, "(send-vel-cmd 0 0)", "(send-vel-cmdd 0 0)", "(send-vel-cmdd 0 0)", "undefined function", "send-vel-cmd"),
    (PLANS, "(value *turtle-pose*)", "(value *turtle-posse*)", "*turtle-posse*", "undefined variable", None),
    (PLANS, "(calculate-angular-cmd goal 8)", "(calculate-angular-cmd)", "(calculate-angular-cmd)", "argument", None),
    (PLANS, "(calculate-angular-cmd goal 8)", "(calculate-angular-cmd 1 2 3)", "(calculate-angular-cmd 1 2 3)", "argument", None),
    (PLANS, '"Drive until', "Drive until", None, None, None),
    (PLANS, "turn to face `goal', a 3d-vector.\"", "turn to face `goal', a 3d-vector.", None, None, None),
    (PLANS, "(transform-point ", "(cl-transforms:transform-pointt ", "transform-pointt", "transform-pointt", None),
    (PLANS, "(make-transform", "(nowhere:make-transform", "nowhere:make-transform", "nowhere", None),
    (PLANS, "(let ((reached", "(let (((reached", None, None, None),
    (PLANS, "&optional (ang-vel-factor 4)", "&optionl (ang-vel-factor 4)", None, None, None),
    (PLANS, "(unwind-protect", "(unwind-protct", "(unwind-protct", "undefined function", "unwind-protect"),
    (PLANS, "(send-vel-cmd 0 0)", "(if)", "(if)", "if", None),
    (PLANS, "(send-vel-cmd 0 0)", "(let ((unused 5)) nil)", "unused 5", "never used", None),
    (PLANS, "(send-vel-cmd 0 0)", "(1 2 3)", "(1 2 3)", "", None),
    (PLANS, "(send-vel-cmd 0 0)", "(go nowhere-at-all)", "(go nowhere-at-all)", "nowhere-at-all", None),
    (PLANS, "(send-vel-cmd 0 0)", "(return-from nobody 1)", "(return-from nobody 1)", "nobody", None),
    (PLANS, "(send-vel-cmd 0 0)", "#<unreadable>", "#<unreadable>", "", None),
    (PLANS, "(send-vel-cmd 0 0)", "(setq 5 6)", "(setq 5 6)", "", None),
    (PLANS, "(send-vel-cmd 0 0)", "(quote)", "(quote)", "", None),
    (SYSTEM, '(:file "high-level-plans"', '(:file "high-level-plan"', '(:file "high-level-plan"', "missing", "high-level-plans"),
    (SYSTEM, "cram-executive)", "cram-executve)", "cram-executve", "no system", "cram-executive"),
    (SYSTEM, "cram-executive)", "cram-executive", None, "never closed", ")"),
    (MANIFEST, "</package>", "</packag>", "</packag>", "no XML", None),
    (MANIFEST, "<license>", "<licence>", None, None, None),
    (HY, "(wait-duration 0.1)", "(wait-duration 0.1))", None, "", None),
    (
        HY,
        "calculate-angular-cmd goal 8",
        "calculate-angular-cdm goal 8",
        "calculate-angular-cdm",
        "defines calculate-angular-cdm",
        "calculate-angular-cmd",
    ),
    (HY, "(setv distance", "(setv 5", None, None, None),
]
SHORT = [number for number, (file, *_) in enumerate(MISTAKES)]


def diagnostics(editor, file, text):
    return editor.checked(file.as_uri(), text)


def test_enough_kinds():
    assert len(MISTAKES) >= 25


@pytest.mark.parametrize("number", SHORT)
def test_mistake(editor, number):
    file, old, new, at, word, fix = MISTAKES[number]
    source = file.read_text(encoding="utf-8")
    assert old in source
    text = source.replace(old, new, 1)
    found = diagnostics(editor, file, text)
    assert found, "nothing is told"
    if word is not None:
        fitting = [each for each in found if word.lower() in each.message.lower()]
        assert fitting, [each.message for each in found]
        if at is not None:
            lines = [each.range.start.line for each in fitting]
            assert text.count("\n", 0, text.index(at)) in lines, [(each.range, each.message) for each in fitting]
        if fix is not None:
            actions = editor.ask(
                "code_action",
                lsp.CodeActionParams(lsp.TextDocumentIdentifier(file.as_uri()), fitting[0].range, lsp.CodeActionContext(diagnostics=[])),
            )
            edits = [edit.new_text for action in actions for edits in action.edit.changes.values() for edit in edits]
            assert fix in edits, edits


FILES = sorted(ROOT.rglob("*.hy")) + sorted(ROOT.rglob("*.asd")) + sorted(ROOT.rglob("package.xml"))
QUICK = [file for file in FILES if "kitchen" not in file.parts]
SLOW = [file for file in FILES if "kitchen" in file.parts]


@pytest.mark.parametrize("file", [*QUICK, *(pytest.param(file, marks=takes_long) for file in SLOW)], ids=lambda file: file.name)
def test_the_course_has_none(editor, file):
    assert [(each.range.start, each.message) for each in diagnostics(editor, file, file.read_text(encoding="utf-8"))] == []
