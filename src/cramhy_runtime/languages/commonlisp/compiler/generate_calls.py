"""Calls of functions whose shape is known: no frame stands between the call and the function.

A standard function with keywords is a Python function with keyword-only parameters behind one that sorts keyword objects
(`ground.keyword_calls`). A call that names its keywords is sorted here, once, and calls the Python function itself. Several values
are taken apart where they are made, if that can be seen.
"""

from __future__ import annotations

from types import FunctionType

from cramhy_runtime.ground.data import Character, Keyword, Symbol
from cramhy_runtime.ground.dispatch.reached_slots import read_attribute
from cramhy_runtime.ground.keyword_calls import keyword_calls, name_of_key, takes_keywords
from cramhy_runtime.ground.packages import sym
from ..objects.makers import maker
from ..objects.slots import named_slot
from . import core, nodes
from .core import NONE, TRUE, List, Tuple, expression, word
from .destinations import FIRST_OF_VALUES
from .kinds import INT, exactly, kind_of, raw
from .several_values import gives_tuple, values_calls
from .destinations import VALUES as ALL_VALUES
from .arithmetic.operations import AND, DOT, IF, INT_CLASS, IS, IS_NOT, SETX, class_of

FIND, FLOOR, GETHASH, LIST, TRUNCATE, VALUES = map(sym, "FIND FLOOR GETHASH LIST TRUNCATE VALUES".split())
MAKE_INSTANCE, SAME_CHARACTER, SLOT_VALUE = map(sym, "MAKE-INSTANCE CHAR= SLOT-VALUE".split())
CHARACTER, GET, IN, PLUS, SETV = map(word, "Lcharacter get in + setv".split())


class CallGenerator:
    """The part of the `Generator` that calls functions of known shape."""

    def standard_function(self, symbol, models, arguments):
        """The call of a standard function with the values ``models`` of the nodes ``arguments``."""
        function = symbol.function
        python = getattr(function, "python", None)
        if hasattr(python, "__code__"):
            sorted_ = sorted_arguments(function, models, arguments)
            if sorted_ is not None:
                return expression(word(self.constants.name("function.python", symbol)), *sorted_)
        return expression(word(self.constants.name("function", symbol)), *models)

    def keyword_call(self, node, symbol, models, arguments):
        """The call of a user's function with keywords that the code names, if it takes them as Python's; else ``None``."""
        if not isinstance(symbol, Symbol) or (count := _keys_begin(symbol.function, arguments)) is None:
            return None
        names = [name_of_key(key.value) for key in arguments[count::2]]
        if not takes_keywords(symbol.function, count, names) or len({*names}) < len(names):
            return None
        calls = self.constant(keyword_calls(symbol, count, *[key.value for key in arguments[count::2]]))
        done = models[:count]
        for name, value in zip(names, models[count + 1 :: 2], strict=True):
            done += [core.Keyword(name), value]
        return self.positioned(expression(expression(DOT, calls, word("call")), *done), node)

    def known_function(self, symbol):
        return word(self.constants.name("function", symbol))

    # ---------------------------------------------------------------------------------------------------------- in place

    def open_call(self, node, symbol, arguments, destination):
        """The expression of a call of a standard function that needs no function, or another one; ``None`` for a usual call.

        It has one value, but that of ``values`` with all that are wanted.
        """
        count = len(arguments)
        if symbol is VALUES and count > 1:
            if destination.multiple:
                return expression(word("LMultipleValues"), Tuple(self.arguments(arguments)))
            (first, *_) = self.stable_names(self.arguments(arguments))
            return first
        if symbol is MAKE_INSTANCE:
            return self.instance_made(node, arguments)
        if symbol is FLOOR and count == 2 and destination.multiple and _is_number(arguments[1]):
            divisor = arguments[1].value
            number, name = self.named(arguments[0])
            slow = self.positioned(expression(self.known_function(symbol), name, divisor), node)
            quick = expression(word("LMultipleValues"), self.call("divmod", name, divisor))
            return expression(IF, expression(IS, class_of(number), INT_CLASS), quick, slow)
        if symbol is SLOT_VALUE and count == 2 and (named := slot_named_by(arguments[1])) is not None:
            (target,) = self.stable_names(self.arguments(arguments[:1]))
            classes = self.constant(named)
            slow = self.positioned(expression(expression(DOT, classes, word("read")), target), node)
            return expression(IF, self.among(target, classes), expression(DOT, target, word(named.attribute)), self.first_value(slow))
        if symbol is GETHASH and count in (2, 3) and (not destination.multiple or destination is FIRST_OF_VALUES):
            return self.entry_read(node, arguments)
        if symbol is LIST and count > 4:
            return self.call("list", *self.arguments(arguments))
        if symbol is SAME_CHARACTER and count == 2:
            test = self.same_character(node, arguments)
            return None if test is None else self.truth_value(test)
        if symbol is FIND and count == 2 and _is_text(arguments[1]):
            item, name, among, slow = self.found_in_text(node, arguments)
            return expression(IF, expression(IS, class_of(item), CHARACTER), expression(IF, among, name, NONE), slow)
        return None

    def open_test(self, node, symbol, arguments):
        """A Python expression that is true when the value of such a call is; ``None`` for other calls."""
        if symbol is SAME_CHARACTER and len(arguments) == 2:
            return self.same_character(node, arguments)
        if symbol is FIND and len(arguments) == 2 and _is_text(arguments[1]):
            item, _, among, slow = self.found_in_text(node, arguments)
            return expression(IF, expression(IS, class_of(item), CHARACTER), among, expression(IS_NOT, slow, NONE))
        return None

    def found_in_text(self, node, arguments):
        """``(find item "text")``: the first and later use of the item, a test whether the character is in the text, and the usual call."""
        item, name = self.named(arguments[0])
        among = expression(IN, expression(DOT, name, word("char")), arguments[1].value)
        return item, name, among, self.positioned(expression(self.known_function(FIND), name, arguments[1].value), node)

    def instance_made(self, node, arguments):
        """``(make-instance 'class :key value ...)``"""
        keys = arguments[1::2]
        constant = all(each.__class__ is nodes.Constant for each in (arguments[:1] + keys))
        if not arguments or not constant or len(arguments) % 2 == 0 or any(key.value.__class__ is not Keyword for key in keys):
            return None
        name = arguments[0].value
        if name.__class__ is not Symbol or name.package is None:
            return None
        made_by = self.constant(maker(name, *[key.value for key in keys]))
        model = expression(expression(DOT, made_by, word("make")), *self.arguments(arguments[2::2]))
        return self.first_value(self.positioned(model, node))

    def same_character(self, node, arguments):
        """A test for ``(char= x y)``: characters are the same object if they are the same."""
        if any(each.__class__ is nodes.Constant and each.value.__class__ is not Character for each in arguments):
            return None
        models = self.stable_names(self.arguments(arguments))
        unknown = [
            expression(IS, class_of(model), CHARACTER)
            for model, argument in zip(models, arguments, strict=True)
            if not (argument.__class__ is nodes.Constant and argument.value.__class__ is Character)
        ]
        same = expression(IS, *models)
        if not unknown:
            return same
        test = unknown[0] if len(unknown) == 1 else expression(AND, *unknown)
        slow = self.positioned(expression(self.known_function(SAME_CHARACTER), *models), node)
        return expression(IF, test, same, expression(IS_NOT, slow, NONE))

    # -------------------------------------------------------------------------------------------------------------- slots

    def slot_read(self, node, symbol, models):
        """A call of an accessor: the attribute itself, if the object is of a class where that means the same; or ``None``."""
        if len(models) != 1 or (attribute := read_attribute(symbol)) is None:
            return None
        (target,) = self.stable_names(models)
        classes = word(self.constants.name(f"reads.of_{attribute}", symbol))
        slow = self.positioned(expression(expression(DOT, self.constant(symbol), word("function")), target), node)
        return expression(IF, self.among(target, classes), expression(DOT, target, word(attribute)), self.first_value(slow))

    @staticmethod
    def among(target, classes):
        """A test whether the class of ``target`` is one of ``classes`` (`ground.data.Classes`)."""
        last = expression(IS, expression(SETX, word("Lo"), class_of(target)), expression(DOT, classes, word("last")))
        return expression(word("or"), last, expression(IN, word("Lo"), classes))

    def slot_written(self, node, attribute, models, destination):
        """``(setf (accessor object) new)``, with the new value and the object as ``models``."""
        classes = word(self.constants.name(f"writes.of_{attribute}", node.symbol))
        self.attribute_set(node, attribute, models, destination, classes, self.call("setf_function", self.constant(node.symbol)))

    def named_slot_written(self, node, named, models, destination):
        """``(setf (slot-value object 'name) new)``"""
        classes = self.constant(named)
        self.attribute_set(node, named.attribute, models[:2], destination, classes, expression(DOT, classes, word("write")))

    def attribute_set(self, node, attribute, models, destination, classes, function):
        """Set an attribute of an object that is an instance of one of ``classes``, or call ``function``."""
        new, target = self.stable_names(models)
        quick, _ = self.captured(lambda: self.finish(new, nodes.Constant(None), destination, pure=True))
        call = self.positioned(expression(function, new, target), node)
        slow, _ = self.captured(lambda: self.finish(call, node, destination))
        store = expression(word("setv"), expression(DOT, target, word(attribute)), new)
        self.branch(self.among(target, classes), [store, *quick], slow)
        self.effects += 1

    # -------------------------------------------------------------------------------------------------------------- vectors

    def pushed(self, node, arguments, destination):
        """``(vector-push new vector)`` and ``vector-push-extend``: if there is room in the vector, its new element is stored right here."""
        new, vector = self.stable_names(self.arguments(arguments))
        index, end = word(self.temporary("Lindex")), expression(DOT, vector, word("fill_pointer"))
        test = expression(
            AND,
            expression(IS, class_of(vector), word("Lany_vector")),
            expression(IS, expression(DOT, vector, word("element_type")), TRUE),
            expression(IS_NOT, expression(SETX, index, end), NONE),
            expression(word("<"), index, expression(GET, expression(DOT, vector, word("dimensions")), 0)),
        )
        place = expression(GET, expression(DOT, vector, word("storage")), expression(PLUS, expression(DOT, vector, word("offset")), index))
        quick = [expression(SETV, place, new), expression(SETV, end, expression(PLUS, index, 1))]
        value, _ = self.captured(lambda: self.finish(index, nodes.Constant(None), destination, pure=True))
        call = self.positioned(expression(self.known_function(node.symbol), new, vector), node)
        slow, _ = self.captured(lambda: self.finish(call, nodes.Constant(None), destination))
        self.branch(test, [*quick, *value], slow)
        self.effects += 1

    # --------------------------------------------------------------------------------------------------------- hash tables

    def entry(self, operands):
        """(a test whether the dictionary behind a table has the value under the key itself, that dictionary). ``operands`` are the key, the
        table, and perhaps a default."""
        key, table, *_ = operands
        known = expression(IS, self.class_of(table.later), word("Lhash_table"))
        plain = expression(IN, self.class_of(key.later), expression(DOT, table.later, word("plain")))
        return expression(AND, known, plain), expression(DOT, table.later, word("entries"))

    def entry_read(self, node, arguments):
        """``(gethash key table default)``, the first of its values."""
        operands = self.operands(arguments)
        self.settle(operands)
        plain, entries = self.entry(operands)
        usual = list(map(self.argument, operands))
        quick = expression(expression(DOT, entries, GET), operands[0].later, *usual[2:])
        return expression(IF, plain, quick, self.positioned(self.call("gethash", *usual), node))

    def entry_and_presence(self, node, arguments):
        """Both values of ``(gethash key table default)``, as a tuple."""
        operands = self.operands(arguments)
        self.settle(operands)
        plain, entries = self.entry(operands)
        key = operands[0].later
        slow = self.positioned(self.call("gethash_values", *map(self.argument, operands)), node)
        return expression(IF, expression(AND, plain, expression(IN, key, entries)), Tuple([expression(GET, entries, key), TRUE]), slow)

    def entry_written(self, node, destination):
        """``(setf (gethash key table) new)``"""
        new, *others = operands = self.operands(node.arguments)
        self.settle(operands)
        (value,) = self.stable_names([self.argument(new)])
        plain, entries = self.entry(others)
        setter = word(self.constants.name("setf_function", GETHASH))
        slow = self.positioned(expression(setter, value, *map(self.argument, others)), node)
        self.branch(plain, [expression(SETV, expression(GET, entries, others[0].later), value)], [slow])
        self.effects += 1
        self.finish(value, nodes.Constant(None), destination, pure=True)

    # ----------------------------------------------------------------------------------------------------- several values

    def assign_values(self, names, node):
        """Assign the values of ``node`` to the variables ``names``; those that are missing are nil."""
        target = List(names) if len(names) > 1 else names[0]
        made = self.values_in_place(names, node)
        if made is not None:
            self.emit(word("setv"), target, made)
            return
        if len(names) > 1 and node.__class__ is nodes.Call and gives_tuple(node.symbol):
            function = expression(DOT, self.constant(values_calls(node.symbol)), word("call"))
            call = self.positioned(expression(function, *self.arguments(node.arguments)), node)
            values = word(self.temporary())
            fits = expression(word("="), self.call("len", expression(SETX, values, call)), len(names))
            self.emit(word("setv"), target, expression(IF, fits, values, self.call("first_of", values, len(names))))
            return
        value = self.gen(node, ALL_VALUES)
        if len(names) == 1:
            self.emit(word("setv"), target, self.first_value(value))
            return
        values = word(self.temporary())
        several = expression(IS, class_of(expression(SETX, values, value)), word("LMultipleValues"))
        fits = expression(AND, several, expression(word("="), self.call("len", values), len(names)))
        self.emit(word("setv"), target, expression(IF, fits, values, self.call("spread", values, len(names))))

    def tuple_of_values(self, model):
        """A tuple of all values of ``model``."""
        if model.__class__ is not core.Expression:
            return self.call("all_values", model) if model.__class__ is core.Symbol and model not in (NONE, TRUE) else Tuple([model])
        if model[0] == "LMultipleValues":
            return model[1]
        if model[0] == IF:
            return expression(IF, model[1], *map(self.tuple_of_values, model[2:]))
        return self.call("all_values", model)

    def values_in_place(self, names, node):
        """A Python tuple of as many values of ``node``, a call of a function that gives them, as there are ``names``; or ``None``."""
        if node.__class__ is not nodes.Call or not self.standard(node.symbol):
            return None
        symbol, arguments, wanted = node.symbol, node.arguments, len(names)
        if symbol is VALUES and arguments:
            models = self.arguments(arguments)
            if len(models) > wanted:
                models = self.stable_names(models)[:wanted]
            models += [NONE] * (wanted - len(models))
            return Tuple(models) if wanted > 1 else models[0]
        if wanted != 2:
            return None
        if symbol is GETHASH and len(arguments) in (2, 3):
            return self.entry_and_presence(node, arguments)
        if (symbol is FLOOR or symbol is TRUNCATE) and len(arguments) == 2:
            return self.quotient_and_rest(node, symbol, arguments)
        return None

    def quotient_and_rest(self, node, symbol, arguments):
        """Both values of ``floor`` or ``truncate`` of two arguments, as a tuple: Python's ``divmod``, where that gives the same."""
        if not all(kind_of(argument) & INT and not raw(kind_of(argument)) for argument in arguments):
            return None
        operands = number, divisor = self.operands(arguments)
        self.settle(operands)
        tests = [expression(IS, self.class_of(each.later), INT_CLASS) for each in operands if not exactly(each.kind, INT)]
        certain = _is_number(divisor.node) and (symbol is FLOOR or divisor.node.value > 0)
        if symbol is TRUNCATE:
            tests.append(expression(word("<="), 0, number.later))
        if not certain:
            tests.append(expression(word("!=" if symbol is FLOOR else "<"), 0, divisor.later))
        quick = self.call("divmod", number.later, divisor.later)
        if not tests:
            return quick
        call = self.positioned(expression(self.known_function(symbol), *map(self.argument, operands)), node)
        return expression(IF, tests[0] if len(tests) == 1 else expression(AND, *tests), quick, self.call("spread", call, 2))


def _keys_begin(function, arguments):
    """The number of arguments of a call of ``function`` before those with keywords; ``None`` if there are none, or odd ones."""
    if function.__class__ is not FunctionType or len(arguments) < 2:
        return None
    code = function.__code__
    if not code.co_kwonlyargcount and "python_keys" not in function.__dict__:
        return None
    count = code.co_argcount
    keys = arguments[count::2]
    if not keys or len(arguments) - count & 1:
        return None
    return count if all(key.__class__ is nodes.Constant and key.value.__class__ is Keyword for key in keys) else None


def slot_named_by(node):
    """The `NamedSlot` of the symbol that ``node`` is; ``None`` for anything else."""
    name = node.value if node.__class__ is nodes.Constant else None
    return named_slot(name) if name.__class__ is Symbol and name.package is not None else None


def _is_text(node):
    return node.__class__ is nodes.Constant and node.value.__class__ is str


def _is_number(node):
    """Whether ``node`` is an integer that one can divide by."""
    return node.__class__ is nodes.Constant and node.value.__class__ is int and node.value != 0


def sorted_arguments(function, models, arguments):
    """``models``, the arguments of a call of the lispified ``function``, for the Python function behind it; ``None`` if only it can
    sort them, as where a keyword is computed, unknown or repeated."""
    code = function.python.__code__
    positional, defaults = code.co_argcount, function.python.__defaults__ or ()
    if len(models) <= positional:
        return models if len(models) >= positional - len(defaults) else None
    if len(models) - positional & 1 or code.co_flags & 0x0C:
        return None
    keys = arguments[positional::2]
    if any(key.__class__ is not nodes.Constant or key.value.__class__ is not Keyword for key in keys):
        return None
    names = [function.python_keywords.get(key.value) for key in keys]
    if None in names or len(set(names)) < len(names):
        return None
    done = models[:positional]
    for name, value in zip(names, models[positional + 1 :: 2], strict=True):
        done += [core.Keyword(name), value]
    return done


__all__ = ["SLOT_VALUE", "CallGenerator", "slot_named_by"]
