"""Programs as SWI-Prolog reads them, with what differs between the dialects spelled out, and a way to run many of them at once.

An ``or`` stops a cut, so it is called. Arithmetic and comparison of what is no number fail. ``setof`` does not sort. What ``findall``,
``bagof`` and ``setof`` find must be of known value: where variables are left in it the dialects differ, and the query is given up, as
are those with endless terms and long proofs.
"""

import subprocess

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from cramhy_runtime.utilities.patterns import ANONYMOUS, variable

LIBRARY = r"""
:- style_check(-singleton), style_check(-discontiguous), style_check(-no_effect), style_check(-var_branches).
:- set_prolog_flag(occurs_check, error).
:- set_prolog_flag(double_quotes, string).
:- set_prolog_flag(stack_limit, 60000000).
:- use_module(library(time)).
lf_plus(X, Y, Z) :- number(X), number(Y), R is X + Y, Z = R.
lf_minus(X, Y, Z) :- number(X), number(Y), R is X - Y, Z = R.
lf_times(X, Y, Z) :- number(X), number(Y), R is X * Y, Z = R.
lp_less(X, Y) :- number(X), number(Y), X < Y.
lp_greater(X, Y) :- number(X), number(Y), X > Y.
lp_at_most(X, Y) :- number(X), number(Y), X =< Y.
lp_at_least(X, Y) :- number(X), number(Y), X >= Y.
lp_even(X) :- integer(X), 0 is X mod 2.
of_length(L, N) :- is_list(L), length(L, M), N = M.
mem(X, [X|_]).
mem(X, [_|T]) :- mem(X, T).
app([], L, L).
app([H|T], L, [H|R]) :- app(T, L, R).
all(T, G, L) :- findall(T, G, L0), ( ground(L0) -> L = L0 ; throw(dialects_differ) ).
bag(T, G, L) :- all(T, G, L0), L0 \== [], L = L0.
set(T, G, L) :- all(T, G, L0), L0 \== [], last_ones(L0, L1), L = L1.
last_ones([], []).
last_ones([H|T], R) :- last_ones(T, S), ( same_in(H, T) -> R = S ; R = [H|S] ).
same_in(H, [X|T]) :- ( H == X -> true ; same_in(H, T) ).
show(T) :- var(T), !, write(T).
show([]) :- !, write('nil').
show([H|T]) :- !, write('('), show(H), write(' . '), show(T), write(')').
show(T) :- writeq(T).
answers(N, Limit) :-
    State = count(0),
    ( query(N, Vs), \+ \+ ( numbervars_in_order(Vs), show(Vs), nl ),
      arg(1, State, C0), C is C0 + 1, nb_setarg(1, State, C), C >= Limit -> true ; true ).
numbervars_in_order(Vs) :- term_variables(Vs, Free), name_all(Free, 0).
name_all([], _).
name_all([V|Vs], N) :- format(atom(A), '_~d', [N]), V = '$named'(A), M is N + 1, name_all(Vs, M).
run(N, Limit) :- format('query ~d~n', [N]),
    catch(call_with_time_limit(0.5, call_with_inference_limit(answers(N, Limit), 8000, R)), E, true),
    ( nonvar(E) -> format('given up~n')
    ; R == inference_limit_exceeded -> format('given up~n') ; true ).
"""

_OPERATORS = {"+": "lf_plus", "-": "lf_minus", "*": "lf_times"}
_COMPARISONS = {"<": "lp_less", ">": "lp_greater", "<=": "lp_at_most", ">=": "lp_at_least"}
_COLLECTIONS = {"FINDALL": "all", "BAGOF": "bag", "SETOF": "set"}
_SIMPLE = {"==": "=", "MEMBER": "mem", "APPEND": "app", "LENGTH": "of_length", "GROUND": "ground", "BOUND": "nonvar"}


def quoted(symbol):
    return "'" + (":" if isinstance(symbol, Keyword) else "") + symbol.name.lower() + "'"


def term(data):
    if data is None:
        return "[]"
    if isinstance(data, Cons):
        return f"[{term(data.car)}|{term(data.cdr)}]"
    if variable(data):
        return "_" if data is ANONYMOUS else "V" + data.name[1:]
    if isinstance(data, Symbol):
        return quoted(data)
    return f'"{data}"' if isinstance(data, str) else f"({data!r})" if isinstance(data, (int, float)) and data < 0 else repr(data)


def goal(data, number):
    """The goal as SWI-Prolog has it, with the predicates of program ``number``."""
    name, parts = data.car.name, list(data.cdr or ())

    def inner(part):
        return goal(part, number)

    def conjunction(goals):
        return "(" + ", ".join(map(inner, goals)) + ")" if goals else "true"

    if name == "AND":
        return conjunction(parts)
    if name == "OR":
        return "call((" + " ; ".join(map(inner, parts)) + "))"
    if name == "NOT":
        return f"\\+ {inner(parts[0])}"
    if name in ("->", "*->"):
        return f"({inner(parts[0])} {name} {inner(parts[1])} ; {inner(parts[2]) if len(parts) > 2 else 'fail'})"
    if name == "CUT":
        return "!"
    if name in ("ONCE", "CALL"):
        return f"{name.lower()}({conjunction(parts)})"
    if name == "FORALL":
        return f"forall({inner(parts[0])}, {inner(parts[1])})"
    if name in _COLLECTIONS:
        return f"{_COLLECTIONS[name]}({term(parts[0])}, {inner(parts[1])}, {term(parts[2])})"
    if name == "LISP-FUN":
        return f"{_OPERATORS[parts[0].name]}({', '.join(map(term, parts[1:]))})"
    if name == "LISP-PRED":
        return f"lp_even({term(parts[1])})"
    functor = _COMPARISONS.get(name) or _SIMPLE.get(name) or f"'{number}_{name.lower()}'"
    if functor == "=":
        return f"{term(parts[0])} = {term(parts[1])}"
    return f"{functor}({', '.join(map(term, parts))})"


def program_text(program, number, queries):
    """``queries``: (number, goal, variables)."""
    lines = []
    for clause in program.clauses:
        body = ", ".join(goal(part, number) for part in clause.cdr or ())
        lines.append(goal(clause.car, number) + (f" :- {body}." if body else "."))
    for each, query, variables in queries:
        lines.append(f"query({each}, [{', '.join(map(term, variables))}]) :- {goal(query, number)}.")
    return "\n".join(lines)


def run(programs, limit, folder):
    """For each program the answers to each of its queries: at most ``limit`` lines of text; ``None`` for a query that was given up.

    ``programs``: pairs of a program and the list of (query, its variables).
    """
    path = folder / "programs.pl"
    text, count = LIBRARY, 0
    for number, (program, queries) in enumerate(programs):
        text += program_text(program, number, [(count + index, *query) for index, query in enumerate(queries)]) + "\n"
        count += len(queries)
    path.write_text(text)
    done = subprocess.run(
        ["swipl", "-q", "-f", str(path), "-g", f"forall(between(0, {count - 1}, N), run(N, {limit}))", "-t", "halt"],
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert not done.stderr.strip(), done.stderr[:2000]
    found = []
    for line in done.stdout.splitlines():
        if line.startswith("query "):
            found.append([])
        elif line.startswith("given up"):
            found[-1] = None
        else:
            found[-1].append(line)
    answers = iter(found)
    return [[next(answers) for _ in queries] for _, queries in programs]
