"""No question changes its answer: whoever asks whether there is a package, a symbol or a robot loads no library by that."""

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.lisp_core import packages
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.systems import systems
from cramhy_runtime.languages.commonlisp.systems.importer import package_for
from cramhy_runtime.languages.commonlisp.systems.unit_tests import _loaded
from cramhy_runtime.lsp.meanings import package_at
from cramhy_runtime.lsp.texts import Text
from cramhy_runtime.repl.session import Session
from cramhy_runtime.session import Image, arglists, completion, fuzzy, lookup
from cramhy_runtime.swank.packages import package_called

USER = packages.COMMON_LISP_USER
QUESTIONS = {
    "find_package": lambda _: packages.find_package("CRAM-PR2-PROJECTION"),
    "find_package, by a nickname": lambda _: packages.find_package("BTR"),
    "find-package": lambda ask: ask("(find-package :cram-pr2-projection)"),
    "find-package in #+": lambda ask: ask(
        "#+#.(cl:if (cl:find-package :btr) '(and) '(or)) 1 #-#.(cl:if (cl:find-package :btr) '(and) '(or)) nil"
    ),
    "uiop:find-package*": lambda ask: ask("(uiop:find-package* :btr nil)"),
    "uiop:find-symbol*": lambda ask: ask("(uiop:find-symbol* '#:spawn-object :btr-utils nil)"),
    "asdf:find-system": lambda ask: (ask("(asdf:find-system :cram-pr2-projection nil)"), None)[1],
    "asdf:component-loaded-p": lambda ask: ask("(asdf:component-loaded-p :cram-pr2-projection)"),
    "cut:function-bound-feature": lambda ask: (ask('(cut:function-bound-feature "SPAWN-OBJECT" "BTR-UTILS")') != ["(:OR)"]) or None,
    "delete-package": lambda ask: ask("(handler-case (delete-package :alexandria) (package-error () nil))"),
    "completion": lambda _: completion.completions("(btr-utils:spawn", USER)[0] or None,
    "completion by letters": lambda _: fuzzy.completions("btr-utils:spwn", USER) or None,
    "the arguments of a function": lambda _: arglists.symbol_named("btr-utils:spawn-object", USER),
    "the definitions of a name": lambda _: lookup.definitions("btr-utils:spawn-object", USER) or None,
    "the package of a buffer": lambda _: package_called(":btr-utils"),
    "the package of a place in an editor": lambda _: package_at(Text("(in-package :btr-utils)\n(f)\n"), 26) is not USER or None,
    "the module of a package": lambda _: package_for("btr"),
    "whether a library of tests is there": lambda _: _loaded("FIVEAM") or None,
}


def libraries_waiting():
    return {name for name, library in packages.on_demand.items() if isinstance(library, str)}


def asking():
    """A function that evaluates a form in a fresh image, and gives what it prints in a list, or ``None`` for nil."""
    with Image():
        made = Session(time="virtual", turtlesim=False)

        def ask(form):
            value = made.evaluate_text(form)[0]
            return value and [prin1_to_string(value)]

        yield ask
        kernel.stop()


fresh = pytest.fixture(asking)
shared = pytest.fixture(scope="module")(asking)
"""Questions leave an image as it was, so one is enough for all of them."""


@pytest.mark.parametrize("question", QUESTIONS.values(), ids=list(QUESTIONS))
def test_no_question_loads_what_it_asks_about(question, shared):
    loaded, waiting = dict(systems.loaded), libraries_waiting()
    assert (question(shared), question(shared)) == (None, None)
    assert systems.loaded == loaded
    assert {"BTR", "CRAM-PR2-PROJECTION", "ALEXANDRIA", "FIVEAM"} <= waiting == libraries_waiting()


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "use",
    [
        "(alexandria:curry #'+ 1)",
        '(intern "CURRY" :alexandria)',
        '(find-symbol "CURRY" :alexandria)',
        "(use-package :alexandria (make-package :mine))",
    ],
)
def test_a_package_that_is_named_to_be_used_has_its_library_loaded(use, fresh):
    assert fresh("(find-package :alexandria)") is None
    fresh(use)
    assert fresh("(package-name (find-package :alexandria))") == ['"ALEXANDRIA"'] and "alexandria" in systems.loaded
