"""XML-RPC structs: what ``get-param`` returns for a namespace, a name with values below it (package S-XML-RPC).

A struct is an association list of keywords, spelled as the parameters are (``:|background_r|``), and values; below it are lists and
structs again. ``set-param`` takes one as well. Source: roslisp.md 8.1, the library s-xml-rpc.
"""

from __future__ import annotations

from ...lisp import conditions
from ...lisp.data import Cons, list_from
from ...lisp.faces import define_face
from ...lisp.packages import keyword, string_designator, sym
from ...lisp.printer.printer import define_printer
from ...lisp.printer.standard_printers import print_slots


class Struct:
    """Members by name, in order; the values are Lisp's."""

    __slots__ = ("members",)
    lisp_name = "S-XML-RPC::XML-RPC-STRUCT"

    def __init__(self, members):
        self.members = members


def xml_rpc_struct(*names_and_values):
    """A new struct of alternating names (symbols or strings) and values."""
    if len(names_and_values) % 2:
        return conditions.error("An XML-RPC struct is made of names and values in turn, but the last name has no value.")
    return Struct({string_designator(name): value for name, value in zip(names_and_values[::2], names_and_values[1::2])})


def xml_rpc_struct_alist(struct):
    """Its members as an association list with keywords."""
    return list_from([Cons(keyword(name), value) for name, value in _checked(struct).members.items()])


def get_xml_rpc_struct_member(struct, member):
    """The value of a member, or nil when it has none of that name."""
    return _checked(struct).members.get(string_designator(member))


def xml_rpc_struct_p(thing):
    """T for structs."""
    return True if isinstance(thing, Struct) else None


def _checked(struct):
    return struct if isinstance(struct, Struct) else conditions.type_error(struct, "S-XML-RPC:XML-RPC-STRUCT")


define_face("S-XML-RPC", functions={"xml-rpc-struct": xml_rpc_struct, "xml-rpc-struct-alist": xml_rpc_struct_alist,
                                    "get-xml-rpc-struct-member": get_xml_rpc_struct_member, "xml-rpc-struct-p": xml_rpc_struct_p})
define_printer(Struct, lambda struct, stream: print_slots(sym(Struct.lisp_name), [("ALIST", xml_rpc_struct_alist(struct))], stream))
