"""Exits: ``block``, ``return-from``, ``tagbody``, ``go`` and ``unwind-protect``.

Inside one Python function they become ``return``, ``break`` and ``continue``; only an exit from an inner function raises an
exception. A ``tagbody`` becomes a Python loop over its segments with a counter that says where to go on. A Python loop that is left
for an outer one sets ``Lexit`` and breaks, and the code after the loop goes on from there. Every turn of a loop counts as a checkpoint
of the kernel: it takes one of `Lbudget.ticks`, and when these are used up, `Lrefill` lets others run. Cleanup forms are shielded: no
request to end the task interrupts them (law 2).
"""

from __future__ import annotations

from .. import nodes
from ..core import NONE, TRUE, List, Tuple, expression, word
from ..destinations import EFFECT, VALUES
from ..facts import walk
from ..passes import JUMPS
from ..words import DOT
from .output import generates

DEEP = 5
"""Python loops inside each other up to which a loop counts its turns by a loop of its own: Python nests no more than 20 statements."""


class Frame:
    """A Python loop around the code being generated.

    ``breaks`` and ``again`` are the targets that are reached by breaking it and by its next turn; ``exits`` are outer targets that
    it is left for. A target is a block, a tagbody, or (tagbody, index of the segment).
    """

    def __init__(self, breaks=None, again=None):
        self.breaks = breaks
        self.again = again
        self.exits = {}


@generates(nodes.BlockNode)
def _block_node(generator, node, destination):
    return generator.by_statements(node, destination, lambda inner: block_statements(generator, node, inner))


def block_statements(generator, node, destination):
    block = node.block
    generator.destinations[block] = destination
    if block.escapes:
        generator.assign(block.variable.name, generator.call("block"))
    statements, _ = generator.captured(lambda: block_body(generator, node, destination))
    if not block.escapes:
        generator.out.extend(statements)
        generator.effects += 1
        return
    exit_name = generator.temporary("Le")
    handler, _ = generator.captured(
        lambda: generator.finish(value_left_with(generator, exit_name, block), nodes.Call(None, []), destination)
    )
    generator.emit(
        word("try"),
        *(statements or [NONE]),
        expression(word("except"), List([word(exit_name), word("LBlockExit")]), *handler),
        expression(word("finally"), ended(generator, block)),
    )


def block_body(generator, node, destination):
    if destination.kind == "return":
        generator.gen(node.body, destination)
        return
    frame = Frame(breaks=node.block)
    generator.frames.append(frame)
    statements, _ = generator.captured(lambda: generator.gen(node.body, destination))
    generator.frames.pop()
    generator.emit(word("while"), TRUE, *statements, expression(word("break")))
    continue_exits(generator, frame)


def value_left_with(generator, exit_name, target):
    """The value with which ``target`` is left by the exception ``exit_name``. An exit of another block or tagbody goes on."""
    left = word(exit_name)
    generator.emit(word("when"), expression(word("is-not"), left, generator.reference(target.variable)), expression(word("raise")))
    # It leads to frames that hold the exit: a circle that only the garbage collector would find.
    generator.emit(word("setv"), expression(DOT, left, word("__traceback__")), NONE)
    return expression(DOT, left, word("value"))


def ended(generator, target):
    """Code after which nobody can leave ``target`` any more, a block or tagbody."""
    return expression(word("setv"), expression(DOT, generator.reference(target.variable), word("active")), word("False"))


def leave_outer(generator, target, value):
    """Leave ``target``, a block or tagbody of an outer function, with ``value``."""
    exit_ = generator.reference(target.variable)
    generator.emit(word("setv"), expression(DOT, exit_, word("value")), value)
    generator.emit(word("when"), expression(word("not"), expression(DOT, exit_, word("active"))), generator.call("nothing_to_leave"))
    generator.emit(word("raise"), exit_)


@generates(nodes.ReturnFrom)
def _return_from(generator, node, destination):
    block = node.block
    if block.owner is not generator.scope:
        leave_outer(generator, block, generator.gen(node.value, VALUES))
        return NONE if destination.kind == "value" else None
    target = generator.destinations[block]
    generator.gen(node.value, target)
    if target.kind != "return":
        jump(generator, block)
    return NONE if destination.kind == "value" else None


def jump(generator, target):
    """Leave the Python loops between here and that of ``target``, then break it or go on with its next turn."""
    inner = generator.frames[-1]
    if target == inner.breaks or target == inner.again:
        generator.emit(word("break" if target == inner.breaks else "continue"))
        return
    code = generator.jump_codes.setdefault(target, len(generator.jump_codes) + 1)
    generator.scope.exits_set += 1
    generator.assign("Lexit", code)
    inner.exits[target] = code
    generator.emit(word("break"))


def continue_exits(generator, frame):
    """After a loop: go on with the exits for which it was left."""
    for target, code in frame.exits.items():

        def onward(target=target):
            if target in (generator.frames[-1].breaks, generator.frames[-1].again):
                generator.assign("Lexit", 0)
            jump(generator, target)

        statements, _ = generator.captured(onward)
        generator.emit(word("when"), expression(word("="), word("Lexit"), code), *statements)


@generates(nodes.TagbodyNode)
def _tagbody(generator, node, destination):
    tagbody_statements(generator, node)
    return generator.finish(NONE, node, destination, pure=True)


def tagbody_statements(generator, node):
    """A loop over the segments of a tagbody, which may jump from anywhere to anywhere."""
    tagbody = node.tagbody
    tagbody.counter = generator.temporary("Lpc")
    frame = Frame(again=tagbody)
    generator.assign(tagbody.counter, 0)
    if tagbody.escapes:
        generator.assign(tagbody.variable.name, generator.call("block"))
    generator.frames.append(frame)
    parts = []
    for index, segment in enumerate(node.segments):
        statements, _ = generator.captured(lambda segment=segment: [generator.gen(item, EFFECT) for item in segment])
        if statements:
            test = expression(word("<="), word(tagbody.counter), index)
            last = index == len(node.segments) - 1
            parts.extend(statements if last else [expression(word("when"), test, *statements)])
    generator.frames.pop()
    parts.append(expression(word("break")))
    if tagbody.escapes:
        exit_name = generator.temporary("Le")
        handler, _ = generator.captured(lambda: generator.assign(tagbody.counter, value_left_with(generator, exit_name, tagbody)))
        parts = [expression(word("try"), *parts, expression(word("except"), List([word(exit_name), word("LBlockExit")]), *handler))]
    loop = ticking(parts, len(generator.frames))
    if tagbody.escapes:
        generator.emit(word("try"), loop, expression(word("finally"), ended(generator, tagbody)))
    else:
        generator.out.append(loop)
        generator.effects += 1
    continue_exits(generator, frame)


def ticking(body, depth):
    """An endless loop whose turns count, inside ``depth`` others: Python nests no more than 20 statements."""
    if depth >= DEEP:
        return expression(word("while"), TRUE, expression(word("Lcheckpoint")), *body)
    ticks = expression(word("."), word("Lbudget"), word("ticks"))
    refill = expression(word("else"), expression(word("Lrefill")), expression(word("continue")))
    return expression(
        word("while"), TRUE, expression(word("for"), List([word("Ltick"), ticks]), *(body or [NONE]), refill), expression(word("break"))
    )


@generates(nodes.Go)
def _go(generator, node, destination):
    tagbody = node.tagbody
    if tagbody.owner is not generator.scope:
        leave_outer(generator, tagbody, node.index)
        return NONE if destination.kind == "value" else None
    if tagbody.structured:
        jump(generator, (tagbody, node.index))
    else:
        generator.assign(tagbody.counter, node.index)
        jump(generator, tagbody)
    return NONE if destination.kind == "value" else None


@generates(nodes.Each)
def _each(generator, node, destination):
    items = generator.call(node.source, generator.value(node.sequence), *([node.context] if node.context else []))
    names = [word(variable.name) for variable in node.variables]
    frame = Frame()
    generator.frames.append(frame)
    body, _ = generator.captured(lambda: generator.gen(node.body, EFFECT))
    generator.frames.pop()
    if node.source == "each_entry":
        body.insert(0, expression(word("when"), expression(word("is"), names[1], word("Lremoved")), expression(word("continue"))))
    generator.emit(word("for"), List([List(names) if len(names) > 1 else names[0], items]), *(body or [NONE]))
    continue_exits(generator, frame)
    return generator.finish(NONE, node, destination, pure=True)


@generates(nodes.UnwindProtect)
def _unwind_protect(generator, node, destination):
    def produce(inner):
        statements, _ = generator.captured(lambda: generator.gen(node.body, inner))
        before = generator.scope.exits_set
        cleanup, _ = generator.captured(lambda: generator.gen(node.cleanup, EFFECT))
        cleanup = [expression(word("with"), List([word("_"), generator.call("cleanup")]), *(cleanup or [NONE]))]
        if generator.scope.exits_set != before:  # the cleanup must not forget the exit that it was entered by, nor may its end
            saved = generator.temporary("Lsaved")
            cleanup = [generator.setting(saved, word("Lexit")), *cleanup, generator.setting("Lexit", word(saved))]
        generator.emit(word("try"), *(statements or [NONE]), expression(word("finally"), *cleanup))

    return generator.by_statements(node, destination, produce)


@generates(nodes.Catching)
def _catching(generator, node, destination):
    return generator.by_statements(node, destination, lambda inner: catching_statements(generator, node, inner))


def catching_statements(generator, node, destination):
    """``handler-case``: the handlers are in force while the form runs; the clause runs when they are not any more."""
    task, run, left = word(generator.temporary("Ltask")), word(generator.temporary("Lrun")), word(generator.temporary("Le"))
    clause = word(generator.temporary("Lclause"))
    found = List([clause, word(node.condition.name)])
    ends = destination.kind != "return"  # whether the code goes on behind the form that was guarded
    if ends:
        generator.assign(clause, -1)
    in_force(generator, task, run, word(generator.constants.case(node.types)))
    frame = Frame(breaks=node.condition)
    signals = JUMPS and any(item.__class__ is nodes.Call and item.symbol in JUMPS for item in walk([node.form]))
    if signals:
        generator.frames.append(frame)
        generator.cases.append(((task, run), found, node.condition, generator.scope))
    guarded, _ = generator.captured(lambda: generator.gen(node.form, destination))
    if signals:
        generator.cases.pop()
        generator.frames.pop()
    attempt = expression(
        word("try"),
        *(guarded or [NONE]),
        expression(word("except"), List([left, word("Lcatchable")]), expression(word("setv"), found, generator.call("caught", left, run))),
        expression(word("finally"), out_of_force(task, run)),
    )
    if signals:
        generator.emit(word("while"), TRUE, attempt, expression(word("break")))
        continue_exits(generator, frame)
    else:
        generator.out.append(attempt)
        generator.effects += 1
    bodies = [generator.captured(lambda body=body: generator.gen(body, destination))[0] for body in node.clauses]
    if len(bodies) == 1 and not ends:
        generator.out += bodies[0]
    else:
        for number, body in enumerate(bodies):
            generator.emit(word("when"), expression(word("="), clause, number), *(body or [NONE]))


@generates(nodes.Handling)
def _handling(generator, node, destination):
    return generator.by_statements(node, destination, lambda inner: handling_statements(generator, node, inner))


def handling_statements(generator, node, destination):
    """``handler-bind``: the handlers are in force while the body runs."""
    functions = generator.arguments(node.functions)
    task, run, passing = word(generator.temporary("Ltask")), word(generator.temporary("Lrun")), word(generator.temporary("Le"))
    in_force(generator, task, run, List([Tuple([generator.literal(kind), each]) for kind, each in zip(node.types, functions, strict=True)]))
    body, _ = generator.captured(lambda: generator.gen(node.body, destination))
    late = [generator.call("offer_late", passing), expression(word("raise"))]
    generator.emit(
        word("try"),
        *(body or [NONE]),
        expression(word("except"), List([passing, word("Lexceptions")]), *late),
        expression(word("finally"), out_of_force(task, run)),
    )


def in_force(generator, task, run, handlers):
    """Put ``handlers`` in force for the task that runs; ``run`` names the pair that stands for this time."""
    active = expression(word("or"), expression(DOT, word("Lactive"), word("value")), expression(word("Lno_kernel")))
    generator.emit(word("setv"), task, expression(DOT, active, word("current")))
    generator.emit(word("setv"), run, Tuple([handlers, expression(DOT, task, word("handlers"))]))
    generator.emit(word("setv"), expression(DOT, task, word("handlers")), run)


def out_of_force(task, run):
    """Code after which those that were in force before ``run`` are again."""
    return expression(word("setv"), expression(DOT, task, word("handlers")), expression(word("get"), run, 1))
