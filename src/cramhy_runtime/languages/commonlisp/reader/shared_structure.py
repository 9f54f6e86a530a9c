"""Labels: ``#1=object`` names an object for ``#1#``, which may stand inside of it (ANSI 2.4.8.15 and 2.4.8.16).

While the object is read, a `_Label` stands for it; then the object takes the places of the label.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.data import NO_VALUES, Cons
from ..syntax.backquote import Comma
from .reader_errors import fail
from .text_reader import SUPPRESS, as_reader


class _Label:
    """Stands for the object of ``#n=`` while that is being read."""

    __slots__ = ("used",)

    def __init__(self):
        self.used = False


def sharp_equal(stream, sub, argument):
    """``#1=object``: label an object for ``#1#``."""
    reader = as_reader(stream)
    start = reader.frame_start()
    if SUPPRESS.value is not None:
        return NO_VALUES
    if argument is None:
        return fail(reader, start, "Missing label for #=", hint="It is written #1=object.")
    if argument in reader.labels:
        return fail(reader, start, "Multiply defined label: #~D=", argument)
    label = reader.labels[argument] = _Label()
    found = reader.required()
    if found is label:
        return fail(reader, start, "Must label something more than just #~D#", argument)
    reader.labels[argument] = found
    if label.used:
        _replace_label(found, label)
    return found


def sharp_sharp(stream, sub, argument):
    """``#1#``: the object labelled ``#1=``."""
    reader = as_reader(stream)
    start = reader.frame_start()
    if SUPPRESS.value is not None:
        return None
    if argument is None:
        return fail(reader, start, "Missing label for ##", hint="It is written #1#.")
    if argument not in reader.labels:
        return fail(reader, start, "Reference to undefined label #~D#", argument, hint=f"Before it, #{argument}= must label an object.")
    found = reader.labels[argument]
    if isinstance(found, _Label):
        found.used = True
    return found


def _replace_label(root, label):
    pending, seen = [root], set()
    while pending:
        item = pending.pop()
        if id(item) in seen:
            continue
        seen.add(id(item))
        if isinstance(item, Cons):
            attributes = ("car", "cdr")
        elif isinstance(item, Comma):
            attributes = ("form",)
        elif isinstance(item, list):
            for index, element in enumerate(item):
                if element is label:
                    item[index] = root
                else:
                    pending.append(element)
            continue
        elif hasattr(item, "storage"):
            pending.append(item.storage)
            continue
        elif hasattr(type(item), "lisp_structure"):
            attributes = [slot.attribute for slot in type(item).lisp_structure.slots]
        else:
            continue
        for attribute in attributes:
            value = getattr(item, attribute)
            if value is label:
                setattr(item, attribute, root)
            else:
                pending.append(value)
