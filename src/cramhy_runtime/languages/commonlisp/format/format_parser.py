"""Control strings of ``format``, parsed once: text, directives, and the clauses of those that enclose others.

A parsed control is a list of strings and `Directive` objects. What encloses (``~{ ~}``, ``~[ ~]``, ``~( ~)``, ``~<
~>``) has its clauses as such lists. Controls are few and used often, so they are remembered. A bad control is a
`FormatError`, whose report shows the control with a mark below the place, as SBCL's does. Source: ANSI 22.3; texts of
SBCL 2.2.9.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import Error, error
from cramhy_runtime.lisp_core.data import UNBOUND

NEWLINE = "\n"


class FormatError(Error):
    """A control string that is wrong, or does not fit its arguments."""

    lisp_name = "SB-FORMAT::FORMAT-ERROR"

    def __init__(self, complaint=UNBOUND, control=None, offset=None, section=None, **slots):
        super().__init__(**slots)
        self.complaint, self.control, self.offset, self.section = complaint, control, offset, section
        self.banner = True

    def report(self):
        text = ("error in FORMAT: " if self.banner else "") + self.complaint
        if self.control is not None:
            text += f"\n  {self.control}\n  {' ' * self.offset}^"
        return text if self.section is None else f"{text}\nSee also:\n  The ANSI Standard, Section {self.section}"


class Directive:
    """One directive: ``char`` in upper case, ``params`` a list of (offset, value), ``start`` and ``end`` its extent.

    ``clauses`` and ``separators`` belong to the enclosing ones, whose closing directive is ``close``; ``name`` to
    ``~/name/``.
    """

    __slots__ = ("control", "start", "end", "params", "colon", "at", "char", "clauses", "separators", "close", "name", "handler", "cache")

    def __init__(self, control, start, end, params, colon, at, char):
        self.control, self.start, self.end = control, start, end
        self.params, self.colon, self.at, self.char = params, colon, at, char
        self.clauses = self.separators = self.close = self.name = self.handler = self.cache = None

    def complain(self, complaint, offset=None, section=None):
        """Signal a `FormatError` at this directive, or at ``offset`` of the control; ``section`` of ANSI says why."""
        return error(FormatError(complaint, self.control, self.end - 1 if offset is None else offset, section))

    def reject(self, colon=False, at=False, both=False):
        """Complain about modifiers that the directive does not take."""
        if both and self.colon and self.at:
            self.complain("The colon and the at-sign modifiers cannot be used simultaneously with this directive.")
        if colon and self.colon:
            self.complain("The colon modifier cannot be used with this directive.")
        if at and self.at:
            self.complain("The at-sign modifier cannot be used with this directive.")


_CLOSERS = {"(": ")", "[": "]", "{": "}", "<": ">"}
_NAMES = {"(": "paren", "[": "bracket", "{": "brace", "<": "bracket"}
_parsed: dict[str, list] = {}


def parse(control):
    """The parsed form of the string ``control``."""
    found = _parsed.get(control)
    if found is None:
        tokens = _tokens(control)
        nodes, index, _ = _nest(tokens, 0, None)
        _check_line_prefixes(nodes)
        _place(nodes)
        if len(_parsed) > 5000:
            _parsed.clear()
        found = _parsed[control] = nodes
    return found


def _place(nodes):
    for node in nodes:
        if isinstance(node, Directive):
            node.handler = handlers().get(node.char)
            for clause in node.clauses or ():
                _place(clause)


# --------------------------------------------------------------------------------------------------------------- tokens


def _tokens(control):
    tokens, index = [], 0
    while True:
        tilde = control.find("~", index)
        if tilde < 0:
            _add_text(tokens, control[index:])
            return tokens
        _add_text(tokens, control[index:tilde])
        directive = _directive(control, tilde)
        index = directive.end
        text = _literal(directive)
        if text is None:
            tokens.append(directive)
            continue
        if directive.char == NEWLINE and not directive.colon:
            while index < len(control) and control[index] in " \t\n":
                index += 1
        _add_text(tokens, text, keep=True)


def _add_text(tokens, text, keep=False):
    if tokens and tokens[-1].__class__ is str:
        tokens[-1] += text
    elif text or (keep and tokens and isinstance(tokens[-1], Directive) and tokens[-1].char == "{"):
        tokens.append(text)  # an empty text keeps "~{~0|~}" from meaning "~{~}"


def _literal(directive):
    """The text that ``directive`` always stands for, or ``None``: ``~%``, ``~~``, ``~|`` with constant counts,
    ``~newline``.
    """
    if directive.char == NEWLINE:
        if directive.params or (directive.colon and directive.at):
            return None
        return NEWLINE if directive.at else ""
    text = {"%": NEWLINE, "~": "~", "|": "\f"}.get(directive.char)
    if text is None or directive.colon or directive.at or len(directive.params) > 1:
        return None
    count = directive.params[0][1] if directive.params else 1
    count = 1 if count is None else count
    return text * count if count.__class__ is int and 0 <= count < 128 else None


def _directive(control, start):
    position, params, colon, at = start + 1, [], False, False
    length = len(control)

    def character():
        if position >= length:
            error(FormatError("String ended before directive was found", control, start))
        return control[position]

    def complain(text, section=None):
        error(FormatError(text, control, position, section))

    def in_order():
        if colon or at:
            complain("Parameters found after #\\: or #\\@ modifier", "22.3")

    while True:
        char = character()
        if char in "0123456789+-":
            in_order()
            end = position + 1
            while end < length and control[end].isdecimal():
                end += 1
            number = control[position:end]
            params.append((position, int(number) if number[-1].isdecimal() else None))
            position = end
        elif char in "vV":
            in_order()
            params.append((position, ARGUMENT_MARK))
            position += 1
        elif char == "#":
            in_order()
            params.append((position, REMAINING_MARK))
            position += 1
        elif char == "'":
            in_order()
            position += 1
            params.append((position, character()))
            position += 1
        elif char == ",":
            in_order()
            params.append((position, None))
        elif char == ":":
            if colon:
                complain("Too many colons supplied", "22.3")
            colon = True
            position += 1
            continue
        elif char == "@":
            if at:
                complain("Too many #\\@ characters supplied", "22.3")
            at = True
            position += 1
            continue
        else:
            if control[position - 1] == "," and control[position - 2] != "'":
                in_order()
                params.append((position - 1, None))
            break
        # after a parameter: a comma leads to the next one
        if character() == ",":
            position += 1
        elif character() not in ":@":
            break
    char = character()
    name = None
    if char == "/":
        closing = control.find("/", position + 1)
        if closing < 0:
            complain("No matching closing slash")
        name = control[position + 1 : closing]
        position = closing
    directive = Directive(control, start, position + 1, params, colon, at, char.upper())
    directive.name = name
    return directive


class _Mark:
    """A parameter that is known only when the control is used."""

    def __init__(self, text):
        self.text = text

    def __repr__(self):
        return self.text


ARGUMENT_MARK, REMAINING_MARK = _Mark("V"), _Mark("#")


# -------------------------------------------------------------------------------------------------------------- nesting


def _nest(tokens, index, opener):
    """(nodes, next index, the directive that ended them) of the tokens from ``index`` on, inside ``opener`` or at
    top.
    """
    nodes = []
    while index < len(tokens):
        token = tokens[index]
        index += 1
        if token.__class__ is str:
            nodes.append(token)
            continue
        char = token.char
        if char in _CLOSERS:
            index = _enclose(tokens, index, token)
            nodes.append(token)
        elif char in ")]}>;":
            if opener is not None and (char == _CLOSERS[opener.char] or char == ";" and opener.char in "[<"):
                return nodes, index, token
            _misplaced(token)
        else:
            nodes.append(token)
    if opener is not None:
        opener.complain(f"No corresponding close {_NAMES[opener.char]}")
    return nodes, index, None


def _misplaced(token):
    if token.char == ";":
        token.complain("~; not contained within either ~[...~] or ~<...~>")
    if token.char == ">":
        token.complain("~> without a matching ~<", token.start)
    token.complain(
        {")": "no corresponding open paren", "]": "No corresponding open bracket", "}": "No corresponding open brace"}[token.char]
    )


def _enclose(tokens, index, opener):
    opener.clauses, opener.separators = [], []
    while True:
        nodes, index, end = _nest(tokens, index, opener)
        opener.clauses.append(nodes)
        if end.char == ";":
            opener.separators.append(end)
        else:
            opener.close = end
            break
    if opener.char == "<":
        (_check_block if opener.close.colon else _check_justification)(opener)
    return index


def _check_block(block):
    if block.params:
        block.complain("No parameters can be supplied with ~<...~:>.", block.params[0][0])
    if len(block.clauses) > 3:
        block.complain("Too many segments for ~<...~:>")
    texts = ["(" if block.colon else "", ")" if block.colon else ""]
    outer = {2: [0], 3: [0, 2]}.get(len(block.clauses), [])
    for index in outer:
        for node in block.clauses[index]:
            if isinstance(node, Directive):
                node.complain(
                    f"Cannot include format directives inside the {'prefix' if index == 0 else 'suffix'} segment of ~<...~:>",
                    node.end - 1,
                    "22.3.5.2",
                )
        texts[index // 2] = "".join(block.clauses[index])
    body = block.clauses[min(1, len(block.clauses) - 1)]
    if block.close.at:
        body = _with_fill_newlines(body, block)
    per_line = bool(block.separators) and block.separators[0].at
    block.clauses, block.cache = [body], (texts[0], texts[1], per_line)


def _with_fill_newlines(nodes, block):
    filled = []
    for node in nodes:
        if isinstance(node, Directive):
            if node.clauses and not (node.char == "<" and not node.close.colon):
                node.clauses = [_with_fill_newlines(clause, block) for clause in node.clauses]
            filled.append(node)
            continue
        position = 0
        while True:
            blank = node.find(" ", position)
            if blank < 0:
                filled.append(node[position:])
                break
            end = blank
            while end < len(node) and node[end] == " ":
                end += 1
            filled.append(node[position:end])
            filled.append(Directive(block.control, block.end, block.end, [], True, False, "_"))
            position = end
            if position == len(node):
                break
    return filled


def _check_justification(opener):
    count = sum(map(_count_pretty, opener.clauses))
    if count:
        opener.complain(f"{count} illegal directive{'s' if count != 1 else ''} found inside justification block", section="22.3.5.2")
    if opener.close.at:
        opener.complain(
            "@ modifier not allowed in close directive of justification block (i.e. ~<...~@>.", opener.close.end - 1, "22.3.6.2"
        )


def _check_line_prefixes(nodes):
    """Signal that ``~<...~:;...~>`` stands in one control with a directive of the pretty printer."""
    prefix = _with_line_prefix(nodes)
    if prefix is not None and _count_pretty(nodes):
        prefix.complain("~<...~:;...~> cannot be used in the same format string with ~W, ~_, ~<...~:>, ~I or ~:T.", section="22.3.5.2")


def _with_line_prefix(nodes):
    """A ``~<...~:;...~>`` in ``nodes``, or ``None``."""
    for node in nodes:
        if isinstance(node, Directive):
            if node.char == "<" and not node.close.colon and node.separators and node.separators[0].colon:
                return node
            for clause in node.clauses or ():
                if (found := _with_line_prefix(clause)) is not None:
                    return found
    return None


def _count_pretty(nodes):
    count = 0
    for node in nodes:
        if isinstance(node, Directive):
            block = node.char == "<" and node.close.colon
            count += node.char in "WI_" or (node.char == "T" and node.colon) or block
            count += sum(map(_count_pretty, node.clauses or ()))
    return count


def handlers():
    """The functions of the directives by their characters. The module that defines them needs this one."""
    from .format_directives import HANDLERS

    return HANDLERS
