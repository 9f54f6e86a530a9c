"""Messages: one Python class per ROS type, with the slots of its ``.msg`` file.

``message_class("turtlesim/Pose")`` is a class with slots ``x y theta linear_velocity angular_velocity``; the Lisp class
``turtlesim-msg:Pose`` is the same object. Making a message checks nothing: as in roslisp, types are checked when a message
crosses the graph (``wire.py``). Do not change a message after sending it; subscribers always receive a fresh object.
Source: roslisp.md 5.
"""

from __future__ import annotations

import functools

from cramhy_runtime.lisp_core import conditions, packages
from cramhy_runtime.lisp_core.condition_types import CaseFailure, SimpleError
from cramhy_runtime.lisp_core.data import UNSUPPLIED, LispString, Symbol, lisp_list, truth
from cramhy_runtime.lisp_core.classes import find_class_or_error
from cramhy_runtime.lisp_core.floats import literal_float
from cramhy_runtime.lisp_core.dispatch.generic_errors import no_applicable_method
from cramhy_runtime.lisp_core.packages import Package, delete_package, intern, near_names, ours, registered, string_designator, sym
from cramhy_runtime.utilities.generated_functions import generated_function
from . import definition_files
from .definition_text import DefinitionError
from .former_types import successor
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any, NoReturn, Self, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path
    from .definition_files import PackageDefinitions
    from .definition_text import Definition, Field
    from .signatures import MessageType, ServiceName, TypeName

    Loaded = tuple[list["MessageType"], list["ServiceType"]]

M = TypeVar("M", bound="RosMessage")


class _SignatureOfFields:
    """The signature of a message class: its fields. It is made on demand; `inspect` takes 5 ms."""

    def __get__(self, message, cls):
        from inspect import Parameter, Signature

        return Signature([Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in cls.field_names])


class RosMessage:
    """The root class of all messages (``roslisp:ros-message``). Class attributes describe the type.

    ``ros_type``: ``"turtlesim/Pose"``. ``fields``: `Field` objects in order. ``constants``: name → value. ``attributes``: upper-case
    Lisp name → Python attribute. ``lisp_symbol``: the symbol that names the class.
    """

    __slots__ = ()
    __signature__ = _SignatureOfFields()
    lisp_name = "ROSLISP-MSG-PROTOCOL::ROS-MESSAGE"
    ros_type = ""
    fields: tuple[Field, ...] = ()
    field_names: tuple[str, ...] = ()
    constants: dict[str, str | int | float | bool | None] = {}
    attributes: dict[str, str] = {}
    initargs: dict[str, str] = {}
    keywords: tuple[Symbol, ...] = ()
    lisp_symbol: Symbol  # of each type that is defined; the root has only ``lisp_name``
    definition: Definition = None  # type: ignore[assignment]

    if TYPE_CHECKING:  # the fields of each type stand in its definition

        def __init__(self, *values: object, **fields: object): ...
        def __getattr__(self, name: str) -> Any: ...
        def __setattr__(self, name: str, value: Any) -> None: ...

    def lisp_init(self) -> None:
        """Fill a message that Lisp makes by ``make-instance`` (see `maker`)."""
        for name, value in zip(self.field_names, maker(type(self))().values(), strict=True):
            setattr(self, name, value)

    def __repr__(self) -> str:
        inside = ", ".join(f"{name}={getattr(self, name)!r}" for name in self.field_names)
        return f"{type(self).__name__}({inside})"

    def __eq__(self, other: object) -> Any:
        """Whether ``other`` is a message of the same type with the same values; lists, tuples and arrays count as the same."""
        if not isinstance(other, RosMessage):
            return NotImplemented
        cls = self.__class__
        if other.__class__ is not cls:
            return False
        return all(_same(field, getattr(self, field.attribute), getattr(other, field.attribute)) for field in cls.fields)

    __hash__ = object.__hash__  # Lisp has messages in tables, each under itself, and its tables do not ask for equality

    def __copy__(self) -> Self:
        return self.copy()

    def __reduce__(self) -> Any:
        return _restored, (self.ros_type, self.values())

    def copy(self) -> Self:
        """A shallow copy: both messages share the messages and lists inside."""
        return type(self)(*[getattr(self, name) for name in self.field_names])

    def values(self) -> list[Any]:
        """The values of the fields, in order."""
        return [getattr(self, name) for name in self.field_names]


def _same(field: Field, one: Any, other: Any) -> bool:
    if one is other:
        return True
    if not field.is_array:
        return bool(one == other) or field.base == "bool" and not truth(one) and not truth(other)
    if isinstance(one, bytearray) and isinstance(other, bytearray):
        return one == other
    one, other = _listed(one), _listed(other)
    return one == other or field.base == "bool" and [*map(truth, one)] == [*map(truth, other)]


def _listed(values: Any) -> list[Any]:
    return [] if values is None else values.tolist() if hasattr(values, "tolist") else list(values)


def _restored(ros_type: str, values: list[Any]) -> RosMessage:
    """The message that ``pickle`` or ``copy.deepcopy`` has taken apart."""
    found = message_class_exact(ros_type) or part_of_service(ros_type)
    if found is None:
        raise TypeError(f"There is no message type {ros_type}. Is its package on ROS_PACKAGE_PATH?")
    return found(*values)


def part_of_service(ros_type: str) -> MessageType | None:
    """The class of a request or a response, ``"turtlesim/SpawnRequest"``, or ``None``."""
    for half, attribute in (("Request", "request"), ("Response", "response")):
        service = service_type_exact(ros_type.removesuffix(half)) if ros_type.endswith(half) else None
        if service is not None:
            return getattr(service, attribute)
    return None


class ServiceType:
    """A type of service: its request and response classes, and the Lisp symbol that names it (``turtlesim-srv:Spawn``)."""

    __slots__ = ("name", "request", "response", "lisp_symbol")

    def __init__(self, name: str, request: MessageType, response: MessageType, lisp_symbol: Symbol):
        self.name, self.request, self.response, self.lisp_symbol = name, request, response, lisp_symbol

    def __repr__(self) -> str:
        return f"<service type {self.name}>"


_messages: dict[str, MessageType] = {}
_services: dict[str, ServiceType] = {}
_by_symbol: dict[object, object] = {}
_loaded: dict[str, Loaded] = {}
_reading: list[str] = []
_listeners: list[Callable[..., object]] = []
_warned: set[Symbol] = set()

DEFAULTS = {"string": '""', "bool": "False", "float32": "0.0", "float64": "0.0", "time": "0", "duration": "0"}


def load_package(package: str) -> Loaded | None:
    """Define all messages and services of the ROS package ``package``.

    Returns the lists of their Python classes and `ServiceType` objects, or ``None`` if there is no such package. An error in a
    definition is a Lisp error, `BrokenDefinition`, and nothing is defined then.
    """
    found = _loaded.get(package)
    if found is None:
        folder = definition_files.package_folder(package)
        if folder is None:
            return None
        definitions = _read(package, folder)
        found = _loaded[package] = ([], [])
        _define_package(package, definitions, *found)
        for listener in _listeners:
            listener(package, *found)
    return found


def _read(package: str, folder: Path) -> PackageDefinitions:
    _reading.append(package)
    try:
        return definition_files.read_package(package, folder)
    except DefinitionError as problem:
        return _signal_broken(problem, package, folder)
    finally:
        _reading.remove(package)


class BrokenDefinition(SimpleError):
    """The Lisp condition for a `DefinitionError` in a package's file."""

    lisp_name = "ROSLISP::DEFINITION-ERROR"


def _signal_broken(problem: DefinitionError, package: str, folder: Path) -> Any:
    broken = BrokenDefinition("~a", problem.problem)
    retry = (sym("RETRY"), lambda: _read(package, folder), f"Read the definitions of {package} again.")
    return conditions.restart_case([retry], lambda: conditions.error(broken, hint=problem.hint))


def _define_package(package: str, definitions: PackageDefinitions, classes: list[MessageType], services: list[ServiceType]) -> None:
    for name, definition in definitions.messages.items():
        classes.append(_define_message(package, name, definition, "MSG", f"{package}/{name}"))
    for name, parts in definitions.services.items():
        request, response = (
            _define_message(package, f"{name}-{half}", part, "SRV", f"{package}/{name}{half.title()}")
            for half, part in zip(("request", "response"), parts)
        )
        symbol = intern(name.upper(), lisp_package(package, "SRV"))
        service = _services[f"{package}/{name}"] = _by_symbol[symbol] = ServiceType(f"{package}/{name}", request, response, symbol)
        services.append(service)


def on_load(listener: Callable[[str, list[MessageType], list[ServiceType]], object]) -> None:
    """Call ``listener(package, message classes, services)`` for every package, loaded already or later."""
    _listeners.append(listener)
    for package, classes in list(_loaded.items()):
        listener(package, *classes)


class MessagePackage(Package):
    """The Lisp package of a ROS package's messages or services. The first look at its symbols reads the definitions."""

    def __init__(self, ros_package: str, kind: str):
        self.ros_package = ros_package
        super().__init__(f"{ros_package.upper()}-{kind}")

    @property
    def external(self) -> Any:
        """The table of external symbols. The first access loads the ROS package."""
        if self.ros_package not in _loaded and self.ros_package not in _reading:
            try:
                load_package(self.ros_package)
            except BaseException:
                if self.ros_package not in _loaded:
                    _forget_lisp_packages(self.ros_package)  # who looks through all packages does not stumble over a broken one
                raise
        return self._external

    @external.setter
    def external(self, table: Any) -> None:
        self._external = table


def lisp_package(package: str, kind: str) -> Package:
    """The Lisp package of the ROS package ``package``, as ``TURTLESIM-MSG``; made if missing. ``kind``: ``"MSG"`` or ``"SRV"``."""
    return registered(f"{package.upper()}-{kind}") or ours(f"{package.upper()}-{kind}", lambda: MessagePackage(package, kind))


def early_symbol(package: str, kind: str, name: str) -> Symbol:
    """The symbol ``name`` of `lisp_package`, which the definitions will export. They are not read for that."""
    home = lisp_package(package, kind)
    table = home.external if package in _loaded else home.internal
    return table.setdefault(name, Symbol(name, home))


def _forget_lisp_packages(package: str) -> None:
    _reading.append(package)
    for kind in ("MSG", "SRV"):
        home = registered(f"{package.upper()}-{kind}")
        if home is not None:
            for user in list(home.used_by):
                user.unuse_package(home)
            delete_package(home)
    _reading.remove(package)


def find_lisp_package(name: str) -> Package | None:
    """The Lisp package ``name``, as ``MY_MSGS-MSG``, made if missing; ``None`` if no ROS package has such definitions."""
    package, _, kind = name.rpartition("-")
    package = package.lower()
    folder = definition_files.package_folder(package) if kind in ("MSG", "SRV") else None
    if folder is None or not definition_files.has_kind(folder, kind.lower()):
        return None
    return lisp_package(package, kind)


def find_message_system(name: str) -> bool:
    """Load the ROS package of the system ``name``, ``my_msgs-msg`` or ``my_msgs-srv``.

    Returns false if no ROS package has such definitions.
    """
    package, _, kind = name.rpartition("-")
    if kind not in ("msg", "srv") or not package:
        return False
    folder = definition_files.package_folder(package)
    if folder is None or not definition_files.has_kind(folder, kind):
        return False
    load_package(package)
    return True


def message_systems() -> Iterator[str]:
    """Yield the names of all systems of messages and services, as ``turtlesim-msg``."""
    for package in definition_files.known_packages():
        folder = definition_files.package_folder(package)
        yield from (f"{package}-{kind}" for kind in ("msg", "srv") if definition_files.has_kind(folder, kind))


@functools.cache
def our_lisp_packages() -> list[str]:
    """The names of the Lisp packages for the messages and services that come with cramhy."""
    return [f"{folder.name.upper()}-{kind}" for folder in sorted(definition_files.OURS.iterdir()) for kind in ("MSG", "SRV")
            if definition_files.has_kind(folder, kind.lower())]  # fmt: skip


packages.finders.append((find_lisp_package, our_lisp_packages))


def _define_message(package: str, name: str, definition: Definition, kind: str, ros_type: str) -> MessageType:
    fields = definition.fields
    names = tuple(field.attribute for field in fields)
    home = lisp_package(package, kind)
    symbol = home.intern(name.upper())
    attributes = {field.name.upper(): field.attribute for field in fields}
    body = {
        "__slots__": names,
        "ros_type": ros_type,
        "fields": tuple(fields),
        "field_names": names,
        "constants": definition.constants,
        "attributes": attributes,
        "initargs": attributes,
        "definition": definition,
        "keywords": tuple(sym(":" + field.name.upper()) for field in fields),
        "lisp_symbol": symbol,
        "lisp_name": f"{home.name}::{name.upper()}",
        "__module__": __name__,
        "__doc__": "\n".join(definition.lines),
    }
    cls = type(name.replace("-request", "Request").replace("-response", "Response"), (RosMessage,), body)
    cls.__init__ = _deferred_initializer(cls, fields)
    if kind == "MSG":
        _messages[ros_type] = cls
    _by_symbol[symbol] = cls
    _by_symbol[home.intern(f"<{name.upper()}>")] = cls
    return cls


def _deferred_initializer(cls: Any, fields: Sequence[Field]) -> Callable[..., None]:
    # Most types of a package are never used, and writing out their initializers is most of the work of loading it.
    def __init__(self, *arguments, **keywords):
        if cls.__init__ is __init__:
            cls.__init__ = _initializer(cls, fields)
        cls.__init__(self, *arguments, **keywords)

    return __init__


def _initializer(cls: MessageType, fields: Sequence[Field]) -> Callable[..., None]:
    """An ``__init__`` with one parameter per field, in the order of the definition. It makes messages inside only when needed."""
    scope = {"_unsupplied": UNSUPPLIED, "_part": part_class}
    parameters, body = _assignments(fields, DEFAULTS)
    initializer = generated_function(f"__init__ of {cls.ros_type}", "__init__", ["self", *parameters], body, scope)
    initializer.__qualname__ = f"{cls.__name__}.__init__"
    return initializer


_makers: dict[type, Callable[..., RosMessage]] = {}


def maker(cls: MessageType) -> Callable[..., RosMessage]:
    """The function that makes messages of ``cls`` as roslisp does: a float that is not given is the 0.0 of Lisp's literals."""
    found = _makers.get(cls)
    if found is None:
        scope = {"_unsupplied": UNSUPPLIED, "_part": lambda ros_type: maker(part_class(ros_type)), "_zero": literal_float(0.0)}
        parameters, body = _assignments(cls.fields, {**DEFAULTS, "float32": "_zero", "float64": "_zero"})
        lines = ["self = new(cls)", *body, "return self"]
        found = generated_function(f"making {cls.ros_type}", "make", parameters, lines, {**scope, "new": cls.__new__, "cls": cls})
        _makers[cls] = found
    return found


def _assignments(fields: Sequence[Field], defaults: dict[str, str]) -> tuple[list[str], list[str]]:
    parameters, body = [], []  # written out once per type, as dataclasses do: making messages is on the path of every command
    for field in fields:
        default = _default(field, defaults)
        if default is None:
            default = defaults.get(field.base, "0")
            parameters.append(f"{field.attribute}={default}")
            body.append(f"self.{field.attribute} = {field.attribute}")
        else:
            parameters.append(f"{field.attribute}=_unsupplied")
            body.append(f"self.{field.attribute} = {default} if {field.attribute} is _unsupplied else {field.attribute}")
    return parameters, body


def part_class(ros_type: str) -> MessageType:
    """The class of the type ``ros_type`` of a field. If there is none, it is an error."""
    return message_class_exact(ros_type) or conditions.error(
        SimpleError("~a", f"The message type {ros_type} is not known, but it is the type of a field. Is its package on ROS_PACKAGE_PATH?")
    )


def _default(field: Field, defaults: dict[str, str]) -> str | None:
    """An expression, as text, for a default that each message needs anew; ``None`` for a constant default."""
    if field.is_array:
        if field.length == 0:
            return "[]"
        element = defaults.get(field.base, "0") if field.primitive else f"_part({field.base!r})()"
        return f"[{element}] * {field.length}"  # message elements are one shared instance, as in roslisp
    return None if field.primitive else f"_part({field.base!r})()"


# ------------------------------------------------------------------------------------------------------------ finding types


def message_class_exact(ros_type: str) -> MessageType | None:
    """The class of ``"package/Name"``, with upper and lower case as in the definition, or ``None``."""
    found = _messages.get(ros_type)
    if found is None and "/" in ros_type:
        load_package(ros_type.partition("/")[0])
        found = _messages.get(ros_type)
    return found


def service_type_exact(ros_type: str) -> ServiceType | None:
    """The `ServiceType` ``"package/Name"``, with upper and lower case as in the definition, or ``None``."""
    found = _services.get(ros_type)
    if found is None and "/" in ros_type:
        load_package(ros_type.partition("/")[0])
        found = _services.get(ros_type)
    return found


def _folded(table: dict[str, Any], exact: Callable[[str], Any], ros_type: str) -> Any:
    package, _, name = ros_type.lower().partition("/")
    found = exact(f"{package}/{name}")
    if found is None:
        for candidate, value in table.items():
            if candidate.lower() == ros_type.lower():
                return value
    return found


def named(symbol: object) -> MessageType | ServiceType | None:
    """The message class or `ServiceType` that ``symbol`` names, or ``None``."""
    found = _by_symbol.get(symbol)
    if found is None and isinstance(symbol, Symbol) and symbol.package is not None:
        package, dash, kind = symbol.package.name.rpartition("-")
        if kind in ("MSG", "SRV"):
            load_package(package.lower())
            found = _by_symbol.get(symbol)
    return found


def message_class(designator: TypeName) -> MessageType:
    """The message class for ``make-message``. ``designator``: a string ``"pkg/Name"`` in any case, a symbol, or the class itself.

    An unknown type is an error. Source: roslisp.md 5.3.
    """
    if isinstance(designator, type):
        return designator
    if isinstance(designator, (str, LispString)):
        text = str(designator)
        found = _messages.get(text)
        return found if found is not None else _folded_or_error(text)
    if isinstance(designator, Symbol):
        found = named(designator)
        if isinstance(found, type):
            if designator.name[0] == "<" and designator not in _warned:
                _warned.add(designator)
                old = f"{designator.package.name.lower()}:"
                new = found.__name__ if found.fields and found.ros_type.endswith("/" + found.__name__) else found.lisp_symbol.name.title()
                conditions.warn("~a", f"using old message class name {old}<{new}> is deprecated: use {old}{new} instead.")
            return found
        return find_class_or_error(designator)
    return conditions.error(CaseFailure(designator, "ETYPECASE", lisp_list(sym("STRING"), sym("SYMBOL"))))


def _folded_or_error(text: str) -> MessageType:
    package, slash, name = text.partition("/")
    if not slash or "/" in name:
        parts = " ".join(f'"{part.upper()}"' for part in text.split("/"))
        given = text.count("/") + 1
        return conditions.error(
            SimpleError(
                "~a",
                f"Error while parsing arguments to DESTRUCTURING-BIND:\n  too {'few' if given < 2 else 'many'} elements in\n"
                f"    ({parts})\n  to satisfy lambda list\n    (PKG-NAME TYPE):\n  exactly 2 expected, but got {given}",
            )
        )
    if load_package(package.lower()) is None:
        return _unknown(f"Can't find package {package.upper()}-MSG", _packages_hint(package, text.partition("/")[2]))
    return _folded(_messages, message_class_exact, text) or _unknown(f"Can't find class for {text}", _types_hint("rosmsg", _messages, text))


def _unknown(text: str, hint: str | None) -> NoReturn:
    conditions.error(SimpleError("~a", text), hint=hint)


def _packages_hint(package: str, name: str, kind: str = "msg") -> str:
    """The hint for a ``package`` that is not a ROS package with definitions; ``name``: the type that is wanted of it."""
    near = near_names(package.lower(), definition_files.known_packages(), 1)
    if near:
        return f"Did you mean {near[0]}?"
    return definition_files.why_missing(package, name, kind)


def topic_class(designator: TypeName) -> MessageType:
    """The message class for ``advertise`` and ``subscribe``. In a string, upper and lower case must match (roslisp.md 6.1).

    ``designator``: a string ``"pkg/Name"``, a symbol, or the class itself. An unknown type is an error.
    """
    if isinstance(designator, type):
        return designator
    if not isinstance(designator, (str, LispString)):
        return message_class(designator)
    text = str(designator)
    found = _messages.get(text)
    if found is not None:
        return found
    package, slash, name = text.partition("/")
    if not slash or "/" in name:
        return conditions.error(SimpleError("~a", f'Too few or too many slashes in "{text}"'))
    if load_package(package) is None:
        return conditions.package_does_not_exist(f"{package.upper()}-MSG", _packages_hint(package, name))
    found = message_class_exact(text)
    if found is None:
        other = _folded(_messages, message_class_exact, text)
        if other is not None:
            return _unknown(f"Case mismatch for message type {text}, did you mean {other.ros_type}?", None)
        return _unknown(f"No datatype {text} known", _types_hint("rosmsg", _messages, text))
    return found


def _types_hint(tool: str, table: dict[str, Any], text: str) -> str:
    """The hint if ``table`` has types of the package, but not the type ``text``. ``tool``: the command that lists them."""
    former = successor(text) if tool == "rosmsg" else None
    if former is not None:
        return former
    package, _, wanted = text.lower().partition("/")
    names = {name.lower().partition("/")[2]: name for name in table if name.startswith(package + "/")}
    near = near_names(wanted, names, 1)
    if near:
        return f"Did you mean {names[near[0]]}?"
    return f"{tool} package {package}, typed at the prompt, lists those that there are."


def service_type(designator: ServiceName) -> ServiceType:
    """The `ServiceType` of ``designator``: a symbol ``turtlesim-srv:Spawn``, a string in any case, or a `ServiceType`.

    An unknown type is an error.
    """
    if isinstance(designator, ServiceType):
        return designator
    advice = None
    if isinstance(designator, (str, LispString)):
        text = str(designator)
        found = _services.get(text)
        if found is not None:
            return found
        if "/" not in text:
            return conditions.type_error(None, "STRING")
        if load_package(text.partition("/")[0].lower()) is None:
            package, _, name = text.partition("/")
            return _unknown("Service-package not found. Maybe it is not loaded?", _packages_hint(package, name, "srv"))
        found = _folded(_services, service_type_exact, text)
        name = text.partition("/")[2].upper()
        designator = found or intern(name, lisp_package(text.partition("/")[0].lower(), "SRV"))
        if found is not None:
            return found
        advice = _types_hint("rossrv", _services, text)
    found = named(conditions.as_name(designator))
    if not isinstance(found, ServiceType):
        advice = advice or 'A service type is a symbol, such as turtlesim-srv:Spawn, or a text, such as "turtlesim/Spawn".'
        return no_applicable_method("ROSLISP-MSG-PROTOCOL:SERVICE-RESPONSE-TYPE", len(_services), designator, advice=advice)
    return found


def lisp_attribute(cls: MessageType, name: object) -> str | None:
    """The Python attribute of ``cls`` for the Lisp field ``name``, or ``None``. Case does not count; an ending ``-val`` is dropped."""
    name = string_designator(name) if not isinstance(name, LispString) else str(name)
    found = cls.attributes.get(name)
    if found is None:
        upper = name.upper()
        found = cls.attributes.get(upper)
        if found is None and upper.endswith("-VAL"):
            found = cls.attributes.get(upper[:-4])
    return found
