"""Exits: ``block``, ``return-from``, ``tagbody``, ``go`` and ``unwind-protect``.

Inside one Python function they become ``return``, ``break`` and ``continue``; only an exit from an inner function raises an
exception. A ``tagbody`` is a ``while`` loop over its segments with a counter that says where to go on. A Python loop that is left
for an outer one sets ``Lexit`` and breaks, and the code after the loop goes on from there. Every ``go`` backwards is a checkpoint
of the kernel. Cleanup forms are shielded: no request to end the task interrupts them (law 2).
"""

from __future__ import annotations

from hy import models

from . import nodes
from .constants import expression, symbol_model
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
            self.call("block_value", symbol_model(exit_name), self.reference(block.variable)), nodes.Call(None, []), destination))
        self.emit(symbol_model("try"), *(statements or [NONE]),
                  expression(symbol_model("except"), models.List([symbol_model(exit_name), symbol_model("LBlockExit")]), *handler),
                  expression(symbol_model("finally"), self.call("end_block", self.reference(block.variable))))

    def block_body(self, node, destination):
        if destination.kind == "return":
            self.gen(node.body, destination)
            return
        frame = Frame(node.block)
        self.frames.append(frame)
        statements, _ = self.captured(lambda: self.gen(node.body, destination))
        self.frames.pop()
        self.emit(symbol_model("while"), TRUE, *statements, expression(symbol_model("break")))
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
            self.emit(symbol_model("continue" if again else "break"))
            return
        code = self.jump_codes.setdefault(target, len(self.jump_codes) + 1)
        self.scope.exits_set += 1
        self.assign("Lexit", models.Integer(code))
        inner.exits[target] = code
        self.emit(symbol_model("break"))

    def continue_exits(self, frame):
        """After a loop: go on with the exits for which it was left."""
        for target, code in frame.exits.items():
            def onward(target=target):
                if self.frames[-1].target is target:
                    self.assign("Lexit", models.Integer(0))
                self.jump(target)

            statements, _ = self.captured(onward)
            self.emit(symbol_model("when"), expression(symbol_model("="), symbol_model("Lexit"), models.Integer(code)), *statements)

    def TagbodyNode(self, node, destination):
        tagbody = node.tagbody
        tagbody.counter = self.temporary("Lpc")
        frame = Frame(tagbody)
        self.assign(tagbody.counter, models.Integer(0))
        if tagbody.escapes:
            self.assign(tagbody.variable.name, self.call("block"))
        self.frames.append(frame)
        parts = []
        for index, segment in enumerate(node.segments):
            frame.segment = index
            statements, _ = self.captured(lambda segment=segment: [self.gen(item, EFFECT) for item in segment])
            if statements:
                test = expression(symbol_model("<="), symbol_model(tagbody.counter), models.Integer(index))
                last = index == len(node.segments) - 1
                parts.extend(statements if last else [expression(symbol_model("when"), test, *statements)])
        self.frames.pop()
        parts.append(expression(symbol_model("break")))
        if tagbody.escapes:
            exit_name = self.temporary("Le")
            target = expression(symbol_model("setv"), symbol_model(tagbody.counter),
                                self.call("block_value", symbol_model(exit_name), self.reference(tagbody.variable)))
            parts = [expression(symbol_model("try"), *parts, expression(
                symbol_model("except"), models.List([symbol_model(exit_name), symbol_model("LBlockExit")]), target))]
        loop = expression(symbol_model("while"), TRUE, *parts)
        if tagbody.escapes:
            end = self.call("end_block", self.reference(tagbody.variable))
            self.emit(symbol_model("try"), loop, expression(symbol_model("finally"), end))
        else:
            self.out.append(loop)
            self.effects += 1
        self.continue_exits(frame)
        return self.finish(NONE, node, destination, pure=True)

    def Go(self, node, destination):
        tagbody = node.tagbody
        if tagbody.owner is not self.scope:
            return self.finish(self.call("return_from", self.reference(tagbody.variable), models.Integer(node.index)),
                               nodes.Constant(None), destination)
        frame = next(frame for frame in self.frames if frame.target is tagbody)
        if node.index <= frame.segment:
            self.checkpoint()
        self.assign(tagbody.counter, models.Integer(node.index))
        self.jump(tagbody)
        return NONE if destination.kind == "value" else None

    def checkpoint(self):
        """`kernel.checkpoint` of a loop, its counting done in place."""
        left = expression(symbol_model("."), symbol_model("Lbudget"), symbol_model("left"))
        self.emit(symbol_model("setv"), left, expression(symbol_model("-"), left, models.Integer(1)))
        self.emit(symbol_model("when"), expression(symbol_model("<"), left, models.Integer(0)), self.call("checkpoint"))

    def UnwindProtect(self, node, destination):
        def produce(inner):
            statements, _ = self.captured(lambda: self.gen(node.body, inner))
            before = self.scope.exits_set
            cleanup, _ = self.captured(lambda: self.gen(node.cleanup, EFFECT))
            if self.scope.exits_set != before:  # the cleanup must not forget the exit that it was entered by
                saved = self.temporary("Lsaved")
                cleanup = [self.setting(saved, symbol_model("Lexit")), *cleanup, self.setting("Lexit", symbol_model(saved))]
            shielded = expression(symbol_model("with"), models.List([symbol_model("_"), self.call("shield")]), *(cleanup or [NONE]))
            self.emit(symbol_model("try"), *(statements or [NONE]), expression(symbol_model("finally"), shielded))

        return self.by_statements(node, destination, produce)
