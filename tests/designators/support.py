"""Short names for the tests of designators: Lisp data from Python."""

from cramhy_runtime import designators as desig
from cramhy_runtime.lisp_core.data import Cons, lisp_list
from cramhy_runtime.lisp_core.packages import intern, keyword, sym
from cramhy_runtime.prolog.engine.fact_groups import define_fact_group, remove_fact_group


def user(name):
    """The symbol ``name`` of CRAM-USER."""
    return intern(name, "CRAM-USER")


def lisp(thing):
    """Nested Python lists as Lisp lists; ``":key"`` is a keyword, ``"?x"`` a variable of CRAM-USER, ``"pkg::name"`` a symbol."""
    if isinstance(thing, list):
        return lisp_list(*map(lisp, thing))
    if isinstance(thing, str):
        if thing.startswith(":"):
            return keyword(thing[1:].upper())
        if "::" in thing:
            return sym(thing.upper())
        if thing.startswith("'"):
            return thing[1:]
        return user(thing.upper())
    return thing


def make(kind, *pairs):
    """A designator of ``kind``, ``"motion"``, with pairs as `lisp` takes them."""
    return desig.make_designator(keyword(kind.upper()), lisp(list(pairs)))


def python(thing):
    """Lisp lists as Python lists, symbols as their names."""
    if isinstance(thing, (Cons, list)):
        return [python(item) for item in thing]
    return getattr(thing, "name", thing)


class facts:  # noqa: N801  (reads as a statement)
    """``with facts(group, extendable, clause...):`` a fact group for the extent of a block."""

    def __init__(self, name, extendable, *clauses):
        self.name, self.extendable, self.clauses = user(name.upper()), lisp(extendable), lisp(list(clauses))

    def __enter__(self):
        define_fact_group(self.name, self.extendable, self.clauses)

    def __exit__(self, *problem):
        remove_fact_group(self.name)
