"""Feature expressions that look at the image: ``cut:function-bound-feature``."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import Symbol, lisp_list, one
from cramhy_runtime.lisp_core.packages import find_package, keyword
from ...printer.print_controls import PACKAGE
from ...packages.package_functions import find_symbol
from ...evaluation.symbols import fboundp


def function_bound_feature(name, package=None):
    """A feature expression that holds if a function ``name`` is defined: for ``#+#.(cut:function-bound-feature "F" "PKG")``.

    ``name`` is a symbol, or a string and ``package`` the package in which it is looked up.
    """
    symbol = name
    if not isinstance(name, Symbol):
        home = PACKAGE.value if package is None else find_package(str(getattr(package, "name", package)))
        symbol = one(find_symbol(str(name), home)) if home is not None else None
    return lisp_list(keyword("OR") if symbol is None or fboundp(symbol) is None else keyword("AND"))
