"""Fact groups: named sets of clauses that are defined, redefined and removed together.

``(def-fact-group name (extendable-predicate...) (<- head goal...)...)`` calls `define_fact_group`. Clauses of a predicate stand
in the order of their groups, within a group as in the text; a redefined group moves to the end. A group may add clauses to a
predicate of another group only if it lists it as extendable, so that a typing error does not extend something by accident.
Source: prolog.md section 6.
"""

from __future__ import annotations

from itertools import zip_longest

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.lisp_core.conditions import SimpleError, error, style_warn, type_error
from cramhy_runtime.lisp_core.data import Cons, list_from, python_list
from cramhy_runtime.lisp_core.source_places import circumstance, describe

from .database import Clause, changed, functor_entry, functors, valid_functor
from ..terms.origins import position_of_origin
from .goal_text import show
from ..symbols import sym
from ..terms.terms import list_end
from cramhy_runtime.utilities.patterns import rename_vars

_groups: dict = per_image({})
_ARROW = sym("CRAM-PROLOG::<-")
EXTENDABLE = "The list behind the name of a group names the predicates of others that it may add to: {} is missing there."


def _tell_fact(here):
    """A text for an error in a definition: which clause is wrong, and where it is."""
    if "fact" not in here:
        return None
    place = describe(position_of_origin(here["origin"]))
    return f"in the clause {show(Cons(_ARROW, here['fact']))}" + (f" at {place}" if place else "")


@circumstance(_tell_fact)
def define_fact_group(name, extendable, facts, origins=()):
    """Define the group ``name`` with ``facts``, a list of (head goal...). Returns a list of (functor fact...).

    ``origins`` are the user's code that made each fact, see ``terms/origins.py``. If the group exists, it warns and replaces the group.
    An invalid functor is an error, and so is a functor of another group that ``extendable`` does not list. After an error everything is
    as before, and the old group too. Source: prolog.md 6.2.
    """
    if name in _groups:
        style_warn("Redefining prolog fact-group ~a.", name)
    if extendable is not None and not isinstance(extendable, (Cons, list, tuple)):
        return type_error(extendable, "LIST")
    extendable = python_list(extendable)
    for functor in extendable:
        if not valid_functor(functor):
            return error(
                SimpleError(
                    "Extendible predicates in the definition of fact group ~a~%            contained an invalid functor ~a.", name, functor
                )
            )
    clauses = {}
    for fact, origin in zip_longest(facts or (), origins):
        head = fact.car if isinstance(fact, Cons) else fact
        if not isinstance(head, Cons):
            return type_error(head, "CONS" if head is None else "LIST")
        if list_end(fact) is not None:
            return type_error(fact, "LIST")
        functor = head.car
        if not valid_functor(functor):
            return error(SimpleError("Functor ~a of fact head ~a is not valid.", functor, head))
        if functor in clauses:  # which was looked at with its first fact
            others = None
        else:
            others = [group for group in functors[functor].groups() if group is not name] if functor in functors else None
        if others and functor not in extendable:
            return error(
                SimpleError(
                    "Functor ~a is being redefined in fact-group ~a.~%                Other definitions were in fact-groups ~a.",
                    functor,
                    name,
                    list_from(others),
                ),
                hint=EXTENDABLE.format(functor.name.lower()),
            )
        fact = rename_vars(fact, gensym_var_names=None)
        clauses.setdefault(functor, []).append((fact, Clause(fact.car, python_list(fact.cdr) or None, name, origin)))
    remove_fact_group(name)
    _groups[name] = list(clauses)
    for functor, new in clauses.items():
        functor_entry(functor).clauses += [clause for _, clause in new]
        changed(functor)
    return list_from([Cons(functor, list_from([fact for fact, _ in new])) for functor, new in clauses.items()])


def remove_fact_group(name):
    """Remove all clauses of the group ``name``."""
    for functor in _groups.pop(name, ()):
        entry = functors.get(functor)
        if entry is None:
            continue
        entry.clauses = [clause for clause in entry.clauses if clause.group is not name]
        if entry.native_group is name:
            _came_with_us.setdefault(name, {})[functor] = entry.native
            entry.native = entry.native_group = None
        changed(functor)


_came_with_us: dict = per_image({})
"""Built-in group → functor → the native facts that came with it."""


def restore_fact_group(name):
    """Undo the redefinition of a built-in group by users. Returns ``nil`` if it is unchanged. Another name is an error.

    Clauses that users added for its predicates in groups of their own stay.
    """
    if name not in _came_with_us:
        if any(entry.native_group is name for entry in functors.values()):
            return None
        return error("~S is not a fact group that came with CRAM-PROLOG.", name)
    if all(functors[functor].native is native for functor, native in _came_with_us[name].items()):
        return None
    remove_fact_group(name)
    _groups[name] = list(_came_with_us[name])
    for functor, native in _came_with_us[name].items():
        entry = functor_entry(functor)
        entry.native, entry.native_group = native, name
        changed(functor)
    return True


def built_in_group(name, functor):
    """Note that ``functor`` belongs to the built-in group ``name``. Users extend it in groups that list it as extendable."""
    functor_entry(functor).native_group = name
    functors_of_group = _groups.setdefault(name, [])
    if functor not in functors_of_group:
        functors_of_group.append(functor)


def fact_outside_group(*fact):
    """``<-`` outside of a fact group: signal an error."""
    return error("Facts cannot be declared outside fact-groups.")


def fact_group_names():
    """The names of all fact groups, oldest first."""
    return list(_groups)
