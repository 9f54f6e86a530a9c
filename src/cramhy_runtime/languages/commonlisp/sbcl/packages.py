"""Which names SBCL's packages have here. Each function below makes one package complete; it is called when a program first names
something of the package that is not there yet (`extension_packages.LatePackage`).
"""

from __future__ import annotations

import sys

from cramhy_runtime.cpl.task_variables import define_task_state

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.packages import find_package_or_error, sym
from cramhy_runtime.utilities import threads as utility_threads

from ..packages.face_definition import define_face
from ..reader import readtables
from ..streams import streams
from ..syntax.operator_macros import define, export
from ..types.types import define_type
from ..evaluation.function_facts import lambda_list_of
from ..numbers import float_traps
from . import (
    atomics,
    backtraces,
    deadlines,
    extensions,
    internals,
    interrupts,
    mutexes,
    operators,
    posix,
    reader_internals,
    threads,
    timers,
    weak_pointers,
)


def _setters(package: str, setters: dict[str, object]) -> None:
    for name, setter in setters.items():
        sym(f"{package}::{name.upper()}").setf_function = lispify(setter)


def _macros(package: str) -> None:
    for table in operators.TABLES:
        if table.package == package:
            export(table)
            define(table)


def define_threads() -> None:
    """SB-THREAD, with the functions that the macros of SB-EXT and SB-SYS stand for, too."""
    package = find_package_or_error("SB-THREAD")
    if not package.present("*CURRENT-THREAD*"):
        package.export(define_task_state("SB-THREAD", "*CURRENT-THREAD*", threads.current_thread))
    internal = {
        mutexes: "call-with-mutex call-with-recursive-lock",
        deadlines: "call-with-timeout call-with-deadline wait-until",
        extensions: "define-hash-table-test call-with-locked-table",
        interrupts: "call-uninterrupted call-interrupted call-allowing-interrupts call-locally-interrupted",
        "leave-thread": threads.return_from_thread,
    }
    define_face(
        "SB-THREAD",
        functions={
            threads: """make-thread join-thread interrupt-thread terminate-thread abort-thread main-thread main-thread-p
                thread-ephemeral-p thread-os-tid thread-yield symbol-value-in-thread""",
            utility_threads: "thread-alive-p thread-name",
            "destroy-thread": threads.terminate_thread,
            "list-all-threads": utility_threads.all_threads,
            "thread-error-thread": lambda condition: condition.thread,
            "thread-deadlock-cycle": lambda condition: condition.cycle,
            mutexes: """make-mutex mutex-name mutex-owner holding-mutex-p grab-mutex get-mutex release-mutex make-waitqueue waitqueue-name
                condition-wait condition-notify condition-broadcast""",
            "mutex-value": mutexes.mutex_owner,
            "make-spinlock": mutexes.make_mutex,
            "get-spinlock": mutexes.grab_mutex,
            "release-spinlock": mutexes.release_mutex,
            "release-foreground": extensions.no_effect,
        },
        imports={
            "CRAM-UTILITIES": """semaphore make-semaphore wait-on-semaphore try-semaphore signal-semaphore semaphore-count
                semaphore-name"""
        },
        export="""thread thread-error join-thread-error interrupt-thread-error symbol-value-in-thread-error thread-deadlock mutex waitqueue
            spinlock foreign-thread""",
    )
    define_face("SB-THREAD", functions=internal, internal=" ".join(_names(internal)))
    _macros("SB-THREAD")
    setters = {
        "thread-name": threads.set_thread_name,
        "mutex-name": mutexes.set_mutex_name,
        "waitqueue-name": mutexes.set_waitqueue_name,
        "symbol-value-in-thread": threads.set_symbol_value_in_thread,
    }
    _setters("SB-THREAD", setters)


def _names(functions: dict) -> list[str]:
    return [name for key, value in functions.items() for name in (value.split() if isinstance(value, str) else [key])]


def define_extensions() -> None:
    """The part of SB-EXT that most programs do not name."""
    package = find_package_or_error("SB-EXT")
    if not package.present("*EXIT-HOOKS*"):
        package.export(define_task_state("SB-EXT", "*EXIT-HOOKS*", extensions.exit_hooks, extensions.set_exit_hooks))
    define_face(
        "SB-EXT",
        functions={
            timers: "make-timer schedule-timer unschedule-timer timer-name timer-scheduled-p list-all-timers",
            weak_pointers: "make-weak-pointer weak-pointer-value weak-pointer-p finalize cancel-finalization gc",
            "posix-environ": posix.environ,
            "symbol-global-value": threads.symbol_global_value,
            "timeout-seconds": lambda condition: condition.seconds,
            extensions: """float-nan-p float-infinity-p string-to-octets octets-to-string valid-type-specifier-p defined-type-name-p
                typexpand typexpand-1 get-time-of-day get-bytes-consed dynamic-space-size save-lisp-and-die print-symbol-with-prefix""",
            "typexpand-all": extensions.typexpand,
            "assert-version->=": extensions.assert_version,
            "defconstant-uneql-name": lambda condition: condition.name,
            "defconstant-uneql-old-value": lambda condition: condition.old,
            "defconstant-uneql-new-value": lambda condition: condition.new,
            **dict.fromkeys(
                "purify disable-debugger enable-debugger restrict-compiler-policy describe-compiler-policy spin-loop-hint".split(),
                extensions.no_effect,
            ),
        },
        variables={
            "*evaluator-mode*": sym(":COMPILE"),
            "*after-gc-hooks*": None,
            "*gc-run-time*": 0,
            "*default-external-format*": sym(":UTF-8"),
            "*derive-function-types*": None,
            "*inline-expansion-limit*": 350,
            "*muffled-warnings*": None,
            "*runtime-pathname*": None,
            "*core-pathname*": None,
        },
        export="timeout timer weak-pointer word compiler-note code-deletion-note defconstant-uneql",
        internal="timeout-seconds",
    )
    _macros("SB-EXT")
    for name, expand in atomics.MACROS.items():
        symbol = sym(f"SB-EXT::{name}")
        symbol.package.export(symbol)
        atomics.define(symbol, expand)
    define_type(sym("SB-EXT::WORD"), lambda form, environment: lisp_list(sym("UNSIGNED-BYTE"), 64), "What a register holds.")
    _setters("SB-EXT", {"symbol-global-value": threads.set_symbol_global_value})


def define_system() -> None:
    """SB-SYS."""
    define_face(
        "SB-SYS",
        functions={
            deadlines: "defer-deadline cancel-deadline signal-deadline",
            "wait-until-fd-usable": extensions.wait_until_usable,
            "beep": extensions.no_effect,
        },
        variables={"*stdin*": streams.CONSOLE_INPUT, "*stdout*": streams.CONSOLE_OUTPUT, "*stderr*": streams.CONSOLE_ERROR},
        export="deadline-timeout io-timeout interactive-interrupt",
    )
    _macros("SB-SYS")


def define_posix() -> None:
    """SB-POSIX."""
    define_face("SB-POSIX", functions={posix: posix.NAMES, **posix.OF_FILES}, variables=posix.CONSTANTS, export="syscall-error")
    for name in posix.CONSTANTS:
        sym(f"SB-POSIX::{name}").constant = True


def define_debug() -> None:
    """SB-DEBUG."""
    define_face(
        "SB-DEBUG",
        functions={backtraces: "print-backtrace backtrace list-backtrace backtrace-as-list"},
        variables={"*backtrace-frame-count*": backtraces.MOST},
    )


def define_internals() -> None:
    """What programs use of SB-INT."""
    define_face(
        "SB-INT",
        functions={
            extensions: "constant-form-value fixnump",
            internals: "missing-arg bug",
            "style-warn": conditions.style_warn,
            "get-floating-point-modes": float_traps.modes,
            "set-floating-point-modes": float_traps.set_modes,
            "call-with-float-traps-masked": float_traps.masked,
        },
        variables={"base-char-code-limit": 128},
        export="compiled-program-error bug index package-at-variance truly-dynamic-extent",
        internal="call-with-float-traps-masked",
    )
    sym("SB-INT::BASE-CHAR-CODE-LIMIT").constant = True
    define_type(
        sym("SB-INT::INDEX"), lambda form, environment: lisp_list(sym("MOD"), sym("ARRAY-DIMENSION-LIMIT").value), "A place in a vector."
    )
    _macros("SB-INT")


def define_kernel() -> None:
    """What programs use of SB-KERNEL: the bits of floats, parts of vectors, descriptions of structures."""
    define_face(
        "SB-KERNEL",
        functions={
            internals: """single-float-bits double-float-bits double-float-high-bits double-float-low-bits make-single-float
                make-double-float shrink-vector ub8-bash-copy find-defstruct-description dd-slots dsd-name dsd-type
                structure-raw-slot-data""",
            "%shrink-vector": internals.shrink_vector,
        },
        imports={"SB-INT": "package-at-variance"},
        export="redefinition-warning",
        internal="structure-raw-slot-data",
    )
    _macros("SB-KERNEL")


def define_implementation() -> None:
    """What programs take from SB-IMPL: the parts of a readtable."""
    names = """character-macro-array character-macro-hash-table dispatch-tables assert-not-standard-readtable"""
    functions = {reader_internals: names, "%fun-name": reader_internals.fun_name}
    variables = {"*standard-readtable*": readtables.STANDARD, "*default-external-format*": sym(":UTF-8")}
    define_face("SB-IMPL", functions=functions, variables=variables)
    _setters("SB-IMPL", {"dispatch-tables": reader_internals.set_dispatch_tables})


def define_unix() -> None:
    """What programs ask of SB-UNIX: the current folder."""
    define_face("SB-UNIX", functions={"posix-getcwd/": internals.posix_getcwd})


def define_introspection() -> None:
    """What programs ask of SB-INTROSPECT about functions."""
    names = dict.fromkeys(("function-lambda-list", "function-arglist"), lambda function: lambda_list_of(function_of(function)))
    define_face("SB-INTROSPECT", functions=names)


def define_machine() -> None:
    """What programs ask of SB-VM: sizes in bits."""
    sizes = {"n-word-bits": 64, "n-byte-bits": 8, "n-word-bytes": 8}
    define_face("SB-VM", variables=sizes, export="word")
    define_type(sym("SB-VM::WORD"), lambda form, environment: lisp_list(sym("UNSIGNED-BYTE"), 64), "What a register holds.")
    for name in sizes:
        sym(f"SB-VM::{name.upper()}").constant = True


def define_compiler() -> None:
    """What programs ask of SB-C: the order of bytes, and the conditions of a compiler."""
    variables = {"*backend-byte-order*": sym(f":{sys.byteorder.upper()}-ENDIAN")}
    define_face("SB-C", variables=variables, export="compiler-error fatal-compiler-error")


def define_gray() -> None:
    """SB-GRAY."""
    from . import gray_streams

    gray_streams.define()


def define_metaobjects() -> None:
    """The part of SB-MOP that most programs do not name, and SB-PCL, which has the same names."""
    from . import metaobjects

    metaobjects.define()


MAKERS = {
    "SB-THREAD": define_threads,
    "SB-EXT": define_extensions,
    "SB-SYS": define_system,
    "SB-POSIX": define_posix,
    "SB-DEBUG": define_debug,
    "SB-INT": define_internals,
    "SB-GRAY": define_gray,
    "SB-MOP": define_metaobjects,
    "SB-PCL": define_metaobjects,
    "SB-KERNEL": define_kernel,
    "SB-IMPL": define_implementation,
    "SB-UNIX": define_unix,
    "SB-INTROSPECT": define_introspection,
    "SB-VM": define_machine,
    "SB-C": define_compiler,
}


def complete(name: str) -> None:
    """Make the package ``name`` complete."""
    MAKERS[name]()


__all__ = ["MAKERS", "complete"]
