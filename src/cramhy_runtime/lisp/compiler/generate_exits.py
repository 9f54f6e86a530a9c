"""Exits: ``block``, ``return-from``, ``tagbody``, ``go`` and ``unwind-protect``.

Inside one Python function they become ``return``, ``break`` and ``continue``; only an exit from an inner function raises an
exception. A ``tagbody`` is a ``while`` loop over its segments with a counter that says where to go on. A Python loop that is left
for an outer one sets ``Lexit`` and breaks, and the code after the loop goes on from there. Every ``go`` backwards is a checkpoint
of the kernel. Cleanup forms are shielded: no request to end the task interrupts them (law 2).
"""

from __future__ import annotations

from . import nodes
from .core import List, expression, word
from .destinations import EFFECT, NONE, TRUE, VALUES


class Frame:
    """A Python loop around the code being generated; ``exits`` are outer targets that it is left for."""

    def __init__(self, target, segment=0):
        self.target = target
        self.segment = segment
        self.exits = {}


class ExitGenerator:
    """The part of the `Generator` that leaves forms before their end."""

    def BlockNode(self, node, destination):
        return self.by_statements(node, destination, lambda inner: self.block(node, inner))

    def block(self, node, destination):
        block = node.block
        self.destinations[block] = destination
        if block.escapes:
            self.assign(block.variable.name, self.call("block"))
        statements, _ = self.captured(lambda: self.block_body(node, destination))
        if not block.escapes:
            self.out.extend(statements)
            self.effects += 1
            return
        exit_name = self.temporary("Le")
        handler, _ = self.captured(lambda: self.finish(
            self.call("block_value", word(exit_name), self.reference(block.variable)), nodes.Call(None, []), destination))
        self.emit(word("try"), *(statements or [NONE]),
                  expression(word("except"), List([word(exit_name), word("LBlockExit")]), *handler),
                  expression(word("finally"), self.call("end_block", self.reference(block.variable))))

    def block_body(self, node, destination):
        if destination.kind == "return":
            self.gen(node.body, destination)
            return
        frame = Frame(node.block)
        self.frames.append(frame)
        statements, _ = self.captured(lambda: self.gen(node.body, destination))
        self.frames.pop()
        self.emit(word("while"), TRUE, *statements, expression(word("break")))
        self.continue_exits(frame)

    def ReturnFrom(self, node, destination):
        block = node.block
        if block.owner is not self.scope:
            value = self.gen(node.value, VALUES)
            return self.finish(self.call("return_from", self.reference(block.variable), value), nodes.Constant(None), destination)
        target = self.destinations[block]
        self.gen(node.value, target)
        if target.kind != "return":
            self.jump(block)
        return NONE if destination.kind == "value" else None

    def jump(self, target):
        """Leave the Python loops between here and the frame of ``target``, then break it or, for a tagbody, go on in it."""
        inner = self.frames[-1]
        again = target.__class__.__name__ == "Tagbody"
        if inner.target is target:
            self.emit(word("continue" if again else "break"))
            return
        code = self.jump_codes.setdefault(target, len(self.jump_codes) + 1)
        self.scope.exits_set += 1
        self.assign("Lexit", code)
        inner.exits[target] = code
        self.emit(word("break"))

    def continue_exits(self, frame):
        """After a loop: go on with the exits for which it was left."""
        for target, code in frame.exits.items():
            def onward(target=target):
                if self.frames[-1].target is target:
                    self.assign("Lexit", 0)
                self.jump(target)

            statements, _ = self.captured(onward)
            self.emit(word("when"), expression(word("="), word("Lexit"), code), *statements)

    def TagbodyNode(self, node, destination):
        tagbody = node.tagbody
        tagbody.counter = self.temporary("Lpc")
        frame = Frame(tagbody)
        self.assign(tagbody.counter, 0)
        if tagbody.escapes:
            self.assign(tagbody.variable.name, self.call("block"))
        self.frames.append(frame)
        parts = []
        for index, segment in enumerate(node.segments):
            frame.segment = index
            statements, _ = self.captured(lambda segment=segment: [self.gen(item, EFFECT) for item in segment])
            if statements:
                test = expression(word("<="), word(tagbody.counter), index)
                last = index == len(node.segments) - 1
                parts.extend(statements if last else [expression(word("when"), test, *statements)])
        self.frames.pop()
        parts.append(expression(word("break")))
        if tagbody.escapes:
            exit_name = self.temporary("Le")
            target = expression(word("setv"), word(tagbody.counter),
                                self.call("block_value", word(exit_name), self.reference(tagbody.variable)))
            parts = [expression(word("try"), *parts, expression(
                word("except"), List([word(exit_name), word("LBlockExit")]), target))]
        loop = expression(word("while"), TRUE, *parts)
        if tagbody.escapes:
            end = self.call("end_block", self.reference(tagbody.variable))
            self.emit(word("try"), loop, expression(word("finally"), end))
        else:
            self.out.append(loop)
            self.effects += 1
        self.continue_exits(frame)
        return self.finish(NONE, node, destination, pure=True)

    def Go(self, node, destination):
        tagbody = node.tagbody
        if tagbody.owner is not self.scope:
            return self.finish(self.call("return_from", self.reference(tagbody.variable), node.index),
                               nodes.Constant(None), destination)
        frame = next(frame for frame in self.frames if frame.target is tagbody)
        if node.index <= frame.segment:
            self.checkpoint()
        self.assign(tagbody.counter, node.index)
        self.jump(tagbody)
        return NONE if destination.kind == "value" else None

    def checkpoint(self):
        """`kernel.checkpoint` of a loop, its counting done in place."""
        left = expression(word("."), word("Lbudget"), word("left"))
        self.emit(word("setv"), left, expression(word("-"), left, 1))
        self.emit(word("when"), expression(word("<"), left, 0), self.call("checkpoint"))

    def UnwindProtect(self, node, destination):
        def produce(inner):
            statements, _ = self.captured(lambda: self.gen(node.body, inner))
            before = self.scope.exits_set
            cleanup, _ = self.captured(lambda: self.gen(node.cleanup, EFFECT))
            if self.scope.exits_set != before:  # the cleanup must not forget the exit that it was entered by
                saved = self.temporary("Lsaved")
                cleanup = [self.setting(saved, word("Lexit")), *cleanup, self.setting("Lexit", word(saved))]
            shielded = expression(word("with"), List([word("_"), self.call("shield")]), *(cleanup or [NONE]))
            self.emit(word("try"), *(statements or [NONE]), expression(word("finally"), shielded))

        return self.by_statements(node, destination, produce)
