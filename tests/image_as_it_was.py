"""Tests share a process, and so an image of Lisp; what one defines for all must not be there for the next.

Packages of a test's own harm nobody and stay. Taken back is what other tests would meet: the contents of COMMON-LISP-USER, CRAM-USER
and TESTING-USER, the values of Common Lisp's variables, fact groups, generators and validators of locations, classes of designators,
process modules, and the course's system, which extends CRAM's predicates and refuses all locations but its own. Whoever needs it next
loads it anew.
"""

from contextlib import contextmanager

from cramhy_runtime import image
from cramhy_runtime.designators import classes, language_support, locations
from cramhy_runtime.lisp.data import UNBOUND, Symbol
from cramhy_runtime.lisp.packages import COMMON_LISP, COMMON_LISP_USER, find_package
from cramhy_runtime.lisp.systems import systems
from cramhy_runtime.process_modules import registry
from cramhy_runtime.prolog import facts
from cramhy_runtime.testing import plans

COURSE = "cram-my-beginner-tutorial"
_KEPT = ("value", "function", "macro", "setf_function", "plist", "special", "constant", "compiler_data", "reads", "writes")


@contextmanager
def image_as_it_was():
    """A context after which the image is for other tests as it was before; it may be nested."""
    image.boot()
    users = COMMON_LISP_USER, find_package("CRAM-USER"), find_package("TESTING-USER")
    packages = [_Contents(package) for package in users]
    variables = {symbol: symbol.value for name, symbol in COMMON_LISP.external.items()
                 if name.startswith("*") and name.endswith("*") and symbol.value is not UNBOUND}  # some get a value on a later import
    groups = set(facts.fact_group_names())
    registries = [(each, list(each.entries), set(each.disabled)) for each in (locations.generators, locations.validators)]
    types, makers, modules = dict(classes._classes), list(language_support._create_functions), dict(registry._defined)
    yield
    for symbol, value in variables.items():
        symbol.value = value
    for package in packages:
        package.restore()
    for name in facts.fact_group_names():
        if name not in groups and (name.package in users or not name.package.built_in):  # a room that was made on demand keeps its own
            facts.remove_fact_group(name)
    for each, entries, disabled in registries:
        each.entries, each.disabled = entries, disabled
    if classes._classes != types:
        classes._classes.clear()
        for type_, cls in types.items():
            classes.register_designator_class(type_, cls)
    language_support._create_functions[:] = makers
    registry._defined.clear()
    registry._defined.update(modules)
    systems.forget_system(COURSE)
    plans._compiled.clear()  # their definitions may be among what was taken back


class _Contents:
    """The symbols of a package and what they mean."""

    def __init__(self, package):
        self.package, self.use = package, list(package.use)
        self.tables = [(table, dict(table)) for table in (package.internal, package.external, package.shadowing)]
        self.symbols = {symbol: [getattr(symbol, name) for name in _KEPT]
                        for _, table in self.tables for symbol in table.values() if isinstance(symbol, Symbol)}

    def restore(self):
        for other in [each for each in self.package.use if each not in self.use]:
            self.package.unuse_package(other)
        for table, before in self.tables:
            for symbol in [each for name, each in table.items() if name not in before]:
                if isinstance(symbol, Symbol) and symbol.package is self.package:
                    symbol.value = UNBOUND  # code that names it may live on, but not the fluents that it held
            table.clear()
            table.update(before)
        for symbol, values in self.symbols.items():
            for name, value in zip(_KEPT, values):
                setattr(symbol, name, value)
