"""Lisp text of a plan as the text of the same plan in plain Hy, for tests that run in both.

`hy_text` reads Lisp's text as lists of words and writes each form as a Hy programmer would: a ``let`` has brackets, ``#'f`` is ``f``,
``nil`` is ``None``, ``(return x)`` is ``(leave x)``. How the parts of an operator are written, its grammar says: lists that are no calls get
brackets. A call of a function of Common Lisp that Hy does not have becomes one of the object ``cl``. `NotConvertible` is raised for what
plain Hy has no form for, such as ``return-from`` or a bound special variable.
"""

from __future__ import annotations

import re

from lisp_words import Literal, Marked, NotConvertible, implementation, is_declaration, is_hook, is_special, lisp_function, ours, read

from cramhy_runtime.lisp_core.packages import COMMON_LISP
from cramhy_runtime.languages.hy.call_parts import CODE
from cramhy_runtime.languages.hy.expansion import DEFINITIONS
from cramhy_runtime.languages.operators import OPERATORS
from cramhy_runtime.languages.operators.grammar import Many, Maybe, Text, Word

BY_NAME = {operator.name.lower(): operator for operator in OPERATORS.values()}
AS_DATA = ("a", "an", "all", "<-", "def-fact-group")
"""The operators whose parts are data through and through."""

SAME = frozenset("+ - * / < > <= >= = and or not do when if".split())


def hy_text(text, lists="python"):
    """The Hy text of a Lisp text. lists: whether ``(list a b)`` becomes a list of Python, ``[a b]``, or stays one of "lisp"."""
    writer = Writer(lists)
    return "\n".join(writer.form(form) for form in read(text))


def _short(name):
    return name.rpartition(":")[2]


class Writer:
    def __init__(self, lists):
        self.lists = lists
        self.specials, self.functions, self.classes = set(), set(), set()
        self.of_functions = set()  # macros whose bodies become functions
        self.with_values = set()  # names of variables that are objects with a ``value``: of tasks, and parameters
        self.scopes = [{}]  # innermost last; each is a function's: name → None
        self.exits = ["leave"]

    # ------------------------------------------------------------------------------------------------------------ words

    def form(self, form):
        if isinstance(form, list):
            return self.call(form) if form else "None"
        if isinstance(form, Literal):
            return form.replace("\\", "\\\\") if "\\" in form.replace('\\"', "") else str(form)
        if isinstance(form, Marked):
            return self.marked(form)
        if form in ("nil", "t"):
            return {"nil": "None", "t": "True"}[form]
        if form.startswith(":"):
            return f"(lisp {form})"
        if form.startswith(("#", "|")) or "\\" in form:
            raise NotConvertible(form)
        if re.fullmatch(r"[-+]?[\d.]+d\d+", form):
            return form.replace("d", "e")
        if re.fullmatch(r"-?\d+/\d+", form):
            return f"(hy.I.fractions.Fraction {form.replace('/', ' ')})"
        if form in self.with_values or form not in self.specials and is_special(form):
            return f"(. {self.variable(form)} value)"
        return form

    def variable(self, name):
        """The object whose ``value`` the variable is: of a Hy variable that has one, or the symbol of Lisp."""
        return name if name in self.with_values else f"(lisp {name})"

    def marked(self, form):
        if form.mark == "'":
            if isinstance(form.form, str) and form.form in self.classes:
                return form.form
            return f"(lisp {self.data(form.form)})"
        if form.mark == "#'":
            return self.function(form.form)
        if form.mark == "`":
            return "`" + self.form(form.form)
        return {",": "~", ",@": "~@"}[form.mark] + self.form(form.form)

    def function(self, form):
        if isinstance(form, list):
            return self.form(form)
        form = form.removeprefix("cl:")
        if is_hook(_short(form)):
            return f"hooks.{_short(form)}"
        if form in self.functions:
            return form
        if ours(form):
            return f"(fn [#* arguments] ({form} #* arguments))"
        if implementation(form):
            return f"(fn [#* arguments] (cpl-impl::{form} #* arguments))"
        return f"cl.{form}" if lisp_function(form) else form

    def data(self, form):
        if isinstance(form, list):
            return "(" + " ".join(map(self.data, form)) + ")"
        if isinstance(form, Marked):
            return f"(quote {self.data(form.form)})" if form.mark == "'" else form.mark.replace(",", "~") + self.data(form.form)
        if form.startswith("#"):
            raise NotConvertible(form)
        return str(form)

    def bracketed(self, items):
        return "[" + " ".join(items) + "]"

    # ------------------------------------------------------------------------------------------------------------ calls

    def call(self, form):
        head, *parts = form
        if isinstance(head, str) and head.startswith("cl:"):
            head = head[3:]
        if isinstance(head, list):
            return "(" + " ".join(map(self.form, form)) + ")"
        if isinstance(head, Marked):
            return "(" + " ".join(map(self.form, form)) + ")"
        method = FORMS.get(head)
        if method is not None:
            return method(self, *parts)
        if head == "with-policy" and parts[0] == "timeout-policy":  # it is Lisp's, and Hy knows it by its name
            return self.call(["with-named-policy", Marked("'", parts[0]), *parts[1:]])
        if head in self.of_functions:
            return self.inside(f"({head}", parts)
        if head in self.functions:
            return f"({' '.join([head, *map(self.form, parts)])})"
        if _short(head) in BY_NAME and (":" in head or head in BY_NAME):
            return self.operator(head, BY_NAME[_short(head)], parts)
        if head == ":tag":
            return self.inside(f"(:tag {parts[0]}", parts[1:])
        if head in SAME:
            return f"({' '.join([head, *map(self.form, parts)])})"
        if head in ("retry", "do-retry", "get-counter", "reset-counter", "succeed", "next", "finish", "cont", "make-response"):
            return f"({' '.join([head, *map(self.argument, parts)])})"
        if _short(head) == "pat-match":
            return f"(get (all-values ({' '.join([head, *map(self.argument, parts)])})) 0)"
        if ours(head) or head in self.classes:
            return f"({' '.join([head, *map(self.argument, parts)])})"
        if implementation(head):
            return f"(cpl-impl::{head} {' '.join(map(self.argument, parts))})"
        if lisp_function(head):
            return f"(cl.{head} {' '.join(map(self.form, parts))})"
        if COMMON_LISP.external.get(head.upper()) is not None:
            raise NotConvertible(head)
        return f"({' '.join([head, *map(self.form, parts)])})"

    def argument(self, form):
        """An argument of a function of ours, whose quoted names and keywords are Lisp's as they stand."""
        if isinstance(form, str) and form.startswith(":"):
            return form
        if isinstance(form, Marked) and form.mark == "'" and not (isinstance(form.form, str) and form.form in self.classes):
            return "'" + self.data(form.form)
        return self.form(form)

    def body(self, forms):
        forms = [form for form in forms if not is_declaration(form)]
        return " ".join(map(self.form, forms)) if forms else "None"

    def inside(self, before, forms, names=(), after=")"):
        """The forms, which are in a function of their own with these names, behind ``before``."""
        self.scopes.append(dict.fromkeys(names))
        try:
            return f"{before} {self.body(forms)}{after}"
        finally:
            self.scopes.pop()

    # -------------------------------------------------------------------------------------------------------- operators

    def operator(self, head, operator, parts):
        if operator.name.lower() in AS_DATA:
            if operator.name in ("DEF-FACT-GROUP",):
                return f"({head} {parts[0]} {self.bracketed(parts[1])} {' '.join(map(self.data, parts[2:]))})"
            return "(" + " ".join([head, *map(self.data, parts)]) + ")"
        parts = [part for part in parts if not is_declaration(part)]
        if operator.name in ("DEFINE-TASK-VARIABLE", "DEF-CPL-PARAMETER"):
            parts = parts[:2] + [Literal('""') if part == "nil" else part for part in parts[2:3]] + parts[3:]
        outer = self.exits
        self.exits = [*outer, "break" if operator.name == "WHENEVER" else "leave"]
        function = operator.name.startswith(DEFINITIONS)  # other bodies assign the variables of the function around
        if function:
            self.scopes.append({})
        try:
            pattern = operator.patterns[-1] if isinstance(parts[:1], list) and isinstance((parts or [[]])[0], str) else operator.pattern
            return "(" + " ".join([head, *self.parts(pattern, list(parts), operator)]) + ")"
        finally:
            if operator.name in ("DEFINE-TASK-VARIABLE", "DEF-CPL-PARAMETER"):
                self.with_values.add(parts[0])
            self.exits = outer
            if function:
                self.scopes.pop()

    def parts(self, pattern, parts, operator):
        made = []
        options = {item.items[0]: item.items[1] for item in pattern if isinstance(item, Maybe) and str(item.items[0]).startswith(":")}
        for place, item in enumerate(pattern):
            while options and len(parts) > 1 and parts[0] in list(options):
                key = parts.pop(0)
                made += [key, self.part(options[key], parts.pop(0), operator)]
            if not parts:
                break
            if isinstance(item, Many) and isinstance(item.item, Maybe):
                while parts:
                    made += [self.part(each, parts.pop(0), operator) for each in item.item.items if parts]
                return made
            if isinstance(item, Many):
                made += [self.part(item.item, part, operator) for part in parts]
                return made
            if isinstance(item, Maybe):
                if isinstance(parts[0], Literal) and isinstance((pattern[place + 1 :] or [None])[0], Text):
                    continue
                made += self.maybe(item, parts, operator)
                continue
            made.append(self.part(item, parts.pop(0), operator))
        return made + [self.loose(part) for part in parts]

    def maybe(self, item, parts, operator):
        first = item.items[0]
        if isinstance(first, Word) and first.startswith(":"):
            return []
        if isinstance(first, Text) and not isinstance(parts[0], Literal):
            return []
        if not isinstance(parts[0], Literal) and isinstance(parts[0], str) and parts[0].startswith(":"):
            return []
        made = [self.part(first, parts.pop(0), operator)]
        for more in item.items[1:]:
            made += self.maybe(more, parts, operator) if parts else []
        return made

    def part(self, item, part, operator):
        if isinstance(item, list):
            if not isinstance(part, list):
                return self.loose(part)
            part = [each for each in part if not is_declaration(each)]
            if item and isinstance(item[0], Many) and item[0].item == "parameter":
                shown, names = self.lambda_list(part)
                self.scopes[-1].update(dict.fromkeys(names))
                return shown
            opening, closing = "()" if isinstance(item[0], Word) and item[0].startswith(":") else "[]"
            return opening + " ".join(self.parts(item, list(part), operator)) + closing
        if item == "parameter":
            return self.parameter(part)
        if item in CODE or item in ("list", "fact", "value", "function", "seconds"):
            return self.form(part)
        if item == "clause" and isinstance(part, list):
            return "(" + " ".join([part[0], *map(self.argument, part[1:])]) + ")"
        return self.loose(part)

    def loose(self, part):
        """A part that is names, data, or code in lists."""
        if part == "nil":
            return "None"
        if isinstance(part, list) and not part:
            return "[]"
        if isinstance(part, list):
            return "[" + " ".join(map(self.loose, part)) + "]" if all(isinstance(each, str) for each in part) else self.data(part)
        return self.form(part) if not isinstance(part, str) or not part.startswith(":") else part

    def parameter(self, part):
        if isinstance(part, str) and part.startswith("&"):
            raise NotConvertible(part)
        return self.form(part)

    # ---------------------------------------------------------------------------------------------------- Lisp's own

    def lambda_list(self, items):
        made, sign, names = [], None, []
        for item in items:
            if isinstance(item, str) and item.startswith("&"):
                sign = item
                if sign == "&key":
                    made.append("*")
                continue
            name = item[0] if isinstance(item, list) else item
            names.append(name)
            default = self.form(item[1]) if isinstance(item, list) and len(item) > 1 else "None"
            if sign in ("&rest", "&body"):
                made.append(f"#* {name}")
            else:
                made.append(f"[{name} {default}]" if sign else name)
        return self.bracketed(made), names

    def lambda_(self, parameters, *forms):
        shown, names = self.lambda_list(parameters)
        return self.inside(f"(fn {shown}", forms, names)

    def defun(self, name, parameters, *forms):
        self.functions.add(name)
        shown, names = self.lambda_list(parameters)
        return self.inside(f"(defn {name} {shown}", forms, names)

    def defmacro(self, name, parameters, *forms):
        self.functions.add(name)
        apart = []
        for place, part in enumerate(parameters):
            if isinstance(part, str) and part.startswith("&"):
                break
            if isinstance(part, list):
                apart.append(f"(setv {self.lambda_list(part)[0]} part-{place})")
                parameters = [*parameters[:place], f"part-{place}", *parameters[place + 1 :]]
        return f"(defmacro {name} {self.lambda_list(parameters)[0]} {' '.join([*apart, self.body(forms)])})"

    def flet(self, functions, *forms):
        return f"(do {' '.join(self.defun(*function) for function in functions)} {self.body(forms)})"

    def let(self, bindings, *forms):
        pairs, bound = [], []
        for binding in bindings:
            name, value = (binding[0], binding[1:]) if isinstance(binding, list) else (binding, [])
            if name in self.with_values or name not in self.specials and is_special(name):
                bound += [self.variable(name), self.form(value[0]) if value else "None"]
                continue
            if name in self.specials or name.startswith("*"):
                raise NotConvertible(f"the special variable {name} bound")
            pairs += [name, self.form(value[0]) if value else "None"]
            self.scopes[-1][name] = None
        if bound:
            body = f"(with [_ (binding {' '.join(bound)})] {self.body(forms)})"
            return f"(let {self.bracketed(pairs)} {body})" if pairs else body
        if len(self.scopes) > 1:
            return f"(let {self.bracketed(pairs)} {self.body(forms)})"
        names = pairs[::2]
        return self.inside(f"((fn [] (let {self.bracketed(pairs)}", forms, names, ")))")

    def declared(self, name):
        """The words that let an assignment of ``name`` reach the variable, if it belongs to another function."""
        if name in self.with_values or name not in self.specials and is_special(name):
            return ""
        if name in self.specials or (len(self.scopes) > 1 and not any(name in scope for scope in self.scopes)):
            return f"(global {name})" if len(self.scopes) > 1 else ""
        if name in self.scopes[-1]:
            return ""
        return f"(nonlocal {name})"

    def setf(self, *pairs):
        made, target = [], "None"
        for place, value in zip(pairs[::2], pairs[1::2]):
            target = self.place(place)
            declared = self.declared(place) if isinstance(place, str) else ""
            made.append(f"{declared} (setv {target} {self.form(value)})")
        return f"(do {' '.join(made)} {target})"

    def place(self, place):
        if isinstance(place, str):
            return self.form(place)
        if place[0] in ("value", "cpl:value") and len(place) == 2:
            return f"(. {self.form(place[1])} value)"
        if place[0] == "slot-value" and isinstance(place[2], Marked):
            return f"(. {self.form(place[1])} {place[2].form})"
        raise NotConvertible(f"(setf ({place[0]} ...) ...)")

    def incf(self, place, by="1", sign="+"):
        target = self.place(place)
        declared = self.declared(place) if isinstance(place, str) else ""
        return f"(do {declared} ({sign}= {target} {self.form(by)}) {target})"

    def push(self, element, place):
        return self.setf(place, ["cons", element, place])

    def pop(self, place):
        return f"(let [first (cl.car {self.form(place)})] {self.setf(place, ['cdr', place])} first)"

    def pushnew(self, element, place):
        return self.setf(place, ["adjoin", element, place])

    def destructuring_bind(self, names, form, *forms):
        if any(isinstance(name, list) or name.startswith("&") for name in names):
            raise NotConvertible("destructuring-bind of a list in a list")
        self.scopes[-1].update(dict.fromkeys(names))
        return f"(do (setv {self.bracketed(names)} {self.form(form)}) {self.body(forms)})"

    def defmethod(self, name, *parts):
        """A method of a hook of ours is a function that is added to it. Other generic functions belong to Lisp."""
        *qualifiers, parameters = [*parts[: next(i for i, part in enumerate(parts) if isinstance(part, list)) + 1]]
        forms, hook = parts[len(qualifiers) + 1 :], _short(name)
        if not is_hook(hook) or any(isinstance(part, list) for part in parameters):
            raise NotConvertible("defmethod")
        return f'(.add hooks.{hook} {self.lambda_(parameters, *forms)} "{" ".join(qualifiers)}")'

    def defvar(self, name, value="nil", *documentation):
        self.specials.add(name)
        return f"(setv {name} {self.form(value)})"

    def cond(self, *clauses):
        made = [f"{self.form(clause[0])} (do {self.body(clause[1:])})" for clause in clauses]
        return f"(cond {' '.join(made)})"

    def case(self, key, *clauses):
        made = []
        for keys, *forms in clauses:
            keys = keys if isinstance(keys, list) else [keys]
            test = "True" if keys in (["t"], ["otherwise"]) else f"(in key [{' '.join(f'(lisp {self.data(key)})' for key in keys)}])"
            made.append(f"{test} (do {self.body(forms)})")
        return f"(let [key {self.form(key)}] (cond {' '.join(made)}))"

    def for_(self, spec, source, *forms):
        self.scopes[-1][spec] = None
        outer, self.exits = self.exits, [*self.exits, "break"]
        try:
            return f"(for [{spec} {source}] {self.body(forms)})"
        finally:
            self.exits = outer

    def dotimes(self, spec, *forms):
        return self.for_(spec[0], f"(range {self.form(spec[1])})", *forms)

    def dolist(self, spec, *forms):
        return self.for_(spec[0], f"(or {self.form(spec[1])} [])", *forms)

    def loop(self, *parts):
        words = [part for part in parts if isinstance(part, str) and not isinstance(part, Literal)]
        if not words:
            outer, self.exits = self.exits, [*self.exits, "break"]
            try:
                return f"(while True {self.body(parts)})"
            finally:
                self.exits = outer
        match parts:
            case ["repeat", count, "collect", form]:
                return self.comprehension("_", f"(range {self.form(count)})", form)
            case ["until", test, "do", *forms]:
                return f"(while (not {self.form(test)}) {self.body(forms)})"
            case ["while", test, "do", *forms]:
                return f"(while {self.form(test)} {self.body(forms)})"
            case ["repeat", count, "do", *forms]:
                return self.for_("_", f"(range {self.form(count)})", *forms)
            case ["for", name, ("in" | "being"), source, "do", *forms] if isinstance(name, str):
                return self.dolist([name, source], *forms)
            case ["for", name, "in", source, "collect", form] if isinstance(name, str):
                return self.comprehension(name, f"(or {self.form(source)} [])", form)
            case ["for", name, "from", low, ("to" | "below") as end, high, "collect", form]:
                last = self.form(high) if end == "below" else f"(+ 1 {self.form(high)})"
                return self.comprehension(name, f"(range {self.form(low)} {last})", form)
            case ["for", name, "from", low, ("to" | "below") as end, high, "do", *forms]:
                last = self.form(high) if end == "below" else f"(+ 1 {self.form(high)})"
                return self.for_(name, f"(range {self.form(low)} {last})", *forms)
        raise NotConvertible("loop " + " ".join(words))

    def comprehension(self, name, source, form):
        made = f"(lfor {name} {source} {self.form(form)})"
        return made if self.lists == "python" else f"(cl.list #* {made})"

    def list_(self, *forms):
        made = [self.form(form) for form in forms]
        return self.bracketed(made) if self.lists == "python" else f"(cl.list {' '.join(made)})"

    def handler_case(self, form, *clauses):
        made = []
        for type_, parameters, *forms in clauses:
            if type_ == ":no-error":
                raise NotConvertible("handler-case with :no-error")
            name = (parameters or ["problem"])[0]
            if parameters:
                self.scopes[-1][name] = None
            made.append(f"(except [{name} {self.class_(type_)}] {self.body(forms)})")
        return f"(try {self.form(form)} {' '.join(made)})"

    def class_(self, name):
        if isinstance(name, list):
            return f"#({' '.join(map(self.class_, name[1:]))})"
        return name if name in self.classes else f"(class-of-condition (lisp {name}))"

    def define_condition(self, name, bases, *options):
        if len(options) > 1 or options and options[0]:
            raise NotConvertible("define-condition with slots")
        self.classes.add(name)
        shown = [base if base in self.classes else self.class_(base) for base in bases]
        return f"(defclass {name} [{' '.join(shown)}])"

    def remove_method(self, function, method):
        if isinstance(function, Marked) and not is_hook(_short(function.form)):
            raise NotConvertible("remove-method")
        return f'(.remove {self.form(function)} "laws")'

    def handler_bind(self, clauses, *forms):
        made = [f"#({self.class_(type_)} {self.form(function)})" for type_, function in clauses]
        return self.inside(f"(handler-bind {self.bracketed(made)} (fn []", forms, after="))")

    def return_(self, *value):
        if self.exits[-1] == "break":
            if value:
                raise NotConvertible("a return with a value out of a loop")
            return "(break)"
        return f"(leave {self.form(value[0])})" if value else "(leave)"

    def values(self, *forms):
        return self.form(forms[0]) if len(forms) == 1 else f"#({' '.join(map(self.form, forms))})"

    def multiple_value_bind(self, names, form, *forms):
        self.scopes[-1].update(dict.fromkeys(names))
        return f"(do (setv #({' '.join(names)}) (all-values {self.many(form)} {len(names)})) {self.body(forms)})"

    def many(self, form):
        """A form whose values are all wanted."""
        written = self.form(form)
        if written.startswith("(get (all-values "):
            return written[len("(get (all-values ") : -len(") 0)")]
        return "(cl-values." + written[len("(cl.") :] if written.startswith("(cl.") else written

    def funcall(self, function, *arguments):
        if isinstance(function, Marked) and function.mark == "'":
            raise NotConvertible("funcall of a name")
        return f"({' '.join([self.form(function), *map(self.form, arguments)])})"

    def apply(self, function, *arguments):
        *first, last = map(self.form, arguments)
        return f"({' '.join([self.form(function), *first])} #* {last})"

    def if_(self, test, then, otherwise="nil"):
        return f"(if {self.form(test)} {self.form(then)} {self.form(otherwise)})"

    def wrong(self, *parts):
        raise NotConvertible("a form of Common Lisp")


def _word(template):
    return lambda self, *parts: template.format(" ".join(map(self.form, parts)))


FORMS = {
    "cpl-impl::log-succeed": lambda self: "(log-succeed)",
    "cpl-impl::log-fail": lambda self: "(log-fail)",
    "quote": lambda self, form: f"(lisp {self.data(form)})",
    "progn": lambda self, *forms: f"(do {self.body(forms)})",
    "lambda": Writer.lambda_,
    "defun": Writer.defun,
    "defmacro": Writer.defmacro,
    "flet": Writer.flet,
    "labels": Writer.flet,
    "let": Writer.let,
    "let*": Writer.let,
    "setf": Writer.setf,
    "setq": Writer.setf,
    "incf": Writer.incf,
    "decf": lambda self, place, by="1": self.incf(place, by, "-"),
    "push": Writer.push,
    "pop": Writer.pop,
    "pushnew": Writer.pushnew,
    "destructuring-bind": Writer.destructuring_bind,
    "defmethod": Writer.defmethod,
    "remove-method": Writer.remove_method,
    "handler-bind": Writer.handler_bind,
    "assert": lambda self, test, *rest: f"(assert {self.form(test)})",
    "nth-value": lambda self, number, form: f"(get (all-values {self.many(form)}) {self.form(number)})",
    "defvar": Writer.defvar,
    "defparameter": Writer.defvar,
    "cond": Writer.cond,
    "case": Writer.case,
    "if": Writer.if_,
    "when": lambda self, test, *forms: f"(when {self.form(test)} {self.body(forms)})",
    "unless": lambda self, test, *forms: f"(when (not {self.form(test)}) {self.body(forms)})",
    "dotimes": Writer.dotimes,
    "dolist": Writer.dolist,
    "loop": Writer.loop,
    "list": Writer.list_,
    "handler-case": Writer.handler_case,
    "ignore-errors": lambda self, *forms: f"(try {self.body(forms)} (except [Exception] None))",
    "define-condition": Writer.define_condition,
    "return": Writer.return_,
    "values": Writer.values,
    "vector": lambda self, *forms: self.bracketed(map(self.form, forms)),
    "multiple-value-list": lambda self, form: f"(cl.list #* (all-values {self.many(form)}))",
    "multiple-value-bind": Writer.multiple_value_bind,
    "funcall": Writer.funcall,
    "apply": Writer.apply,
    "unwind-protect": lambda self, form, *cleanup: f"(try {self.form(form)} (finally {self.body(cleanup)}))",
    "function": lambda self, form: self.function(form),
    "null": _word("(is {} None)"),
    "eq": lambda self, *parts: f"(eq {' '.join(map(self.argument, parts))})",
    "1+": _word("(+ {} 1)"),
    "1-": _word("(- {} 1)"),
    "/=": _word("(!= {})"),
    "mod": _word("(% {})"),
    **dict.fromkeys(("return-from", "catch", "throw", "tagbody", "restart-case", "macrolet", "symbol-macrolet"), Writer.wrong),
}
