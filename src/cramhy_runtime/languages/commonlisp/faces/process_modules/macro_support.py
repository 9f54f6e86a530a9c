"""What the macros of CRAM-PROCESS-MODULES call, as functions of the package CRAMHY: lists come as Lisp lists."""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import python_list
from ...packages.face_definition import define_face
from cramhy_runtime.process_modules.modules import define_process_module
from cramhy_runtime.process_modules.registry import (
    register_process_module,
    with_process_module_aliases,
    with_process_module_registered_running,
)
from cramhy_runtime.process_modules.running import with_process_modules_running


def define():
    """Enter the functions into CRAMHY."""
    define_face(
        "CRAMHY",
        functions={
            "define-process-module": define_process_module,
            "register-process-module": register_process_module,
            "with-process-modules-running": with_process_modules_running,
            "with-process-module-aliases": lambda aliases, body: with_process_module_aliases(
                [tuple(pair) for pair in python_list(aliases)], body
            ),
            "with-process-module-registered-running": with_process_module_registered_running,
        },
    )
