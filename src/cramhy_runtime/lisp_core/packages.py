"""Packages: which symbol a name means.

A package maps names to symbols; it may use other packages (and sees their external symbols) and shadow names. NIL and T are
the Python objects ``None`` and ``True``, so a package table may hold them besides `Symbol` objects. Source: ANSI chapter 11;
message texts are SBCL's.
"""

from __future__ import annotations

from operator import attrgetter, is_, itemgetter

from cramhy_runtime.kernel.images import part, per_image
from cramhy_runtime.kernel.typing_names import Any

from .data import Character, Keyword, LispString, Symbol
from .ports import PORTS


class Package:
    """A package. ``internal`` and ``external`` map names to the symbols present in it; ``built_in``: it is part of cramhy.

    ``lends_nicknames``: programs may define packages that are called like its nicknames, which it loses then. So it is with packages
    that the original has only in a program that asks for them, when they have short nicknames; their room uses the full name.
    """

    built_in = lends_nicknames = False

    def __init__(self, name, nicknames=(), use=(), documentation=None):
        self.name = name
        self.nicknames = list(nicknames)
        self.use = list(use)
        self.internal = {}
        self.external = {}
        self.shadowing = {}  # names, in the order in which they were shadowed
        self.locked = False
        self.local_nicknames = {}  # names that mean a package only while this one is current
        self.documentation = documentation
        self.defined = False  # by ``defpackage``, whose second call looks for differences
        self.file = None  # the path of the file in which that stood

    @property
    def used_by(self):
        """The packages that use this one, in order of definition."""
        return [other for other in all_packages() if self in other.use]

    def __repr__(self):
        return f'#<PACKAGE "{self.name}">' if self.name is not None else "#<PACKAGE (deleted)>"

    def __reduce__(self):
        return ensure_package, (self.name,)

    @property
    def names(self):
        return [self.name, *self.nicknames] if self.name is not None else []

    def lookup(self, name):
        """(symbol, status): status is ``"internal"``, ``"external"``, ``"inherited"`` or ``None``."""
        if name in self.external:
            return self.external[name], "external"
        if name in self.internal:
            return self.internal[name], "internal"
        for other in self.use:
            if name in other.external:
                return other.external[name], "inherited"
        return None, None

    def intern(self, name):
        """The symbol ``name`` means here; a new internal one (external in KEYWORD) when there is none."""
        found, status = self.lookup(name)
        if status:
            return found
        if self is KEYWORD:
            symbol = Keyword(name, self)
            self.external[name] = symbol
        else:
            symbol = Symbol(name, self)
            self.internal[name] = symbol
        return symbol

    def present(self, name):
        """Whether a symbol ``name`` is in this package itself, not inherited."""
        return name in self.external or name in self.internal

    def complete(self):
        """Make sure that all external symbols are there; see `PythonPackage`, whose symbols are made when they are asked for."""

    def import_symbol(self, symbol):
        """Make ``symbol`` present here. An equally named other symbol is an error of class package-error."""
        name = symbol_name(symbol)
        found, status = self.lookup(name)
        if status and found is not symbol:
            PORTS.signals.package_error(
                self,
                f"Importing {printed(symbol)} into {self.name} would conflict with {printed(found)}, which is "
                f"already there. Shadow one of them with :shadow or :shadowing-import-from.",
            )
        if not self.present(name):
            self.internal[name] = symbol
            if isinstance(symbol, Symbol) and symbol.package is None:
                symbol.package = self

    def shadowing_import(self, symbol):
        name = symbol_name(symbol)
        self.external.pop(name, None)
        self.internal[name] = symbol
        self.shadowing[name] = True

    def shadow(self, name):
        """Make sure that a symbol ``name`` is present here, whatever is inherited."""
        if not self.present(name):
            self.internal[name] = Symbol(name, self)
        self.shadowing[name] = True
        return self.intern(name)

    def export(self, symbol):
        name = symbol_name(symbol)
        if name in self.external:
            return
        if name not in self.internal:
            self.import_symbol(symbol)
        self.external[name] = self.internal.pop(name)

    def unexport(self, symbol):
        name = symbol_name(symbol)
        if name in self.external:
            self.internal[name] = self.external.pop(name)

    def unintern(self, symbol):
        name = symbol_name(symbol)
        for table in (self.external, self.internal):
            if table.get(name, table) is symbol:
                del table[name]
                self.shadowing.pop(name, None)
                if isinstance(symbol, Symbol) and symbol.package is self:
                    symbol.package = None
                return True
        return None

    def use_package(self, other):
        """Inherit the external symbols of ``other``; a clash of names is an error unless shadowed here."""
        if other is self or other in self.use:
            return
        visible = (self.external, self.internal, *(used.external for used in self.use))
        if shared := set().union(*(other.external.keys() & names.keys() for names in visible)):  # few, of thousands
            self._check_clashes(other, shared)
        self.use.append(other)

    def _check_clashes(self, other, shared):
        for name, symbol in other.external.items():
            found = self.lookup(name)[0] if name in shared else symbol
            if found is not symbol and name not in self.shadowing:
                PORTS.signals.package_error(
                    self,
                    f"{self.name} cannot use {other.name}: both {printed(symbol)} and {printed(found)} would be "
                    f"called {name} in it. Shadow one of them with (:shadowing-import-from PACKAGE #:{name}).",
                )

    def unuse_package(self, other):
        if other in self.use:
            self.use.remove(other)


_packages: dict[str, Package] = per_image({})
_ours: dict[str, Package] = {}
"""The packages of our own code, whose symbols our modules hold: all images have the same, though not all at the same time."""
on_demand: dict = per_image({})
"""Packages that come with cramhy → the system of a library, which is loaded when code names the package to use it, or a function that
makes the package when somebody asks for it."""
finders: list = []
"""Who is asked for a package that nobody has registered: pairs of a function of its name, which registers it and returns it, or returns
``None``, and a function that gives the names of all that it could make, for "did you mean"."""
CURRENT = Symbol("*PACKAGE*")  # that of COMMON-LISP takes its place below


def register(package):
    """Enter ``package`` under its name and nicknames. A name that is taken is a package-error."""
    for name in package.names:
        if _packages.get(name, package) is not package:
            PORTS.signals.package_error(package, f"A package named {name} already exists.")
    for name in package.names:
        _packages[name] = package
    return package


def ensure_package(name, *nicknames, use=()):
    """The package ``name``, registered with its nicknames if it does not exist yet: what a room's ``symbols.py`` calls."""
    return _packages.get(name) or named_package(name) or ours(name, lambda: Package(name, nicknames, use))


def ours(name, make):
    """The package ``name`` of our own code, registered; the first image in which somebody asks makes it by ``make``."""
    found = _ours.get(name)
    if found is None or found.name is None:  # it was deleted
        found = _ours[name] = make()
    return register(found)


def make_package(name, nicknames=(), use=()):
    """A new registered package that uses the packages ``use``."""
    return register(Package(name, nicknames, [find_package_or_error(other) for other in use]))


def delete_package(package):
    """Take ``package`` out of the world: nobody uses it any more, its symbols have no home, it has no name."""
    for name in package.names:
        _packages.pop(name, None)
    for other in list(package.use):
        package.unuse_package(other)
    for table in (package.external, package.internal):
        for symbol in table.values():
            if isinstance(symbol, Symbol) and symbol.package is package:
                symbol.package = None
    package.name = None


def rename_package(package, name, nicknames=()):
    for old in package.names:
        _packages.pop(old, None)
    package.name, package.nicknames = name, list(nicknames)
    return register(package)


def all_packages():
    """Every registered package once, in order of definition."""
    return list(dict.fromkeys(_packages.values()))


def symbol_name(symbol):
    """The name of a symbol, NIL and T included."""
    return "NIL" if symbol is None else "T" if symbol is True else symbol.name


def symbol_package(symbol):
    return COMMON_LISP if symbol is None or symbol is True else symbol.package


def printed(symbol):
    """The full name of a symbol, as messages show it: ``PACKAGE:NAME``, with two colons when it is internal."""
    package, name = symbol_package(symbol), symbol_name(symbol)
    if package is None:
        return f"#:{name}"
    if package is KEYWORD:
        return f":{name}"
    return f"{package.name}{':' if name in package.external else '::'}{name}"


def is_symbol(obj):
    return obj is None or obj is True or isinstance(obj, Symbol)


def string_designator(designator):
    """The string that a string, symbol or character stands for."""
    if designator.__class__ is str:
        return designator
    if is_symbol(designator):
        return symbol_name(designator)
    return str(getattr(designator, "char", designator))


def is_string_designator(thing):
    """Whether ``thing`` is a string, a symbol or a character."""
    return isinstance(thing, (str, LispString, Character)) or is_symbol(thing)


def find_package(designator):
    """The package that a name, symbol or package stands for, or ``None``. A question: no library is loaded to answer it.

    A package of our own that is only made when somebody asks for it counts as there, and is made.
    """
    if isinstance(designator, Package):
        return designator
    name = string_designator(designator)
    nicknames = getattr(CURRENT.value, "local_nicknames", None)
    if nicknames and name in nicknames:
        return nicknames[name]
    maker = on_demand.get(name)
    if callable(maker):
        with our_own:
            maker()
    found = _packages.get(name)
    if found is None and maker is None:
        for find, _ in finders:
            found = found or find(name)
    return found


def named_package(designator):
    """The package that code names in order to use what is in it, or ``None``; a library that defines it is loaded first."""
    found = find_package(designator)
    library = on_demand.get(string_designator(designator)) if found is None else None
    if library is not None:
        PORTS.systems.load(library)
        found = find_package(designator)
    return found


def registered(name):
    """The package called ``name`` if there is one by now; nothing is made on demand."""
    return _packages.get(name)


def defined_by_program(names):
    """Packages called ``names`` are about to be defined: no library is loaded for them any more, and a nickname that was lent is theirs."""
    for name in names:
        on_demand.pop(name, None)
        package = _packages.get(name)
        if package is not None and package.lends_nicknames and package.name != name:
            package.nicknames.remove(name)
            del _packages[name]


def find_package_or_error(designator):
    """The package; a name without one is an error whose restarts may give another."""
    package = named_package(designator)
    if package is None:
        if not is_string_designator(designator):
            return PORTS.signals.type_error(designator, "(OR STRING SYMBOL CHARACTER PACKAGE)")
        return PORTS.signals.package_does_not_exist(designator)
    return package if package.name is not None else PORTS.signals.package_does_not_exist(package)


def near_names(name, candidates, most=3):
    """Names like ``name``, for "did you mean": the closest first."""
    import difflib

    return difflib.get_close_matches(name, list(candidates), n=most, cutoff=0.75)


def package_names():
    """The names and nicknames of all packages that there are or that naming them would make."""
    return list(dict.fromkeys([*_packages, *on_demand, *(name for _, names in finders for name in names())]))


def intern(name, package="COMMON-LISP"):
    """The symbol ``name`` in ``package`` (a name or a `Package`); made there if there is none."""
    found = package if isinstance(package, Package) else _packages.get(package)
    return (found or find_package_or_error(package)).intern(name)


def find_symbol(name, package):
    """Two values as Python sees them: (symbol, status), status ``None`` when not there."""
    return find_package_or_error(package).lookup(name)


_shorthand: dict[str, object] = {}


def sym(designator: str) -> Any:
    """Shorthand for the runtime's own code: ``sym("CAR")``, ``sym("CPL-IMPL::PAR")``, ``sym(":NAME")``."""
    found = _shorthand.get(designator)
    if found is None:
        package, _, name = designator.rpartition(":")
        package = package.rstrip(":")
        if designator.startswith(":"):
            package = "KEYWORD"
        found = _shorthand[designator] = intern(name, package or "COMMON-LISP")
    return found


def keyword(name: str) -> Keyword:
    """The keyword ``:NAME``."""
    symbol: Keyword = KEYWORD.intern(name)
    return symbol


KEYWORD = ours("KEYWORD", lambda: Package("KEYWORD"))
COMMON_LISP = ours("COMMON-LISP", lambda: Package("COMMON-LISP", ["CL"]))
STANDARD_NAMES = """
&allow-other-keys &aux &body &environment &key &optional &rest &whole * ** *** *break-on-signals* *compile-file-pathname*
*compile-file-truename* *compile-print* *compile-verbose* *debug-io* *debugger-hook* *default-pathname-defaults*
*error-output* *features* *gensym-counter* *load-pathname* *load-print* *load-truename* *load-verbose* *macroexpand-hook*
*modules* *package* *print-array* *print-base* *print-case* *print-circle* *print-escape* *print-gensym* *print-length*
*print-level* *print-lines* *print-miser-width* *print-pprint-dispatch* *print-pretty* *print-radix* *print-readably*
*print-right-margin* *query-io* *random-state* *read-base* *read-default-float-format* *read-eval* *read-suppress*
*readtable* *standard-input* *standard-output* *terminal-io* *trace-output* + ++ +++ - / // /// /= 1+ 1- < <= = > >= abort
abs acons acos acosh add-method adjoin adjust-array adjustable-array-p allocate-instance alpha-char-p alphanumericp and
append apply apropos apropos-list aref arithmetic-error arithmetic-error-operands arithmetic-error-operation array
array-dimension array-dimension-limit array-dimensions array-displacement array-element-type array-has-fill-pointer-p
array-in-bounds-p array-rank array-rank-limit array-row-major-index array-total-size array-total-size-limit arrayp ash asin
asinh assert assoc assoc-if assoc-if-not atan atanh atom base-char base-string bignum bit bit-and bit-andc1 bit-andc2 bit-eqv
bit-ior bit-nand bit-nor bit-not bit-orc1 bit-orc2 bit-vector bit-vector-p bit-xor block boole boole-1 boole-2 boole-and
boole-andc1 boole-andc2 boole-c1 boole-c2 boole-clr boole-eqv boole-ior boole-nand boole-nor boole-orc1 boole-orc2 boole-set
boole-xor boolean both-case-p boundp break broadcast-stream broadcast-stream-streams built-in-class butlast byte
byte-position byte-size caaaar caaadr caaar caadar caaddr caadr caar cadaar cadadr cadar caddar cadddr caddr cadr
call-arguments-limit call-method call-next-method car case catch ccase cdaaar cdaadr cdaar cdadar cdaddr cdadr cdar cddaar
cddadr cddar cdddar cddddr cdddr cddr cdr ceiling cell-error cell-error-name cerror change-class char char-code
char-code-limit char-downcase char-equal char-greaterp char-int char-lessp char-name char-not-equal char-not-greaterp
char-not-lessp char-upcase char/= char< char<= char= char> char>= character characterp check-type cis class class-name
class-of clear-input clear-output close clrhash code-char coerce compilation-speed compile compile-file compile-file-pathname
compiled-function compiled-function-p compiler-macro compiler-macro-function complement complex complexp
compute-applicable-methods compute-restarts concatenate concatenated-stream concatenated-stream-streams cond condition
conjugate cons consp constantly constantp continue control-error copy-alist copy-list copy-pprint-dispatch copy-readtable
copy-seq copy-structure copy-symbol copy-tree cos cosh count count-if count-if-not ctypecase debug decf declaim declaration
declare decode-float decode-universal-time defclass defconstant defgeneric define-compiler-macro define-condition
define-method-combination define-modify-macro define-setf-expander define-symbol-macro defmacro defmethod defpackage
defparameter defsetf defstruct deftype defun defvar delete delete-duplicates delete-file delete-if delete-if-not
delete-package denominator deposit-field describe describe-object destructuring-bind digit-char digit-char-p directory
directory-namestring disassemble division-by-zero do do* do-all-symbols do-external-symbols do-symbols documentation dolist
dotimes double-float double-float-epsilon double-float-negative-epsilon dpb dribble dynamic-extent ecase echo-stream
echo-stream-input-stream echo-stream-output-stream ed eighth elt encode-universal-time end-of-file endp enough-namestring
ensure-directories-exist ensure-generic-function eq eql equal equalp error etypecase eval eval-when evenp every exp export
expt extended-char fboundp fceiling fdefinition ffloor fifth file-author file-error file-error-pathname file-length
file-namestring file-position file-stream file-string-length file-write-date fill fill-pointer find find-all-symbols
find-class find-if find-if-not find-method find-package find-restart find-symbol finish-output first fixnum flet float
float-digits float-precision float-radix float-sign floating-point-inexact floating-point-invalid-operation
floating-point-overflow floating-point-underflow floatp floor fmakunbound force-output format formatter fourth fresh-line
fround ftruncate ftype funcall function function-keywords function-lambda-expression functionp gcd generic-function gensym
gentemp get get-decoded-time get-dispatch-macro-character get-internal-real-time get-internal-run-time get-macro-character
get-output-stream-string get-properties get-setf-expansion get-universal-time getf gethash go graphic-char-p handler-bind
handler-case hash-table hash-table-count hash-table-p hash-table-rehash-size hash-table-rehash-threshold hash-table-size
hash-table-test host-namestring identity if ignorable ignore ignore-errors imagpart import in-package incf
initialize-instance inline input-stream-p inspect integer integer-decode-float integer-length integerp interactive-stream-p
intern internal-time-units-per-second intersection invalid-method-error invoke-debugger invoke-restart
invoke-restart-interactively isqrt keyword keywordp labels lambda lambda-list-keywords lambda-parameters-limit last lcm ldb
ldb-test ldiff least-negative-double-float least-negative-long-float least-negative-normalized-double-float
least-negative-normalized-long-float least-negative-normalized-short-float least-negative-normalized-single-float
least-negative-short-float least-negative-single-float least-positive-double-float least-positive-long-float
least-positive-normalized-double-float least-positive-normalized-long-float least-positive-normalized-short-float
least-positive-normalized-single-float least-positive-short-float least-positive-single-float length let let*
lisp-implementation-type lisp-implementation-version list list* list-all-packages list-length listen listp load
load-logical-pathname-translations load-time-value locally log logand logandc1 logandc2 logbitp logcount logeqv
logical-pathname logical-pathname-translations logior lognand lognor lognot logorc1 logorc2 logtest logxor long-float
long-float-epsilon long-float-negative-epsilon long-site-name loop loop-finish lower-case-p machine-instance machine-type
machine-version macro-function macroexpand macroexpand-1 macrolet make-array make-broadcast-stream make-concatenated-stream
make-condition make-dispatch-macro-character make-echo-stream make-hash-table make-instance make-instances-obsolete make-list
make-load-form make-load-form-saving-slots make-method make-package make-pathname make-random-state make-sequence make-string
make-string-input-stream make-string-output-stream make-symbol make-synonym-stream make-two-way-stream makunbound map
map-into mapc mapcan mapcar mapcon maphash mapl maplist mask-field max member member-if member-if-not merge merge-pathnames
method method-combination method-combination-error method-qualifiers min minusp mismatch mod most-negative-double-float
most-negative-fixnum most-negative-long-float most-negative-short-float most-negative-single-float most-positive-double-float
most-positive-fixnum most-positive-long-float most-positive-short-float most-positive-single-float muffle-warning
multiple-value-bind multiple-value-call multiple-value-list multiple-value-prog1 multiple-value-setq multiple-values-limit
name-char namestring nbutlast nconc next-method-p nil nintersection ninth no-applicable-method no-next-method not notany
notevery notinline nreconc nreverse nset-difference nset-exclusive-or nstring-capitalize nstring-downcase nstring-upcase
nsublis nsubst nsubst-if nsubst-if-not nsubstitute nsubstitute-if nsubstitute-if-not nth nth-value nthcdr null number numberp
numerator nunion oddp open open-stream-p optimize or otherwise output-stream-p package package-error package-error-package
package-name package-nicknames package-shadowing-symbols package-use-list package-used-by-list packagep pairlis parse-error
parse-integer parse-namestring pathname pathname-device pathname-directory pathname-host pathname-match-p pathname-name
pathname-type pathname-version pathnamep peek-char phase pi plusp pop position position-if position-if-not pprint
pprint-dispatch pprint-exit-if-list-exhausted pprint-fill pprint-indent pprint-linear pprint-logical-block pprint-newline
pprint-pop pprint-tab pprint-tabular prin1 prin1-to-string princ princ-to-string print print-not-readable
print-not-readable-object print-object print-unreadable-object probe-file proclaim prog prog* prog1 prog2 progn program-error
progv provide psetf psetq push pushnew quote random random-state random-state-p rassoc rassoc-if rassoc-if-not ratio rational
rationalize rationalp read read-byte read-char read-char-no-hang read-delimited-list read-from-string read-line
read-preserving-whitespace read-sequence reader-error readtable readtable-case readtablep real realp realpart reduce
reinitialize-instance rem remf remhash remove remove-duplicates remove-if remove-if-not remove-method remprop rename-file
rename-package replace require rest restart restart-bind restart-case restart-name return return-from revappend reverse room
rotatef round row-major-aref rplaca rplacd safety satisfies sbit scale-float schar search second sequence serious-condition
set set-difference set-dispatch-macro-character set-exclusive-or set-macro-character set-pprint-dispatch set-syntax-from-char
setf setq seventh shadow shadowing-import shared-initialize shiftf short-float short-float-epsilon
short-float-negative-epsilon short-site-name signal signed-byte signum simple-array simple-base-string simple-bit-vector
simple-bit-vector-p simple-condition simple-condition-format-arguments simple-condition-format-control simple-error
simple-string simple-string-p simple-type-error simple-vector simple-vector-p simple-warning sin single-float
single-float-epsilon single-float-negative-epsilon sinh sixth sleep slot-boundp slot-exists-p slot-makunbound slot-missing
slot-unbound slot-value software-type software-version some sort space special special-operator-p speed sqrt stable-sort
standard standard-char standard-char-p standard-class standard-generic-function standard-method standard-object step
storage-condition store-value stream stream-element-type stream-error stream-error-stream stream-external-format streamp
string string-capitalize string-downcase string-equal string-greaterp string-left-trim string-lessp string-not-equal
string-not-greaterp string-not-lessp string-right-trim string-stream string-trim string-upcase string/= string< string<=
string= string> string>= stringp structure structure-class structure-object style-warning sublis subseq subsetp subst
subst-if subst-if-not substitute substitute-if substitute-if-not subtypep svref sxhash symbol symbol-function symbol-macrolet
symbol-name symbol-package symbol-plist symbol-value symbolp synonym-stream synonym-stream-symbol t tagbody tailp tan tanh
tenth terpri the third throw time trace translate-logical-pathname translate-pathname tree-equal truename truncate
two-way-stream two-way-stream-input-stream two-way-stream-output-stream type type-error type-error-datum
type-error-expected-type type-of typecase typep unbound-slot unbound-slot-instance unbound-variable undefined-function
unexport unintern union unless unread-char unsigned-byte untrace unuse-package unwind-protect
update-instance-for-different-class update-instance-for-redefined-class upgraded-array-element-type
upgraded-complex-part-type upper-case-p use-package use-value user-homedir-pathname values values-list variable vector
vector-pop vector-push vector-push-extend vectorp warn warning when wild-pathname-p with-accessors with-compilation-unit
with-condition-restarts with-hash-table-iterator with-input-from-string with-open-file with-open-stream with-output-to-string
with-package-iterator with-simple-restart with-slots with-standard-io-syntax write write-byte write-char write-line
write-sequence write-string write-to-string y-or-n-p yes-or-no-p zerop
"""
"""The 978 external symbols of COMMON-LISP (ANSI 1.9), in lower case: they exist whether or not cramhy defines them."""
COMMON_LISP.external.update({name.upper(): Symbol(name.upper(), COMMON_LISP) for name in STANDARD_NAMES.split()}, NIL=None, T=True)
CURRENT = COMMON_LISP.external["*PACKAGE*"]
COMMON_LISP_USER = ours("COMMON-LISP-USER", lambda: Package("COMMON-LISP-USER", ["CL-USER"], [COMMON_LISP]))
CRAMHY = ours("CRAMHY", lambda: Package("CRAMHY"))  # what macros expand into: functions of the runtime that users do not name


# ------------------------------------------------------------------------------------------------------------------- images

USERS = ("COMMON-LISP-USER", "CRAM-USER", "TESTING-USER", "PYTHON-USER")
"""The packages of our own code whose contents are the user's: each image has its own."""
_DEFINITIONS = ("value", "function", "macro", "setf_function", "plist", "special", "constant", "compiler_data")
_definitions = attrgetter(*_DEFINITIONS)
_functions = itemgetter(_DEFINITIONS.index("function"), _DEFINITIONS.index("setf_function"))
_redefined: dict[Symbol, tuple] = {}  # symbols of ours that users redefined -> what they mean by themselves


def common(symbol):
    """Whether all images share ``symbol``: it is of a package of ours, or nil or t."""
    package = symbol_package(symbol)
    return package is not None and is_ours(package)


def is_ours(package):
    """Whether all images share ``package``: it is one of our own code, and its contents are not the user's."""
    return _ours.get(package.name) is package and package.name not in USERS


class _OurOwn:
    """``with our_own:`` what is defined within comes with us, and is the same in all images."""

    depth = 0

    def __enter__(self):
        self.depth += 1

    def __exit__(self, *problem):
        self.depth -= 1


our_own = _OurOwn()


def redefined(symbol):
    """A program is about to give ``symbol`` another meaning. Of a symbol that all images share, the others keep the old one."""
    if isinstance(symbol, Symbol) and symbol not in _redefined and not our_own.depth and common(symbol):
        _redefined[symbol] = _state_of(symbol)


def was_redefined(symbol):
    """Whether a program gave ``symbol``, which all images share, another meaning than it has by itself."""
    return symbol in _redefined


def _state_of(symbol):
    *others, data = _definitions(symbol)
    return (*others, dict(data) if data else data)


@part
class _Redefinitions:
    """What users made of the symbols that images share: those of our packages, and those that were there when an image was copied."""

    @staticmethod
    def take():
        return {symbol: _definitions(symbol) for symbol in _redefined}

    @staticmethod
    def put(state):
        for symbol, own in _redefined.items():
            before, wanted = _definitions(symbol), state.get(symbol, own)
            if all(map(is_, before, wanted)):
                continue  # as most are, and a change of images shall not take longer for them
            for name, value in zip(_DEFINITIONS, wanted):
                setattr(symbol, name, value)
            if not all(map(is_, _functions(before), _functions(wanted))):
                symbol.function_changed()

    @staticmethod
    def copy(state):
        for package in _users_packages():
            for symbol in (*package.internal.values(), *package.external.values()):
                if isinstance(symbol, Symbol) and symbol.package is package and symbol not in _redefined:
                    _redefined[symbol] = _state_of(symbol)
        return {symbol: _state_of(symbol) for symbol in _redefined}

    @staticmethod
    def new(state):
        return {}


def _users_packages():
    return [package for package in all_packages() if package.name in USERS or _ours.get(package.name) is not package]


@part
class _UsersPackages:
    """What is in the packages whose contents are the user's."""

    @staticmethod
    def take():
        return {package: (package.internal, package.external, package.shadowing, package.use) for package in _users_packages()}

    @staticmethod
    def put(state):
        for package, contents in state.items():
            package.internal, package.external, package.shadowing, package.use = contents

    @staticmethod
    def copy(state):
        return {package: tuple(table.copy() for table in contents) for package, contents in state.items()}
