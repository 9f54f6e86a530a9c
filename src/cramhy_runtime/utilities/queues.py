"""Queues and mailboxes: first in, first out. Taking from an empty queue gives nil; receiving from an empty mailbox waits.

Names and values are those of SB-CONCURRENCY, which CRAM-UTILITIES re-exports (cpl.md 13.3). A message that was handed to a task which
died before it ran again is back in front of its mailbox, so none is lost.
"""

from __future__ import annotations

from collections import deque

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import MultipleValues, list_from, python_list
from cramhy_runtime.lisp_core.printing import define_printer, print_unreadable
from cramhy_runtime.lisp_core.printing import prin1_to_string

from .wait_queue import Line, need, time_limit


class Queue:
    """Objects in the order in which they came."""

    lisp_name = "CRAM-UTILITIES::QUEUE"

    def __init__(self, name, items):
        self.name, self.items = name, deque(items)

    def copy(self):
        """A queue of the same objects, for another image."""
        return Queue(self.name, self.items)


def _queue(thing):
    return need(thing, Queue, "CRAM-UTILITIES:QUEUE")


def make_queue(*, name=None, initial_contents=None):
    return Queue(name, python_list(initial_contents))


def enqueue(value, queue):
    """``cut:enqueue``: put ``value`` at the end; returns it."""
    _queue(queue).items.append(value)
    return value


def dequeue(queue):
    """``cut:dequeue``: the oldest value and T, or nil and nil."""
    items = _queue(queue).items
    return MultipleValues((items.popleft(), True)) if items else MultipleValues((None, None))


def list_queue_contents(queue):
    return list_from(list(_queue(queue).items))


def queue_count(queue):
    return len(_queue(queue).items)


def queue_empty_p(queue):
    return None if _queue(queue).items else True


def queue_name(queue):
    return _queue(queue).name


def queuep(obj):
    return True if isinstance(obj, Queue) else None


# ----------------------------------------------------------------------------------------------------------------- mailboxes


class Mailbox:
    """A queue with a line of tasks that wait for a message."""

    lisp_name = "CRAM-UTILITIES::MAILBOX"

    def __init__(self, name, messages):
        self.name, self.messages = name, deque(messages)
        self.line = Line(give_back=lambda place: self.put_back(place.got))

    def put_back(self, message):
        """``message`` was not received after all: the next in line gets it, else it is the first again."""
        if len(self.line):
            self.line.serve(message)
        else:
            self.messages.appendleft(message)


def _mailbox(thing):
    return need(thing, Mailbox, "CRAM-UTILITIES:MAILBOX")


def make_mailbox(*, name=None, initial_contents=None):
    return Mailbox(name, python_list(initial_contents))


def send_message(mailbox, message):
    """``cut:send-message``: put ``message`` into the mailbox, or into the hands of the task that waits longest."""
    if len(_mailbox(mailbox).line):
        mailbox.line.serve(message)
    else:
        mailbox.messages.append(message)


def receive_message(mailbox, *, timeout=None):
    """``cut:receive-message``: the oldest message and T, waiting for one; nil and nil after ``timeout`` seconds."""
    until = time_limit(timeout)
    if _mailbox(mailbox).messages:
        return MultipleValues((mailbox.messages.popleft(), True))
    place = mailbox.line.stand(lambda: f"a message in the mailbox {mailbox.name or ''}".rstrip(), until)
    return MultipleValues((None, None) if place is None else (place.got, True))


def receive_message_no_hang(mailbox):
    """``cut:receive-message-no-hang``: the oldest message and T, or nil and nil."""
    messages = _mailbox(mailbox).messages
    return MultipleValues((messages.popleft(), True)) if messages else MultipleValues((None, None))


def receive_pending_messages(mailbox, n=None):
    """``cut:receive-pending-messages``: the messages that are there, at most ``n``, oldest first."""
    messages = _mailbox(mailbox).messages
    if n is not None and not (isinstance(n, int) and n >= 0):
        type_error(n, "UNSIGNED-BYTE")
    return list_from([messages.popleft() for _ in range(len(messages) if n is None else min(n, len(messages)))])


def list_mailbox_messages(mailbox):
    return list_from(list(_mailbox(mailbox).messages))


def mailbox_count(mailbox):
    return len(_mailbox(mailbox).messages)


def mailbox_empty_p(mailbox):
    return None if _mailbox(mailbox).messages else True


def mailbox_name(mailbox):
    return _mailbox(mailbox).name


def mailboxp(obj):
    return True if isinstance(obj, Mailbox) else None


def _print(mailbox, stream):
    name = f"{prin1_to_string(mailbox.name)} " if mailbox.name is not None else ""
    print_unreadable(mailbox, stream, f"MAILBOX {name}({len(mailbox.messages)} msgs pending)", identity=True)


define_printer(Mailbox, _print)
define_printer(
    Queue,
    lambda queue, stream: print_unreadable(
        queue, stream, "QUEUE" + (f" {prin1_to_string(queue.name)}" if queue.name is not None else ""), identity=True
    ),
)
