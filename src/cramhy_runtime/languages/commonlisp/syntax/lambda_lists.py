"""Lambda lists: the parameters of functions and macros, taken apart (ANSI 3.4).

`parse` serves ordinary lambda lists and the destructuring ones of macros and ``destructuring-bind``; `destructure` turns the
latter into ordinary bindings, so that the compiler knows only one kind of variable.
"""

from __future__ import annotations


from cramhy_runtime.lisp_core.conditions import CompileError, error
from cramhy_runtime.lisp_core.data import Cons, Symbol, lisp_list, list_from
from cramhy_runtime.lisp_core.packages import keyword, sym, symbol_name

KEYWORDS = {name: f"&{name}" for name in ("OPTIONAL", "REST", "BODY", "KEY", "AUX", "WHOLE", "ENVIRONMENT", "ALLOW-OTHER-KEYS")}


ORDER = {"&REQUIRED": 0, "&OPTIONAL": 1, "&REST": 2, "&BODY": 2, "&KEY": 3, "&AUX": 4}
"""What may follow what in a lambda list."""


class LambdaList:
    """A lambda list. In destructuring ones, required items and rest may be lambda lists themselves (Lisp lists)."""

    def __init__(self):
        self.whole = self.environment = None
        self.required: list = []
        self.optional: list = []  # (variable, default form, supplied-p variable or None)
        self.rest = None
        self.keys: list = []  # (keyword, variable, default form, supplied-p variable or None)
        self.has_keys = self.allow_other_keys = False
        self.aux: list = []  # (variable, form)

    def has_defaults(self):
        """Whether an optional or keyword parameter has a default form."""
        return any(default is not None for _, default, _ in self.optional) or any(key[2] is not None for key in self.keys)

    def in_order(self):
        """An ordinary lambda list that binds the same variables by ``&aux``, so that each default form sees the variables before it."""
        other = LambdaList()
        other.rest, other.has_keys, other.allow_other_keys = self.rest, self.has_keys, self.allow_other_keys

        def bound_later(symbol):
            value = gensym(symbol_name(symbol))
            other.aux.append((symbol, value))
            return value

        def default_later(symbol, default, supplied):
            value, given = gensym(symbol_name(symbol)), gensym("GIVEN")
            other.aux.append((symbol, lisp_list(sym("IF"), given, value, default)))
            if supplied is not None:
                other.aux.append((supplied, given))
            return value, None, given

        other.required = [bound_later(symbol) for symbol in self.required]
        other.optional = [default_later(*parameter) for parameter in self.optional]
        if self.rest is not None:
            other.rest = bound_later(self.rest)
        other.keys = [(key, *default_later(*parameter)) for key, *parameter in self.keys]
        other.aux += self.aux
        return other


def _marker(item):
    return item.name if isinstance(item, Symbol) and item.name in KEYWORDS.values() else None


def malformed(lambda_list, why):
    return error(CompileError("The lambda list ~S is malformed: ~A", lambda_list, why, lambda_list=lambda_list))


def parse(lambda_list, destructuring=False, default=None):
    """The `LambdaList` of ``lambda_list``, a Lisp list. Malformed ones are compile errors that say where.

    default: the form of optional and keyword parameters that give none.
    """
    result = LambdaList()
    state = "REQUIRED"
    cell = lambda_list
    while isinstance(cell, Cons):
        item, cell = cell.car, cell.cdr
        marker = _marker(item)
        if marker in ORDER:
            if ORDER[marker] <= ORDER["&" + state]:
                malformed(lambda_list, f"{marker} is misplaced or occurs twice.")
        elif marker == "&ALLOW-OTHER-KEYS" and state != "KEY":
            malformed(lambda_list, "&ALLOW-OTHER-KEYS may only follow &KEY.")
        if marker == "&WHOLE":
            result.whole, cell = _next(lambda_list, cell, marker)
        elif marker == "&ENVIRONMENT":
            result.environment, cell = _next(lambda_list, cell, marker)
        elif marker in ("&REST", "&BODY"):
            result.rest, cell = _next(lambda_list, cell, marker)
            state = "REST"
        elif marker == "&OPTIONAL":
            state = "OPTIONAL"
        elif marker == "&KEY":
            result.has_keys, state = True, "KEY"
        elif marker == "&ALLOW-OTHER-KEYS":
            result.allow_other_keys = True
        elif marker == "&AUX":
            state = "AUX"
        elif state == "REQUIRED":
            if not destructuring and not isinstance(item, Symbol):
                malformed(lambda_list, "a parameter must be a symbol.")
            result.required.append(item)
        elif state == "OPTIONAL":
            result.optional.append(_with_default(item, default))
        elif state == "KEY":
            result.keys.append(_key(item, default))
        elif state == "AUX":
            variable, form, _ = _with_default(item)
            result.aux.append((variable, form))
        else:
            malformed(lambda_list, "only one variable may follow &REST.")
    if cell is not None:
        if not destructuring or not isinstance(cell, Symbol):
            example = f", as in ({cell.name.strip('[]').lower()})" if isinstance(cell, Symbol) else ""
            malformed(lambda_list, "it ends in a dot." if isinstance(lambda_list, Cons) else f"the parameters stand in a list{example}.")
        result.rest = cell
    return result


def _next(lambda_list, cell, marker):
    if cell is None:
        malformed(lambda_list, f"a variable must follow {marker}.")
    return cell.car, cell.cdr


def _with_default(item, default=None):
    if isinstance(item, Cons):
        parts = list(item)
        return parts[0], parts[1] if len(parts) > 1 else default, parts[2] if len(parts) > 2 else None
    return item, default, None


def _key(item, default):
    variable, default, supplied = _with_default(item, default)
    if isinstance(variable, Cons):
        name, variable = list(variable)
        return name, variable, default, supplied
    return keyword(symbol_name(variable)), variable, default, supplied


def variables_of(lambda_list):
    """The variables that an ordinary lambda list binds."""
    parsed = parse(lambda_list)
    found = [*parsed.required, parsed.rest, *(variable for variable, _ in parsed.aux)]
    for variable, _, supplied in [*parsed.optional, *(key[1:] for key in parsed.keys)]:
        found += [variable, supplied]
    return [variable for variable in found if variable is not None]


def support(name):
    """The symbol of the runtime function ``name`` that expansions call: ``CRAMHY::NAME``."""
    return sym(f"CRAMHY::{name}")


def gensym(base="G"):
    return Symbol(base)


def destructure(lambda_list, form, what, environment=None, default=None):
    """Bindings that take the value of ``form`` apart: a list of (variable, form), to be made in order.

    lambda_list: a destructuring lambda list. what: the text naming the construct in errors.
    environment: the form for an &environment variable. default: that of optional and keyword
    variables without one. A shape that does not fit is a program-error at run time.
    """
    bindings = []
    _destructure(parse(lambda_list, destructuring=True, default=default), form, what, lambda_list, bindings, environment)
    return bindings


def _destructure(parsed, form, what, lambda_list, bindings, environment):
    quote, car, cdr = sym("QUOTE"), sym("CAR"), sym("CDR")
    whole = gensym("WHOLE")
    bindings.append((whole, form))
    if parsed.whole is not None:
        _bind(parsed.whole, whole, what, bindings)
    if parsed.environment is not None:
        bindings.append((parsed.environment, environment))
    rest = gensym("REST")
    minimum = len(parsed.required)
    maximum = None if parsed.rest is not None or parsed.has_keys else minimum + len(parsed.optional)
    check = lisp_list(support("CHECK-SHAPE"), whole, minimum, maximum, what, lisp_list(quote, lambda_list))
    if not (parsed.optional or parsed.has_keys):
        _destructure_plain(parsed, whole, check, what, bindings)
        return
    bindings.append((rest, check))
    for item in parsed.required:
        _bind(item, lisp_list(car, rest), what, bindings)
        rest = _advance(rest, bindings, cdr)
    for variable, default, supplied in parsed.optional:
        given = lisp_list(sym("CONSP"), rest)
        if supplied is not None:
            bindings.append((supplied, lisp_list(sym("IF"), given, True, None)))
            given = supplied
        _bind(variable, lisp_list(sym("IF"), given, lisp_list(car, rest), default), what, bindings)
        rest = _advance(rest, bindings, cdr)
    if parsed.rest is not None:
        _bind(parsed.rest, rest, what, bindings)
    if parsed.has_keys:
        names = list_from([key for key, *_ in parsed.keys])
        table = gensym("KEYS")
        bindings.append(
            (table, lisp_list(support("KEY-TABLE"), rest, lisp_list(quote, names), True if parsed.allow_other_keys else None, what))
        )
        for key, variable, default, supplied in parsed.keys:
            given = lisp_list(support("KEY-GIVEN-P"), table, lisp_list(quote, key))
            if supplied is not None:
                bindings.append((supplied, given))
                given = supplied
            value = lisp_list(support("KEY-VALUE"), table, lisp_list(quote, key))
            _bind(variable, lisp_list(sym("IF"), given, value, default), what, bindings)
    bindings.extend(parsed.aux)


def _destructure_plain(parsed, whole, check, what, bindings):
    """As `_destructure`, without optional and keyword variables: the conses themselves are tested, ``check`` only makes the error."""
    if_, consp, null, car, cdr = sym("IF"), sym("CONSP"), sym("NULL"), support("CAR-OF-CONS"), support("CDR-OF-CONS")
    cells = [whole]
    for _ in parsed.required[1:]:
        cells.append(gensym("REST"))
        bindings.append((cells[-1], lisp_list(if_, lisp_list(consp, cells[-2]), lisp_list(cdr, cells[-2]), None)))
    last, rest = cells[-1], parsed.rest
    if parsed.required:
        fits, after = lisp_list(consp, last), lisp_list(cdr, last)
        if rest is None:
            fits = lisp_list(if_, fits, lisp_list(null, after), None)
    else:
        fits, after = lisp_list(null, whole), whole
    if parsed.required or rest is None:
        bindings.append((gensym("CHECKED"), lisp_list(if_, fits, None, check)))
    if isinstance(rest, Cons):
        tail = gensym("REST")
        bindings.append((tail, after))
        after = tail
    for item, cell in zip(parsed.required, cells):  # noqa: B905  without variables there is still the whole
        _bind(item, lisp_list(car, cell), what, bindings)
    if rest is not None:
        _bind(rest, after, what, bindings)
    bindings.extend(parsed.aux)


def _advance(rest, bindings, cdr):
    following = gensym("REST")
    bindings.append((following, lisp_list(cdr, rest)))
    return following


def _bind(item, form, what, bindings):
    if isinstance(item, Cons):
        _destructure(parse(item, destructuring=True), form, what, item, bindings, None)
    elif item is None:
        bindings.append((gensym("EMPTY"), lisp_list(support("CHECK-SHAPE"), form, 0, 0, what, None)))
    else:
        bindings.append((item, form))
