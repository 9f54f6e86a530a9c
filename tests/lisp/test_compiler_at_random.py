"""Random programs mean the same to the compiler and to an interpreter of a page.

The programs mix binding, assignment, closures, loops, local functions, exits and handlers in all nestings, also in argument position,
where the compiler must save what was evaluated before. The interpreter below follows the standard and knows nothing of Python's
statements, so it cannot make the compiler's mistakes.
"""

from __future__ import annotations

from systems import SOAK
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.repl.session import Session

# A program is a nested tuple; strings are symbols. ``n`` makes a number of anything, so that ``+`` always has numbers.


class Names:
    """What is in scope: variables, blocks, functions of one argument, catch tags, operators that signal what is handled around."""

    def __init__(self, variables=(), blocks=(), functions=(), tags=(), signals=()):
        self.variables, self.blocks, self.functions, self.tags, self.signals = variables, blocks, functions, tags, signals

    def plus(self, **more):
        fields = {name: getattr(self, name) for name in ("variables", "blocks", "functions", "tags", "signals")}
        return Names(**{name: (*value, *more.get(name, ())) for name, value in fields.items()})


@st.composite
def programs(draw, names=Names(), depth=4):
    def expression(names=names):
        return draw(programs(names, depth - 1))

    def body(names=names, most=3):
        return [expression(names) for _ in range(draw(st.integers(1, most)))]

    def statements(names=names):  # of a tagbody, where bare numbers and symbols would be tags
        return [("progn", form) for form in body(names)]

    simple = ["number"] + ["variable"] * 3 * bool(names.variables)
    if depth <= 0:
        kind = draw(st.sampled_from(simple))
    else:
        kinds = (
            simple
            + """+ + list progn if let let let* dotimes dolist block block flet labels lambda unwind-protect catch when and
            or remember values tagbody < do handler-case handler-case handler-bind ignore-errors
            search search destructuring-bind""".split()
        )
        kinds += ["signal"] * 4 * bool(names.signals)
        kinds += ["setq"] * 4 * bool(names.variables) + ["return-from"] * 3 * bool(names.blocks)
        kinds += ["call"] * 2 * bool(names.functions) + ["throw"] * bool(names.tags)
        kind = draw(st.sampled_from(kinds))
    new = draw(st.sampled_from("abc"))
    match kind:
        case "number":
            return draw(st.integers(-3, 9))
        case "variable":
            return draw(st.sampled_from(names.variables))
        case "setq":
            return ("setq", draw(st.sampled_from(names.variables)), expression())
        case "+" | "<":
            return (kind, ("n", expression()), ("n", expression()))
        case "list" | "progn" | "and" | "or":
            return (kind, *body())
        case "if" | "when":
            return (kind, expression(), expression(), *([expression()] if kind == "if" else []))
        case "let":
            return ("let", ((new, expression()), ("d", expression())), *body(names.plus(variables=(new, "d"))))
        case "let*":
            inner = names.plus(variables=(new,))
            return ("let*", ((new, expression()), ("d", expression(inner))), *body(inner.plus(variables=("d",))))
        case "dotimes":
            return (
                "dotimes",
                (new, draw(st.integers(0, 3)), expression(names.plus(variables=(new,), blocks=("nil",)))),
                *statements(names.plus(variables=(new,), blocks=("nil",))),
            )
        case "dolist":
            return ("dolist", (new, ("list", *body())), *statements(names.plus(variables=(new,), blocks=("nil",))))
        case "do":
            inner = names.plus(variables=("i",), blocks=("nil",))
            counting = ("i", 0, ("setq", "k", ("+", "k", 1)))
            end = ((">=", "k", 2), expression(inner))
            return ("let", (("k", 0),), ("do", (counting,), end, *statements(inner)), draw(programs(names, 0)))
        case "block":
            name = draw(st.sampled_from("pq"))
            return ("block", name, *body(names.plus(blocks=(name,))))
        case "return-from":
            return ("return-from", draw(st.sampled_from(names.blocks)), expression())
        case "flet" | "labels":
            name = draw(st.sampled_from("fg"))
            function = (name, (new,), *body(names.plus(variables=(new,), blocks=(name,))))
            return (kind, (function,), *body(names.plus(functions=(name,))))
        case "call":
            return (draw(st.sampled_from(names.functions)), expression())
        case "lambda":
            return ("funcall", ("lambda", (new,), *body(names.plus(variables=(new,)))), expression())
        case "unwind-protect":
            return ("unwind-protect", expression(), *body(most=2))
        case "catch":
            return ("catch", ("quote", "tag"), *body(names.plus(tags=("tag",))))
        case "throw":
            return ("throw", ("quote", "tag"), expression())
        case "remember":  # a closure that is called when all is over: it may use no block, for that is left by then
            return ("push", ("lambda", (), draw(programs(Names(names.variables, (), (), ()), depth - 1))), "closures")
        case "values":
            return ("multiple-value-bind", (new, "d"), ("values", *body()), *body(names.plus(variables=(new, "d"))))
        case "handler-case":
            types = draw(st.lists(st.sampled_from(list(CONDITIONS)), min_size=1, max_size=3, unique=True))
            form = expression(names.plus(signals=("error", "signal", "fails") if "trouble" in types else ()))
            return ("handler-case", form, *(handler(type_, new, body(names.plus(variables=(new,)))) for type_ in types))
        case "ignore-errors":
            return ("ignore-errors", *body(names.plus(signals=("error", "signal", "fails"))))
        case "handler-bind":
            types = draw(st.lists(st.sampled_from(list(CONDITIONS)), min_size=1, max_size=2))
            function = [("lambda", *handler(type_, new, body(names.plus(variables=(new,))))[1:]) for type_ in types]
            return ("handler-bind", tuple(zip(types, function)), *body(names.plus(signals=("signal",))))
        case "search":
            name = draw(st.sampled_from(SEARCHES))
            items = ("list", *body(most=4))
            if "remove" not in name and name != "mapcar" and draw(st.booleans()):
                items = ("coerce", items, "'vector")
            return (name, ("lambda", (new,), *body(names.plus(variables=(new,)))), items)
        case "destructuring-bind":
            form = ("list", expression(), ("list", *body(most=3)), *body(most=2))
            pattern = ("a", ("b", "&rest", "c"), "&rest", "d")
            return ("destructuring-bind", pattern, form, *body(names.plus(variables=("a", "b", "c", "d"))))
        case "signal":
            return (draw(st.sampled_from(names.signals)), ("quote", draw(st.sampled_from(list(CONDITIONS)))), ":value", expression())
        case "tagbody":
            step = ("setq", "e", ("+", "e", 1))
            back = ("if", ("<", "e", draw(st.integers(0, 4))), ("go", "again"))
            onward = ("if", expression(), ("funcall", ("lambda", (), ("go", "end"))))
            parts = (step, *statements(), "again", step, *statements(), back, onward, *statements(), "end")
            return ("let", (("e", 0),), ("tagbody", *parts), "e")


CONDITIONS = {"trouble": ("trouble",), "small-trouble": ("small-trouble", "trouble"), "other-trouble": ("other-trouble", "trouble")}
"""The classes of conditions of the programs, each with those that are above it."""


SEARCHES = "find-if position-if count-if some every notany notevery remove-if remove-if-not mapcar".split()
"""Functions of a function and a sequence that the compiler writes in place."""


def handler(type_, variable, forms):
    """A clause of ``handler-case``, in which ``variable`` is the value in the condition."""
    return (type_, ("c",), ("let", ((variable, ("value-of", "c")),), *forms))


# --------------------------------------------------------------------------------------------------------- the interpreter


class Exit(BaseException):
    def __init__(self, target, value):
        self.target, self.value = target, value


class Go(Exit):
    pass


def run(form, env):
    """The value of ``form``; ``env`` maps ("variable" | "block" | "function" | "tag", name) to cells, tokens or functions."""
    if isinstance(form, str):
        return None if form == "nil" else form if form[0] in ":'" else env["variable", form][0]
    if not isinstance(form, tuple):
        return form
    return first(values(form, env))


def first(many):
    return many[0] if many else None


def sequence(forms, env):
    result = [None]
    for form in forms:
        result = values(form, env)
    return result


def binding(env, names, given, kind="variable"):
    return {**env, **{(kind, name): [value] for name, value in zip(names, given)}}


def exits(env, name, thunk, kind="block"):
    token = object()
    try:
        return thunk({**env, (kind, name): token})
    except Exit as exit_:
        if exit_.target is not token:
            raise
        return exit_.value


def function(parameters, forms, env):
    return lambda *given: sequence(forms, binding(env, parameters, given))


def taken_apart(pattern, items):
    """(variable, value) pairs of a list ``pattern`` with &rest."""
    if not pattern:
        return []
    name, *others = pattern
    if name == "&rest":
        return [(others[0], items or None)]
    return [*(taken_apart(name, items[0]) if isinstance(name, tuple) else [(name, items[0])]), *taken_apart(others, items[1:])]


class Signalled:
    """A condition."""

    def __init__(self, name, value):
        self.name, self.value = name, value


handlers = []  # in force, the innermost last: a list of (type, function of the condition)


def with_handlers(cluster, thunk):
    handlers.append(cluster)
    try:
        return thunk()
    finally:
        handlers.pop()


def signal(condition):
    """Ask the handlers, the innermost first; each runs with only those around its cluster in force."""
    global handlers
    asked = handlers
    for index in reversed(range(len(asked))):
        for type_, function in asked[index]:
            if type_ == "error" or type_ in CONDITIONS[condition.name]:
                handlers = asked[:index]
                try:
                    function(condition)
                finally:
                    handlers = asked
    return [None]


class TooLong(BaseException):
    """A program that does not seem to end."""


steps = 0


def values(form, env):
    """All values of ``form``, a list."""
    global steps
    steps += 1
    if steps > 3000:
        raise TooLong
    if not isinstance(form, tuple):
        return [run(form, env)]
    head, *rest = form
    match head:
        case "setq":
            env["variable", rest[0]][0] = result = run(rest[1], env)
            return [result]
        case "progn":
            return sequence(rest, env)
        case "if" | "when":
            if run(rest[0], env) is not None:
                return values(rest[1], env)
            return values(rest[2], env) if len(rest) > 2 else [None]
        case "and" | "or":
            for item in rest[:-1]:
                result = run(item, env)
                if (result is None) == (head == "and"):
                    return [result]
            return values(rest[-1], env)
        case "let":
            return sequence(rest[1:], binding(env, [name for name, _ in rest[0]], [run(value, env) for _, value in rest[0]]))
        case "let*":
            for name, value in rest[0]:
                env = binding(env, [name], [run(value, env)])
            return sequence(rest[1:], env)
        case "multiple-value-bind":
            given = values(rest[1], env) + [None, None]
            return sequence(rest[2:], binding(env, rest[0], given))
        case "values":
            return [run(item, env) for item in rest]
        case "block":
            return exits(env, rest[0], lambda inner: sequence(rest[1:], inner))
        case "return-from":
            result = values(rest[1], env)
            raise Exit(env["block", rest[0]], result)
        case "catch":
            return exits(env, "tag", lambda inner: sequence(rest[1:], inner), "catch")
        case "throw":
            result = values(rest[1], env)
            raise Exit(env["catch", "tag"], result)
        case "unwind-protect":
            try:
                return values(rest[0], env)
            finally:
                sequence(rest[1:], env)
        case "dotimes" | "dolist":
            name, given, *result = rest[0]

            def loop(env):
                items = run(given, env)
                for item in range(items) if head == "dotimes" else items:
                    sequence(rest[1:], binding(env, [name], [item]))
                return values(result[0], binding(env, [name], [items])) if result else [None]

            return exits(env, "nil", loop)
        case "do":
            (name, initial, step), (test, result), *forms = rest[0][0], rest[1], *rest[2:]

            def loop(env):
                inner = binding(env, [name], [run(initial, env)])
                while run(test, inner) is None:
                    sequence(forms, inner)
                    inner["variable", name][0] = run(step, inner)
                return values(result, inner)

            return exits(env, "nil", loop)
        case "tagbody":
            token = object()
            inner, at = {**env, ("tagbody", ""): token}, 0
            while at < len(rest):
                try:
                    if isinstance(rest[at], tuple):
                        values(rest[at], inner)
                    at += 1
                except Go as exit_:
                    if exit_.target is not token:
                        raise
                    at = rest.index(exit_.value)
            return [None]
        case "go":
            raise Go(env["tagbody", ""], rest[0])
        case "lambda":
            return [function(rest[0], rest[1:], env)]
        case "flet" | "labels":
            ((name, parameters, *forms),) = rest[0]
            inner = dict(env)
            inner["function", name] = function(parameters, [("block", name, *forms)], inner if head == "labels" else env)
            return sequence(rest[1:], inner)
        case "push":
            cell = env["variable", rest[1]]
            cell[0] = [run(rest[0], env), *cell[0]]
            return [0]
        case "quote":
            return [rest[0]]
        case "handler-case":
            token = object()

            def leave(clause):
                def handle(condition):
                    raise Exit(token, (clause, condition))

                return handle

            try:
                return with_handlers([(clause[0], leave(clause)) for clause in rest[1:]], lambda: values(rest[0], env))
            except Exit as exit_:
                if exit_.target is not token:
                    raise
                (_, parameters, *forms), condition = exit_.value
            return sequence(forms, binding(env, parameters, [condition]))
        case "ignore-errors":
            token = object()

            def leave(condition):
                raise Exit(token, [None, condition])

            try:
                return with_handlers([("error", leave)], lambda: sequence(rest, env))
            except Exit as exit_:
                if exit_.target is not token:
                    raise
                return exit_.value
        case "destructuring-bind":
            return sequence(rest[2:], binding(env, *zip(*taken_apart(rest[0], run(rest[1], env)))))
        case "handler-bind":
            return with_handlers([(type_, run(function, env)) for type_, function in rest[0]], lambda: sequence(rest[1:], env))
    given = [run(item, env) for item in rest]
    match head:
        case "+":
            return [sum(given)]
        case "<" | ">=":
            return [True if (given[0] < given[1]) == (head == "<") else None]
        case "n":
            return [given[0] if type(given[0]) is int else 0]
        case "list":
            return [given]
        case "funcall":
            return given[0](*given[1:])
        case "coerce":
            return [given[0]]
        case "mapcar":
            return [[first(given[0](item)) for item in given[1]]]
        case "find-if" | "position-if" | "some":
            for index, item in enumerate(given[1]):
                if (answer := first(given[0](item))) is not None:
                    return [{"find-if": item, "position-if": index, "some": answer}[head]]
            return [None]
        case "every" | "notany" | "notevery":
            for item in given[1]:
                if (first(given[0](item)) is None) == (head != "notany"):
                    return [True if head == "notevery" else None]
            return [None if head == "notevery" else True]
        case "count-if" | "remove-if" | "remove-if-not":
            chosen = [item for item in given[1] if (first(given[0](item)) is not None) == (head != "remove-if")]
            return [len(chosen) if head == "count-if" else chosen or None]
        case "value-of":
            return [given[0].value]
        case "error" | "signal" | "fails":
            return signal(Signalled(given[0], given[2]))
    return env["function", head](*given)


# ------------------------------------------------------------------------------------------------------------------- tests


def text(form):
    if isinstance(form, tuple):
        return "(" + " ".join(map(text, form)) + ")"
    return str(form)


def plain(value):
    """Lisp data as lists, to compare."""
    if isinstance(value, Cons):
        return [plain(item) for item in value]
    if isinstance(value, Condition):
        return type(value).__name__.lower()
    return "function" if callable(value) and value is not True else value


def reference(program):
    """The value of ``program``, and those of the closures that it remembered."""
    global steps
    steps = 0
    handlers.clear()
    env = {("variable", "closures"): [[]]}
    result = run(program, env)
    return [lists(result), lists([first(closure()) for closure in env["variable", "closures"][0]])]


def lists(value):
    if isinstance(value, list):
        return [lists(item) for item in value] if value else None
    if isinstance(value, Signalled):
        return value.name.replace("-", "")
    return "function" if callable(value) and value is not True else value


_session = []


@settings(max_examples=150 if SOAK else 25, deadline=None, suppress_health_check=list(HealthCheck))
@given(programs())
def test_the_compiler_and_the_interpreter_agree(program):
    if not _session:
        _session.append(Session(time="virtual", turtlesim=False))
        _session[0].evaluate_text("(defun n (x) (if (integerp x) x 0))")
        _session[0].evaluate_text("""(define-condition trouble (error) ((value :initarg :value :reader value-of)))
            (define-condition small-trouble (trouble) ()) (define-condition other-trouble (trouble) ())
            (defun fails (&rest arguments) (apply #'error arguments))""")
        _session[0].evaluate_text("(defmacro remember (closure list) `(progn (push ,closure ,list) 0))")
    try:
        wanted = reference(program)
    except (TooLong, RecursionError):
        return
    (got,) = _session[0].evaluate_text(
        f"(let ((closures nil)) (let ((r {text(program)})) (list r (mapcar #'funcall closures))))".replace("(push ", "(remember ")
    )
    assert plain(got) == wanted, text(program)
