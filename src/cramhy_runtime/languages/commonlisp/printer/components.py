"""How the parts of the printer print what an object is made of: with the whole printer, which stands above them.

Layouts, arrays and lists print their elements, and an element may be anything. ``printer.py``, which knows all parts, puts its functions
into `COMPONENTS`.
"""

from __future__ import annotations


class Components:
    """``output_object(object, stream)``, ``output_ugly`` and ``print_unreadable`` of the printer."""

    __slots__ = ("output_object", "output_ugly", "print_unreadable", "write_string_text")


COMPONENTS = Components()
