"""What can go wrong with packages: conflicts of names, and locks.

A *name conflict* arises when one name would mean two symbols in a package; it is signalled before anything is changed, with
restarts that decide which symbol the name means (ANSI 11.1.1.2.5). A *locked* package belongs to the system: its symbols cannot
be given other meanings by mistake, and it does not change; a restart or ``without-package-locks`` goes ahead all the same (ANSI
11.1.2.1.2). Classes, texts and restarts are those of SBCL 2.2.9.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.ports import PORTS
from cramhy_runtime.lisp_core.printing import prin1_to_string
from contextlib import contextmanager

from cramhy_runtime.lisp_core.condition_types import PackageError, formatted
from cramhy_runtime.lisp_core.conditions import error, restart_case
from cramhy_runtime.lisp_core.data import UNBOUND, Cons, Symbol, list_from
from cramhy_runtime.lisp_core.dynamic import binding, special
from cramhy_runtime.lisp_core.packages import (
    COMMON_LISP,
    COMMON_LISP_USER,
    KEYWORD,
    ensure_package,
    is_symbol,
    redefined,
    sym,
    symbol_name,
    symbol_package,
)
from ..streams.streams import QUERY_IO, output_stream

PACKAGE = special("*PACKAGE*", COMMON_LISP_USER)
IMPLEMENTATION = ensure_package("SB-IMPL")
KEEP_OLD, TAKE_NEW, SHADOWING_IMPORT_IT, DONT_IMPORT_IT, RESOLVE_CONFLICT = map(
    IMPLEMENTATION.intern, ("KEEP-OLD", "TAKE-NEW", "SHADOWING-IMPORT-IT", "DONT-IMPORT-IT", "RESOLVE-CONFLICT")
)
SB_EXT = ensure_package("SB-EXT")
UNLOCK_PACKAGE, IGNORE_ALL = SB_EXT.intern("UNLOCK-PACKAGE"), IMPLEMENTATION.intern("IGNORE-ALL")
for _name in ("NAME-CONFLICT", "PACKAGE-DOES-NOT-EXIST", "PACKAGE-LOCK-VIOLATION", "PACKAGE-LOCKED-ERROR", "SYMBOL-PACKAGE-LOCKED-ERROR"):
    SB_EXT.export(SB_EXT.intern(_name))
_unlocked = special(Symbol("*UNLOCKED-PACKAGES*"), None)


class SimplePackageError(PackageError):
    """An operation that the package does not allow."""

    lisp_name = "SB-KERNEL::SIMPLE-PACKAGE-ERROR"


class NameConflict(PackageError):
    """One name would mean several symbols in ``package``; ``function`` and ``datum`` say who wanted that."""

    lisp_name = "SB-EXT::NAME-CONFLICT"
    initargs = {**PackageError.initargs, "FUNCTION": "function", "DATUM": "datum", "SYMBOLS": "symbols"}

    def __init__(self, package=None, function=None, datum=None, symbols=None, **slots):
        super().__init__(package, **slots)
        self.function, self.datum, self.symbols = function, datum, symbols
        self.hint = "Choose with a restart, or say in the package definition which one is meant, with :shadow or :shadowing-import-from."

    def report(self):
        with binding(PACKAGE, KEYWORD):
            symbols = list_from([Cons(prin1_to_string(symbol)) for symbol in self.symbols])
            symbol = prin1_to_string(self.datum)
        datum = symbol if is_symbol(self.datum) else prin1_to_string(self.datum)
        return formatted(
            "~@<~S ~A causes name-conflicts in ~S between the following symbols: ~2I~@:_~{~{~A~}~^, ~}~:@>",
            (self.function, datum, self.package, symbols),
        )


class PackageLockViolation(PackageError):
    lisp_name = "SB-EXT::PACKAGE-LOCK-VIOLATION"
    within = None
    """The package that was current when the lock was violated."""

    def report(self):
        where = f" while in package {(self.within or PACKAGE.value).name}."
        return formatted(
            f"~@<Lock on package {self.package.name} violated when ~?{where}~:@>",
            (self.format_control, list_from(self.format_arguments or ())),
        )


class PackageLockedError(PackageLockViolation):
    lisp_name = "SB-EXT::PACKAGE-LOCKED-ERROR"


class SymbolPackageLockedError(PackageLockViolation):
    lisp_name = "SB-EXT::SYMBOL-PACKAGE-LOCKED-ERROR"
    initargs = {**PackageLockViolation.initargs, "SYMBOL": "symbol"}
    symbol = UNBOUND


# -------------------------------------------------------------------------------------------------------------- conflicts


def name_conflict(package, function, datum, symbols, choices, resolve):
    """Signal that ``symbols`` have one name in ``package``.

    function: the Lisp name of the operation, ``"USE-PACKAGE"``; datum: what it was given. choices: (restart name, function,
    report). resolve: is called with the symbol that the user chose. Returns when one of these has settled it.
    """
    restarts = [*choices]
    if resolve is not None:
        restarts.append((RESOLVE_CONFLICT, resolve, "Resolve conflict.", lambda: (_ask_which(symbols),)))
    restart_case(restarts, lambda: error(NameConflict(package, sym(function), datum, symbols)))


def _ask_which(symbols):
    output = output_stream(QUERY_IO.value)
    with binding(PACKAGE, KEYWORD):
        output.write("Select a symbol to be made accessible:\n")
        for number, symbol in enumerate(symbols, 1):
            output.write(f"  {number}. {prin1_to_string(symbol)}\n")
    while True:
        chosen = PORTS.user.form(f"Enter an integer (between 1 and {len(symbols)}): ")
        if isinstance(chosen, int) and 1 <= chosen <= len(symbols):
            return symbols[chosen - 1]


# ------------------------------------------------------------------------------------------------------------------ locks


def locked(package):
    """Whether the lock of ``package`` is on and not lifted here.

    It does not hold for forms that are in the package itself (SBCL's manual, "Implementation Packages"), that of COMMON-LISP apart."""
    if package is None or not package.locked or PACKAGE.value is package and package is not COMMON_LISP:
        return False
    lifted = _unlocked.value
    return lifted is not True and (lifted is None or package not in lifted)


@contextmanager
def unlocked(packages=True):
    """Lift the locks of ``packages`` (``True``: all) for the extent of the block."""
    outer = _unlocked.value
    with binding(_unlocked, True if packages is True or outer is True else [*packages, *(outer or ())]):
        yield


def check_package(package, control, *arguments):
    """Signal, if ``package`` is locked, that it is about to be changed: ``check_package(package, "interning ~A", name)``."""
    if package.locked and locked(package):
        violated(PackageLockedError(package, control, *arguments))


def check_symbol(symbol, control, *arguments):
    """Signal, if the home package of ``symbol`` is locked, that the symbol is about to get another meaning; and note that it does."""
    redefined(symbol)
    package = symbol_package(symbol) if is_symbol(symbol) else None
    if package is not None and package.locked and locked(package):
        condition = SymbolPackageLockedError(package, control, *arguments, symbol=symbol)
        condition.hint = (
            f"Choose another name, or shadow the symbol: (:shadow #:{symbol_name(symbol).lower()}) in the definition of your package."
        )
        violated(condition)


def check_function_name(name, control):
    """As `check_symbol`, for the name of a function: a symbol or ``(setf symbol)``."""
    check_symbol(name.cdr.car if isinstance(name, Cons) else name, control, name)


def violated(condition):
    """Signal a lock violation; returns when a restart says to go ahead."""
    condition.within = PACKAGE.value

    def unlock():
        condition.package.locked = False

    restart_case(
        [
            (sym("CONTINUE"), lambda: None, "Ignore the package lock."),
            (IGNORE_ALL, lambda: None, "Ignore all package locks in the context of this operation."),
            (UNLOCK_PACKAGE, unlock, "Unlock the package."),
        ],
        lambda: error(condition),
    )
