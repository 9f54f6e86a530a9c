"""Make, change and take apart messages, as roslisp's macros do.

A *field path* is a tuple of names read inside-out: ``("X", "LINEAR")`` is the field x of the field linear. The macros of
``hy_src/cramhy/roslisp.hy`` turn their unevaluated field specs into such tuples and call the functions here. These apply the
specs from the last to the first, so of two values for one field the first one counts (roslisp.md 5.3).
"""

from __future__ import annotations

from cramhy_runtime.lisp_core import conditions
from cramhy_runtime.lisp_core.condition_types import Error, SimpleError, TypeError_
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from, python_list
from cramhy_runtime.lisp_core.classes import make_instance
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.condition_types import MissingSlot
from cramhy_runtime.lisp_core.packages import COMMON_LISP, is_symbol, sym, symbol_name
from cramhy_runtime.lisp_core.printing import princ_to_string
from . import messages, type_texts
from .messages import RosMessage, lisp_attribute
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .signatures import FieldPath, FieldSpecs, MessageType, ServiceName, TypeName


NO_MESSAGE_YET = (
    "No message is there yet: a fluent is NIL until the first one comes. Has its topic been subscribed to, and does somebody publish on it?"
)


def make_message(designator: TypeName, specs: FieldSpecs = ()) -> RosMessage:
    """A new message (``make-message``, ``make-msg``).

    ``designator``: a class, symbol or string that names the type. ``specs``: a sequence of (field path, value). An unknown field
    is an error. Source: roslisp.md 5.3.
    """
    message = messages.maker(messages.message_class(designator))()
    return set_fields(message, specs, fresh=True) if specs else message


def make_request(designator: ServiceName, specs: FieldSpecs = ()) -> RosMessage:
    """A new request of the service ``designator`` (symbol, string, or `ServiceType`), with ``specs`` as for `make_message`."""
    return set_fields(messages.maker(messages.service_type(designator).request)(), specs, fresh=True)


def make_response(service: ServiceName, *initargs: object) -> RosMessage:
    """A new response of ``service``; ``initargs``: keyword, value, keyword … (``roslisp:make-response``)."""
    return instance(messages.service_type(service).response, initargs)


def instance(cls: MessageType, initargs: Sequence[Any]) -> RosMessage:
    """A new message of class ``cls`` from ``initargs``: keyword, value, keyword … (``make-instance``). Paths are not allowed."""
    keywords = {}
    for index in range(0, len(initargs) - 1, 2):
        attribute = cls.attributes.get(symbol_name(initargs[index])) if isinstance(initargs[index], Symbol) else None
        if attribute is None:
            return _bad_initargs(cls, initargs)
        keywords.setdefault(attribute, initargs[index + 1])
    if len(initargs) % 2:
        return _bad_initargs(cls, initargs)
    return messages.maker(cls)(**keywords)


def _bad_initargs(cls: MessageType, initargs: Sequence[Any]) -> Any:
    def advise(problem):
        problem.hint = _fields_hint(cls)

    # the error is the one that every class gives
    return conditions.handler_bind([(Error, advise)], lambda: make_instance(cls, *initargs))


def modify_message_copy(message: RosMessage, specs: FieldSpecs) -> RosMessage:
    """A copy of ``message`` with the fields in ``specs`` changed (``modify-message-copy``). Other parts are the same objects.

    If ``message`` is not a message, it is a type error.
    """
    if not isinstance(message, RosMessage):
        return conditions.error(TypeError_(message, "ROSLISP:ROS-MESSAGE"), hint=NO_MESSAGE_YET if message is None else None)
    return set_fields(message.copy(), specs)


def set_fields(message: RosMessage, specs: FieldSpecs, fresh: bool = False) -> RosMessage:
    """Set the fields in ``specs`` of ``message``, which belongs to the caller, and return it.

    Messages on the way of a path are copied first, unless this call made them. With ``fresh``, all parts of ``message`` are new and
    need no copy. An unknown field is an error.
    """
    own = {id(message)}
    if fresh:
        own.update(id(getattr(message, name)) for name in message.field_names)
    for path, value in reversed(specs):
        target = message
        for depth in range(len(path) - 1, 0, -1):
            attribute = _attribute(target, path[depth], message)
            part = getattr(target, attribute)
            if id(part) not in own:
                if not isinstance(part, RosMessage):
                    return _no_field(path[depth - 1], part)
                part = part.copy()
                own.add(id(part))
                setattr(target, attribute, part)
            target = part
        setattr(target, _attribute(target, path[0], message), value)
        own.discard(id(value))
    return message


def _attribute(target: Any, name: str, whole: object) -> str:
    attribute = target.attributes.get(name) if isinstance(target, RosMessage) else None
    if attribute is None:
        attribute = lisp_attribute(type(target), name) if isinstance(target, RosMessage) else None
        if attribute is None:
            return _no_field(name, target)
    return attribute


def _no_field(name: object, target: object) -> NoReturn:
    dump = princ_to_string(_as_deep_list(target))
    hint = _fields_hint(type(target)) if isinstance(target, RosMessage) else None
    conditions.error(SimpleError("~a", f"Could not find field {str(name).upper()} in {dump}"), hint=hint)


def _fields_hint(cls: MessageType) -> str:
    """The hint for an unknown field: the fields of ``cls``. A request is called by the name of its service, as users call it."""
    name = cls.ros_type
    for part, called in (("Request", "{}"), ("Response", "The response of {}")):
        service = name.removesuffix(part)
        if service != name and messages.service_type_exact(service) is not None:
            name = called.format(service)
    fields = [field.name for field in cls.fields]
    return f"{name} has {'the fields ' + ' '.join(fields) if fields[1:] else 'the field ' + fields[0] if fields else 'no fields'}."


def _as_deep_list(value: Any) -> Any:
    if not isinstance(value, RosMessage):
        return value
    return Cons(value.lisp_symbol, list_from([Cons(key, _as_deep_list(part)) for key, part in zip(value.keywords, value.values())]))


def get_field(message: Any, path: FieldPath) -> Any:
    """The value at ``path`` in ``message`` (``with-fields``). An unknown field is SBCL's missing-slot error."""
    for name in reversed(path):
        attribute = message.attributes.get(name) if isinstance(message, RosMessage) else None
        if attribute is None:
            message = msg_slot_value(message, name)
        else:
            message = getattr(message, attribute)
    return message


def msg_slot_value(message: RosMessage, slot: str | Symbol) -> Any:
    """The value of a field of ``message`` (``roslisp:msg-slot-value``). ``slot``: a string in any case, a keyword or a symbol.

    An unknown field is SBCL's missing-slot error.
    """
    attribute = lisp_attribute(type(message), slot) if isinstance(message, RosMessage) else None
    if attribute is not None:
        return getattr(message, attribute)
    home = message.lisp_symbol.package if isinstance(message, RosMessage) else COMMON_LISP
    name = symbol_name(slot) if isinstance(slot, Symbol) or slot is None else str(slot)
    return conditions.error(MissingSlot(home.intern(name.upper()), message), hint=NO_MESSAGE_YET if message is None else None)


# ----------------------------------------------------------------------------------------------------- list form, constants


def ros_message_to_list(message: RosMessage) -> Cons:
    """The list form of ``message``, as ``(TURTLESIM-MSG:POSE (:X . 0.0) …)``; messages inside stay objects."""
    return Cons(message.lisp_symbol, list_from([Cons(key, value) for key, value in zip(message.keywords, message.values())]))


def list_to_ros_message(form: object) -> Any:
    """The message with the list form ``form``, as from `ros_message_to_list`; messages inside may be lists too.

    Anything but a list is returned as it is. A list in another form is an error.
    """
    if not isinstance(form, Cons):
        return form
    return set_fields(messages.message_class(form.car)(), [_field_of(entry, form) for entry in python_list(form.cdr)])


def _field_of(entry: Any, form: object) -> tuple[FieldPath, Any]:
    if not isinstance(entry, Cons) or not is_symbol(entry.car):
        return conditions.error(
            SimpleError("~s is no field of a message in list form, in ~s.", entry, form),
            hint="The list form is (CLASS (FIELD . value) ...), as ros-message-to-list gives it.",
        )
    value = entry.cdr
    return (symbol_name(entry.car),), list_to_ros_message(value) if isinstance(value, Cons) and messages.named(value.car) else value


def _constants_class(designator: Any) -> MessageType:
    if isinstance(designator, RosMessage):
        return type(designator)
    return messages.message_class(designator)


def symbol_codes(designator: TypeName | RosMessage) -> Cons | None:
    """The constants of a message type, as an association list of keyword and value."""
    cls = _constants_class(designator)
    return list_from([Cons(sym(":" + name.upper()), value) for name, value in cls.constants.items()])


def symbol_code(designator: TypeName | RosMessage, key: Symbol) -> str | int | float | bool | None:
    """The value of the constant ``key``, a symbol, of a message type. An unknown constant is an error."""
    cls = _constants_class(designator)
    if not is_symbol(key):
        conditions.type_error(key, "SYMBOL")
    for name, value in cls.constants.items():
        if name.upper() == symbol_name(key):
            return value
    return conditions.error(
        SimpleError("~a", f"Could not get symbol code for {symbol_name(key)} for ROS message type {_shown_type(designator)}")
    )


def code_symbols(designator: TypeName | RosMessage, code: object) -> Cons | None:
    """The constants of a message type with the value ``code``, as (keyword . value) pairs."""
    return list_from([pair for pair in symbol_codes(designator) or () if pair.cdr == code])


def code_symbol(designator: TypeName | RosMessage, code: object) -> Symbol:
    """The first constant of a message type with the value ``code``, as a keyword. If there is none, it is an error."""
    found = code_symbols(designator, code)
    if found is not None:
        return found.car.car
    return conditions.error(SimpleError("~a", f"Could not get code symbol for {code} in ROS message type {_shown_type(designator)}"))


def _shown_type(designator: Any) -> str:
    return symbol_name(designator) if isinstance(designator, Symbol) else _constants_class(designator).lisp_symbol.name


def ros_datatype(designator: TypeName | RosMessage) -> str:
    """The type name, as ``"turtlesim/Pose"``, of a class symbol, message, or service symbol."""
    found = _type_of(designator, "ROS-DATATYPE")
    return found.ros_type if isinstance(found, type) else found.name


def _type_of(designator: Any, function: str) -> Any:
    if isinstance(designator, RosMessage):
        return type(designator)
    found = messages.named(designator) if isinstance(designator, Symbol) else messages.message_class(designator)
    return found if found is not None else no_applicable_method(f"ROSLISP-MSG-PROTOCOL:{function}", 2, designator)


def md5sum(designator: TypeName | RosMessage) -> str:
    """The md5 sum, the same as in ROS, of a class symbol, message, or service symbol."""
    return type_texts.md5_of(_type_of(designator, "MD5SUM"))


def message_definition(designator: TypeName | RosMessage) -> str:
    """The definition of a type without comments, followed by the definitions of all messages inside."""
    return type_texts.definition_text(_type_of(designator, "MESSAGE-DEFINITION"))
