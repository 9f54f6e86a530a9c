"""A ``.hy`` file in Common Lisp that Python imports: its module shows the Lisp package, as that of a ``.lisp`` file does.

``import simple_plans`` gives a module whose ``drive`` is the function ``drive`` of the package that the file goes into. The definitions
live in the symbols, so a redefinition is seen by Python at once.
"""

from __future__ import annotations

import sys

from ..commonlisp.evaluation.evaluator import PACKAGE
from ..commonlisp.systems import importer


def show_package(name):
    """Let the module ``name``, if it is being imported, show the current package."""
    module = sys.modules.get(name)
    if module is not None and getattr(module, "__spec__", None) is not None and name != "__main__":
        importer.show_package(module, PACKAGE.value)


__all__ = ["show_package"]
