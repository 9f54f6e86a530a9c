"""What Emacs asks while one types and looks around: completion, arglists, definitions, documentation, macros, packages, inspection."""

from __future__ import annotations

import pytest


def test_completion(emacs):
    assert emacs.call('(swank:simple-completions "mapca" "CL-USER")') == [["mapcan", "mapcar"], "mapca"]
    assert emacs.call('(swank:completions "cpl:pursu" "CL-USER")') == [["cpl:pursue"], "cpl:pursue"]
    assert emacs.call('(swank:completions "MAPCA" "CL-USER")') == [["MAPCAN", "MAPCAR"], "MAPCA"]
    assert emacs.call('(swank:completions "m-v-b" "CL-USER")') == [["multiple-value-bind"], "multiple-value-bind"]
    assert emacs.call('(swank:completions "no-such-thing" "CL-USER")') == [None, "no-such-thing"]
    assert emacs.refused('(swank:completions "x" "NO-SUCH-PACKAGE")') == "There is no package NO-SUCH-PACKAGE."
    assert emacs.call('(swank:completions-for-character "Sp")') == [["Space"], "Space"]


def test_fuzzy_completion_puts_the_likeliest_first(emacs):
    found, _ = emacs.call('(swank:fuzzy-completions "mvb" "CL-USER" :limit 3 :time-limit-in-msec 500)')
    assert (
        found[0][0] == "multiple-value-bind" and found[0][2] == [[0, "m"], [9, "v"], [15, "b"]] and found[0][3] in ("-----m--", "--------")
    )
    assert len(found) == 3 and float(found[0][1]) > float(found[1][1])
    found, _ = emacs.call('(swank:fuzzy-completions "cpl:trya" "CL-USER")')
    assert found[0][:3] == ["cpl:try-all", found[0][1], [[4, "try"], [8, "a"]]]
    assert emacs.call('(swank:fuzzy-completions "zzzzqq" "CL-USER")') == [None, None]
    assert emacs.call('(swank:fuzzy-completion-selected "mvb" \'("a" 1))') is None
    assert emacs.call('(slynk-completion:flex-completions "mvb" "CL-USER")')[0][0][0] == "multiple-value-bind"


def test_keywords_of_the_call_at_hand(emacs):
    emacs.repl("(defun go-there (x &key speed start) (list x speed start))")
    form = '(swank:completions-for-keyword ":s" \'("go-there" "1" swank::%cursor-marker%))'
    assert emacs.call(form) == [[":speed", ":start"], ":s"]
    assert ":start" in emacs.call('(swank:completions-for-keyword ":star" nil)')[0]


@pytest.mark.parametrize(
    ("form", "shown"),
    [
        ('("mapcar" "f" swank::%cursor-marker%)', "(mapcar ===> function <=== lst &rest lists)"),
        ('("mapcar" "f" "" swank::%cursor-marker%)', "(mapcar function ===> lst <=== &rest lists)"),
        ('("mapcar" "f" "a" "b" "" swank::%cursor-marker%)', "(mapcar function lst &rest ===> lists <===)"),
        ('("mapcar" swank::%cursor-marker%)', "(mapcar function lst &rest lists)"),
        ('("if" "a" "" swank::%cursor-marker%)', "(if test ===> then <=== &optional else)"),
        ('("cpl:top-level" ("cpl:par" "" swank::%cursor-marker%))', "(cpl:par ===> form... <===)"),
        ('("mapcar" ("no-such" "" swank::%cursor-marker%))', "(mapcar ===> function <=== lst &rest lists)"),
        ('("go-there" "1" ":speed" "" swank::%cursor-marker%)', "(go-there x &key ===> (speed 5) <===)"),
        ('("go-there" "1" ":sp" swank::%cursor-marker%)', "(go-there x &key (speed 5))"),
        ('("when" "x" "" swank::%cursor-marker%)', "(when test &rest ===> body <===)"),
        ('("let" (("list" "" swank::%cursor-marker%)))', "(let ===> bindings <=== &body body)"),
        ('("let" (("x" ("car" "" swank::%cursor-marker%))))', "(car ===> lst <===)"),
        ('("labels" (("near" ("x" "y") "1")) ("near" "1" "" swank::%cursor-marker%))', "(near x ===> y <===)"),
        ('("labels" (("near" ("list" "" swank::%cursor-marker%))))', "(labels ===> definitions <=== &body body)"),
        ('("handler-case" "1" ("error" ("e") "" swank::%cursor-marker%))', "(handler-case form &rest ===> clauses <===)"),
        ('("defun" "f" ("list" "" swank::%cursor-marker%))', "(defun name ===> lambda-list <=== &rest body)"),
        ('("case" "x" ("list" "" swank::%cursor-marker%))', "(case key &rest ===> clauses <===)"),
    ],
)
def test_autodoc(emacs, form, shown):
    emacs.repl("(defun go-there (x &key (speed 5)) (list x speed))")
    found = emacs.call(f"(swank:autodoc '{form} :print-right-margin 80)")
    assert found == [shown, True]


def test_autodoc_of_a_variable_tells_its_value(emacs):
    emacs.repl("(defvar *speed-limit* (list 50 :km))")
    shown = "*SPEED-LIMIT* => (50 :KM)"
    assert emacs.call('(swank:autodoc \'("list" "*speed-limit*" swank::%cursor-marker%))') == [shown, None]
    assert emacs.call('(swank:autodoc \'("*speed-limit*" swank::%cursor-marker%))') == [shown, None]
    emacs.repl("(setf *speed-limit* (make-list 99 :initial-element 123456789012345))")
    told = emacs.call('(swank:autodoc \'("list" "*speed-limit*" swank::%cursor-marker%))')[0]
    assert len(told) == 100 and told.endswith("...")
    arglist = "(list &rest ===> items <===)"  # behind a space, or at a name without a value
    assert emacs.call('(swank:autodoc \'("list" "*speed-limit*" "" swank::%cursor-marker%))') == [arglist, True]
    assert emacs.call('(swank:autodoc \'("list" "car" swank::%cursor-marker%))') == [arglist, True]
    assert emacs.call('(swank:autodoc \'("*" swank::%cursor-marker%))')[1] is True  # an operator, though it is a variable, too


def test_autodoc_of_what_nobody_knows(emacs):
    assert emacs.call('(swank:autodoc \'("no-such" "" swank::%cursor-marker%))') == [":not-available", True]
    assert emacs.call('(swank:autodoc \'("" swank::%cursor-marker%))') == [":not-available", True]
    assert emacs.call("(swank:autodoc nil)") == [":not-available", True]
    assert emacs.call('(swank:complete-form \'("no-such" swank::%cursor-marker%))') == ":not-available"
    assert emacs.call('(swank:operator-arglist "no-such" "CL-USER")') is None


def test_arglists(emacs):
    assert emacs.call('(swank:operator-arglist "mapcar" "CL-USER")') == "(mapcar function lst &rest lists)"
    assert emacs.call('(swank:complete-form \'("mapcar" "" swank::%cursor-marker%))') == "function lst lists)"


def test_the_arglist_of_a_plan_is_its_own(emacs):
    emacs.call('(swank:interactive-eval "(cpl:def-cram-function go-there (?place &key (speed 1)) ?place)")')
    assert emacs.call('(swank:operator-arglist "go-there" "CL-USER")') == "(go-there ?place &key (speed 1))"
    emacs.call('(swank:interactive-eval "(defun go-there (&optional x) x)")')
    assert emacs.call('(swank:operator-arglist "go-there" "CL-USER")') == "(go-there &optional x)"


# ---------------------------------------------------------------------------------------------------------------------- finding


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("files")


@pytest.fixture
def files(emacs, folder):
    """A file of Lisp and one of Hy, loaded."""
    lisp, hy = folder / "plans.lisp", folder / "more.hy"
    lisp.write_text(
        "(in-package :cl-user)\n\n(defvar *where-in-looking* 1)\n\n(defun far-away-here (x)\n  (list x *where-in-looking*))\n\n(defmacro done-twice-here (form)\n  `(progn ,form ,form))\n\n"
        "(defclass looked-at-place () ())\n\n(defgeneric visit-place-here (thing))\n(defmethod visit-place-here ((thing looked-at-place)) (far-away-here thing))\n"
        "(defmethod visit-place-here :before ((thing looked-at-place)) (setf *where-in-looking* 2))\n"
    )
    hy.write_text("(require cramhy *)\n(in-package :cl-user)\n\n(defun in-hy-here (x)\n  (far-away-here x))\n")
    for path in (lisp, hy):
        emacs.call(f'(swank:load-file "{path}")')
    return lisp, hy


def where(location):
    """(file name, the text that stands there) of a location."""
    (_, path), (_, position) = location[1], location[2]
    with open(path) as file:
        return path.rpartition("/")[2], file.read()[position - 1 :].partition("\n")[0]


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("far-away-here", [("(DEFUN FAR-AWAY-HERE)", "plans.lisp", "(defun far-away-here (x)")]),
        ("done-twice-here", [("(DEFMACRO DONE-TWICE-HERE)", "plans.lisp", "(defmacro done-twice-here (form)")]),
        ("*where-in-looking*", [("(DEFVAR *WHERE-IN-LOOKING*)", "plans.lisp", "(defvar *where-in-looking* 1)")]),
        ("looked-at-place", [("(DEFCLASS LOOKED-AT-PLACE)", "plans.lisp", "(defclass looked-at-place () ())")]),
        ("in-hy-here", [("(DEFUN IN-HY-HERE)", "more.hy", "(defun in-hy-here (x)")]),
        ("#'far-away-here", [("(DEFUN FAR-AWAY-HERE)", "plans.lisp", "(defun far-away-here (x)")]),
        ("cl-user::far-away-here", [("(DEFUN FAR-AWAY-HERE)", "plans.lisp", "(defun far-away-here (x)")]),
    ],
)
def test_definitions_in_lisp_and_hy(emacs, files, name, found):
    told = emacs.call(f'(swank:find-definitions-for-emacs "{name}")')
    assert [(label, *where(location)) for label, location in told] == found


def test_definitions_of_methods(emacs, files):
    told = emacs.call('(swank:find-definitions-for-emacs "visit-place-here")')
    lines = {where(location)[1] for _, location in told}
    assert (
        "(defgeneric visit-place-here (thing))" in lines
        and "(defmethod visit-place-here :before ((thing looked-at-place)) (setf *where-in-looking* 2))" in lines
    )
    assert any(":BEFORE" in label for label, _ in told)


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("name", "file", "text"),
    [
        ("roslisp:publish", "topics.py", "def publish("),
        ("mapcar", "lists.py", "def mapcar("),
        ("cpl:par", "plan_language.py", '("(par form...)"'),
        ("cpl:with-failure-handling", "plan_language.py", ""),
        ("cramhy_runtime.kernel.sleep", "active.py", "def sleep("),
    ],
)
def test_definitions_in_python(emacs, name, file, text):
    import cramhy_runtime.kernel  # noqa: F401

    told = emacs.call(f'(swank:find-definitions-for-emacs "{name}")')
    assert told and where(told[0][1])[1].startswith(text)


@pytest.mark.soak
def test_definitions_of_what_was_typed_and_of_nothing(emacs):
    emacs.repl("(defun typed-one (x) x)")
    [[label, location]] = emacs.call('(swank:find-definitions-for-emacs "typed-one")')
    assert label == "(DEFUN TYPED-ONE)" and location[1] == [":source-form", "(defun typed-one (x) x)"]
    assert emacs.call('(swank:find-definitions-for-emacs "nothing-of-that-name")') is None
    assert emacs.call('(swank:find-definitions-for-emacs "")') is None
    assert emacs.call('(swank:find-source-location-for-emacs \'(:string "typed-one"))')[0] == ":location"
    assert emacs.call("(swank:find-definition-for-thing '(:inspector 9))") == [":error", "It is not known where this is defined."]


@pytest.mark.soak
def test_uses(emacs, files):
    told = emacs.call('(swank:xref \':calls "far-away-here")')
    assert [(label, where(location)[0]) for label, location in told] == [
        ("(DEFMETHOD VISIT-PLACE-HERE)", "plans.lisp"),
        ("(DEFUN IN-HY-HERE)", "more.hy"),
    ]
    assert [label for label, _ in emacs.call('(swank:xref \':sets "*where-in-looking*")')] == ["(DEFMETHOD VISIT-PLACE-HERE)"]
    assert {label for label, _ in emacs.call('(swank:xref \':references "*where-in-looking*")')} == {
        "(DEFUN FAR-AWAY-HERE)",
        "(DEFMETHOD VISIT-PLACE-HERE)",
    }
    assert {label for label, _ in emacs.call('(swank:xref \':specializes "looked-at-place")')} == {"(DEFMETHOD VISIT-PLACE-HERE)"}
    assert emacs.call('(swank:xref \':binds "*where-in-looking*")') == ":not-implemented"
    assert emacs.call('(swank:xref \':calls "no-such")') is None
    assert [kind for kind, *_ in emacs.call('(swank:xrefs \'(:calls :binds :sets) "far-away-here")')] == [":calls", ":sets"]


# --------------------------------------------------------------------------------------------------------------------- telling


def test_descriptions(emacs):
    emacs.repl('(defun told-of (x) "It is told of." x)')
    assert "It is told of." in emacs.call('(swank:describe-symbol "told-of")')
    assert emacs.call('(swank:describe-function "told-of")').startswith("#<FUNCTION TOLD-OF>")
    assert emacs.call('(swank:describe-definition-for-emacs "told-of" \':function)').startswith("COMMON-LISP-USER::TOLD-OF")
    assert emacs.refused('(swank:describe-function "told-off")').startswith("There is no symbol told-off")
    emacs.repl("(defvar *no-function* 1)")
    assert emacs.refused('(swank:describe-function "*no-function*")').endswith("is no function, no macro and no special operator.")
    assert emacs.call('(swank:documentation-symbol "told-of")') == ("Documentation for the symbol TOLD-OF:\n\nFunction:\n It is told of.\n")
    assert emacs.call('(swank:documentation-symbol "*no-function*")') == "Not documented: *NO-FUNCTION*."
    assert "(par form...)" in emacs.call('(swank:documentation-symbol "cpl:par")')


def test_apropos(emacs):
    emacs.repl('(defun told-of (x) "It is told of." x)')
    [facts] = emacs.call('(swank:apropos-list-for-emacs "told-of" nil nil "CL-USER")')
    assert facts == [":designator", "TOLD-OF", ":function", "It is told of."]
    found = emacs.call('(swank:apropos-list-for-emacs "pursue" t)')
    assert "CRAM-LANGUAGE-IMPLEMENTATION:PURSUE" in [entry[1] for entry in found]
    assert emacs.call('(swank:apropos-list-for-emacs "no-such-name-at-all")') is None


def test_macros(emacs):
    assert emacs.call('(swank:swank-macroexpand-1 "(when a (unless b c))")') == "(IF A\n    (UNLESS B C))"
    assert emacs.call('(swank:swank-macroexpand "(when a (unless b c))")') == "(IF A\n    (UNLESS B C))"
    assert emacs.call('(swank:swank-expand-1 "(when a b)")') == emacs.call('(swank:swank-expand "(when a b)")') == "(IF A\n    B)"
    assert emacs.call('(swank:swank-macroexpand-all "(list (when a (unless b (quote (when c d)))))")').split() == (
        "(LIST (IF A (IF B NIL '(WHEN C D))))".split()
    )
    assert emacs.call('(swank:swank-compiler-macroexpand-1 "(car x)")') == "(CAR X)"
    assert emacs.call('(swank:swank-format-string-expand "~a")') == "~a"


def test_disassembly(emacs):
    emacs.repl("(defun short (x) (* 2 x))")
    assert emacs.call('(swank:disassemble-form "\'short")').startswith("; Python of SHORT\n")


def test_macros_are_indented(emacs):
    emacs.call("(swank-repl:create-repl nil)")
    told = {name: (count, packages) for name, count, packages in emacs.wait_for(":indentation-update")[1]}
    assert told["par"] == (0, ["CRAM-LANGUAGE-IMPLEMENTATION"]) and told["with-failure-handling"][0] == 1
    emacs.repl("(defmacro with-it ((it) &body body) `(let ((,it 1)) ,@body))")
    assert emacs.wait_for(":indentation-update")[1] == [["with-it", 1, ["COMMON-LISP-USER"]]]
    emacs.call("(swank:update-indentation-information)")
    assert len(emacs.wait_for(":indentation-update")[1]) > 40


def test_systems(emacs, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "small.asd").write_text('(defsystem "small" :components ((:file "code")))')
    (tmp_path / "code.lisp").write_text("(in-package :cl-user)\n(defun of-small (x y) x)\n")
    result = emacs.call('(swank:operate-on-system-for-emacs "small" \'load-op)')
    assert result[1][0][3] == ":style-warning" and result[2] is True
    assert emacs.repl("(of-small 1 2)") == "1\n"
    names = emacs.call("(swank:list-asdf-systems)")
    assert "alexandria" in names
    assert emacs.call("(swank:list-all-systems-in-central-registry)") == emacs.call("(swank:list-all-systems-known-to-asdf)") == names


def test_systems_and_their_files(emacs, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "base.asd").write_text('(defsystem "base" :components ((:file "code")))')
    (tmp_path / "top.asd").write_text(
        '(defsystem "top" :depends-on ("base") :components ((:file "more")) :perform (test-op (o c) (format t "The tests have run.~%")))'
    )
    (tmp_path / "code.lisp").write_text("(in-package :cl-user)\n(defvar *loads* 0)\n(incf *loads*)\n")
    (tmp_path / "more.lisp").write_text("(in-package :cl-user)\n(defun more () 1)\n")
    assert emacs.call('(swank:asdf-system-loaded-p "top")') is None
    assert emacs.call('(swank:operate-on-system-for-emacs "top" \'asdf:test-op)')[2] is True
    assert "The tests have run.\n" in [event[1] for event in emacs.events if event[0] == ":write-string"]
    assert emacs.call('(swank:asdf-system-loaded-p "top")') is True
    assert emacs.call('(swank:asdf-system-files "top")') == [str(tmp_path / "top.asd"), str(tmp_path / "more.lisp")]
    assert emacs.call('(swank:asdf-system-directory "top")') == f"{tmp_path}/"
    assert emacs.call(f'(swank:asdf-determine-system "{tmp_path / "code.lisp"}" "CL-USER")') == "base"
    assert emacs.call('(swank:asdf-determine-system nil ":top")') == "top"
    assert emacs.call('(swank:asdf-determine-system "/no/such.lisp" "CL-USER")') is None
    assert emacs.call('(swank:who-depends-on "base")') == ["top"]
    assert emacs.call('(swank:reload-system "base")')[2] is True
    assert emacs.repl("*loads*") == "2\n"
    assert emacs.call('(swank:delete-system-fasls "base")') == "base will be loaded anew."
    emacs.call('(swank:operate-on-system-for-emacs "base" \'load-op)')
    assert emacs.repl("*loads*") == "3\n"
    emacs.call('(swank:operate-on-system-for-emacs "base" \'load-op :force t)')
    assert emacs.repl("*loads*") == "4\n"
    assert "no-such-system" in emacs.refused('(swank:asdf-system-files "no-such-system")')


def test_packages(emacs):
    names = emacs.call("(swank:list-all-package-names)")
    assert "COMMON-LISP-USER" in names and "CL-USER" not in names
    assert "CL-USER" in emacs.call("(swank:list-all-package-names t)")
    emacs.repl("(defpackage :mine (:use :cl))")
    emacs.repl("(defun mine::helper () 1)")
    assert emacs.call('(swank:export-symbol-for-emacs "helper" "MINE")') is True
    assert emacs.repl("(mine:helper)") == "1\n"
    assert emacs.call('(swank:unexport-symbol-for-emacs "helper" "MINE")') is True
    assert emacs.repl('(nth-value 1 (find-symbol "HELPER" :mine))') == ":INTERNAL\n"
    assert emacs.call('(swank:unintern-symbol "helper" "MINE")') == "helper is no longer in MINE."
    assert emacs.repl('(values (find-symbol "HELPER" :mine))') == "NIL\n"


def test_functions_are_traced_and_undefined(emacs):
    emacs.repl("(defun watched (x) x)")
    assert emacs.call('(swank:swank-toggle-trace "watched")') == "WATCHED is now traced."
    assert emacs.repl("(watched 3)") == "  0: (WATCHED 3)\n  0: WATCHED returned 3\n3\n"
    assert emacs.call('(swank:swank-toggle-trace "watched")') == "WATCHED is no longer traced."
    emacs.call('(swank:swank-toggle-trace "watched")')
    emacs.call("(swank:untrace-all)")
    assert emacs.repl("(watched 3)") == "3\n"
    assert emacs.call('(swank:undefine-function "watched")') == "WATCHED"
    assert emacs.repl("(fboundp 'watched)") == "NIL\n"


# ------------------------------------------------------------------------------------------------------------------- inspecting


def content(shown):
    """(title, the text, {label of an action: its number}, [numbers of parts in their order])."""
    _, title, _, _, _, (pieces, *_) = shown
    text = "".join(piece if isinstance(piece, str) and not isinstance(piece, list) else piece[1] for piece in pieces)
    actions = {piece[1]: piece[2] for piece in pieces if isinstance(piece, list) and piece[0] == ":action"}
    return title, text, actions, [piece[2] for piece in pieces if isinstance(piece, list) and piece[0] == ":value"]


@pytest.mark.parametrize(
    ("form", "lines"),
    [
        ("(list 1 2)", ["The object is a proper list of length 2.", "0: 1", "1: 2"]),
        ("(cons 1 2)", ["The object is a CONS.", "CAR: 1", "CDR: 2"]),
        ("(quote car)", ["The object is a SYMBOL.", 'Name:     "CAR"']),
        ("(find-package :cl)", ["The object is a PACKAGE.", 'Name:             "COMMON-LISP"']),
        ("#'car", ["The object is a FUNCTION.", "Lambda-list: "]),
        ("(let ((table (make-hash-table))) (setf (gethash :a table) 1) table)", ["The object is a HASH-TABLE of type EQL.", ":A:    1"]),
        ("(progn (defstruct spot x (y 2)) (make-spot))", ["The object is a STRUCTURE-OBJECT of type SPOT.", "Y:     2"]),
        ("(progn (defclass thing () ((size :initform 3) other)) (make-instance 'thing))", ["SIZE:  3", "OTHER: unbound"]),
        ("(vector 7 8)", ["The object is a VECTOR of length 2.", "0:     7"]),
        ("(make-condition 'simple-error)", ["The object is a CONDITION of type SIMPLE-ERROR."]),
        ("(cpl:make-fluent :name :speed :value 4)", ["Name:                     :SPEED", "Value:                    4", "[pulse it]"]),
        ("(desig:a motion (type driving) (speed 5))", [":SPEED:            5", "Resolution so far: NIL", "[resolve it]"]),
        ("(roslisp:make-message \"geometry_msgs/Point\" :x 1.0)", ["X:     1.0", "Y:     0.0"]),
    ],
)  # fmt: skip
def test_objects_and_their_parts(emacs, form, lines):
    from cramhy_runtime.swank.wire import write

    title, text, *_ = content(emacs.call(f"(swank:init-inspector {write(form)})"))
    for line in lines:
        assert line in text, text


def test_the_way_through_objects(emacs):
    first = emacs.call('(swank:init-inspector "(list (list 1 2) 3)")')
    assert first[:4] == [":title", "((1 2) 3)", ":id", 0]
    assert emacs.call("(swank:inspect-nth-part 1)")[1] == "(1 2)"
    assert emacs.call("(swank:inspector-nth-part 1)") == "1"
    assert emacs.call("(swank:pprint-inspector-part 0)") == "(1 2)"
    assert emacs.call("(swank:inspect-nth-part 2)")[1] == "2"
    assert emacs.call("(swank:inspector-pop)")[1] == "(1 2)"
    assert emacs.call("(swank:inspector-pop)") == first
    assert emacs.call("(swank:inspector-pop)") is None
    assert emacs.call("(swank:inspector-next)")[1] == "(1 2)"
    assert emacs.call('(swank:inspector-eval "(length *)")').startswith("=> 2 ")
    assert emacs.call("(swank:inspector-reinspect)")[1] == emacs.call("(swank:inspector-toggle-verbose)")[1] == "(1 2)"
    assert "* 1 (1 2)" in emacs.call("(swank:inspector-history)")
    assert emacs.call("(swank:inspector-range 0 1)") == [["The object is a proper list of length 2.\n"], 7, 0, 1]
    assert emacs.call("(swank:describe-inspectee)").startswith("(1 2)")
    assert emacs.refused("(swank:inspect-nth-part 77)") == "What is inspected has no part 77."
    assert emacs.refused("(swank:inspector-call-nth-action 5)") == "What is inspected has no action 5."
    assert emacs.call("(swank:quit-inspector)") is None
    assert emacs.refused("(swank:inspector-pop)") == "Nothing is inspected."


def test_a_fluent_is_read_without_its_pulse_and_can_be_pulsed(emacs):
    emacs.repl("(defvar *speed* (cpl:make-fluent :name :speed :value 4))")
    _, _, actions, _ = content(emacs.call('(swank:init-inspector "*speed*")'))
    _, text, *_ = content(emacs.call(f"(swank:inspector-call-nth-action {actions['[pulse it]']})"))
    assert "Pulses:                   1" in text


def test_a_task_and_its_tree(emacs):
    emacs.repl("(defvar *task* nil)")
    emacs.rex('(swank-repl:listener-eval "(cpl:top-level (cpl:with-tags (:tag one (setf *task* one) (sleep 5))))")', thread=":repl-thread")
    emacs.call('(swank:interactive-eval "1")')
    title, text, actions, parts = content(emacs.call('(swank:init-inspector "*task*")'))
    assert "The object is a task." in text and "Status:" in text and "[evaporate it]" in actions
    emacs.call(f"(swank:inspector-call-nth-action {actions['[evaporate it]']})")


def test_parts_of_a_task_are_values_of_lisp(emacs):
    """Its children are a list of tasks, and what a condition keeps as a tuple of Python is a list."""
    emacs.repl("(defvar *parent* nil)")
    form = "(cpl:top-level (cpl:with-tags (:tag one (setf *parent* one) (cpl:par (sleep 5) (sleep 6)))))"
    emacs.rex(f'(swank-repl:listener-eval "{form}")', thread=":repl-thread")
    emacs.call('(swank:interactive-eval "1")')
    _, text, *_ = content(emacs.call('(swank:init-inspector "*parent*")'))
    assert "Children: (#<" in text and "PYTHON" not in text
    _, text, *_ = content(emacs.call('(swank:init-inspector "(make-condition \'simple-error :format-control \\"x\\")")'))
    assert "FORMAT-ARGUMENTS: NIL" in text


def test_a_part_is_shown_on_one_line(emacs):
    _, text, _, parts = content(emacs.call('(swank:init-inspector "(cons (desig:a motion (type driving)) 1)")'))
    assert "CAR: #<A MOTION (TYPE DRIVING)>\n" in text


def test_presentations_are_inspected(emacs):
    emacs.call("(swank:init-presentations)")
    emacs.repl("(list 5)")
    number = next(event[1] for event in emacs.events if event[0] == ":presentation-start")
    assert emacs.call(f"(swank:inspect-presentation {number} t)")[1] == "(5)"
    assert emacs.call(f"(swank:inspect-presentation {number} nil)")[1] == "(5)"
