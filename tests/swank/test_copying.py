"""Objects that Emacs shows are copied into the REPL buffer, described and printed."""

from __future__ import annotations

import pytest

from .test_debugger import fail


def written(emacs):
    return "".join(event[1] for event in emacs.events if event[0] == ":write-string")


def test_a_part_in_the_inspector_becomes_the_newest_result(emacs):
    emacs.call('(swank:init-inspector "(list 7 (list 8 9))")')
    emacs.call("(swank-repl:listener-save-value 'swank:inspector-nth-part 2)")
    emacs.events.clear()
    assert emacs.call("(swank-repl:listener-get-value)", thread=":repl-thread") is True
    assert written(emacs) == "(8 9)\n"
    assert emacs.repl("(reverse *)") == "(9 8)\n"


def test_a_variable_in_the_debugger_becomes_the_newest_result(emacs):
    _, thread, *_ = fail(emacs)
    emacs.call("(swank-repl:listener-save-value 'swank/backend:frame-var-value 0 2)", thread=thread)
    assert emacs.call("(swank/backend::frame-call 0)", thread=thread) == "(BROKEN 1 2)"
    refusal = emacs.refused("(swank-repl:listener-save-value 'swank/backend:frame-var-value 0 9)", thread=thread)
    assert refusal == "This frame has no variable 9."
    emacs.refused("(swank:throw-to-toplevel)", thread=thread)
    emacs.call("(swank-repl:listener-get-value)", thread=":repl-thread")
    assert emacs.repl("(list * *)") == "(3 3)\n"


def test_what_cannot_be_copied(emacs):
    assert emacs.refused("(swank/backend:frame-call 0)") == "This call belongs to a debugger, and there is none."
    assert emacs.refused("(swank-repl:listener-get-value)", thread=":repl-thread") == "Nothing was copied."
    assert emacs.refused("(swank-repl:listener-save-value 'cl:car 1)") == "cramhy cannot copy what cl:car gives."


def test_presentations(emacs):
    emacs.call("(swank:init-presentations)")
    emacs.repl("(list :one 2)")
    number = next(event[1] for event in emacs.events if event[0] == ":presentation-start")
    assert emacs.call(f"(cl:nth-value 1 (swank:lookup-presented-object '{number}))") is True
    assert emacs.call(f"(swank::describe-to-string (swank:lookup-presented-object '{number}))").startswith("(:ONE 2)")
    assert emacs.call(f"(swank::swank-pprint (cl:list (swank:lookup-presented-object '{number})))") == "(:ONE 2)\n"
    assert emacs.call(f"(swank::menu-choices-for-presentation-id '{number})") is None
    emacs.call("(swank-repl:clear-repl-results)")
    assert emacs.call(f"(cl:nth-value 1 (swank:lookup-presented-object '{number}))") is None
    assert emacs.refused(f"(swank::describe-to-string (swank:lookup-presented-object '{number}))") == "This object is not kept any more."


@pytest.mark.parametrize("name", ["throw-away", ":throw-away", '\\"THROW-AWAY\\"'])
def test_packages_are_asked_for_and_deleted(emacs, name):
    emacs.repl("(defpackage :throw-away)")
    assert emacs.call(f'(cl:packagep (swank::guess-package "{name}"))') is True
    assert emacs.call(f'(cl:delete-package (swank::guess-package "{name}"))') is True
    assert emacs.call(f'(cl:packagep (swank::guess-package "{name}"))') is None
    assert emacs.refused(f'(cl:delete-package (swank::guess-package "{name}"))') == "There is no such package."
