"""Calls that find: where something is defined, and where it is used."""

from __future__ import annotations

from cramhy_runtime.lisp_core.packages import is_symbol, symbol_name
from cramhy_runtime.session import lookup
from cramhy_runtime.session.arglists import symbol_named

from .. import places, presentations
from ..rpcs import rpc, text
from ..wire import Name

NOT_IMPLEMENTED = Name(":not-implemented")


@rpc("find-definitions-for-emacs find-definitions")
def find_definitions(call, name):
    """[(label, location), ...]. ``M-.`` sends the text of the symbol at the cursor, in Lisp, Hy or Python."""
    found = lookup.definitions(text(name), call.package)
    return [[place.label, places.location(place)] for place in found]


@rpc("find-source-location-for-emacs find-definition-for-thing")
def find_source_location(call, thing, *_):
    found = _definitions_of(call, thing)
    return places.location(found[0]) if found else places.error("It is not known where this is defined.")


def _definitions_of(call, thing):
    if isinstance(thing, str):
        return lookup.definitions(str(thing), call.package)
    if isinstance(thing, list) and len(thing) > 1 and str(thing[0]) in (":string", ":symbol"):
        return lookup.definitions(text(thing[1]), call.package)
    if isinstance(thing, list) and len(thing) > 1 and str(thing[0]) in (":inspector", ":sldb"):
        obj = call.connection.inspector.part(thing[1]) if call.connection.inspector is not None else None
    elif isinstance(thing, int):
        obj = presentations.of(call.connection).find(thing)
    else:
        return []
    return lookup.definitions_of(obj) if is_symbol(obj) else lookup.place_of_function(obj) or lookup.in_texts(type(obj).__name__.upper())


@rpc("xref")
def xref(call, kind, name):
    return _uses(call, str(kind), text(name))


@rpc("xrefs")
def xrefs(call, kinds, name):
    return [[kind, *found] for kind in kinds or () if isinstance(found := _uses(call, str(kind), text(name)), list)]


def _uses(call, kind, name):
    symbol = symbol_named(name.lstrip("'#"), call.package)
    if symbol is None:
        return []
    bare = symbol_name(symbol)
    if kind in (":calls", ":macroexpands", ":calls-who"):
        found = lookup.uses(bare, calls=True, symbol=symbol) if kind != ":calls-who" else None
    elif kind == ":sets":
        found = lookup.uses(bare, sets=True, symbol=symbol)
    elif kind in (":references", ":binds"):
        found = lookup.uses(bare, symbol=symbol) if kind == ":references" else None
    elif kind == ":specializes":
        found = [place for place in lookup.uses(bare, symbol=symbol) if place.label.startswith("(DEFMETHOD")]
    else:
        found = None
    return NOT_IMPLEMENTED if found is None else [[place.label, places.location(place)] for place in found]
