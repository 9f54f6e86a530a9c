"""Loading the components of a system: each file that has changed or was not loaded yet, by the methods of ``asdf:perform``.

A file is compiled and loaded in one. That happens when ``load-op`` is performed on it. Where the program has a method of ``compile-op``,
with which it binds a readtable or muffles a warning, it happens there, or by ``load-op`` after all, if that method calls no next one.
Source: the ASDF manual, section 7.1.
"""

from __future__ import annotations

from contextlib import nullcontext
from pathlib import Path

from cramhy_runtime.lisp_core.conditions import CompileError, error
from cramhy_runtime.lisp_core.data import one
from cramhy_runtime.lisp_core.dispatch.generic_functions import EqlSpecializer
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.packages import keyword, sym
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any
from cramhy_runtime.storage.dependencies import file_state, unchanged
from cramhy_runtime.storage.dependency_tracing import is_library

from ..streams.streams import ERROR_OUTPUT, output_stream
from ..files.files import lisp_path
from . import loader
from .component_order import components_of
from .for_sbcl import lacking, read_for_sbcl
from .system_definitions import PERFORM, CompileOp, Component, LoadOp, SourceFile, System, holds, is_of_program

if TYPE_CHECKING:
    from contextlib import AbstractContextManager

_loaded: dict[Path, tuple[str, object, str]] = per_image({})
"""File → what was loaded before it, its state and its fingerprint."""
_performed: list[_Loading] = per_image([])


class _Loading:
    """A component that is being loaded. ``chain``: the fingerprint of what came before; ``fingerprint``: its own, when it was loaded."""

    def __init__(self, component: Component, chain: str) -> None:
        self.component, self.chain, self.fingerprint = component, chain, ""

    def load(self) -> None:
        if not self.fingerprint and isinstance(self.component, SourceFile):
            self.fingerprint = loader.load_file(path_of(self.component), self.chain)


def loaded_files() -> list[Path]:
    """The files of systems that were loaded."""
    return list(_loaded)


def forget_files(system: System) -> None:
    """Forget that the files of the system were loaded."""
    for component in components_of(system):
        _loaded.pop(component.pathname, None)


def path_of(component: Component) -> Path:
    """Where a component lies: ``asdf:component-pathname`` says so of a class of the program."""
    if not is_of_program(component):
        return component.pathname
    return Path(sym("ASDF::COMPONENT-PATHNAME").function(component))


def load_components(system: System, chain: str, force: bool) -> str:
    """Load the components that have changed since, or ``force``. ``chain``: the fingerprint of what comes before; returns that of all."""
    components = [each for each in components_of(system) if isinstance(each, SourceFile) or has_methods(each)]
    _tell_what_is_lacking(system, [path_of(each) for each in components if isinstance(each, SourceFile)])
    for component in components:
        with _features_for(component):
            chain = _load_component(component, chain, force)
    return chain


def has_methods(component: Component) -> bool:
    """Whether the program may have said how to perform operations on this component."""
    return is_of_program(component) or bool(component.methods)


def _features_for(component: Component) -> AbstractContextManager[None]:
    """A context in which ``*features*`` has SBCL or not, as the file needs it."""
    lacks = None if not isinstance(component, SourceFile) or is_library(str(component.system.file)) else lacking([path_of(component)])
    return nullcontext() if lacks is None else read_for_sbcl(not lacks and not component.system.without_sbcl)


def _tell_what_is_lacking(system: System, files: list[Path]) -> None:
    """Tell who asked for the feature SBCL what the files of the system would name of SBCL that is not here."""
    if not holds(keyword("SBCL")) or is_library(str(system.file)) or any(path in _loaded for path in files):
        return
    without = [path for path in files if lacking([path])]
    if without:
        names = lacking(without) or []
        stream = output_stream(ERROR_OUTPUT.value)
        stream.fresh_line()
        stream.write(
            f"; {', '.join(path.name for path in without)} of the system {system.name} {'is' if len(without) == 1 else 'are'} read without "
            f"the feature SBCL: {', '.join(names[:3])}{f' and {len(names) - 3} more' if len(names) > 3 else ''} cannot be had here.\n"
        )
        stream.flush()


def _load_component(component: Component, chain: str, force: bool) -> str:
    path = path_of(component)
    known = _loaded.get(path)
    if known is not None and known[0] == chain and unchanged(path, known[1]) and not force:
        return known[2]
    _loaded.pop(path, None)
    state, loading = file_state(path), _Loading(component, chain)
    _performed.append(loading)
    try:
        _around_compile(component, lambda: _perform(loading))
    finally:
        _performed.pop()
    _loaded[path] = (chain, state, loading.fingerprint or chain)
    return loading.fingerprint or chain


def _perform(loading: _Loading) -> None:
    if has_methods(loading.component):
        PERFORM(CompileOp(), loading.component)
        PERFORM(LoadOp(), loading.component)
    else:
        loading.load()


def _around_compile(component: Component, load: Any) -> None:
    """Call ``load``; if the component or a module around it says ``:around-compile``, that function calls it."""
    hook, outer = None, component
    while outer is not None and hook is None:
        hook, outer = outer.around_compile, outer.parent
    if hook is None:
        load()
        return

    def load_and_check(*keywords: Any) -> Any:
        """What the hook calls, with the keywords for the compilation: ``:compile-check`` is a function that says whether it went well."""
        loaded = load()
        check = dict(zip(keywords[::2], keywords[1::2])).get(keyword("COMPILE-CHECK"))
        file = lisp_path(path_of(component))
        if check is not None and one(function_of(check)(file, keyword("OUTPUT-FILE"), file)) is None:
            error(CompileError("~S was compiled, but the function ~S, which its system gave as :COMPILE-CHECK, refuses it.", file, check))
        return loaded

    function_of(one(sym("UIOP::ENSURE-FUNCTION").function(hook)))(load_and_check)


@PERFORM.method(CompileOp, SourceFile)
def compile_file(operation: CompileOp, component: SourceFile) -> None:
    """``asdf:perform`` of ``compile-op``: compile the file and load it, if that is for ``compile-op``."""
    if _says_how_to_compile(component):
        _load_it(component)


def _says_how_to_compile(component: Component) -> bool:
    """Whether the program has a method of ``compile-op`` for the component; then loading the file is done there, else by ``load-op``."""
    for method in PERFORM.methods:
        operation, wanted = method.specializers
        if method not in _OURS and isinstance(operation, type) and issubclass(CompileOp, operation):
            if wanted.value is component if isinstance(wanted, EqlSpecializer) else isinstance(component, wanted):
                return True
    return False


@PERFORM.method(LoadOp, SourceFile)
def load_file(operation: LoadOp, component: SourceFile) -> None:
    """``asdf:perform`` of ``load-op``: load the file, if compiling it has not done so."""
    _load_it(component)


def _load_it(component: SourceFile) -> None:
    loading = _performed[-1] if _performed and _performed[-1].component is component else _Loading(component, "")
    loading.load()


_OURS = list(PERFORM.methods)


__all__ = ["forget_files", "has_methods", "load_components", "loaded_files", "path_of"]
