"""What the texts of a system, and the libraries that are loaded, define for plans: predicates, properties, process modules."""

from __future__ import annotations

from collections import Counter

from cramhy_runtime.lisp_core.data import Cons, Keyword, Symbol
from cramhy_runtime.languages.commonlisp.objects.classes import find_class
from cramhy_runtime.prolog.engine import database
from cramhy_runtime.prolog.explanations.undefined import defined_functors
from cramhy_runtime.session.lookup import bare_name

from . import outlines
from .texts import Form


class KnownNames:
    """The names, in capitals and without prefix; to be made in an image. texts: those of the system."""

    def __init__(self, texts):
        self.definitions, self.predicates, self.modules, self.keys, self.types = set(), set(), set(), set(), set()
        self.heads = Counter()  # predicate → how many clauses have it
        self.slots = {}  # MAKE-NAME → slots, of the structures in the texts
        for text in texts:
            self._read(text)
        self._of_database()

    def _read(self, text):
        for operator, name, *_ in outlines.definitions(text):
            operator, bare = operator.rpartition(":")[2], bare_name(name.split()[0].lstrip("(")) if name.split() else ""
            self.definitions.add(bare)
            if operator == "defstruct":
                self.definitions.add(f"MAKE-{bare}")
            elif operator == "def-process-module":
                self.modules.add(bare)
            elif operator == "def-prolog-handler":
                self.predicates.add(bare)
        waiting = list(text.forms)
        while waiting:
            form = waiting.pop()
            waiting += [item for item in form.items if isinstance(item, Form)]
            head = bare_name(form.word(0))
            if head == "DEFSTRUCT" and len(form.items) > 2:
                self._structure(form)
            inner = [item for item in form.items[1:] if isinstance(item, Form)]
            if head == "<-" and inner:
                self.predicates.add(bare_name(inner[0].word(0)))
                self.heads[bare_name(inner[0].word(0))] += 1
            elif head == "DEF-FACT-GROUP" and inner:
                self.predicates |= {bare_name(item.text) for item in inner[0].items if not isinstance(item, Form)}
            elif head == "WITH-DESIG-PROPS" and inner:
                self.keys |= {bare_name(item.text) for item in inner[0].items if not isinstance(item, Form)}
            elif head == "DESIG-PROP" and inner:
                key, value = bare_name(inner[-1].word(0)), inner[-1].word(1)
                self.keys.add(key)
                if key == "TYPE" and value and not value.startswith("?"):
                    self.types.add(bare_name(value))
            elif head not in ("A", "AN"):
                self.keys |= {bare_name(each.text) for each in form.items[1:] if not isinstance(each, Form) and each.text.startswith(":")}

    def _structure(self, form):
        name = form.items[1]
        if isinstance(name, Form) and any(isinstance(option, Form) for option in name.items):
            return  # its constructor may have another name, or it may have more slots
        slots = [each.word(0) if isinstance(each, Form) else each.text for each in form.items[2:] if getattr(each, "kind", "") != "string"]
        self.slots[f"MAKE-{bare_name(name.word(0) if isinstance(name, Form) else name.text)}"] = [slot.upper() for slot in slots]

    def _of_database(self):
        self.functors = set(defined_functors())
        for entry in database.functors.values():
            for clause in entry.clauses:
                waiting = list(clause.goals or ())
                while waiting:
                    goal = waiting.pop()
                    while isinstance(goal, Cons):
                        if isinstance(goal.car, Cons):
                            waiting.append(goal.car)
                            self._note(goal.car)
                        goal = goal.cdr

    def _note(self, pair):
        """Note (:key value) in a goal of a clause."""
        if isinstance(pair.car, Keyword):
            self.keys.add(pair.car.name)
            value = pair.cdr.car if isinstance(pair.cdr, Cons) else None
            if pair.car.name == "TYPE" and isinstance(value, (Keyword, Symbol)) and not value.name.startswith("?"):
                self.types.add(value.name)

    def has_class(self, symbol):
        """Whether ``symbol`` names a class."""
        return find_class(symbol, False) is not None
