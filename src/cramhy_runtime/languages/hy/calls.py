"""What the code calls that the macros of plain Hy expand into."""

from __future__ import annotations

import functools
import inspect

import hy

from cramhy_runtime import cpl
from cramhy_runtime.cpl import RetryCounter, wait_for
from cramhy_runtime.cpl.fluents.operators import cpl_parameter_fluent, define_cpl_parameter
from cramhy_runtime.cpl.failures.python_exceptions import for_python
from cramhy_runtime.cpl.forms import plans
from cramhy_runtime.cpl.tree.tags import enter_with_tags, execute_tag, make_tag_task, prepare_tag
from cramhy_runtime.lisp_core.classes import find_class
from cramhy_runtime.lisp_core.data import STANDS_FOR, Cons, Symbol, list_from
from cramhy_runtime.lisp_core.data import values as as_values
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.packages import find_package_or_error, intern, keyword, sym
from cramhy_runtime.lisp_core.python_exceptions import condition_class
from cramhy_runtime.kernel import checkpoint, cleanup_here, refill
from cramhy_runtime.kernel.budget import budget
from cramhy_runtime.process_modules import AsynchronousModule
from ..commonlisp.compiler.support import BlockExit, block_value, end_block, return_from
from ..commonlisp.faces.prolog.macro_support import collect_fact, fact_collector, finish_fact_group
from . import answer_lists, keywords
from .answer_lists import in_goal, spliced_in_goal
from .goal_functions import as_lisp_calls, asking, called, calling
from .lisp_data import choose_package, constant, inserted, is_about_lists, own_symbol, plan_package

__all__ = [
    "AsynchronousModule",
    "Branching",
    "Cons",
    "RetryCounter",
    "Symbols",
    "as_lisp",
    "asking",
    "block",
    "budget",
    "call_plan",
    "call_service",
    "called",
    "calling",
    "checkpoint",
    "choose_package",
    "cleanup_here",
    "collect_fact",
    "constant",
    "cpl_parameter",
    "define_plan",
    "enter_with_tags",
    "execute_tag",
    "fact_collector",
    "failure_class",
    "failure_type",
    "finish_fact_group",
    "function",
    "in_goal",
    "inserted",
    "items",
    "get_param",
    "has_param",
    "keyword_values",
    "lispify",
    "publish_message",
    "set_param",
    "subscribe_to",
    "lisp_list",
    "lisp_list_ending",
    "make_tag_task",
    "prepare_tag",
    "publish",
    "refill",
    "lists",
    "spliced",
    "spliced_in_goal",
    "use_package",
    "users_or_ours",
    "wait_for",
]


class Symbols:
    """Its attributes are packages, whose attributes are symbols: ``symbols.cram_language.value``. They are found once.

    The function of a symbol is asked for at each call, since a definition may replace it.
    """

    def __init__(self, package=None):
        self._package = package

    def __getattr__(self, name):
        written = hy.unmangle(name).upper()
        found = Symbols(written) if self._package is None else intern(written, self._package)
        setattr(self, name, found)
        return found


lists = answer_lists.Lists()
keyword_values = keywords.Values()


class Branching(Symbols):
    """Its attributes are the functions behind the operators with branches; what Python code raised leaves them as the same exception."""

    def __getattr__(self, name):
        found = for_python(function_of(intern(hy.unmangle(name).upper(), "CRAMHY")))
        setattr(self, name, found)
        return found


def function(package, name):
    """The function that a symbol of a package of ours names. It takes keywords as Python writes them."""
    if is_about_lists(package, name):
        return answer_lists.list_function(package, name)
    found = function_of(intern(name, package))
    return found if takes_keywords(found) else _with_keyword_objects(found)


def users_or_ours(users, ours):
    """``users``, what a name means in Hy, if that is a function; else ``ours``, the function of that name in Lisp."""
    return users if callable(users) else ours


def takes_keywords(function_):
    """Whether a function has parameters that Python's keywords can name."""
    code = getattr(getattr(function_, "python", function_), "__code__", None)
    return code is not None and bool(code.co_kwonlyargcount or code.co_flags & inspect.CO_VARKEYWORDS)


@functools.lru_cache(maxsize=1000)
def _with_keyword_objects(function_):
    """``function_`` with what Python's keywords say as keyword objects behind the other arguments, as Lisp passes them."""

    def call(*arguments, **keywords):
        for name, value in keywords.items():
            arguments += (keyword(name.rstrip("_").replace("_", "-").upper()), value)
        return function_(*arguments)

    return call


class Exit(BlockExit):
    """The way out of one run of a block: ``leave(value)`` ends it with that value, from whatever depth. Without a value it is ``None``."""

    def __call__(self, value=None, *more):
        return_from(self, as_values(value, *more) if more else value)


def block(body):
    """The value of ``body(leave)``, where ``leave`` is an `Exit`."""
    leave = Exit()
    try:
        return body(leave)
    except BlockExit as exit_:
        return block_value(exit_, leave)
    finally:
        end_block(leave)


def items(elements):
    """The elements that a form goes through, as a list of Lisp: Python's lists and all that can be iterated will do."""
    return elements if elements is None or isinstance(elements, Cons) else list_from(list(elements))


def as_lisp(value):
    """The object of Lisp that the value of a variable in a designator stands for, such as a keyword, or the value."""
    kind = value.__class__
    return STANDS_FOR[kind](value) if kind in STANDS_FOR else value


def lisp_list(*items):
    """A list of Lisp."""
    return list_from(items)


def lisp_list_ending(tail, *items):
    """A list of Lisp whose last pair ends with ``tail``."""
    return list_from(items, tail)


def spliced(values, package):
    """The values of ``~@values`` in a template, each as `inserted` has it."""
    return [inserted(value, package) for value in values or ()]


def publish(symbol, function_):
    """Let ``symbol`` name a function that was written in Hy; returns the symbol. What is no function stays what the symbol names."""
    if isinstance(function_, Symbol):
        return function_
    if callable(function_):
        symbol = own_symbol(symbol)
        symbol.function = answer_lists.for_lisp(as_lisp_calls(function_))
        symbol.function_changed()
        answer_lists.published(symbol)
    return symbol


def publish_message(topic, message):
    """`ros.python.publish`. The library of ROS is imported when a program calls it."""
    from cramhy_runtime.ros.python import publish

    return publish(topic, message)


def call_service(service, *rest):
    """`checked_call_service` of roslisp."""
    from cramhy_runtime.ros.roslisp.services import checked_call_service

    return checked_call_service(service, *rest)


def subscribe_to(topic, topic_type, callback, *, max_queue_length=None):
    """`ros.python.subscribe`."""
    from cramhy_runtime.ros.python import subscribe

    return subscribe(topic, topic_type, callback, max_queue_length=max_queue_length)


def get_param(key, *default):
    """`ros.python.get_param`."""
    from cramhy_runtime.ros.python import get_param

    return get_param(key, *default)


def set_param(key, value):
    """`ros.python.set_param`."""
    from cramhy_runtime.ros.python import set_param

    return set_param(key, value)


def has_param(key):
    """`ros.python.has_param`."""
    from cramhy_runtime.ros.python import has_param

    return has_param(key)


def failure_type(symbol, type_):
    """The type of conditions that a handler names: a class of Python that ``type_()`` gives, or else the symbol of Lisp.

    Raises NameError when it is neither: such a handler would never be called.
    """
    try:
        found = type_()
    except NameError as problem:
        if find_class(symbol) is not None:
            return symbol
        name = hy.unmangle(problem.name or symbol.name)
        there = (
            f"It is imported by (import cramhy_runtime.cpl [{name}])." if hasattr(cpl, name) else "Is it imported, and spelled like this?"
        )
        raise NameError(
            f"A handler names the type {name}, which is no class of Hy and no type of Lisp. {there}", name=problem.name
        ) from None
    return failure_class(found) or symbol


def failure_class(found):
    """The type of conditions for a class of exceptions, or for a tuple of classes; ``None`` for any other object."""
    if isinstance(found, tuple):
        return list_from([sym("OR"), *map(_condition_type, found)])
    return _condition_type(found) if isinstance(found, type) else None


def _condition_type(class_):
    """The class of conditions for a class of exceptions; a failure of plans is one itself."""
    return class_ if issubclass(class_, Condition) or not issubclass(class_, Exception) else condition_class(class_)


def cpl_parameter(name, value):
    """Define the parameter ``name``; its fluent."""
    define_cpl_parameter(name, value)
    return cpl_parameter_fluent(name)


def call_plan(kind, name, body, arguments, keywords):
    """A call of the plan ``name``, of the kind "PLAN" or "TOP-LEVEL-PLAN", with Python's arguments."""
    call = plans.call_cram_function if kind == "PLAN" else plans.call_top_level_cram_function
    return call(name, functools.partial(body, **keywords) if keywords else body, arguments)


def define_plan(kind, name, parameters, body, function_):
    """Note that ``name`` is a plan, which Lisp can call as well; returns the name."""
    name = own_symbol(name)
    plans.define_plan(name, kind, parameters, body)
    return publish(name, function_)


def use_package(name, here):
    """Let the names of the package ``here``, a Hy module's, be those of the package ``name`` where they mean nothing else yet."""
    package, used = plan_package(here), find_package_or_error(name)
    if used not in package.use:
        package.use.append(used)
    return True
