"""Mistakes in plans that no compiler sees, since the names are data: kinds and properties of designators, predicates, process modules,
types of messages, conditions, and control strings.

A name that might be defined elsewhere is told only if it is almost one that is known, or if the texts of its system must have it.
"""

from __future__ import annotations

import re
from difflib import SequenceMatcher

from cramhy_runtime.designators import classes as designators
from cramhy_runtime.lisp_core.condition_types import Condition
from cramhy_runtime.lisp_core.data import Symbol, UndefinedFunction
from cramhy_runtime.lisp_core.packages import near_names
from cramhy_runtime.languages.commonlisp.format import format_parser
from cramhy_runtime.languages.commonlisp.tools.advice import hint_for, report_text
from cramhy_runtime.languages.operators import ROSLISP
from cramhy_runtime.prolog.engine import database
from cramhy_runtime.prolog.explanations.undefined import advice
from cramhy_runtime.ros import messages
from cramhy_runtime.session.completion import keywords_of_symbol
from cramhy_runtime.session.lookup import bare_name

from .findings import ERROR, HINT, WARNING, Finding, fixes, meant_in_lisp
from .known_names import KnownNames
from .texts import Form

_LOGGED = [name for name, operator in ROSLISP.items() if '"text" argument' in operator.shape]
_TYPED = frozenset(("FAIL", "ERROR", "SIGNAL", "WARN", "MAKE-CONDITION", "MAKE-INSTANCE"))
_CONTROL = frozenset(("AND", "OR", "NOT", "ONCE", "FORALL", "->"))
_ONE_ARGUMENT = frozenset("ASDFEG$XOBCRW")
_NO_ARGUMENT = frozenset("%&|~T\n")
_FACT_GROUP = "A fact group is written (def-fact-group name (predicate...) (<- head goal...)...)."
_ALMOST = 0.8
"""How alike two variables are of which one is probably misspelt: ?sped and ?speed, and not ?subtype and ?type."""
_CHECKS = {}


def check(text, texts, resolve):
    """The `Finding`s in ``text``; to be called in its image.

    texts: those of its system with it. resolve: a function of a token, which gives (name of an operator or function in capitals, its
    symbol or ``None``), or ``None`` for words that are the user's own; with a second argument that is true, the symbol of any word.
    """
    checks = Checks(text, KnownNames(texts), resolve)
    for form in text.forms:
        checks.walk(form)
    return checks.found


def _for(*names):
    def register(method):
        _CHECKS.update(dict.fromkeys(names, method.__name__))
        return method

    return register


class Checks:
    """The walk through one text."""

    def __init__(self, text, known, resolve):
        self.text, self.known, self.resolve, self.found = text, known, resolve, []

    def tell(self, item, severity, message, hint=None):
        """A finding at ``item``, a token or a form, of which its first line is marked."""
        end = item.end
        line_end = self.text.text.find("\n", item.start)
        end = min(end, line_end) if line_end > item.start else end
        whole = f"{message}\n{hint}" if hint else message
        self.found.append(Finding(item.start, end, severity, whole, tuple(fixes(message, hint, self.text, item.start, end))))

    def walk(self, form):
        head = form.items[0] if form.items else None
        meant = self.resolve(head) if _is_word(head) else None
        if meant is not None:
            method = _CHECKS.get(meant[0])
            if method is not None:
                getattr(self, method)(form, meant[0])
            if meant[0] in ("QUOTE", "DEFMACRO", "DEF-FACT-GROUP"):
                return
        before = None
        for item in form.items:
            if isinstance(item, Form) and not (before is not None and before.kind == "quote" and before.text in ("'", "`")):
                self.walk(item)
            before = item if not isinstance(item, Form) else None

    # ---------------------------------------------------------------------------------------------------- control strings

    @_for("FORMAT", *_LOGGED)
    def _format(self, form, name):
        items = _unprefixed(form)
        control = items[2] if len(items) > 2 else None
        if isinstance(control, Form) or control is None or control.kind != "string" or len(control.text) < 2:
            return
        written = re.sub(r"\\(.)", r"\1", control.text[1:-1], flags=re.S)
        try:
            nodes = format_parser.parse(written)
        except Condition as problem:
            self.tell(control, WARNING, getattr(problem, "complaint", None) or report_text(problem))
            return
        strange = next((node for node in nodes if not isinstance(node, str) and node.handler is None), None)
        if strange is not None:
            self.tell(control, WARNING, f"A control string has no directive ~{written[strange.end - 1]}.")
            return
        needed, given = _needed(nodes), sum(1 for item in items[3:] if isinstance(item, Form) or item.kind != "quote")
        if needed is not None and given < needed:
            what = "one argument" if needed == 1 else f"{needed} arguments"
            self.tell(
                control, WARNING, f"This control string takes {what}, but {given or 'none'} {'follow' if given > 1 else 'follows'} it."
            )

    # ------------------------------------------------------------------------------------------------------ kinds and names

    @_for(*sorted(_TYPED))
    def _type(self, form, name):
        word = _quoted(form, 1)
        symbol = self.resolve(word, True) if word is not None else None
        if symbol is None or self.known.has_class(symbol) or bare_name(word.text) in self.known.definitions:
            return
        what = "class" if name == "MAKE-INSTANCE" else "condition"
        self.tell(word, WARNING, f"Nothing defines the {what} {word.text}.", self._type_hint(symbol))

    def _type_hint(self, symbol):
        from cramhy_runtime.lisp_core.condition_types import SimpleWarning

        asked = SimpleWarning("undefined type")
        asked.name, asked.undefined = symbol, "type"
        return meant_in_lisp(near_names(symbol.name, self.known.definitions)) or hint_for(asked)

    @_for("MAKE-MESSAGE", "MAKE-MSG", "SUBSCRIBE", "ADVERTISE")
    def _message(self, form, name):
        making = name.startswith("MAKE")
        items = _unprefixed(form)
        item = items[1 if making else 2] if len(items) > (1 if making else 2) else None
        if item is None or isinstance(item, Form) or item.kind != "string":
            return
        try:
            found = messages.message_class(item.text.strip('"')) if making else messages.topic_class(item.text.strip('"'))
        except Condition as problem:
            self._of_condition(item, problem)
            return
        if making:
            self._fields(form.items[2:], found)

    @_for("CALL-SERVICE")
    def _service(self, form, name):
        item = next((each for each in form.items[2:4] if not isinstance(each, Form) and each.kind in ("word", "string")), None)
        if item is None or len(form.items) < 3:
            return
        try:
            if item.kind == "string":
                found = messages.service_type(item.text.strip('"'))
            else:
                symbol = self.resolve(item, True)
                found = messages.named(symbol) if symbol is not None else None
        except Condition as problem:
            self._of_condition(item, problem)
            return
        if found is not None and hasattr(found, "request"):
            self._fields(form.items[form.items.index(item) + 1 :], found.request)

    def _of_condition(self, item, problem):
        self.tell(item, WARNING, report_text(problem), hint_for(problem))
        start, end = item.start + 1, item.end - 1
        for near in re.findall(r"[Dd]id you mean (\S+)\?", self.found[-1].message):
            new = near if "/" in near else item.text.strip('"').partition("/")[0] + "/" + near
            if "/" not in near and "package" in report_text(problem).lower():
                new = near + "/" + item.text.strip('"').partition("/")[2]
            self.found[-1] = self.found[-1]._replace(fixes=((f"Write {new}", start, end, new),))

    def _fields(self, items, message):
        key = True
        for item in items:
            if key and not isinstance(item, Form) and item.text.startswith(":"):
                if messages.lisp_attribute(message, item.text[1:]) is None:
                    near = near_names(item.text[1:].upper(), message.attributes)
                    hint = meant_in_lisp(near, ":") or f"Its fields are {', '.join(message.field_names) or 'none'}."
                    self.tell(item, WARNING, f"{message.ros_type} has no field {item.text[1:]}.", hint)
            elif key and not isinstance(item, Form):
                return  # a quote, or a value that is not a pair
            key = not key

    @_for("MAKE-FLUENT")
    def _fluent(self, form, name):
        self._keywords(form.items[0], form.items[1::2], keywords_of_symbol(self.resolve(form.items[0])[1]))

    def _keywords(self, called, items, known):
        """Tell of those ``items`` that are almost one of the keywords ``known`` of what is ``called``."""
        for item in items if known else ():
            if _is_word(item) and item.text.startswith(":") and item.text[1:].upper() not in known:
                hint = meant_in_lisp(near_names(item.text[1:].upper(), known), ":")
                if hint:
                    self.tell(item, WARNING, f"{called.text} takes no argument {item.text}.", hint)

    @_for("PM-EXECUTE", "PM-RUN")
    def _module(self, form, name):
        word = _quoted(form, 1)
        if word is not None:
            self._module_named(word)

    @_for("WITH-PROCESS-MODULES-RUNNING")
    def _modules(self, form, name):
        names = form.items[1] if len(form.items) > 1 else None
        for item in names.items if isinstance(names, Form) else ():
            word = item.items[0] if isinstance(item, Form) and item.items else item
            if _is_word(word):
                self._module_named(word)

    def _module_named(self, word):
        bare = bare_name(word.text)
        if bare in self.known.modules or not self.known.modules:
            return
        symbol = self.resolve(word, True)
        if isinstance(symbol, Symbol) and not isinstance(symbol.function, UndefinedFunction) and symbol.function is not None:
            return
        hint = meant_in_lisp(near_names(bare, self.known.modules))
        if hint:
            self.tell(word, WARNING, f"Nothing defines the process module {word.text}.", hint)

    # ---------------------------------------------------------------------------------------------------------- designators

    @_for("A", "AN")
    def _designator(self, form, name):
        kind = form.items[1] if len(form.items) > 1 else None
        if kind is None or not _is_word(kind) or kind.text.startswith("?"):
            return
        kinds = [key.name for key in designators._classes]
        if bare_name(kind.text) not in kinds:
            hint = meant_in_lisp(near_names(bare_name(kind.text), kinds))
            if not hint:
                return  # perhaps a list of variables that begins with one of this name
            self.tell(kind, WARNING, f"There is no designator for {kind.text}.", hint)
        for item in form.items[2:]:
            if _is_word(item) and not item.text.startswith(("?", "#", "&")):
                self.tell(item, ERROR, f"{item.text} is not a property of a designator.", "A property is written (key value).")
            elif isinstance(item, Form):
                self._property(item)

    def _property(self, pair):
        key, value = (pair.items + [None, None])[:2]
        if not _is_word(key) or key.text.startswith("?"):
            return
        bare = bare_name(key.text)
        if bare not in self.known.keys and bare != "TYPE":
            hint = meant_in_lisp(near_names(bare, {*self.known.keys, "TYPE"}))
            if hint:
                self.tell(key, WARNING, f"No rule asks for the property {key.text}.", hint)
        elif bare == "TYPE" and value is not None and _is_word(value) and not value.text.startswith("?"):
            named = bare_name(value.text)
            hint = meant_in_lisp(near_names(named, self.known.types)) if named not in self.known.types else None
            if hint:
                self.tell(value, WARNING, f"No rule is about the type {value.text}.", hint)

    # ---------------------------------------------------------------------------------------------------------- fact groups

    @_for("DEF-FACT-GROUP")
    def _fact_group(self, form, name):
        group, predicates = (form.items[1:3] + [None, None])[:2]
        if not _is_word(group):
            self.tell(form.items[0] if group is None else group, ERROR, "The name of this fact group is missing.", _FACT_GROUP)
            return
        if not isinstance(predicates, Form) or bare_name(predicates.word(0)) == "<-":
            self.tell(predicates or form.items[0], ERROR, "The list of predicates that this fact group extends is missing.", _FACT_GROUP)
            return
        for clause in form.items[3:]:
            if not isinstance(clause, Form):
                if clause.kind != "string":
                    self.tell(clause, ERROR, f"{clause.text} is not a clause.", _FACT_GROUP)
            elif bare_name(clause.word(0)) != "<-":
                at = clause.items[0] if clause.items and not isinstance(clause.items[0], Form) else clause
                self.tell(at, ERROR, "A clause of a fact group begins with <-.", "Did you mean <-?" if at is not clause else _FACT_GROUP)
            elif len(clause.items) < 2 or not isinstance(clause.items[1], Form):
                self.tell(clause, ERROR, "This clause has no head.", "A clause is written (<- (predicate argument...) goal...).")
            else:
                self._head(clause.items[1], predicates)
                for goal in clause.items[2:]:
                    self._goal(goal)
                self._lonely_variables(clause)

    def _head(self, head, predicates):
        named = [bare_name(item.text) for item in predicates.items if not isinstance(item, Form)]
        word = head.items[0] if head.items else None
        alone = _is_word(word) and self.known.heads[bare_name(word.text)] == 1  # a predicate of several clauses is meant so
        if alone and bare_name(word.text) not in named and (near := near_names(bare_name(word.text), named)):
            self.tell(word, WARNING, f"This fact group does not extend {word.text}.", meant_in_lisp(near))

    def _count(self, goal, symbol):
        """A built-in predicate that nobody extends knows how many arguments it takes."""
        entry = database.functors.get(symbol)
        if entry is None or not entry.native or None in entry.native or entry.clauses or entry.handler:
            return
        given = sum(1 for item in goal.items[1:] if isinstance(item, Form) or item.kind != "quote")
        if given not in entry.native:
            counts = sorted(entry.native)
            wanted = f"{' or '.join(map(str, counts))} argument{'' if counts == [1] else 's'}"
            self.tell(goal, ERROR, f"The predicate {goal.word(0)} takes {wanted}, but here {'is' if given == 1 else 'are'} {given}.")

    def _goal(self, goal):
        if not isinstance(goal, Form):
            if goal.kind == "word" and not goal.text.startswith(("?", "!", ":")) and bare_name(goal.text) in ("DESIG-PROP", "LISP-FUN"):
                self.tell(goal, ERROR, f"{goal.text} is not a goal.", f"A goal is a list: ({goal.text} ...).")
            return
        head = goal.items[0] if goal.items else None
        if not _is_word(head) or head.text.startswith("?"):
            return
        bare = bare_name(head.text)
        if bare in _CONTROL:
            for item in goal.items[1:]:
                self._goal(item)
        elif bare in ("LISP-FUN", "LISP-PRED"):
            self._call_of_lisp(goal)
        elif bare not in self.known.predicates:
            symbol = self.resolve(head, True)
            if symbol is None:
                functors = {functor.name for functor in self.known.functors if isinstance(functor, Symbol)}
                near = near_names(bare, functors) if bare not in functors else ()
                if near:
                    self.tell(head, WARNING, f"Nothing defines the predicate {head.text}.", meant_in_lisp(near[:1]))
            elif symbol in self.known.functors:
                self._count(goal, symbol)
            else:
                told = meant_in_lisp(near_names(bare, self.known.predicates)) or advice(symbol)
                told = told and told.partition("; ")[2] if told and told.startswith("nobody") else told
                told = told and told[0].upper() + told[1:]
                self.tell(head, WARNING, f"Nothing defines the predicate {head.text}.", told or None)

    def _call_of_lisp(self, goal):
        function = goal.items[1] if len(goal.items) > 1 else None
        symbol = self.resolve(function, True) if _is_word(function) and not function.text.startswith("?") else None
        if not isinstance(symbol, Symbol):
            return
        if not self._function(function, symbol):
            return
        known = self.known.slots.get(bare_name(function.text)) or keywords_of_symbol(symbol)
        self._keywords(function, goal.items[2:], known)

    def _function(self, word, symbol):
        """Whether the function of that name is defined, or may be; if not, it is told."""
        bare = bare_name(word.text)
        if not isinstance(symbol.function, UndefinedFunction) and symbol.function is not None or bare in self.known.definitions:
            return True
        near = near_names(bare, {*self.known.definitions, *_functions_seen_from(symbol)})
        self.tell(word, WARNING, f"Nothing defines the function {word.text}.", meant_in_lisp(near))
        return False

    @_for("REGISTER-LOCATION-GENERATOR", "REGISTER-LOCATION-VALIDATION-FUNCTION")
    def _registered(self, form, name):
        word = form.items[2] if len(form.items) > 2 else None
        symbol = self.resolve(word, True) if _is_word(word) else None
        if isinstance(symbol, Symbol):
            self._function(word, symbol)

    def _lonely_variables(self, clause):
        """A variable that occurs once is no mistake by itself; it is told if another one has almost its name."""
        tokens, waiting = [], [clause]
        while waiting:
            for item in waiting.pop().items:
                if isinstance(item, Form):
                    waiting.append(item)
                elif item.kind == "word" and item.text.startswith("?") and len(item.text) > 2 and not item.text.startswith("?_"):
                    tokens.append(item)
        counts = {}
        for token in tokens:
            counts.setdefault(token.text.upper(), []).append(token)
        for name, found in counts.items():
            near = near_names(name, [other for other in counts if other != name], 1) if len(found) == 1 and name[-1].isalpha() else ()
            near = [each for each in near if SequenceMatcher(None, name, each).ratio() >= _ALMOST]
            if near and not near[0][-1].isdigit() and (len(counts[near[0]]) > 1 or counts[near[0]][0].start < found[0].start):
                self.tell(found[0], HINT, f"The variable {found[0].text} occurs only once in this clause.", meant_in_lisp(near[:1]))


def _is_word(item):
    return item is not None and not isinstance(item, Form) and item.kind == "word"


def _unprefixed(form):
    """The items of ``form`` without the ``f`` of Hy's ``f"..."``."""
    ends = {item.start for item in form.items if not isinstance(item, Form) and item.kind == "string"}
    return [item for item in form.items if not (_is_word(item) and item.end in ends)]


def _quoted(form, index):
    """The word behind a quote at ``index``, or ``None``."""
    quote, word = (form.items[index : index + 2] + [None, None])[:2]
    return word if _is_word(word) and not isinstance(quote, Form) and quote.text == "'" else None


def _functions_seen_from(symbol):
    package = symbol.package
    for table in (package.internal, package.external, *(used.external for used in package.use)) if package is not None else ():
        for name, other in table.items():
            if isinstance(other, Symbol) and other.function is not None and not isinstance(other.function, UndefinedFunction):
                yield name


def _needed(nodes):
    """How many arguments the parsed control string takes; ``None`` if that depends on them."""
    count = 0
    for node in nodes:
        if isinstance(node, str):
            continue
        if node.char in _ONE_ARGUMENT:
            count += 1
        elif node.char not in _NO_ARGUMENT:
            return None
        count += sum(1 for _, value in node.params or () if value is format_parser.ARGUMENT_MARK)
    return count
