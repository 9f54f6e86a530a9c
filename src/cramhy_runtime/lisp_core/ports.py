"""What the room lisp_core wants done by whoever is installed above it: eight typed ports, each with a plain Python answer.

The room shows objects, names classes, prints warnings, asks the user. How that is done depends on the language in which the session is
held: Common Lisp has its printer, its class world, its streams and its debugger. A language puts its own objects into `PORTS` when it is
started; until then its plain answers stand there (``plain_answers.py``), so that plans which are called from Python print
and fail readably without any language.
"""

from __future__ import annotations

from collections.abc import Callable
from cramhy_runtime.kernel.typing_names import Any, Protocol


class Signals(Protocol):
    """How data and packages, which stand below conditions, signal what is wrong. ``conditions.py`` installs itself."""

    def error(self, datum: Any, *arguments: Any) -> Any: ...
    def type_error(self, datum: Any, expected: str, context: str = "") -> Any: ...
    def undefined_function(self, symbol: Any, arguments: tuple, keywords: dict) -> Any: ...
    def package_error(self, package: Any, text: str) -> Any: ...
    def package_does_not_exist(self, name: Any, hint: str | None = None) -> Any: ...
    def intern(self, name: str, package: str) -> Any: ...


class Printer(Protocol):
    """How objects and messages become text."""

    def prin1(self, thing: Any) -> str:
        """``thing`` as ``prin1`` prints it: so that it can be read again."""
        ...

    def princ(self, thing: Any) -> str:
        """``thing`` as ``princ`` prints it: for people."""
        ...

    def formatted(self, control: Any, *arguments: Any) -> str:
        """The text of a format control (a string or a function) with ``arguments``."""
        ...

    def format_to(self, stream: Any, control: Any, *arguments: Any) -> None:
        """Write that text to ``stream``, whose lines may have begun already."""
        ...

    def output_object(self, thing: Any, stream: Any) -> None:
        """Print a component of the object that is being printed."""
        ...

    def write(self, thing: Any, stream: Any, escape: bool) -> None:
        """Print ``thing`` to ``stream``."""
        ...

    def print_unreadable(self, thing: Any, stream: Any, text: Any, type_: bool, identity: bool, body: Any) -> Any:
        """Print ``#<...>``; see ``printing.print_unreadable``."""
        ...

    def print_slots(self, name: Any, slots: list, stream: Any) -> None:
        """Print ``#S(NAME :SLOT value)``."""
        ...

    def report(self, condition: Any) -> str:
        """The text of ``condition`` for the user, with long objects in their short form."""
        ...

    def address(self, thing: Any) -> str:
        """What tells ``thing`` from others of its class."""
        ...


class Classes(Protocol):
    """What classes are called, which there are, and what belongs to them."""

    def name(self, cls: type) -> Any:
        """The symbol that names ``cls``."""
        ...

    def define(self, symbol: Any, superclass: type) -> type:
        """A new class that ``symbol`` names; one of that name that is there already keeps its identity."""
        ...

    def customized(self, cls: type) -> bool:
        """Whether users have said how instances of ``cls`` are made."""
        ...

    def find(self, symbol: Any, required: bool) -> Any:
        """The class that ``symbol`` names; if there is none, ``None`` or, when it is ``required``, an error."""
        ...

    def make(self, cls: type, *initargs: Any) -> Any:
        """A new instance; ``initargs`` are keywords and values in turn."""
        ...

    def precedence(self, cls: type) -> tuple:
        """The classes to which instances of ``cls`` belong, the most specific first."""
        ...

    def slots(self, structure: Any) -> list:
        """The slots of a structure, pairs of name and value."""
        ...


class Types(Protocol):
    """What type specifiers mean."""

    def known(self, specifier: Any) -> bool:
        """Whether ``specifier`` is a type by now."""
        ...

    def test(self, specifier: Any) -> Callable[[Any], bool] | None:
        """As `predicate`, but ``None`` for what is no type by now."""
        ...

    def predicate(self, specifier: Any) -> Callable[[Any], bool]:
        """The function that tells whether its argument is of the type; an unknown type is an error."""
        ...

    def declared(self, specifier: Any) -> Callable[[Any], bool]:
        """As `predicate`, for a declared type, which may be one of functions."""
        ...

    def expand(self, specifier: Any) -> Any:
        """What a type of ``deftype`` stands for; other specifiers as they are."""
        ...

    def without_parameters(self, specifier: Any) -> Any:
        """As `expand`, for a symbol whose ``deftype`` has no parameters, so that its expansion needs nothing; others as they are."""
        ...

    def simplified(self, specifier: Any) -> Any:
        """The specifier as messages show it."""
        ...

    def of(self, thing: Any) -> Any:
        """The type of ``thing``, as ``type-of`` gives it."""
        ...


class Output(Protocol):
    """Where the runtime writes what is not the value of a form."""

    def warning(self, condition: Any) -> None:
        """Tell the user of a warning that nobody muffled."""
        ...

    def designated(self, designator: Any) -> Any:
        """The output stream that ``designator`` stands for."""
        ...

    def hint(self, condition: Any) -> str | None:
        """What the user is told of ``condition`` besides its report: circumstances and advice, lines of text."""
        ...

    def stream(self, name: str) -> Any:
        """The stream ``standard-output``, ``error-output`` or ``trace-output``: it has ``write``, ``fresh_line`` and ``flush``."""
        ...


class User(Protocol):
    """Who decides when a program cannot, and in which language."""

    def form(self, prompt: str) -> Any:
        """The value of a form that the user is asked for."""
        ...

    def read(self, text: str) -> Any:
        """The object that ``text`` shows; nothing is evaluated, and no symbol is made that a program would see."""
        ...

    def read_with_places(self, text: str, filename: str) -> tuple[Any, dict]:
        """The first form of ``text``, and where its parts stand: places by the ``id`` of each list."""
        ...

    def evaluate(self, form: Any) -> Any:
        """The values of ``form``, in the language of the session."""
        ...


class Systems(Protocol):
    """Who loads a library when its package is named."""

    def load(self, name: str) -> None: ...


class Definitions(Protocol):
    """Who must agree when a name gets a new meaning: package locks, and methods that users add to a generic function."""

    def check_symbol(self, symbol: Any, control: str, *arguments: Any) -> None:
        """Signal, if the home package of ``symbol`` is locked, that the symbol is about to get another meaning."""
        ...

    def no_applicable_method(self, function: Any, arguments: tuple, default: Callable) -> Any:
        """The value of a call for which no method applies; ``default`` signals the error."""
        ...

    def no_next_method(self, function: Any, method: Any, arguments: tuple, default: Callable) -> Any:
        """The value of ``call-next-method`` where there is no next one; ``default`` signals the error."""
        ...

    def generic_function_of(self, class_: Any, name: Any, lambda_list: Any) -> Any:
        """A new generic function of a user's class."""
        ...

    def maker_of_methods(self, class_: Any) -> Any:
        """What makes a new `Method` one of a user's class."""
        ...

    def warn(self, kind: type, control: str, *arguments: Any) -> None:
        """Tell what a macro found wrong with its call while it was expanded: a warning of class ``kind``."""
        ...

    def expansion_place(self) -> Any:
        """The place of the macro call that is being expanded, or ``None``."""
        ...

    def lambda_list(self, function: Any) -> Any:
        """The parameters of ``function`` in the user's spelling, a list of symbols."""
        ...


class Ports:
    """The ports that are in use. Languages replace them by `install`."""

    signals: Signals
    printer: Printer
    classes: Classes
    types: Types
    output: Output
    user: User
    systems: Systems
    definitions: Definitions

    def install(self, **ports: Any) -> None:
        """Use these ports from now on: ``PORTS.install(printer=...)``. A name that is no port is a ``TypeError``."""
        for name, port in ports.items():
            if name not in Ports.__annotations__:
                raise TypeError(f"There is no port {name}; there are {', '.join(Ports.__annotations__)}.")
            setattr(self, name, port)


PORTS = Ports()
