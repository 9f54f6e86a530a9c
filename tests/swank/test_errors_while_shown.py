"""sldb and the inspector show an error though something in it cannot be printed."""

from __future__ import annotations

import bad_printers
import pytest

FORMS = {what: (form, said) for what, form, said in bad_printers.forms()}


@pytest.fixture
def defined(emacs):
    emacs.repl(bad_printers.DEFINITIONS)
    return emacs


def test_sldb_shows_each_error(defined):
    for what, (form, said) in FORMS.items():
        quoted = form.replace('"', '\\"')
        number = defined.rex(f'(swank-repl:listener-eval "{quoted}")', thread=":repl-thread")
        thread, level, condition, restarts, frames = defined.debugged()
        assert said in " ".join(condition[0].split()) and len(str((condition, restarts, frames))) < bad_printers.MOST, what
        assert level == 1 and len(restarts) <= 4
        if form.startswith("(bp-fail"):
            (variable,), _ = defined.call("(swank:frame-locals-and-catch-tags 0)", thread=thread)
            assert variable[1] == "X" and len(variable[5]) < bad_printers.MOST, what
            assert len(defined.call("(swank:inspect-frame-var 0 0)", thread=thread)[1]) < bad_printers.MOST
        (*_, leave) = [index for index, restart in enumerate(restarts) if restart[0] == "ABORT"]
        defined.rex(f"(swank:invoke-nth-restart-for-emacs {level} {leave})", thread=thread)
        assert defined.wait(number)[0] == ":abort"
