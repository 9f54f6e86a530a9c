"""Exits: ``block``, ``return-from``, ``tagbody``, ``go`` and ``unwind-protect``.

Inside one Python function they become ``return``, ``break`` and ``continue``; only an exit from an inner function raises an
exception. A ``tagbody`` that is a loop (``loop_shapes.py``) becomes Python's loop, any other one a loop over its segments with a
counter that says where to go on. A Python loop that is left for an outer one sets ``Lexit`` and breaks, and the code after the
loop goes on from there. Every turn of a loop counts as a checkpoint of the kernel: it takes one of `Lbudget.ticks`, and when
these are used up, `Lrefill` lets others run. Cleanup forms are shielded: no request to end the task interrupts them (law 2).
"""

from __future__ import annotations

from cramhy_runtime.ground.packages import sym
from . import nodes
from .arithmetic.operations import DOT
from .core import List, Tuple, expression, word
from .destinations import EFFECT, NONE, TRUE, VALUES
from .facts import walk
from .loop_shapes import counting, loop_of


DEEP = 5
ERROR = sym("ERROR")


class Frame:
    """A Python loop around the code being generated.

    ``breaks`` and ``again`` are the targets that are reached by breaking it and by its next turn; ``exits`` are outer targets that
    it is left for. A target is a block, a tagbody, or (tagbody, index of the segment).
    """

    def __init__(self, breaks=None, again=None):
        self.breaks = breaks
        self.again = again
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
        handler, _ = self.captured(lambda: self.finish(self.value_left_with(exit_name, block), nodes.Call(None, []), destination))
        self.emit(
            word("try"),
            *(statements or [NONE]),
            expression(word("except"), List([word(exit_name), word("LBlockExit")]), *handler),
            expression(word("finally"), self.ended(block)),
        )

    def value_left_with(self, exit_name, target):
        """The value with which ``target`` is left by the exception ``exit_name``. An exit of another block or tagbody goes on."""
        left = word(exit_name)
        self.emit(word("when"), expression(word("is-not"), left, self.reference(target.variable)), expression(word("raise")))
        # It leads to frames that hold the exit: a circle that only the garbage collector would find.
        self.emit(word("setv"), expression(DOT, left, word("__traceback__")), NONE)
        return expression(DOT, left, word("value"))

    def ended(self, target):
        """Code after which nobody can leave ``target`` any more, a block or tagbody."""
        return expression(word("setv"), expression(DOT, self.reference(target.variable), word("active")), word("False"))

    def leave(self, target, value):
        """Leave ``target``, a block or tagbody of an outer function, with ``value``."""
        exit_ = self.reference(target.variable)
        self.emit(word("setv"), expression(DOT, exit_, word("value")), value)
        self.emit(word("when"), expression(word("not"), expression(DOT, exit_, word("active"))), self.call("nothing_to_leave"))
        self.emit(word("raise"), exit_)

    def block_body(self, node, destination):
        if destination.kind == "return":
            self.gen(node.body, destination)
            return
        frame = Frame(breaks=node.block)
        self.frames.append(frame)
        statements, _ = self.captured(lambda: self.gen(node.body, destination))
        self.frames.pop()
        self.emit(word("while"), TRUE, *statements, expression(word("break")))
        self.continue_exits(frame)

    def ReturnFrom(self, node, destination):
        block = node.block
        if block.owner is not self.scope:
            self.leave(block, self.gen(node.value, VALUES))
            return NONE if destination.kind == "value" else None
        target = self.destinations[block]
        self.gen(node.value, target)
        if target.kind != "return":
            self.jump(block)
        return NONE if destination.kind == "value" else None

    def jump(self, target):
        """Leave the Python loops between here and that of ``target``, then break it or go on with its next turn."""
        inner = self.frames[-1]
        if target == inner.breaks or target == inner.again:
            self.emit(word("break" if target == inner.breaks else "continue"))
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
                if target in (self.frames[-1].breaks, self.frames[-1].again):
                    self.assign("Lexit", 0)
                self.jump(target)

            statements, _ = self.captured(onward)
            self.emit(word("when"), expression(word("="), word("Lexit"), code), *statements)

    def TagbodyNode(self, node, destination):
        tagbody = node.tagbody
        loop = None if tagbody.escapes else loop_of(node)
        if loop is None:
            self.any_tagbody(node)
        else:
            self.loop(node, loop)
        return self.finish(NONE, node, destination, pure=True)

    def loop(self, node, loop):
        """A tagbody that is a loop: what comes before it, Python's loop, what comes after it."""
        tagbody, segments = node.tagbody, node.segments
        end = (tagbody, loop.last + 1)
        tagbody.structured = True
        first = len(segments) if loop.first is None else loop.first

        def before():
            for segment in segments[: loop.last + 1] if loop.first is None else segments[:first]:
                for item in segment:
                    self.gen(item, EFFECT)
            if loop.first is not None:
                self.repeated(node, loop, end)

        if loop.left_early:
            frame = Frame(breaks=end)
            self.frames.append(frame)
            statements, _ = self.captured(before)
            self.frames.pop()
            self.emit(word("while"), TRUE, *statements, expression(word("break")))
            self.continue_exits(frame)
        else:
            before()
        for segment in segments[loop.last + 1 :]:
            for item in segment:
                self.gen(item, EFFECT)

    def repeated(self, node, loop, end):
        """The loop itself."""
        tagbody = node.tagbody
        statements = [item for segment in node.segments[loop.first : loop.last + 1] for item in segment]
        found = None
        if loop.first == loop.last and len(self.frames) < DEEP:
            found = counting(statements, tagbody, loop.first, end[1], self.scope)
        frame = Frame(breaks=end, again=(tagbody, loop.first))
        self.frames.append(frame)
        if found is not None:
            source, target = self.counted(found)
            body, _ = self.captured(lambda: [self.gen(item, EFFECT) for item in found.body])
            self.frames.pop()
            # two loops in Python: over parts, between which others may get a turn, and over the elements of a part
            part = word("Lpart")
            inner = expression(word("for"), List([target, part]), *(body or [NONE]), expression(word("else"), expression(word("continue"))))
            self.emit(word("for"), List([part, source]), inner, expression(word("break")))
            self.continue_exits(frame)
            return

        last = statements[-1] if statements else None
        again = last.__class__ is nodes.Go and last.tagbody is tagbody and last.index == loop.first

        def turn():
            for item in statements[:-1] if again else statements:
                self.gen(item, EFFECT)
            if not again:
                self.emit(word("break"))

        body, _ = self.captured(turn)
        self.frames.pop()
        self.out.append(self.ticking(body, len(self.frames)))
        self.effects += 1
        self.continue_exits(frame)

    @staticmethod
    def ticking(body, depth):
        """An endless loop whose turns count, inside ``depth`` others: Python nests no more than 20 statements."""
        if depth >= DEEP:
            return expression(word("while"), TRUE, expression(word("Lcheckpoint")), *body)
        ticks = expression(word("."), word("Lbudget"), word("ticks"))
        refill = expression(word("else"), expression(word("Lrefill")), expression(word("continue")))
        return expression(
            word("while"), TRUE, expression(word("for"), List([word("Ltick"), ticks]), *(body or [NONE]), refill), expression(word("break"))
        )

    def Each(self, node, destination):
        items = self.call(node.source, self.value(node.sequence), *([node.context] if node.context else []))
        names = [word(variable.name) for variable in node.variables]
        frame = Frame()
        self.frames.append(frame)
        body, _ = self.captured(lambda: self.gen(node.body, EFFECT))
        self.frames.pop()
        if node.source == "each_entry":
            body.insert(0, expression(word("when"), expression(word("is"), names[1], word("Lremoved")), expression(word("continue"))))
        self.emit(word("for"), List([List(names) if len(names) > 1 else names[0], items]), *(body or [NONE]))
        self.continue_exits(frame)
        return self.finish(NONE, node, destination, pure=True)

    def counted(self, found):
        """(what Python's ``for`` goes over, its target) of a `Counting`."""
        if found.vector is not None:
            return self.call("items", self.value(found.vector)), word(found.element.name)
        variable = word(found.variable.name)
        limit = self.value(found.limit)
        return self.call("counting", variable, limit, found.step, TRUE if found.inclusive else NONE), variable

    def any_tagbody(self, node):
        """A tagbody of any shape: a loop over its segments."""
        tagbody = node.tagbody
        tagbody.counter = self.temporary("Lpc")
        frame = Frame(again=tagbody)
        self.assign(tagbody.counter, 0)
        if tagbody.escapes:
            self.assign(tagbody.variable.name, self.call("block"))
        self.frames.append(frame)
        parts = []
        for index, segment in enumerate(node.segments):
            statements, _ = self.captured(lambda segment=segment: [self.gen(item, EFFECT) for item in segment])
            if statements:
                test = expression(word("<="), word(tagbody.counter), index)
                last = index == len(node.segments) - 1
                parts.extend(statements if last else [expression(word("when"), test, *statements)])
        self.frames.pop()
        parts.append(expression(word("break")))
        if tagbody.escapes:
            exit_name = self.temporary("Le")
            handler, _ = self.captured(lambda: self.assign(tagbody.counter, self.value_left_with(exit_name, tagbody)))
            parts = [expression(word("try"), *parts, expression(word("except"), List([word(exit_name), word("LBlockExit")]), *handler))]
        loop = self.ticking(parts, len(self.frames))
        if tagbody.escapes:
            self.emit(word("try"), loop, expression(word("finally"), self.ended(tagbody)))
        else:
            self.out.append(loop)
            self.effects += 1
        self.continue_exits(frame)

    def Go(self, node, destination):
        tagbody = node.tagbody
        if tagbody.owner is not self.scope:
            self.leave(tagbody, node.index)
            return NONE if destination.kind == "value" else None
        if tagbody.structured:
            self.jump((tagbody, node.index))
        else:
            self.assign(tagbody.counter, node.index)
            self.jump(tagbody)
        return NONE if destination.kind == "value" else None

    def Catching(self, node, destination):
        return self.by_statements(node, destination, lambda inner: self.catching(node, inner))

    def catching(self, node, destination):
        """``handler-case``: the handlers are in force while the form runs; the clause runs when they are not any more."""
        task, run, left = word(self.temporary("Ltask")), word(self.temporary("Lrun")), word(self.temporary("Le"))
        clause = word(self.temporary("Lclause"))
        found = List([clause, word(node.condition.name)])
        ends = destination.kind != "return"  # whether the code goes on behind the form that was guarded
        if ends:
            self.assign(clause, -1)
        self.in_force(task, run, word(self.constants.case(node.types)))
        frame = Frame(breaks=node.condition)
        signals = any(item.__class__ is nodes.Call and item.symbol is ERROR for item in walk([node.form]))
        if signals:
            self.frames.append(frame)
            self.cases.append(((task, run), found, node.condition, self.scope))
        guarded, _ = self.captured(lambda: self.gen(node.form, destination))
        if signals:
            self.cases.pop()
            self.frames.pop()
        attempt = expression(
            word("try"),
            *(guarded or [NONE]),
            expression(word("except"), List([left, word("Lcatchable")]), expression(word("setv"), found, self.call("caught", left, run))),
            expression(word("finally"), self.out_of_force(task, run)),
        )
        if signals:
            self.emit(word("while"), TRUE, attempt, expression(word("break")))
            self.continue_exits(frame)
        else:
            self.out.append(attempt)
            self.effects += 1
        bodies = [self.captured(lambda body=body: self.gen(body, destination))[0] for body in node.clauses]
        if len(bodies) == 1 and not ends:
            self.out += bodies[0]
        else:
            for number, body in enumerate(bodies):
                self.emit(word("when"), expression(word("="), clause, number), *(body or [NONE]))

    def Handling(self, node, destination):
        return self.by_statements(node, destination, lambda inner: self.handling(node, inner))

    def handling(self, node, destination):
        """``handler-bind``: the handlers are in force while the body runs."""
        functions = self.arguments(node.functions)
        task, run, passing = word(self.temporary("Ltask")), word(self.temporary("Lrun")), word(self.temporary("Le"))
        self.in_force(task, run, List([Tuple([self.literal(kind), each]) for kind, each in zip(node.types, functions, strict=True)]))
        body, _ = self.captured(lambda: self.gen(node.body, destination))
        late = [self.call("offer_late", passing), expression(word("raise"))]
        self.emit(
            word("try"),
            *(body or [NONE]),
            expression(word("except"), List([passing, word("Lexceptions")]), *late),
            expression(word("finally"), self.out_of_force(task, run)),
        )

    def error_in_case(self, node, arguments, destination):
        """A call of ``error`` in the form that a ``handler-case`` of this function guards: if a clause fits, the code goes on there."""
        names, found, target, _ = self.cases[-1]
        self.emit(word("setv"), found, self.positioned(self.call("error_in_case", *names, *self.arguments(arguments)), node))
        self.jump(target)
        return NONE if destination.kind == "value" else None

    def in_force(self, task, run, handlers):
        """Put ``handlers`` in force for the task that runs; ``run`` names the pair that stands for this time."""
        active = expression(word("or"), expression(DOT, word("Lactive"), word("value")), expression(word("Lno_kernel")))
        self.emit(word("setv"), task, expression(DOT, active, word("current")))
        self.emit(word("setv"), run, Tuple([handlers, expression(DOT, task, word("handlers"))]))
        self.emit(word("setv"), expression(DOT, task, word("handlers")), run)

    @staticmethod
    def out_of_force(task, run):
        """Code after which those that were in force before ``run`` are again."""
        return expression(word("setv"), expression(DOT, task, word("handlers")), expression(word("get"), run, 1))

    def UnwindProtect(self, node, destination):
        def produce(inner):
            statements, _ = self.captured(lambda: self.gen(node.body, inner))
            before = self.scope.exits_set
            cleanup, _ = self.captured(lambda: self.gen(node.cleanup, EFFECT))
            cleanup = [expression(word("with"), List([word("_"), self.call("cleanup")]), *(cleanup or [NONE]))]
            if self.scope.exits_set != before:  # the cleanup must not forget the exit that it was entered by, nor may its end
                saved = self.temporary("Lsaved")
                cleanup = [self.setting(saved, word("Lexit")), *cleanup, self.setting("Lexit", word(saved))]
            self.emit(word("try"), *(statements or [NONE]), expression(word("finally"), *cleanup))

        return self.by_statements(node, destination, produce)
