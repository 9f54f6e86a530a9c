"""Generic functions and methods.

A `GenericFunction` is called like any function. It looks up the effective function (the applicable methods, put together by
the method combination) under the classes of the arguments at the positions on which any method specializes, so a call costs
one dictionary look-up once it has been made with such arguments. ``(eql x)`` specializers are looked up in a second table.

How methods are called (for the compiler): a method that uses neither ``call-next-method`` nor ``next-method-p`` is added with
``uses_next=False`` and called as ``function(*arguments)``. Otherwise it is called as ``function(next, *arguments)``: ``(call-next-
method)`` is ``next()``, ``(call-next-method a b)`` is ``next(a, b)``, and ``(next-method-p)`` is ``next.exists`` (``True`` or ``None``).
With ``uses_next=DIRECTLY`` it is called so, too, but ``next`` is the function of the next method itself, and the method gives it all
arguments (`method_combination` has the other kinds). A lambda list with ``&key`` is compiled as if it said ``&allow-other-keys``: which
keywords a call may have is checked here, because all applicable methods together decide it (ANSI 7.6.5).

Runtime rooms make generic functions with `generic` and ``@function.method(Class, ...)``. Source: ANSI 7.6; texts are SBCL's.
"""

from __future__ import annotations

import weakref

from ..classes import when_classes_change
from ..conditions import SimpleError, error, program_error, restart_case, wrong_argument_count
from ..data import UNSUPPLIED, Cons, Keyword, UndefinedFunction, lisp_list, list_from, python_list
from ..equality import eql_key
from ..functions import invalid_function_name
from .generic_errors import incongruent, no_applicable_method_error, refuse_ordinary
from ..keyword_calls import lispify
from .keyword_checks import checking_keys
from .method_combination import STANDARD, Combination, find_combination
from .reached_slots import ReachedSlots
from .methods import EqlSpecializer, Method, Shape, class_by_value, class_for_dispatch, generic_lambda_list, specializer_of
from .methods import is_told_by_value, may_be_told_by_value
from ..packages import is_symbol, keyword, our_own, redefined, sym, symbol_name
from ..ports import PORTS
from ..python_names import python_name

all_generic_functions = weakref.WeakSet()
_with_known_calls = weakref.WeakSet()  # whose cache may hold something: far fewer, and each definition of a class goes through them


@when_classes_change
def _forget_dispatch():
    while _with_known_calls:
        function = _with_known_calls.pop()
        if function.cache:  # on which arguments the methods specialize is no matter of the classes
            function.cache = {}
            function.tell_callers()


class FunctionObject:
    """GENERIC-FUNCTION: the root of the classes of generic functions."""

    lisp_name = "GENERIC-FUNCTION"


class GenericFunction(ReachedSlots, FunctionObject):
    """A generic function. Calls are in the subclasses; an instance changes its class when its way of dispatching changes.

    Python looks for ``__call__`` in the class alone. One class whose ``__call__`` asks the instance how to dispatch would make a call
    with one argument slower by a fifth, and a direct one (`call_directly`) more than twice as slow.
    """

    lisp_name = "STANDARD-GENERIC-FUNCTION"

    def __init__(self, name, lambda_list=None):
        self.__lisp_name__ = name
        self.__name__ = self.__qualname__ = python_name(symbol_name(name.cdr.car if isinstance(name, Cons) else name))
        self.__doc__ = None
        self.lambda_list = lambda_list
        self.shape = Shape(lambda_list)
        self.methods: list[Method] = []
        self.own_methods: list[Method] = []  # those of our code, which all images have
        self.user_methods = 0
        self.combination: Combination = STANDARD
        self.combination_options: tuple = ()
        self.precedence = None
        self.from_defgeneric: list = []
        self.forget()
        all_generic_functions.add(self)

    by_protocol = False
    """Whether the function is of a class of a user's, which says how calls are made."""
    method_class = None
    """What makes a new `Method` one of a user's class, or ``None``."""
    watcher = direct = direct_methods = enclosure = None
    advice: str | None = None
    """What the error that no method is applicable tells the user to do."""

    def lisp_init(self, name=None, lambda_list=None, method_class=None):
        """What ``make-instance`` does."""
        GenericFunction.__init__(self, name, lambda_list)
        if method_class is not None:
            self.method_class = PORTS.definitions.maker_of_methods(method_class)

    def enclose(self, enclosure):
        """Let ``enclosure(effective function)`` make the calls in which a method of a user takes part. Returns the argument."""
        self.enclosure = enclosure
        self.forget()
        return enclosure

    def call_directly(self, function):
        """Let ``function`` make all calls, without any dispatch, as long as the methods are those that there are now.

        It must be the only method. When somebody adds a method, calls are dispatched; when that is removed, they are direct again.
        The function takes any arguments, so that it can hand those to `refuse` that do not fit. Returns the function.
        """
        assert [method.function for method in self.methods] == [function]
        call = staticmethod(function)  # then Python calls the function itself, which costs less than a method that passes the call on
        self.direct, self.direct_methods = type("DirectGeneric", (GenericFunction,), {"__call__": call}), list(self.methods)
        self.forget()
        return function

    def refuse(self, *arguments):
        """Signal the error of a call with ``arguments``, their number or that no method applies; ``UNSUPPLIED`` ones were not given."""
        given = [argument for argument in arguments if argument is not UNSUPPLIED]
        return self.lookup(given)(*given)

    def watch(self, watcher):
        """Let ``watcher(effective function, arguments, keywords)`` make all calls from now on; ``None`` ends that. For ``trace``."""
        self.watcher = watcher
        self.forget()

    def forget(self):
        """Forget all effective functions, and find out anew on which arguments the methods specialize."""
        self.cache: dict = {}
        self.tell_callers()
        positions = sorted(
            {index for method in self.methods for index, specializer in enumerate(method.specializers) if specializer is not object}
        )
        self.positions = tuple(positions)
        self.eql_keys = {
            index: {method.specializers[index].key for method in self.methods if method.specializers[index].__class__ is EqlSpecializer}
            for index in positions
        }
        self.eql_positions = tuple(index for index in positions if self.eql_keys[index])
        self.sized = [index for index in positions if any(is_told_by_value(method.specializers[index]) for method in self.methods)]
        self.minimum, self.maximum = self.shape.required, self.shape.maximum
        fixed = self.minimum == self.maximum
        if self.by_protocol:
            self.discriminating = None
        elif self.watcher is not None:
            self.__class__ = _WatchedGeneric
        elif self.direct is not None and self.methods == self.direct_methods:
            self.__class__ = self.direct
        elif len(positions) == 1 and fixed and self.minimum < 3:
            self.__class__ = {(0, 1): UnaryGeneric, (0, 2): FirstOfTwo, (1, 2): _SecondOfTwo}[positions[0], self.minimum]
        elif positions == [0]:
            self.__class__ = _FirstGeneric
        elif positions == [0, 1]:
            self.__class__ = _TwoGeneric
        else:
            self.__class__ = _ManyGeneric

    # ------------------------------------------------------------------------------------------------------------- dispatch

    def lookup(self, arguments):
        """The effective function for ``arguments``, from the cache or computed; wrong argument counts are errors."""
        if len(arguments) < self.minimum or (self.maximum is not None and len(arguments) > self.maximum):
            return wrong_argument_count(len(arguments))
        key = self.cache_key(arguments)
        found = self.cache.get(key)
        if found is None:
            # Only classes for which eql methods exist need the second look-up.
            relevant = [index for index in self.eql_positions if self._eql_possible(index, arguments[index])]
            sized = [index for index in self.sized if may_be_told_by_value(arguments[index].__class__)]
            found = (
                self._by_values(relevant, sized) if sized else self._by_value(relevant) if relevant else self.effective_function(arguments)
            )
            if found is None:
                return lambda *arguments: no_applicable_method(self, arguments)
            self.cache[key] = found
            _with_known_calls.add(self)
            self.tell_callers(found=True)
        return found

    def _eql_possible(self, index, argument):
        cls = argument.__class__
        return any(
            method.specializers[index].value.__class__ is cls
            for method in self.methods
            if method.specializers[index].__class__ is EqlSpecializer
        )

    def _by_value(self, positions):
        """The dispatch on the values at ``positions``, where (eql x) methods exist. The classes there are fixed already."""
        if len(positions) > 1:
            return self._by_values(positions)
        (index,) = positions
        known, table = self.eql_keys[index], {}

        def dispatch(*arguments, **keywords):
            key = eql_key(arguments[index])
            effective = table.get(key)
            if effective is None:
                key = key if key in known else known_as_other
                effective = table.get(key)
                if effective is None:
                    effective = self.effective_function(arguments)
                    if effective is None:
                        return no_applicable_method(self, arguments)
                    table[key] = effective
            return effective(*arguments, **keywords)

        known_as_other = ("any other value",)
        return dispatch

    def _by_values(self, positions, sized=()):
        """The dispatch on the values at ``positions``, and on whether the integers at the positions ``sized`` are fixnums, or
        the classes there classes of conditions."""
        table: dict = {}
        known = [(index, self.eql_keys[index]) for index in positions]

        def dispatch(*arguments, **keywords):
            key = tuple([value if value in keys else None for value, keys in [(eql_key(arguments[index]), keys) for index, keys in known]])
            if sized:
                key += tuple([class_by_value(arguments[index]) for index in sized])
            effective = table.get(key)
            if effective is None:
                effective = self.effective_function(arguments)
                if effective is None:
                    return no_applicable_method(self, arguments)
                table[key] = effective
            return effective(*arguments, **keywords)

        return dispatch

    def cache_key(self, arguments):
        return tuple(arguments[index].__class__ for index in self.positions)

    def applicable_methods(self, arguments):
        """The methods that apply to ``arguments``, most specific first."""
        required = arguments[: self.shape.required]
        mros = [
            PORTS.classes.precedence(class_by_value(argument) if index in self.sized else class_for_dispatch(argument))
            for index, argument in enumerate(required)
        ]
        keys = [eql_key(argument) if index in self.eql_positions else None for index, argument in enumerate(required)]
        order = self.precedence or range(len(required))
        found = [method for method in self.methods if method.applies(mros, keys)]
        found.sort(key=lambda method: method.rank(mros, order))
        return found

    def effective_function(self, arguments):
        """The callable for arguments of these classes; ``None`` when no method applies."""
        methods = self.applicable_methods(arguments)
        if not methods and not self.combination.accepts_none:
            return None
        effective = self.combination.effective(self, methods, tuple(argument.__class__ for argument in arguments))
        if self.enclosure is not None and any(method not in self.own_methods for method in methods):
            effective = self.enclosure(effective)
        if self.shape.has_keys and methods:
            return checking_keys(self, effective, methods)
        return effective

    # ------------------------------------------------------------------------------------------------- for Python rooms

    def method(self, *specializers, qualifier=None, uses_next=False):
        """Decorator: add the Python function as a method for these classes; ``None`` stands for any object.

        qualifier: ``"before"``, ``"after"``, ``"around"`` or another name; uses_next: the function takes ``next`` first.
        """
        classes = [object if specializer is None else specializer for specializer in specializers]

        def define(function):
            qualifiers = () if qualifier is None else (keyword(qualifier.upper()),)
            add_method(self, qualifiers, classes, lispify(function), uses_next=uses_next, lambda_list=self.lambda_list, user=False)
            return function

        return define


class UnaryGeneric(GenericFunction):
    by_object, by_first_of = True, 1

    def __call__(self, *arguments, **keywords):
        try:
            (argument,) = arguments
            effective = self.cache[argument.__class__]
        except (KeyError, ValueError):
            effective = self.lookup(arguments)
        return effective(*arguments, **keywords)

    def cache_key(self, arguments):
        return arguments[0].__class__


class FirstOfTwo(UnaryGeneric):
    by_object, by_first_of = False, 2

    def __call__(self, *arguments, **keywords):
        try:
            argument, _ = arguments
            effective = self.cache[argument.__class__]
        except (KeyError, ValueError):
            effective = self.lookup(arguments)
        return effective(*arguments, **keywords)


class _SecondOfTwo(GenericFunction):
    by_object = True

    def __call__(self, *arguments, **keywords):
        try:
            _, argument = arguments
            effective = self.cache[argument.__class__]
        except (KeyError, ValueError):
            effective = self.lookup(arguments)
        return effective(*arguments, **keywords)

    def cache_key(self, arguments):
        return arguments[1].__class__


class _FirstGeneric(GenericFunction):
    def __call__(self, *arguments, **keywords):
        if len(arguments) < self.minimum or (self.maximum is not None and len(arguments) > self.maximum):
            return wrong_argument_count(len(arguments))
        effective = self.cache.get(arguments[0].__class__) or self.lookup(arguments)
        return effective(*arguments, **keywords)

    def cache_key(self, arguments):
        return arguments[0].__class__


class _TwoGeneric(GenericFunction):
    def __call__(self, *arguments, **keywords):
        if len(arguments) < self.minimum or (self.maximum is not None and len(arguments) > self.maximum):
            return wrong_argument_count(len(arguments))
        effective = self.cache.get((arguments[0].__class__, arguments[1].__class__)) or self.lookup(arguments)
        return effective(*arguments, **keywords)


class _ManyGeneric(GenericFunction):
    def __call__(self, *arguments, **keywords):
        if len(arguments) < self.minimum or (self.maximum is not None and len(arguments) > self.maximum):
            return wrong_argument_count(len(arguments))
        effective = self.cache.get(tuple([arguments[index].__class__ for index in self.positions])) or self.lookup(arguments)
        return effective(*arguments, **keywords)


class _WatchedGeneric(GenericFunction):
    def __call__(self, *arguments, **keywords):
        return self.watcher(self.lookup(arguments), arguments, keywords)


def no_applicable_method(function, arguments):
    """Call NO-APPLICABLE-METHOD; its default signals the error, with a restart RETRY."""
    return PORTS.definitions.no_applicable_method(function, arguments, no_applicable_method_default)


def no_applicable_method_default(function, arguments):
    return restart_case(
        [(sym("RETRY"), lambda: function(*arguments), "Retry calling the generic function.")],
        lambda: no_applicable_method_error(function, arguments),
    )


def no_method_for(name, *arguments):
    """Signal that the function ``name`` of COMMON-LISP, generic in SBCL and built in here, has no method for ``arguments``."""
    return no_applicable_method_error(GenericFunction(sym(name)), arguments)


# ---------------------------------------------------------------------------------------------------------------- definition


def function_cell(name):
    """(symbol, is a setf name) for a function name, a Symbol or ``(setf symbol)``."""
    if isinstance(name, Cons) and name.car is sym("SETF") and isinstance(name.cdr, Cons):
        return name.cdr.car, True
    if not is_symbol(name):
        error(invalid_function_name(name))
    return name, False


def find_generic_function(name):
    """The generic function of that name, or ``None``."""
    symbol, setf = function_cell(name)
    function = symbol.setf_function if setf else symbol.function
    return function if isinstance(function, GenericFunction) else None


def ensure_generic_function(
    name,
    lambda_list=None,
    *,
    method_combination=None,
    argument_precedence_order=None,
    documentation=None,
    generic_function_class=None,
    method_class=None,
):
    """The generic function ``name``; made if there is none. Options that are given replace those it has.

    name: a Symbol or ``(setf symbol)``. lambda_list: a Lisp list, or text for Python rooms. method_combination: a list
    (name option...). argument_precedence_order: a list of parameter names. A name with an ordinary function or macro is an
    error, with a restart CONTINUE that replaces it, except for symbols of COMMON-LISP.
    """
    symbol, setf = function_cell(name)
    function = find_generic_function(name)
    if function is None:
        redefined(symbol)
        old = symbol.setf_function if setf else symbol.function
        opening = getattr(old, "opening", None)
        if opening is None and not setf and (symbol.macro is not None or not isinstance(old, UndefinedFunction)):
            refuse_ordinary(symbol)
        if opening is None:
            PORTS.definitions.check_symbol(symbol, "proclaiming ~S as a function", name)
        if generic_function_class is not None:
            function = PORTS.definitions.generic_function_of(generic_function_class, name, lambda_list)
        else:
            function = GenericFunction(name, lambda_list) if opening is None else opening.open()
        if setf:
            symbol.setf_function = function
        else:
            symbol.function, symbol.macro = function, None
        symbol.function_changed()
    if method_class is not None:
        function.method_class = PORTS.definitions.maker_of_methods(method_class)
    if method_combination is not None:
        options = python_list(method_combination)
        function.combination, function.combination_options = find_combination(options[0]), tuple(options[1:])
        function.forget()
    if argument_precedence_order is not None:
        names, given = function.shape.names, python_list(argument_precedence_order)
        if sorted(map(id, given)) != sorted(map(id, names)):
            program_error("The :ARGUMENT-PRECEDENCE-ORDER ~S does not name each of ~S once.", argument_precedence_order, list_from(names))
        function.precedence = [names.index(parameter) for parameter in given]
        function.forget()
    if documentation is not None:
        function.__doc__ = documentation
    return function


def define_generic(name, lambda_list=None, *, methods=None, generic_function_class=None, method_class=None, **options):
    """``defgeneric``: define or redefine the generic function ``name``; returns it.

    name, lambda_list and options: see `ensure_generic_function`. methods: a list of lists (qualifiers specializers
    lambda-list function uses-next) for the ``:method`` options; methods of an earlier ``defgeneric`` are removed. A lambda
    list that does not fit the existing methods is an error.
    """
    function = find_generic_function(name)
    if function is None or generic_function_class is not None and not function.by_protocol:
        function = ensure_generic_function(name, lambda_list, generic_function_class=generic_function_class)
    else:
        for method in function.from_defgeneric:
            remove_method(function, method)
        set_lambda_list(function, lambda_list)
    function.combination, function.combination_options, function.precedence = STANDARD, (), None
    function.from_defgeneric = []
    ensure_generic_function(name, method_class=method_class, **options)
    for method in reversed(python_list(methods)):  # as on SBCL, the first comes first and wins
        qualifiers, specializers, method_lambda_list, code, uses_next = python_list(method)
        function.from_defgeneric.append(
            add_method(function, qualifiers, specializers, code, lambda_list=method_lambda_list, uses_next=uses_next)
        )
    function.forget()
    return function


def set_lambda_list(function, lambda_list):
    """Give a generic function another lambda list; one that its methods do not agree with is an error."""
    shape = Shape(lambda_list)
    if any(not shape.agrees_with(method.shape) for method in function.methods):
        text = "New lambda-list ~S is incompatible with existing methods of ~S.~%Old lambda-list ~S"
        error(SimpleError(text, lambda_list, function, function.lambda_list))
    function.lambda_list, function.shape = lambda_list, shape
    function.forget()


def define_method(name, qualifiers, specializers, lambda_list, function, *, uses_next=True, documentation=None):
    """``defmethod``: add a method to the generic function ``name``, which is made if there is none; returns the method.

    name: a Symbol or ``(setf symbol)``. qualifiers: a list. specializers: a list with one entry per required parameter: a
    class name (T for unspecialized ones) or a list ``(eql value)`` whose value is evaluated. lambda_list: the lambda list,
    specialized or not. function: see the top of this module. uses_next: whether it takes ``next``; nil is false.
    """
    classes = [specializer_of(specializer) for specializer in python_list(specializers)]
    generic_function = ensure_generic_function(name, generic_lambda_list(lambda_list) if find_generic_function(name) is None else None)
    return add_method(
        generic_function, qualifiers, classes, function, lambda_list=lambda_list, uses_next=uses_next, documentation=documentation
    )


def add_method(
    generic_function,
    qualifiers,
    specializers,
    function,
    *,
    lambda_list=None,
    uses_next=True,
    per_class=False,
    documentation=None,
    user=True,
    shape=None,
):
    """Add a method, replacing one with the same qualifiers and specializers; returns the `Method`.

    qualifiers: symbols; specializers: see `specializer_of`. per_class: ``function`` is called with the tuple of the argument
    classes and returns the function to call, which may know their slots.
    """
    method = Method(
        generic_function,
        tuple(python_list(qualifiers)),
        [specializer_of(specializer) for specializer in python_list(specializers)],
        function,
        uses_next if uses_next.__class__ is Keyword else bool(uses_next),
        Shape(lambda_list) if lambda_list is not None else shape or generic_function.shape,
        per_class,
        documentation,
    )
    if generic_function.method_class is not None:
        method = generic_function.method_class(method)
    return enter_method(generic_function, method, user=user)


def enter_method(generic_function, method, *, user=True):
    """Make ``method``, which belongs to no generic function, one of ``generic_function``. Returns the method.

    It comes first, as on SBCL, where programs read the order, and replaces one with the same qualifiers and specializers. Errors:
    `incongruent`, where its lambda list does not fit.
    """
    shape, specializers, function = method.shape, method.specializers, method.function
    if not generic_function.shape.agrees_with(shape) or len(specializers) != generic_function.shape.required:
        if generic_function.methods or generic_function.lambda_list is not None:
            return incongruent(generic_function, method)
        generic_function.shape = shape
    old = find_method_or_none(generic_function, method.qualifiers, specializers)
    if old is not None:
        generic_function.methods.remove(old)
        old.generic_function = None
    elif user:
        generic_function.user_methods += 1
    if not user:
        generic_function.own_methods = [method] + [own for own in generic_function.own_methods if own is not old]
    generic_function.methods.insert(0, method)
    method.generic_function = generic_function
    generic_function.combination.check(generic_function, method)
    if hasattr(function, "__dict__"):
        function.__lisp_name__ = generic_function.__lisp_name__
    generic_function.forget()
    for watcher in method_watchers:
        watcher(generic_function)
    return method


method_watchers: list = []


def when_methods_change(function):
    """Call ``function(generic_function)`` whenever methods are added to or removed from one."""
    method_watchers.append(function)
    return function


def find_method_or_none(generic_function, qualifiers, specializers):
    for method in generic_function.methods:
        if method.qualifiers == tuple(qualifiers) and method.specializers == list(specializers):
            return method
    return None


def remove_method(generic_function, method):
    """``cl:remove-method``: returns the generic function."""
    if method in generic_function.methods:
        generic_function.methods.remove(method)
        method.generic_function = None
        generic_function.user_methods = max(0, generic_function.user_methods - 1)
        generic_function.forget()
        for watcher in method_watchers:
            watcher(generic_function)
    return generic_function


def generic(name, lambda_list, *, combination=None, documentation=None):
    """A generic function of a Python room: ``publish = generic("ROSLISP::PUBLISH", "(pub message)")``.

    name: ``"PACKAGE::NAME"`` or ``"(setf PACKAGE::NAME)"``. Methods: ``@publish.method(Publication, Message)``.
    """
    if name.startswith("(setf "):
        name = lisp_list(sym("SETF"), sym(name[6:-1]))
    else:
        name = sym(name)
    options = None if combination is None else [sym(combination) if isinstance(combination, str) else combination]
    with our_own:
        return ensure_generic_function(name, lambda_list, method_combination=options, documentation=documentation)


def protocol_function(name, lambda_list, function):
    """A generic function whose default method is ``function``."""
    gf = generic(name, lambda_list)
    function.lisp_default = True
    add_method(gf, (), [True] * gf.shape.required, function, uses_next=False, user=False)
    gf.__doc__ = function.__doc__
    return gf
