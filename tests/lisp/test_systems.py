"""Systems: the shapes of ``.asd`` files, the order of loading, and what is said about a system that is wrong."""

from __future__ import annotations

import itertools

import pytest

from cramhy_runtime.lisp_core.conditions import CompileError, Condition, Error, FileError
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.systems import systems

_numbers = itertools.count()


class Workspace:
    """A folder below which systems lie; ``log`` is the order in which their files were loaded."""

    def __init__(self, folder, session):
        self.folder, self.session = folder, session
        self.number = next(_numbers)
        self.symbol = sym("CL-USER::*LOAD-ORDER*")
        self.symbol.special, self.symbol.value = True, None

    def name(self, short):
        return f"{short}-{self.number}"

    def system(self, short, options, files=(), folder=None):
        """Write a system whose files note that they are loaded; ``{n}`` in the options is this workspace's number."""
        name = self.name(short)
        home = self.folder / (folder or name)
        home.mkdir(exist_ok=True)
        (home / f"{name}.asd").write_text(f"(defsystem {name} {options.replace('{n}', str(self.number))})")
        for file in files:
            path = home / file
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(f'(push "{path.stem}" cl-user::*load-order*)')
        return name

    def load(self, short, **options):
        self.symbol.value = None
        systems.load_system(self.name(short), **options)
        return list(reversed(list(self.symbol.value or ())))


@pytest.fixture
def workspace(tmp_path, session, monkeypatch):
    monkeypatch.setattr("cramhy_runtime.ros.search_folders.extra_folders", [str(tmp_path)])
    monkeypatch.delenv("ROS_PACKAGE_PATH", raising=False)
    session.package = "CL-USER"
    return Workspace(tmp_path, session)


def test_files_come_in_the_order_in_which_they_stand(workspace):
    workspace.system("plain", ':components ((:file "b") (:file "a"))', ["a.lisp", "b.lisp"])
    assert workspace.load("plain") == ["b", "a"]


def test_dependencies_come_first(workspace):
    workspace.system(
        "deps", ':components ((:file "a" :depends-on ("c")) (:file "b" :depends-on ("a")) (:file "c"))', ["a.lisp", "b.lisp", "c.lisp"]
    )
    assert workspace.load("deps") == ["c", "a", "b"]


def test_serial_and_modules(workspace):
    workspace.system(
        "mods",
        ':serial t :components ((:file "package") (:module "src" :serial t :components ((:file "x") (:file "y")))'
        ' (:module "other" :pathname "elsewhere" :components ((:file "z"))) (:static-file "README"))',
        ["package.lisp", "src/x.lisp", "src/y.lisp", "elsewhere/z.lisp"],
    )
    assert workspace.load("mods") == ["package", "x", "y", "z"]


def test_a_module_without_a_folder_of_its_own(workspace):
    workspace.system("flat", ':components ((:module "src" :pathname "" :components ((:file "x"))))', ["x.lisp"])
    assert workspace.load("flat") == ["x"]


def test_the_pathname_of_a_system(workspace):
    workspace.system("path", ':pathname "src/" :components ((:file "x"))', ["src/x.lisp"])
    assert workspace.load("path") == ["x"]


@pytest.mark.parametrize(
    "options",
    [
        ':name "n" :version "1.0" :author "A <a@b>" :license "BSD" :description "d" :long-description "ld" :depends-on () '
        ':components ((:file "x"))',
        ":components ((:file x))",
        ":components ((:file #:x))",
        ":components ((:file :x))",
        ':components ((:file "x" :description "about"))',
        ':depends-on ((:version "cram-language" "1.0") (:feature :no-such "unknown")) :components ((:file "x"))',
        ':depends-on (:roslisp #:cram-language cl-transforms) :components ((:file "x"))',
    ],
)
def test_shapes_of_defsystem(workspace, options):
    workspace.system("shape", options, ["x.lisp"])
    assert workspace.load("shape") == ["x"]


def test_asdf_defsystem_with_its_package_form(workspace):
    name = workspace.system("prefix", ':components ((:file "x"))', ["x.lisp"])
    asd = workspace.folder / name / f"{name}.asd"
    asd.write_text(f'(in-package :asdf-user)\n; a comment\n(asdf:defsystem "{name}" :components ((:file "x")))')
    assert workspace.load("prefix") == ["x"]


def test_systems_load_what_they_depend_on_once(workspace):
    workspace.system("base", ':components ((:file "base"))', ["base.lisp"])
    workspace.system("left", ':depends-on (base-{n}) :components ((:file "left"))', ["left.lisp"])
    workspace.system("right", ':depends-on ("base-{n}") :components ((:file "right"))', ["right.lisp"])
    workspace.system("top", ':depends-on (left-{n} right-{n}) :components ((:file "top"))', ["top.lisp"])
    assert workspace.load("top") == ["base", "left", "right", "top"]
    assert workspace.load("top") == []


def test_a_changed_file_is_loaded_again_with_those_that_come_after_it(workspace):
    name = workspace.system("changing", ':components ((:file "a") (:file "b") (:file "c"))', ["a.lisp", "b.lisp", "c.lisp"])
    workspace.load("changing")
    (workspace.folder / name / "b.lisp").write_text('(push "new b" cl-user::*load-order*)')
    assert workspace.load("changing") == ["new b", "c"]


def test_a_macro_of_another_system_that_changed_reaches_its_users(workspace):
    tools = workspace.system("tools", ':components ((:file "macros"))', ["macros.lisp"])
    user = workspace.system("user", ':depends-on (tools-{n}) :components ((:file "use"))', ["use.lisp"])
    macros = workspace.folder / tools / "macros.lisp"
    macros.write_text('(defmacro cl-user::tool () "old")')
    (workspace.folder / user / "use.lisp").write_text("(push (cl-user::tool) cl-user::*load-order*)")
    assert workspace.load("user") == ["old"]
    macros.write_text('(defmacro cl-user::tool () "brand new")')
    assert workspace.load("user") == ["brand new"]


def test_force_loads_everything_again(workspace):
    workspace.system("forced", ':components ((:file "a"))', ["a.lisp"])
    workspace.load("forced")
    assert workspace.load("forced", force=True) == ["a"]


def test_secondary_systems_lie_in_the_file_of_the_first(workspace):
    name = workspace.system("main", ':components ((:file "main"))', ["main.lisp", "tests.lisp"])
    asd = workspace.folder / name / f"{name}.asd"
    asd.write_text(asd.read_text() + f'\n(defsystem "{name}/tests" :depends-on ("{name}") :components ((:file "tests")))')
    workspace.symbol.value = None
    systems.load_system(f"{name}/tests")
    assert list(reversed(list(workspace.symbol.value))) == ["main", "tests"]


# ------------------------------------------------------------------------------------------------------------ what is wrong


def text_of(action, kind=Condition):
    with pytest.raises(kind) as caught:
        action()
    return caught.value


def test_an_unknown_system_names_its_neighbours(workspace):
    workspace.system("my-tutorial", ':components ((:file "x"))', ["x.lisp"])
    problem = text_of(lambda: systems.load_system(workspace.name("my-tutorail")))
    assert problem.report() == f'Component "{workspace.name("my-tutorail")}" not found'
    assert f"Did you mean {workspace.name('my-tutorial')}?" in problem.hint


def test_an_unknown_dependency_says_who_wants_it(workspace):
    workspace.system("wanting", ':depends-on ("no-such-system-{n}") :components ((:file "x"))', ["x.lisp"])
    problem = text_of(lambda: workspace.load("wanting"))
    assert problem.report() == (
        f'Component "no-such-system-{workspace.number}" not found, required by #<SYSTEM "wanting-{workspace.number}">'
    )


def test_a_missing_file_is_named(workspace):
    name = workspace.system("missing", ':components ((:file "there") (:file "absent"))', ["there.lisp"])
    assert str(workspace.folder / name / "absent.lisp") in text_of(lambda: workspace.load("missing"), FileError).report()


def test_circles_of_files_and_of_systems(workspace):
    workspace.system("circle", ':components ((:file "a" :depends-on ("b")) (:file "b" :depends-on ("a")))', ["a.lisp", "b.lisp"])
    assert text_of(lambda: workspace.load("circle")).report() == f"Circular dependency in system circle-{workspace.number}: a -> b -> a"
    workspace.system("one", ":depends-on (two-{n})")
    workspace.system("two", ":depends-on (one-{n})")
    n = workspace.number
    assert text_of(lambda: workspace.load("one")).report() == f"Circular dependency: one-{n} -> two-{n} -> one-{n}"
    workspace.system("two", ':components ((:file "x"))', ["x.lisp"])
    assert workspace.load("one") == ["x"]


@pytest.mark.parametrize(
    "options",
    [
        ":components",
        ':components ("x")',
        ":components ((:file))",
        ':components ((:file "a" :depends-on ("q")))',
        ":components 5",
        ":depends-on 5",
        ':depends-on "text"',
        ':components ((:file "a" . 5))',
        "5 5",
        ":components ((5 5))",
        ":components ((:file 5))",
    ],
)
def test_malformed_definitions_are_errors_of_the_user(workspace, options):
    workspace.system("broken", options, ["a.lisp"])
    problem = text_of(lambda: workspace.load("broken"))
    assert isinstance(problem, Error)
    assert "Python" not in problem.report() and problem.report()


def test_a_list_of_components_that_was_forgotten_is_taken_as_meant(workspace):
    workspace.system("forgotten", ':components (:module "src" :components (:file "a") (:file "b"))', ["src/a.lisp", "src/b.lisp"])
    assert workspace.load("forgotten") == ["a", "b"]


def test_an_error_in_a_file_has_its_place_and_the_file_is_tried_again(workspace):
    name = workspace.system("failing", ':components ((:file "a") (:file "b"))', ["a.lisp", "b.lisp"])
    path = workspace.folder / name / "b.lisp"
    path.write_text("\n(let ((x 1 2)) x)")
    problem = text_of(lambda: workspace.load("failing"), CompileError)
    assert problem.position[:2] == (str(path), 2)
    path.write_text('(push "mended" cl-user::*load-order*)')
    assert workspace.load("failing") == ["mended"]


def test_a_broken_asd_file_has_its_place(workspace):
    name = workspace.system("unclosed", ':components ((:file "a"', ["a.lisp"])
    problem = text_of(lambda: workspace.load("unclosed"))
    assert problem.position[0] == str(workspace.folder / name / f"{name}.asd")


def test_ros_load_and_asdf(workspace):
    name = workspace.system("by-hand", ':components ((:file "a"))', ["a.lisp"])
    evaluate = workspace.session.evaluate_text
    assert evaluate(f'(asdf:load-system "{name}")') == [True]
    assert evaluate(f"(asdf:load-system :{name})") == [True]
    assert evaluate(f'(ros-load:load-system "{name}" :{name})') == [True]
    assert evaluate('(asdf:find-system "no-such-thing" nil)') == [None]
    assert evaluate("(require :asdf)") == [None]
