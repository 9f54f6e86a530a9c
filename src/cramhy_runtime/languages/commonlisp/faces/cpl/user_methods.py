"""Methods that users define on ``value``, ``(setf value)``, ``pulse``, ``wait-for``, ``fail`` and the functions of callbacks.

In the original these are generic functions, and a class of fluents of one's own is made by methods on them:

    (defclass doubled (value-fluent) ())
    (defmethod value ((fluent doubled)) (* 2 (call-next-method)))

Here they are plain functions as long as nobody does so (``lisp_core/dispatch/open_functions.py``), and a fluent is read and assigned
by its Python methods: nets, waits and callbacks do that everywhere. So when a method is defined, the Python methods of the
classes that it may apply to are replaced by calls of the generic function, whose first method calls what was there before. Users
who define no methods pay nothing. Methods for the built-in classes and for single fluents count for fluents that exist already,
so classes of the user that override would not do; and a ``read`` that asks whether there are methods takes two thirds more time.

Source: cpl.md section 2; callbacks of nets are not callbacks here, so methods do not see them.
"""

from __future__ import annotations

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.lisp_core.dispatch.generic_functions import when_methods_change
from cramhy_runtime.lisp_core.dispatch.methods import EqlSpecializer
from cramhy_runtime.lisp_core.dispatch.open_functions import open_to_methods
from cramhy_runtime.cpl.failures import handling
from cramhy_runtime.cpl.fluents import fluents, nets
from cramhy_runtime.cpl.tasks import waiting
from cramhy_runtime.cpl.fluents.fluents import Fluent, ValueFluent
from cramhy_runtime.cpl.fluents.nets import CachedNet, peeking
from cramhy_runtime.cpl.fluents.pulse_fluents import PulseFluent

_replaced = {}
"""(class, name of a Python method) → the method that was there, or ``None``, for those that call a generic function now."""


def _original(fluent, name):
    """What the Python method ``name`` of ``fluent`` would be without methods of users."""
    for cls in type(fluent).__mro__:
        method = _replaced[cls, name] if (cls, name) in _replaced else vars(cls).get(name)
        if method is not None:
            return method
    raise AttributeError(name)


# What the first methods of the generic functions do.


def _value(fluent):
    """The value of a fluent; any other object is its own value."""
    if not isinstance(fluent, Fluent):
        return fluent
    return _original(fluent, "peek" if kernel.current() in nets.peekers else "read")(fluent)


def _set_value(new, fluent):
    """Assign a value fluent; returns the value."""
    return _original(fluent, "set")(fluent, new)


def _pulse(fluent):
    """Tell the observers of a fluent, though nothing changed."""
    _original(fluent, "pulse")(fluent)


VALUE = open_to_methods(fluents.value, "CPL-IMPL::VALUE", "(fluent)", None, method=_value)
SET_VALUE = open_to_methods(fluents.set_value, "(setf CPL-IMPL::VALUE)", "(new-value fluent)", None, ValueFluent, method=_set_value)
PULSE = open_to_methods(fluents.pulse, "CPL-IMPL::PULSE", "(fluent)", Fluent, method=_pulse)
REGISTER = open_to_methods(
    fluents.register_update_callback, "CPL-IMPL::REGISTER-UPDATE-CALLBACK", "(fluent name function)", Fluent, None, None
)
GET = open_to_methods(fluents.get_update_callback, "CPL-IMPL::GET-UPDATE-CALLBACK", "(fluent name)", Fluent, None)
REMOVE = open_to_methods(fluents.remove_update_callback, "CPL-IMPL::REMOVE-UPDATE-CALLBACK", "(fluent name)", Fluent, None)


WAIT_FOR = open_to_methods(
    waiting.wait_for,
    "CPL-IMPL::WAIT-FOR",
    "(fluent &key timeout &allow-other-keys)",
    None,
    method=waiting.plain_wait_for,
    when_opened=waiting.wait_through,
)
FAIL = open_to_methods(handling.fail, "CPL-IMPL::FAIL", method=handling.plain_fail, when_opened=handling.fail_through)
OPENINGS = (VALUE, SET_VALUE, PULSE, REGISTER, GET, REMOVE, WAIT_FOR, FAIL)


# What takes the place of the Python methods.


def _read_through(fluent):
    return one(VALUE.generic(fluent))


def _peek_through(fluent):
    return peeking(lambda: one(VALUE.generic(fluent)))


def _set_through(fluent, new):
    return SET_VALUE.generic(new, fluent)


def _pulse_through(fluent):
    PULSE.generic(fluent)


def _seen_and_pulse(fluent):
    fluent.seen = fluent.parent.pulses
    PULSE.generic(fluent)


def _store_and_pulse(fluent, new):
    """`ValueFluent.set` for fluents whose value or pulses users see to: it passes through both, and no request to end between them."""
    with kernel.shield():
        if fluent.stores(new):
            fluent.pulse()
    return new


def _replace(cls, **methods):
    for name, method in methods.items():
        if (cls, name) not in _replaced:
            _replaced[cls, name] = vars(cls).get(name)
        setattr(cls, name, method)


def _prepare(cls):
    """Let ``cls`` call the generic functions that have methods of users for it."""
    readers, writers, pulsers = (
        any(_concerns(method.specializers[place], cls) for method in opening.added)
        for opening, place in ((VALUE, 0), (SET_VALUE, 1), (PULSE, 0))
    )
    if readers:
        _replace(
            cls,
            read=_read_through,
            peek=_peek_through,
            _fluent_value=property(_read_through),
            foreign=True,
            value=property(_read_through, lambda fluent, new: fluent.set(new)) if issubclass(cls, ValueFluent) else Fluent.value,
        )
    if pulsers:
        _replace(cls, pulse=_pulse_through)
        if issubclass(cls, CachedNet):
            _replace(cls, input_pulsed=_pulse_through)
        elif issubclass(cls, PulseFluent):
            _replace(cls, input_pulsed=_seen_and_pulse)
    if issubclass(cls, ValueFluent):
        if readers or pulsers:
            _replace(cls, set=_store_and_pulse)
        if writers:
            if readers or pulsers:
                _replaced[cls, "set"] = _store_and_pulse
            _replace(cls, set=_set_through, value=property(lambda fluent: fluent.read(), _set_through))


def _concerns(specializer, cls):
    if specializer.__class__ is EqlSpecializer:
        return isinstance(specializer.value, cls)
    return issubclass(cls, specializer)


@when_methods_change
def _methods_changed(generic):
    if generic in (VALUE.generic, SET_VALUE.generic, PULSE.generic):
        for (cls, name), method in _replaced.items():
            if method is None:
                delattr(cls, name)
            else:
                setattr(cls, name, method)
        _replaced.clear()
        for cls in _with_subclasses(Fluent):
            _prepare(cls)


def _with_subclasses(cls):
    yield cls
    for sub in type.__subclasses__(cls):
        yield from _with_subclasses(sub)


@fluents.when_class_made
def _class_made(cls):
    if VALUE.added or SET_VALUE.added or PULSE.added:
        _prepare(cls)
