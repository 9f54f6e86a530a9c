"""XML-RPC structs (package S-XML-RPC). ``get-param`` returns one for a namespace, a name with values below it.

A struct is an association list of keywords and values. The keywords are spelled as the parameters (``:|background_r|``); values may
be lists and structs. ``set-param`` accepts structs too. Source: roslisp.md 8.1, the library s-xml-rpc.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.data import Cons, list_from
from cramhy_runtime.lisp_core.packages import keyword, string_designator, sym
from cramhy_runtime.lisp_core.printing import define_printer
from cramhy_runtime.lisp_core.printing import print_slots
from cramhy_runtime.kernel.typing_names import Any


class Struct:
    """Members by name, in order. The values are Lisp values."""

    __slots__ = ("members",)
    lisp_name = "S-XML-RPC::XML-RPC-STRUCT"

    def __init__(self, members: dict[str, Any]):
        self.members = members


def xml_rpc_struct(*names_and_values: Any) -> Struct:
    """A new struct from alternating names (symbols or strings) and values. An odd number of arguments is an error."""
    if len(names_and_values) % 2:
        return conditions.error("An XML-RPC struct is made of names and values in turn, but the last name has no value.")
    return Struct({string_designator(name): value for name, value in zip(names_and_values[::2], names_and_values[1::2])})


def xml_rpc_struct_alist(struct: Struct) -> Cons | None:
    """The members of ``struct`` as an association list with keywords."""
    return list_from([Cons(keyword(name), value) for name, value in _checked(struct).members.items()])


def get_xml_rpc_struct_member(struct: Struct, member: object) -> Any:
    """The value of the member with the name ``member``, a symbol or string; nil if there is none."""
    return _checked(struct).members.get(string_designator(member))


def xml_rpc_struct_p(thing: object) -> bool | None:
    """T if ``thing`` is a struct, else nil."""
    return True if isinstance(thing, Struct) else None


def _checked(struct: object) -> Struct:
    return struct if isinstance(struct, Struct) else conditions.type_error(struct, "S-XML-RPC:XML-RPC-STRUCT")


define_printer(Struct, lambda struct, stream: print_slots(sym(Struct.lisp_name), [("ALIST", xml_rpc_struct_alist(struct))], stream))
