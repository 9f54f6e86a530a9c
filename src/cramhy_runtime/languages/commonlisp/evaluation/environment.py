"""The environment: what runs where, its limits, and the variables of a session (ANSI 25.2, 25.1.1).

Limits are SBCL's on 64 bits. What a machine says of itself is what ``uname`` tells.
"""

from __future__ import annotations

import gc
import os
import sys

from cramhy_runtime.lisp_core.conditions import error, type_error
from cramhy_runtime.lisp_core.data import NO_VALUES, Character, LispString, list_from
from cramhy_runtime.lisp_core.packages import is_symbol, string_designator, sym
from ..files.file_streams import open_
from ..streams.streams import CONSOLE_OUTPUT, STANDARD_INPUT, STANDARD_OUTPUT, BroadcastStream, EchoStream, standard_output
from .process_usage import peak_memory

LISP_NAMES = """lisp-implementation-type lisp-implementation-version machine-type machine-instance machine-version software-type
software-version short-site-name long-site-name room ed dribble provide"""
EXTENSION_NAMES = "posix-getenv run-program"
"""Names of the package SB-EXT."""

_MOST = 2**62
CONSTANTS = {
    "ARRAY-DIMENSION-LIMIT": _MOST - 3,
    "ARRAY-TOTAL-SIZE-LIMIT": _MOST - 3,
    "ARRAY-RANK-LIMIT": 129,
    "CHAR-CODE-LIMIT": 0x110000,
    "CALL-ARGUMENTS-LIMIT": _MOST - 1,
    "LAMBDA-PARAMETERS-LIMIT": _MOST - 1,
    "MULTIPLE-VALUES-LIMIT": _MOST - 1,
    "LAMBDA-LIST-KEYWORDS": list_from(
        [sym(name) for name in "&ALLOW-OTHER-KEYS &AUX &BODY &ENVIRONMENT &KEY &OPTIONAL &REST &WHOLE".split()]
    ),
}
MODULES = sym("*MODULES*")
VARIABLES = {**CONSTANTS, "*MODULES*": None, **dict.fromkeys("* ** *** + ++ +++ / // /// -".split())}
EXTENSION_VARIABLES = {"*POSIX-ARGV*": list_from(sys.argv)}


def lisp_implementation_type():
    return "cramhy"


def lisp_implementation_version():
    import cramhy_runtime

    return cramhy_runtime.__version__


def _system(field):
    """What the system says of itself: a field of ``os.uname``; where that is missing, what `platform` finds out instead."""
    if hasattr(os, "uname"):
        return getattr(os.uname(), field)
    import platform  # only here: it takes a hundredth of the time that a session takes to start

    return getattr(platform.uname(), {"sysname": "system", "nodename": "node"}.get(field, field))


def machine_type():
    return _system("machine").upper().replace("_", "-") or None


def machine_instance():
    return _system("nodename") or None


def machine_version():
    import platform

    return platform.processor() or None


def software_type():
    return _system("sysname") or None


def software_version():
    return _system("release") or None


def short_site_name():
    """Nobody has said which site this is."""
    return None


long_site_name = short_site_name


def room(detail=sym(":DEFAULT")):
    """``room``: print how much memory the process uses, and with t how many objects Python's collector knows; no values."""
    used = peak_memory()
    output = standard_output()
    output.fresh_line()
    output.write("Dynamic space usage is:   " + ("not told by this system.\n" if used is None else f"{used:,} bytes at most so far.\n"))
    if detail is not None:
        output.write(f"Garbage collection is currently {'enabled' if gc.isenabled() else 'disabled'}.\n")
    if detail is True:
        output.write(f"The collector watches {len(gc.get_objects()):,} objects.\n")
    return NO_VALUES


def ed(target=None):
    return error(
        "Don't know how to ED ~A: cramhy has no editor. Edit the file with your own, and load it with (LOAD ~S).", target, "file.lisp"
    )


def provide(module):
    """``provide``: note that the module of that name, a string designator, is here."""
    if not (is_symbol(module) or isinstance(module, (str, LispString, Character))):
        return type_error(module, "(OR STRING SYMBOL CHARACTER)")
    name = string_designator(module)
    if name not in (MODULES.value or ()):
        MODULES.value = list_from([name, *(MODULES.value or ())])
    return True


# --------------------------------------------------------------------------------------------------------------- dribbling

_dribbling: list = []
"""(file, standard input, standard output before), the last one last."""


def dribble(pathname=None, *, if_exists=":APPEND"):
    """``dribble``: record the session in a file, what is printed and what is read; without ``pathname`` end that.

    At the prompt the console writes to the file what it shows and what is typed.

    Errors: to end what was not begun, and a file that cannot be written.
    """
    if pathname is not None:
        if_exists = sym(if_exists) if isinstance(if_exists, str) else if_exists
        file = open_(pathname, direction=sym(":OUTPUT"), if_exists=if_exists, if_does_not_exist=sym(":CREATE"))
        _dribbling.append((file, STANDARD_INPUT.value, STANDARD_OUTPUT.value))
        if STANDARD_OUTPUT.value is CONSOLE_OUTPUT:
            CONSOLE_OUTPUT.copies.append(file)
        else:
            STANDARD_OUTPUT.value = BroadcastStream(STANDARD_OUTPUT.value, file)
        STANDARD_INPUT.value = EchoStream(STANDARD_INPUT.value, file)
        return None
    if not _dribbling:
        return error("not currently dribbling")
    file, STANDARD_INPUT.value, STANDARD_OUTPUT.value = _dribbling.pop()
    if file in CONSOLE_OUTPUT.copies:
        CONSOLE_OUTPUT.copies.remove(file)
    file.close()
    return None


# -------------------------------------------------------------------------------------------------------- of SBCL's SB-EXT


def posix_getenv(name):
    """``sb-ext:posix-getenv``: the value of the environment variable, nil if it is not set."""
    return os.environ.get(str(name))


def run_program(program, arguments=None, *, search=None, **options):
    """``sb-ext:run-program``: there is none."""
    return error("Cannot run ~S: cramhy runs no other programs from Lisp. From Python use subprocess.", program)
