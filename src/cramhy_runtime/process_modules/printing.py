"""How process modules are printed: ``#<NAME {address}>`` with the name of the class."""

from __future__ import annotations

from ..lisp.printer import define_printer, print_unreadable
from .modules import AbstractProcessModule


def print_module(module, stream):
    print_unreadable(module, stream, type_=True, identity=True)


define_printer(AbstractProcessModule, print_module)
