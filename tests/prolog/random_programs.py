"""Random Prolog programs as Lisp data: facts, rules, lists, arithmetic, negation, collecting, cut, conditions.

A predicate calls only predicates below it, so most programs end; a few recursive ones walk lists. Which goals a program has is decided
by its seed alone.
"""

import random

from prolog_text import HERE, read

from cramhy_runtime.lisp_core.data import Cons, list_from

VARIABLES = [read(f"?{letter}") for letter in "uvwxyz"]
ATOMS = [read(text) for text in "a a a b b nil 1 1 2 2 3".split()] + [read(text) for text in ("0", "-1", '"s"', ":k", "1.5")]
OPERATORS = [read(text) for text in "+ - *".split()]
COMPARISONS = [read(text) for text in "< > <= >=".split()]

RECURSIVE = {
    "sum": ["((sum nil 0))", "((sum (?h . ?t) ?s) (sum ?t ?r) (lisp-fun + ?h ?r ?s))"],
    "rev": ["((rev nil ?a ?a))", "((rev (?h . ?t) ?a ?r) (rev ?t (?h . ?a) ?r))"],
    "pick": ["((pick ?x (?x . ?t) ?t))", "((pick ?x (?h . ?t) (?h . ?r)) (pick ?x ?t ?r))"],
    "perm": ["((perm nil nil))", "((perm ?l (?x . ?r)) (pick ?x ?l ?m) (perm ?m ?r))"],
    "upto": ["((upto ?n ?n) (cut))", "((upto ?n ?m) (< ?n 4) (lisp-fun + ?n 1 ?k) (upto ?k ?m))"],
    "count": ["((count nil 0) (cut))", "((count (?_ . ?t) ?n) (count ?t ?m) (lisp-fun + ?m 1 ?n))"],
    "evens": ["((evens nil nil))", "((evens (?h . ?t) ?r) (evens ?t ?m) (-> (lisp-pred evenp ?h) (== ?r (?h . ?m)) (== ?r ?m)))"],
    "last": ["((last (?x) ?x))", "((last (?_ . ?t) ?x) (last ?t ?x))"],
}
ARITIES = {"sum": 2, "rev": 3, "pick": 3, "perm": 2, "upto": 2, "count": 2, "evens": 2, "last": 2}


def form(name, *parts):
    return Cons(read(name), list_from(parts))


class Program:
    """``clauses``: (head goal...) lists; ``queries``: goals."""

    def __init__(self, seed):
        self.rng = random.Random(seed)
        self.predicates = {}
        self.clauses = []
        for name in self.rng.sample(sorted(RECURSIVE), 2):
            for needed in ("pick", name) if name == "perm" else (name,):
                if needed not in self.predicates:
                    self.predicates[needed] = ARITIES[needed]
                    self.clauses += map(read, RECURSIVE[needed])
        for level in range(self.rng.randint(2, 3)):
            self.define(f"p{level}")
        self.queries = [self.conjunction(self.rng.randint(1, 3), 2)]
        self.queries += [self.asking(name) for name in self.predicates if name.startswith("p")]

    def define(self, name):
        arity = self.rng.randint(1, 3)
        facts_only = self.rng.random() < 0.3
        for _ in range(self.rng.randint(1, 5)):
            head = Cons(HERE.intern(name.upper()), list_from([self.term(1, 0.2 if facts_only else 0.6) for _ in range(arity)]))
            goals = [] if facts_only or self.rng.random() < 0.4 else [self.goal(2) for _ in range(self.rng.choice((1, 1, 2, 2, 3)))]
            if goals and self.rng.random() < 0.15:
                goals.insert(self.rng.randint(0, len(goals)), form("cut"))
            self.clauses.append(Cons(head, list_from(goals)))
        self.predicates[name] = arity

    def asking(self, name):
        """A query for what holds of a predicate, and perhaps more."""
        call = Cons(HERE.intern(name.upper()), list_from([self.term(1, 0.8) for _ in range(self.predicates[name])]))
        return call if self.rng.random() < 0.4 else form("and", call, self.goal(1))

    def term(self, depth, variables=0.5):
        chance = self.rng.random()
        if chance < variables:
            return self.rng.choice(VARIABLES)
        if chance < 0.85 or depth == 0:
            return self.rng.choice(ATOMS)
        return self.list(depth - 1, variables)

    def list(self, depth, variables):
        items = [self.term(depth, variables) for _ in range(self.rng.randint(0, 3))]
        return list_from(items, self.rng.choice(VARIABLES) if items and self.rng.random() < 0.2 else None)

    def numbers(self):
        return list_from([self.rng.choice([0, 1, 2, 3, 5]) for _ in range(self.rng.randint(0, 4))])

    def number(self):
        return self.rng.choice([*VARIABLES, *VARIABLES, 0, 1, 2, 3, 5, read("a")])

    def call(self):
        name = self.rng.choice(sorted(self.predicates) + [name for name in self.predicates if name.startswith("p")])
        arguments = [self.term(1) for _ in range(self.predicates[name])]
        if name in RECURSIVE and arguments and self.rng.random() < 0.8:
            arguments[1 if name == "pick" else 0] = 1 if name == "upto" else self.numbers()
        return Cons(HERE.intern(name.upper()), list_from(arguments))

    def goal(self, depth):
        """A goal; control constructs nest ``depth`` deep."""
        rng = self.rng
        simple = [
            self.call,
            self.call,
            self.call,
            self.call,
            self.unification,
            self.member,
            self.arithmetic,
            self.comparison,
            self.of_lists,
            self.test,
        ]
        if depth == 0:
            return rng.choice(simple)()
        return rng.choice(
            [
                *simple,
                *simple,
                lambda: form("not", self.conjunction(1, depth - 1)),
                lambda: self.disjunction(depth - 1),
                lambda: self.condition(depth - 1),
                lambda: self.collection(depth - 1),
                lambda: self.committed(depth - 1),
            ]
        )()

    def conjunction(self, count, depth):
        goals = [self.goal(depth) for _ in range(count)]
        if self.rng.random() < 0.15:
            goals.insert(self.rng.randint(0, len(goals)), form("cut"))
        return goals[0] if len(goals) == 1 else form("and", *goals)

    def unification(self):
        return form("==", self.term(2), self.term(2))

    def member(self):
        return form("member", self.term(1), self.rng.choice([self.numbers(), self.list(1, 0.3)]))

    def arithmetic(self):
        return form("lisp-fun", self.rng.choice(OPERATORS), self.number(), self.number(), self.term(0, 0.8))

    def comparison(self):
        return form(self.rng.choice(COMPARISONS).name.lower(), self.number(), self.number())

    def of_lists(self):
        return self.rng.choice(
            [
                lambda: form("length", self.rng.choice([self.list(1, 0.3), self.rng.choice(VARIABLES)]), self.term(0, 0.7)),
                lambda: form("append", self.numbers(), self.term(1), self.term(1)),
                lambda: form("append", self.term(1), self.term(1), self.numbers()),
            ]
        )()

    def test(self):
        return form(self.rng.choice(["ground", "bound"]), self.term(1, 0.7))

    def disjunction(self, depth):
        return form("or", *[self.conjunction(self.rng.randint(1, 2), depth) for _ in range(self.rng.randint(1, 3))])

    def condition(self, depth):
        parts = [self.conjunction(1, depth) for _ in range(self.rng.randint(2, 3))]
        return form(self.rng.choice(["->", "->", "*->"]), *parts)

    def collection(self, depth):
        result = self.rng.choice([self.rng.choice(VARIABLES), self.list(1, 0.7)])
        goal = self.conjunction(self.rng.randint(1, 2), depth)
        return form(self.rng.choice(["findall", "findall", "bagof", "setof"]), self.term(1, 0.8), goal, result)

    def committed(self, depth):
        return self.rng.choice(
            [
                lambda: form("once", *[self.goal(depth) for _ in range(self.rng.randint(1, 2))]),
                lambda: form("call", self.conjunction(1, depth)),
                lambda: form("forall", self.conjunction(1, depth), self.goal(depth)),
            ]
        )()
