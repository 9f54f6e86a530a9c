"""What the macros of CRAM-PROCESS-MODULES call, as functions of the package CRAMHY: lists come as Lisp lists."""

from __future__ import annotations

from ..lisp.data import python_list
from ..lisp.faces import define_face
from .modules import define_process_module
from .registry import register_process_module, with_process_module_aliases, with_process_module_registered_running
from .running import with_process_modules_running


def define():
    """Enter the functions into CRAMHY."""
    define_face("CRAMHY", functions={
        "define-process-module": define_process_module,
        "register-process-module": register_process_module,
        "with-process-modules-running": lambda modules, body: with_process_modules_running(python_list(modules), body),
        "with-process-module-aliases": lambda aliases, body: with_process_module_aliases(
            [tuple(pair) for pair in python_list(aliases)], body),
        "with-process-module-registered-running": with_process_module_registered_running,
    })
