"""Loops: a ``tagbody`` that is a loop (``loop_shapes.py``) becomes Python's loop, and one that counts Python's ``for``.

Rows of ``make bench`` without a pass, as times of the row with it. ``loops``: characters of a text 16.7, three-argument + 1.6, nested
dotimes 1.5. ``counting``: characters of a text 16.3, three-argument + 1.5, a special variable 1.3.
"""

from __future__ import annotations

from .. import nodes
from ..core import NONE, TRUE, List, expression, word
from ..destinations import EFFECT
from ..generator.exits import DEEP, Frame, continue_exits, ticking
from ..generator.output import GENERATORS
from ..loop_shapes import counting, loop_of
from ..passes import ON, opens_node


@opens_node("loops", GENERATORS, nodes.TagbodyNode)
def _tagbody(generator, node, destination):
    loop = None if node.tagbody.escapes else loop_of(node)
    if loop is None:
        return None
    loop_statements(generator, node, loop)
    return (generator.finish(NONE, node, destination, pure=True),)


def loop_statements(generator, node, loop):
    """A tagbody that is a loop: what comes before it, Python's loop, what comes after it."""
    tagbody, segments = node.tagbody, node.segments
    end = (tagbody, loop.last + 1)
    tagbody.structured = True
    first = len(segments) if loop.first is None else loop.first

    def before():
        for segment in segments[: loop.last + 1] if loop.first is None else segments[:first]:
            for item in segment:
                generator.gen(item, EFFECT)
        if loop.first is not None:
            repeated(generator, node, loop, end)

    if loop.left_early:
        frame = Frame(breaks=end)
        generator.frames.append(frame)
        statements, _ = generator.captured(before)
        generator.frames.pop()
        generator.emit(word("while"), TRUE, *statements, expression(word("break")))
        continue_exits(generator, frame)
    else:
        before()
    for segment in segments[loop.last + 1 :]:
        for item in segment:
            generator.gen(item, EFFECT)


def repeated(generator, node, loop, end):
    """The loop itself."""
    tagbody = node.tagbody
    statements = [item for segment in node.segments[loop.first : loop.last + 1] for item in segment]
    found = None
    if loop.first == loop.last and len(generator.frames) < DEEP and "counting" in ON:
        found = counting(statements, tagbody, loop.first, end[1], generator.scope)
    frame = Frame(breaks=end, again=(tagbody, loop.first))
    generator.frames.append(frame)
    if found is not None:
        source, target = counted(generator, found)
        body, _ = generator.captured(lambda: [generator.gen(item, EFFECT) for item in found.body])
        generator.frames.pop()
        # two loops in Python: over parts, between which others may get a turn, and over the elements of a part
        part = word("Lpart")
        inner = expression(word("for"), List([target, part]), *(body or [NONE]), expression(word("else"), expression(word("continue"))))
        generator.emit(word("for"), List([part, source]), inner, expression(word("break")))
        continue_exits(generator, frame)
        return

    last = statements[-1] if statements else None
    again = last.__class__ is nodes.Go and last.tagbody is tagbody and last.index == loop.first

    def turn():
        for item in statements[:-1] if again else statements:
            generator.gen(item, EFFECT)
        if not again:
            generator.emit(word("break"))

    body, _ = generator.captured(turn)
    generator.frames.pop()
    generator.out.append(ticking(body, len(generator.frames)))
    generator.effects += 1
    continue_exits(generator, frame)


def counted(generator, found):
    """(what Python's ``for`` goes over, its target) of a `Counting`."""
    if found.vector is not None:
        return generator.call("items", generator.value(found.vector)), word(found.element.name)
    variable = word(found.variable.name)
    limit = generator.value(found.limit)
    return generator.call("counting", variable, limit, found.step, TRUE if found.inclusive else NONE), variable
