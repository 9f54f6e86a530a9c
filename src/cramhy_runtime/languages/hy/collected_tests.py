"""pytest's tests in Hy: which files have some, their names in Lisp's spelling, and failed assertions that show their values.

Tests are looked for in the module when it has been imported, and not in its text: functions that a macro made, classes, and
``unittest.TestCase`` count as in Python. Hy mangles ``test-foo->bar`` to ``hyx_test_foo_XgreaterHthan_signXbar``, which begins with no
``test``. So each test has a second name in its module or class, the one that the user wrote, and pytest sees only that one. A file that is
named like one of tests, and has none, is an error of collection.

pytest rewrites the assertions of test files and of registered helpers on Python's syntax tree. `RewritingLoader` does
so with the tree that Hy makes. Such code is compiled in each run and never kept, so it cannot be taken for plain code, or be old.
"""

from __future__ import annotations

import ast
import importlib.machinery
import inspect
import re
from pathlib import Path, PurePath
from typing import Any

import pytest

NO_TESTS = (
    "{file} is named like a file of tests, but there are none in it. A test is a function with a name that begins with {functions}, "
    "a method with such a name in a class {classes}, or one of a unittest.TestCase. If this is a helper, give it another name, or write "
    "(setv __test__ False) in it."
)


def named_like_tests(path: Path, config: Any) -> bool:
    """Whether a ``.hy`` file has a name that pytest takes for one of tests, if it ended in ``.py`` and had ``_`` for ``-``."""
    from _pytest.pathlib import fnmatch_ex

    return any(fnmatch_ex(pattern, _as_python(path)) for pattern in config.getini("python_files"))


def _as_python(path: PurePath) -> PurePath:
    return path.with_name(path.stem.replace("-", "_") + ".py")


def lisp_name(name: str) -> str:
    """A name, mangled or not, as Lisp writes it: ``test-foo->bar``."""
    import hy

    return hy.unmangle(hy.mangle(name)) if name else name


def lisp_names_of_arguments(arguments: list[str]) -> list[str]:
    """The arguments of pytest's command with the names of tests in ``.hy`` files as Lisp writes them, which is how they are collected."""
    return [_argument(argument) if ".hy::" in argument else argument for argument in arguments]


def _argument(argument: str) -> str:
    file, *names = argument.split("::")
    return "::".join([file, *(re.sub(r"^[^\[]+", lambda found: lisp_name(found[0]), name) for name in names)])


class HyModule(pytest.Module):
    """A file of tests in Hy."""

    def _getobj(self) -> Any:
        module = super()._getobj()
        add_lisp_names(self, module)
        return module

    def collect(self) -> Any:
        found = list(super().collect())
        if getattr(self.obj, "__test__", True) and not any(map(_has_tests, found)):
            raise self.CollectError(
                NO_TESTS.format(
                    file=self.path.name,
                    functions=" or ".join(self.config.getini("python_functions")),
                    classes=" or ".join(self.config.getini("python_classes")),
                )
            )
        return found


def _has_tests(node: Any) -> bool:
    return not isinstance(node, pytest.Class) or any(
        node.istestfunction(getattr(node.obj, name, None), name) or name == "runTest" or name.startswith("test") for name in dir(node.obj)
    )


def add_lisp_names(collector: Any, holder: Any) -> None:
    """Give the tests in ``holder``, a module or a class, their names in Lisp as second names, where these differ from Python's."""
    is_test = _is_test_of_unittest if inspect.isclass(holder) and _is_test_case(holder) else _is_test
    for name in dir(holder) if inspect.isclass(holder) else list(vars(holder)):
        lisp = name if name.startswith("__") else lisp_name(name)
        if lisp == name or hasattr(holder, lisp):
            continue
        value = inspect.getattr_static(holder, name)
        if is_test(collector, value, lisp) or is_test(collector, value, name):
            setattr(holder, lisp, value)


def _is_test(collector: Any, value: Any, name: str) -> bool:
    """Whether ``value`` is a test by its name. A pattern of the configuration may have ``_`` where the name has ``-``."""
    return any(
        collector.istestclass(value, spelled) if inspect.isclass(value) else collector.istestfunction(value, spelled)
        for spelled in (name, name.replace("-", "_"))
    )


def _is_test_of_unittest(collector: Any, value: Any, name: str) -> bool:
    return callable(value) and name.startswith("test")  # whatever the patterns of pytest are


def make_item(collector: Any, name: str, value: Any) -> Any:
    """What pytest collects for a name in a file of tests in Hy; ``None``: what it collects otherwise."""
    if collector.getparent(HyModule) is None:
        return None
    if _has_lisp_name(collector.obj, name):
        return []  # it is collected under that
    if inspect.isclass(value):
        if _is_test_case(value):
            add_lisp_names(collector, value)
            return None if inspect.isabstract(value) else _test_case(collector, name, value)
        if _is_test(collector, value, name):
            add_lisp_names(collector, value)
    elif "-" in name and _is_test(collector, value, name) and not collector.istestfunction(value, name):
        return list(collector._genfunctions(name, value))
    return None


def _has_lisp_name(holder: Any, name: str) -> bool:
    lisp = lisp_name(name)
    return lisp != name and hasattr(holder, lisp)


def _is_test_case(value: type) -> bool:
    import unittest

    return issubclass(value, unittest.TestCase)


def _test_case(collector: Any, name: str, value: type) -> Any:
    from _pytest.unittest import UnitTestCase

    class HyTestCase(UnitTestCase):
        """A ``unittest.TestCase`` in Hy."""

        def collect(self) -> Any:
            return [item for item in super().collect() if not _has_lisp_name(self.obj, item.name)]

    return HyTestCase.from_parent(collector, name=name, obj=value)


# -------------------------------------------------------------------------------------------------------------- assertions


class RewritingLoader(importlib.machinery.SourceFileLoader):
    """Imports a module in Hy with assertions that show the values of their parts."""

    config: Any = None

    def get_code(self, fullname: str) -> Any:
        path = self.get_filename(fullname)
        return self.source_to_code(self.get_data(path), path)

    def source_to_code(self, data: Any, path: Any, *, _optimize: int = -1) -> Any:  # type: ignore[override]
        from _pytest.assertion.rewrite import rewrite_asserts
        from ..kept_hy import tree_of

        tree = _Assertions().visit(tree_of(self, data, path))
        rewrite_asserts(tree, data, path, self.config)
        return compile(tree, path, "exec", dont_inherit=True, optimize=_optimize)


class _Assertions(ast.NodeTransformer):
    """Makes assertions of what Hy makes of one that needs statements: ``if not test: assert False``, where ``False`` stands at the test."""

    def visit_If(self, node: ast.If) -> ast.AST:
        match node:
            case ast.If(ast.UnaryOp(ast.Not(), test), [ast.Assert(ast.Constant(False) as false, message) as made], []) if (
                false.lineno,
                false.col_offset,
            ) == (node.lineno, node.col_offset):
                return ast.copy_location(ast.Assert(test, message), made)
        return self.generic_visit(node)


def rewrites(name: str, file: str, config: Any) -> bool:
    """Whether pytest would rewrite the assertions of the module ``name`` if its ``file``, in Hy, were one of Python."""
    from _pytest.assertion.rewrite import assertstate_key

    state = config.stash.get(assertstate_key, None)
    hook = None if state is None else state.hook
    return hook is not None and any(hook._should_rewrite(name, str(path), state) for path in (Path(file), _as_python(Path(file))))
