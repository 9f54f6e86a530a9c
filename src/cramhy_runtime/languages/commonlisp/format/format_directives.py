"""The directives of ``format``, one function each, found by their character in `HANDLERS`.

A handler gets the parsed `Directive` and the `State` of the walk. Source: ANSI 22.3, with SBCL 2.2.9 for what that
leaves open.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import Error, handler_bind, type_error
from cramhy_runtime.lisp_core.data import Character, list_from, truth
from cramhy_runtime.lisp_core.packages import named_package
from cramhy_runtime.kernel.active import checkpoint
from ..printer import print_controls as controls
from ..printer.pretty import call_logical_block, pprint_indent, pprint_newline, pprint_tab
from ..printer.print_controls import PRINT_BASE, PRINT_RADIX, bound
from ..collections.characters import character_name
from ..printer.printer import output_object, prin1, prin1_to_string, princ_to_string, write
from ..streams.streams import OutputStream, StringOutputStream
from ..collections.characters import graphic_char_p
from . import format_numbers as numbers
from .format import State, UpAndOut, format_on, list_arguments, run
from .block_arguments import arguments_of
from .format_parameters import NO_CHARACTER, parameters
from .format_parser import ARGUMENT_MARK, REMAINING_MARK, FormatError


# ---------------------------------------------------------------------------------------------------------- any objects


def _object(to_string, escape):
    def directive_a_or_s(directive, state):
        if not directive.params:
            arg = state.next(directive)
            if directive.colon and arg is None:
                state.stream.write("()")
            else:
                write(arg, state.stream, escape)
            return
        mincol, colinc, minpad, padchar = parameters(directive, state, 0, 1, 0, " ")
        arg = state.next(directive)
        if colinc <= 0:
            directive.complain(f"The value of colinc is {colinc}, should be a positive integer")
        if mincol < 0:
            directive.complain(f"The value of mincol is {mincol}, should be a non-negative integer")
        text = "()" if directive.colon and arg is None else to_string(arg)
        numbers.pad(state.stream, text, mincol, colinc, minpad, padchar, directive.at)

    return directive_a_or_s


def _write(directive, state):
    parameters(directive, state)
    arg = state.next(directive)
    bindings = (controls.PRINT_PRETTY, True) if directive.colon else ()
    if directive.at:
        bindings += (controls.PRINT_LEVEL, None, controls.PRINT_LENGTH, None)
    if bindings:
        with bound(*bindings):
            output_object(arg, state.stream)
    else:
        output_object(arg, state.stream)


def _character(directive, state):
    parameters(directive, state)
    arg = state.next(directive)
    if not isinstance(arg, Character):
        directive.complain(f"{prin1_to_string(arg)} is not of type CHARACTER.")
    if directive.colon:
        char = arg.char
        graphic = char != " " and graphic_char_p(arg)
        state.stream.write(char if graphic else character_name(char).title())
    elif directive.at:
        prin1(arg, state.stream)
    else:
        state.stream.write(arg.char)


def _call(directive, state):
    """``~/name/``: the user's function gets stream, argument, colon, at and the parameters."""
    symbol = _function_name(directive)
    values = []
    for offset, value in directive.params:
        if value is ARGUMENT_MARK:
            value = state.next(directive, offset)
        elif value is REMAINING_MARK:
            value = state.remaining
        values.append(Character(value) if value.__class__ is str else value)
    arg = state.next(directive)
    symbol.function(state.stream, arg, directive.colon or None, directive.at or None, *values)


def _function_name(directive):
    head, colon, name = directive.name.upper().partition(":")
    if not colon:
        head, name = "COMMON-LISP-USER", head
    package = named_package(head)
    if package is None:
        directive.complain(f'No package named "{head}"')
    return package.intern(name.removeprefix(":"))


# -------------------------------------------------------------------------------------------------------------- numbers


def _integer(base):
    def directive_d(directive, state):
        if not (directive.params or directive.colon or directive.at):
            arg = state.next(directive)
            if arg.__class__ is int and base == 10:
                write_decimal(arg, state.stream)
            else:
                with bound(PRINT_BASE, base, PRINT_RADIX, None):
                    write(arg, state.stream, False)
            return
        mincol, padchar, commachar, interval = parameters(directive, state, 0, " ", ",", 3)
        numbers.write_integer(
            state.stream, state.next(directive), base, directive.colon, directive.at, mincol, padchar, commachar, interval
        )

    return directive_d


def write_decimal(number, stream):
    numbers.write_integer(stream, number, 10)


def _radix(directive, state):
    base, mincol, padchar, commachar, interval = parameters(directive, state, None, 0, " ", ",", 3)
    arg = state.next(directive)
    if base is not None:
        if not 2 <= base <= 36:
            type_error(base, "(INTEGER 2 36)")
        numbers.write_integer(state.stream, arg, base, directive.colon, directive.at, mincol, padchar, commachar, interval)
        return
    if not isinstance(arg, int) or isinstance(arg, bool):
        directive.complain(f"{prin1_to_string(arg)} is not of type INTEGER.")
    if directive.at:
        state.stream.write(numbers.roman(arg, old=directive.colon))
    else:
        state.stream.write(numbers.ordinal(arg) if directive.colon else numbers.cardinal(arg))


def _plural(directive, state):
    parameters(directive, state)
    if directive.colon:
        if not state.position:
            directive.complain("No previous argument")
        arg = state.args[state.position - 1]
    else:
        arg = state.next(directive)
    single = arg.__class__ is int and arg == 1
    state.stream.write(("y" if single else "ies") if directive.at else "" if single else "s")


def _fixed(directive, state):
    directive.reject(colon=True)
    width, digits, scale, overflow, padchar = parameters(directive, state, None, None, None, NO_CHARACTER, " ")
    numbers.write_fixed(state.stream, state.next(directive), width, digits, scale, overflow or None, padchar, directive.at)


def _exponential(directive, state):
    directive.reject(colon=True)
    width, digits, exponent, scale, overflow, padchar, mark = parameters(
        directive, state, None, None, None, 1, NO_CHARACTER, " ", NO_CHARACTER
    )
    numbers.write_exponential(
        state.stream, state.next(directive), width, digits, exponent, scale, overflow or None, padchar, mark or None, directive.at
    )


def _general(directive, state):
    directive.reject(colon=True)
    *values, overflow, padchar, mark = parameters(directive, state, None, None, None, None, NO_CHARACTER, " ", NO_CHARACTER)
    numbers.write_general(state.stream, state.next(directive), *values, overflow or None, padchar, mark or None, directive.at)


def _dollars(directive, state):
    digits, least, width, padchar = parameters(directive, state, 2, 1, 0, " ")
    numbers.write_dollars(state.stream, state.next(directive), digits, least, width, padchar, directive.colon, directive.at)


# -------------------------------------------------------------------------------------------- lines, columns, arguments


def _repeated(text):
    def directive_newline(directive, state):
        directive.reject(colon=True, at=True)
        (count,) = parameters(directive, state, 1)
        state.stream.write(text * count)

    return directive_newline


def _fresh_line(directive, state):
    directive.reject(colon=True, at=True)
    (count,) = parameters(directive, state, 1)
    if count > 0:
        state.stream.fresh_line()
        state.stream.write("\n" * (count - 1))


def _tabulate(directive, state):
    stream = state.stream
    column, increment = parameters(directive, state, 1, 1)
    if directive.colon:
        pprint_tab("section-relative" if directive.at else "section", column, increment, stream)
    elif stream.is_pretty:
        pprint_tab("line-relative" if directive.at else "line", column, increment, stream)
    else:
        here = stream.column
        if directive.at:
            count = -(-(here + column) // increment) * increment - here if increment > 0 else column
        elif here < column:
            count = column - here
        else:
            count = increment - (here - column) % increment if increment else 0
        stream.write(" " * count)


def _conditional_newline(directive, state):
    parameters(directive, state)
    kinds = {(False, False): "linear", (True, False): "fill", (False, True): "miser", (True, True): "mandatory"}
    pprint_newline(kinds[directive.colon, directive.at], state.stream)


def _indent(directive, state):
    directive.reject(at=True)
    (amount,) = parameters(directive, state, 0)
    pprint_indent("current" if directive.colon else "block", amount, state.stream)


def _go_to(directive, state):
    directive.reject(both=True)
    if directive.at or directive.colon:
        (count,) = parameters(directive, state, 0 if directive.at else 1)
        position = count if directive.at else state.position - count
        if not 0 <= position <= len(state.args):
            directive.complain(f"Index {position} is out of bounds. It should have been between 0 and {len(state.args)}.")
        state.position = position
    else:
        for _ in range(parameters(directive, state, 1)[0]):
            state.next(directive)


def _skip_newline(directive, state):
    directive.reject(both=True)
    parameters(directive, state)


# ---------------------------------------------------------------------------------------------------------- indirection


def _indirectly(directive, stream, control, args, state=None):
    """Format another control; an error in it is reported together with where it was used."""

    def explain(condition):
        if isinstance(condition, FormatError) and getattr(condition, "explained", None) is not directive:
            condition.explained = directive
            condition.complaint = condition.report() + "\nwhile processing indirect format string:"
            condition.control, condition.offset, condition.banner = directive.control, directive.end - 1, False

    return handler_bind([(Error, explain)], lambda: format_on(stream, control, args, state))


def _recursive(directive, state):
    directive.reject(colon=True)
    parameters(directive, state)
    control = state.next(directive)
    if directive.at:
        _indirectly(directive, state.stream, control, (), state)
    else:
        _indirectly(directive, state.stream, control, list_arguments(directive, state.next(directive)))


# ----------------------------------------------------------------------------------------------------------------- case


class CaseStream(OutputStream):
    """Changes the case of what is written to ``target``. ``mode``: upcase, downcase, capitalize, capitalize-first."""

    lisp_name = "SB-IMPL::CASE-FROB-STREAM"

    def __init__(self, target, mode):
        self.target, self.mode = target, mode
        self.inside_word = False

    @property
    def column(self):
        return self.target.column

    @property
    def line_length(self):
        return self.target.line_length

    def write(self, text):
        mode = self.mode
        if mode == "upcase":
            text = text.upper()
        elif mode == "downcase":
            text = text.lower()
        elif mode == "capitalize":
            text = "".join(map(self._capitalized, text))
        else:
            for index, character in enumerate(text):
                if character.isalnum():
                    text = text[:index] + character.upper() + text[index + 1 :].lower()
                    self.mode = "downcase"
                    break
        self.target.write(text)

    def _capitalized(self, character):
        if not character.isalnum():
            self.inside_word = False
            return character
        if self.inside_word:
            return character.lower()
        self.inside_word = True
        return character.upper()

    def fresh_line(self):
        return self.target.fresh_line()

    def flush(self):
        self.target.flush()


def _case(directive, state):
    parameters(directive, state)
    modes = {(False, False): "downcase", (True, False): "capitalize", (False, True): "capitalize-first", (True, True): "upcase"}
    inner = state.on(CaseStream(state.stream, modes[directive.colon, directive.at]))
    try:
        run(directive.clauses[0], inner)
    finally:
        state.position = inner.position


# ------------------------------------------------------------------------------------------------- choice and iteration


def _choose(directive, state):
    directive.reject(both=True)
    clauses = directive.clauses
    if directive.at:
        if len(clauses) > 1:
            directive.complain("Can only specify one section")
        parameters(directive, state)
        before = state.position
        if truth(state.next(directive)):
            state.position = before
            run(clauses[0], state)
    elif directive.colon:
        if len(clauses) != 2:
            directive.complain("Must specify exactly two sections")
        parameters(directive, state)
        run(clauses[1 if truth(state.next(directive)) else 0], state)
    else:
        (index,) = parameters(directive, state, None)
        if index is None:
            index = state.next(directive)
        if index.__class__ is not int:
            directive.complain(f"The argument to ~[ is not an integer: {princ_to_string(index)}")
        separators = directive.separators
        default = bool(separators) and separators[-1].colon
        if 0 <= index < len(clauses) - default:
            run(clauses[index], state)
        elif default:
            run(clauses[-1], state)


def _iterate(directive, state):
    (limit,) = parameters(directive, state, None)
    control = None
    if not directive.clauses[0]:
        control = state.next(directive)

    def once(inner):
        if control is None:
            run(directive.clauses[0], inner)
        else:
            _indirectly(directive, inner.stream, control, (), inner)

    if directive.at:
        _loop(directive, state, once, limit)
    else:
        args = list_arguments(directive, state.next(directive))
        _loop(directive, State(state.stream, args, 0, None, state.rest, state.colon_up), once, limit)


def _loop(directive, state, once, limit):
    at_least_once, sublists = directive.close.colon, directive.colon
    allowed = state.colon_up
    state.colon_up = sublists
    count = 0
    try:
        while (at_least_once or not state.exhausted) and (limit is None or count < limit):
            count += 1
            checkpoint()
            if sublists:
                arg = list_arguments(directive, state.next(directive))
                try:
                    once(State(state.stream, arg, 0, None, state.remaining, True))
                except UpAndOut as up:
                    if up.colon:
                        raise
            else:
                before = state.position
                once(state)
                if state.position == before and limit is None and not state.exhausted:
                    directive.complain("The iteration takes no arguments, so it would never end")
            if at_least_once and state.exhausted:
                break
    except UpAndOut as up:
        if up.colon != sublists:
            raise
    finally:
        state.colon_up = allowed


def _escape_upward(directive, state):
    directive.reject(at=True)
    if directive.colon and not state.colon_up:
        directive.complain("Attempt to use ~:^ outside a ~:{...~} construct")
    first, second, third = parameters(directive, state, None, None, None)
    if third is not None:
        for missing in (first, second):
            if missing is None:
                type_error(missing, "REAL")
        leave = first <= second <= third
    elif second is not None:
        leave = first == second
    elif first is not None:
        leave = first == 0
    elif directive.colon:
        leave = not state.rest
    else:
        leave = state.exhausted
    if leave:
        raise UpAndOut(directive.colon)


# ---------------------------------------------------------------------------------------- logical blocks, justification


def _angle(directive, state):
    if directive.close.colon:
        _logical_block(directive, state)
    else:
        _justify(directive, state)


def _logical_block(directive, state):
    prefix, suffix, per_line = directive.cache
    if directive.at:
        lst, args, start = list_from(state.args[state.position :]), state.args, state.position
    else:
        lst = state.next(directive)
        args, start = arguments_of(lst), 0

    def body(out, block):
        try:
            run(directive.clauses[0], State(out, args, start, block, state.rest, state.colon_up))
        except UpAndOut as up:
            if up.colon:
                raise

    call_logical_block(state.stream, lst, body, prefix, suffix, per_line)
    if directive.at:
        state.position = len(state.args)


def _justify(directive, state):
    mincol, colinc, minpad, padchar = parameters(directive, state, 0, 1, 0, " ")
    clauses = list(directive.clauses)
    line_prefix, extra, line_length, texts = None, 0, 0, []
    try:
        if directive.separators and directive.separators[0].colon:
            default = state.stream.line_length or (80 if state.stream.is_pretty else 72)
            extra, line_length = parameters(directive.separators[0], state, 0, default)
            line_prefix = _rendered(clauses.pop(0), state)
        for clause in clauses:
            texts.append(_rendered(clause, state))
    except UpAndOut as up:
        if up.colon:
            raise
    gaps = len(texts) - 1 + bool(directive.colon) + bool(directive.at)
    used = gaps * minpad + sum(map(len, texts))
    length = mincol if used <= mincol else mincol + -(-(used - mincol) // colinc) * colinc
    padding = length - used + gaps * minpad
    if line_prefix is not None and state.stream.column + length + extra > line_length:
        state.stream.write(line_prefix)

    def gap():
        nonlocal padding, gaps
        size = padding if not gaps else int(padding / gaps)
        padding, gaps = padding - size, gaps - 1
        return padchar * size

    pieces = []
    if directive.colon or (not directive.at and len(texts) < 2):
        pieces.append(gap())
    for index, text in enumerate(texts):
        if index:
            pieces.append(gap())
        pieces.append(text)
    if directive.at:
        pieces.append(gap())
    state.stream.write("".join(pieces))


def _rendered(clause, state):
    stream = StringOutputStream()
    inner = state.on(stream)
    try:
        run(clause, inner)
    finally:
        state.position = inner.position
    return stream.text()


HANDLERS = {
    "A": _object(princ_to_string, False),
    "S": _object(prin1_to_string, True),
    "W": _write,
    "C": _character,
    "/": _call,
    "D": _integer(10),
    "B": _integer(2),
    "O": _integer(8),
    "X": _integer(16),
    "R": _radix,
    "P": _plural,
    "F": _fixed,
    "E": _exponential,
    "G": _general,
    "$": _dollars,
    "%": _repeated("\n"),
    "|": _repeated("\f"),
    "~": _repeated("~"),
    "&": _fresh_line,
    "\n": _skip_newline,
    "T": _tabulate,
    "_": _conditional_newline,
    "I": _indent,
    "*": _go_to,
    "?": _recursive,
    "(": _case,
    "[": _choose,
    "{": _iterate,
    "^": _escape_upward,
    "<": _angle,
}
