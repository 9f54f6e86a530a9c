"""How messages print.

A message is a block, its fields one below the other, names at column 3 and values at column 5 after the bracket; a part of a
message is shown in its list form, and what lies below that as a block again, because that is what roslisp's pretty-print
function does (roslisp.md 5.7). Without ``*print-pretty*``, or with the initial dispatch table of Common Lisp (as
``with-standard-io-syntax`` has it), a message is ``#<TURTLESIM-MSG:POSE {...}>``.
"""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import UNSUPPLIED
from ...printer.pprint_dispatch import INITIAL, PRINT_PPRINT_DISPATCH
from ...printer.pretty import logical_block, pprint_indent, pprint_newline
from ...printer.print_controls import PRINT_PRETTY
from cramhy_runtime.lisp_core.printing import define_printer, output_object, print_unreadable
from ...streams.streams import output_stream
from cramhy_runtime.ros.message_building import ros_message_to_list
from cramhy_runtime.ros.messages import RosMessage, ServiceType


def print_message(message, stream):
    """The printer of all messages."""
    if PRINT_PRETTY.value is None or PRINT_PRETTY.value is False or PRINT_PPRINT_DISPATCH.value is INITIAL:
        print_unreadable(message, stream, body=lambda: output_object(message.lisp_symbol, stream), identity=True)
        return
    with logical_block(stream, "[", "]") as out:
        output_object(message.lisp_symbol, out)
        for field, value in zip(message.fields, message.values()):
            pprint_indent("block", 2, out)
            pprint_newline("mandatory", out)
            out.write(field.name.upper() + ":")
            pprint_indent("block", 4, out)
            pprint_newline("mandatory", out)
            output_object(ros_message_to_list(value) if isinstance(value, RosMessage) else value, out)


def pprint_ros_message(stream_or_message, message=UNSUPPLIED):
    """``roslisp:pprint-ros-message``: ``(message)`` or ``(stream message)``."""
    message, stream = (stream_or_message, None) if message is UNSUPPLIED else (message, stream_or_message)
    if not isinstance(message, RosMessage):
        type_error(message, "ROSLISP:ROS-MESSAGE")
    print_message(message, output_stream(stream))


def define():
    """Let Common Lisp see it; called once, when the image is made."""
    define_printer(RosMessage, print_message)
    define_printer(ServiceType, lambda service, stream: stream.write(f"#<SERVICE-TYPE {service.name}>"))
