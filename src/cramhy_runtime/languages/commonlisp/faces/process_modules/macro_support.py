"""What the macros of CRAM-PROCESS-MODULES call, as functions of the package CRAMHY: lists come as Lisp lists."""

from __future__ import annotations

import sys

from cramhy_runtime.lisp_core.data import python_list
from cramhy_runtime.process_modules import modules, registry, running
from ....operators import PROCESS_MODULES
from ...packages.face_definition import define_face, define_meanings


def with_process_module_aliases(aliases, body):
    """``aliases`` is a list of lists (alias module)."""
    return registry.with_process_module_aliases([tuple(pair) for pair in python_list(aliases)], body)


def define():
    """Enter the functions into CRAMHY."""
    define_meanings(PROCESS_MODULES, modules, registry, running, adapters=sys.modules[__name__])
    define_face("CRAMHY", functions={modules: "define-process-module", registry: "register-process-module"})
