"""The md5 sum of a message definition, and its complete text with all the messages inside. ROS tells types apart by them.

Two programs agree on a message if their sums are equal: the sum covers types, names, order and constants of all fields, also in
the messages inside. Comments and spaces do not count. A recording keeps the complete text, so its readers need no definitions.
Sources: wiki.ros.org/msg; roslisp.md 5.6 and 15.
"""

from __future__ import annotations

from . import messages
from .messages import ServiceType
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING

if TYPE_CHECKING:
    from .definition_text import Definition
    from .signatures import MessageType


_RULE = "=" * 80
_sums: dict[MessageType | ServiceType, str] = {}


def md5_of(message_type: MessageType | ServiceType) -> str:
    """The md5 sum of a message class or a `ServiceType`, in hexadecimal."""
    found = _sums.get(message_type)
    if found is None:
        import hashlib  # a session that nobody connects to does without it

        halves = (message_type.request, message_type.response) if isinstance(message_type, ServiceType) else (message_type,)
        text = "".join(_md5_text(half.definition) for half in halves)
        found = _sums[message_type] = hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()
    return found


def same_on_the_wire(first: MessageType, second: MessageType) -> bool:
    """Whether two message classes have the same md5 sum, as ``tf/tfMessage`` and ``tf2_msgs/TFMessage`` have."""
    return first is second or md5_of(first) == md5_of(second)


def _md5_text(definition: Definition) -> str:
    lines = list(definition.constant_lines)
    for field in definition.fields:
        lines.append(repr(field) if field.primitive else f"{md5_of(messages.part_class(field.base))} {field.name}")
    return "\n".join(lines)


def complete_text(message_class: MessageType) -> str:
    """The definition of a message class, followed by the definitions of all messages inside, each under its name."""
    parts: dict[str, MessageType] = {}
    _collect(message_class, parts)
    sections = [message_class.definition.text, *(f"MSG: {name}\n{part.definition.text}" for name, part in parts.items())]
    return f"\n{_RULE}\n".join(section.rstrip("\n") for section in sections) + "\n"


def _collect(message_class: MessageType, parts: dict[str, MessageType]) -> None:
    for field in message_class.fields:
        if not field.primitive and field.base not in parts:
            part = parts[field.base] = messages.part_class(field.base)
            _collect(part, parts)


def definition_text(message_type: MessageType | ServiceType) -> str:
    """The complete text of a message class, or of both halves of a `ServiceType` with a line of dashes between."""
    if isinstance(message_type, ServiceType):
        return f"{complete_text(message_type.request)}---\n{complete_text(message_type.response)}"
    return complete_text(message_type)
