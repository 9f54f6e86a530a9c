"""Systems that are inferred from packages: of a system of the class ``package-inferred-system`` each file is a system of its own.

The file ``sub/x.lisp`` of the system ``foo`` is the system ``foo/sub/x``. It depends on the systems of the packages that its
``defpackage`` names. Source: the ASDF manual, section 6.5.
"""

from __future__ import annotations

from pathlib import Path

from cramhy_runtime.lisp_core.data import Cons
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import find_package, string_designator
from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.kernel.typing_names import Any

from ..reader.readtables import READTABLE
from .for_sbcl import NamesReader, readtable_of_names
from .system_definitions import PackageInferredSystem, SourceFile, System, systems

_WITH_PACKAGES = {":use", ":mix", ":reexport", ":use-reexport", ":mix-reexport"}
_WITH_ONE_PACKAGE = {":import-from", ":shadowing-import-from"}
_system_of_package: dict[str, str] = per_image({})


def register_system_packages(system: Any, packages: Any) -> None:
    """``asdf:register-system-packages``: the packages are those of the system ``system``, not of one that is called as they are."""
    for package in packages if isinstance(packages, Cons) else [packages]:
        _system_of_package[string_designator(package)] = string_designator(system).lower()


def infer(name: str) -> System | None:
    """The system ``name``, if its file is there below a package-inferred system of the name before the slash."""
    home, _, rest = name.partition("/")
    main = systems.get(home)
    if not rest or not isinstance(main, PackageInferredSystem):
        return None
    path = Path(main.pathname) / f"{rest}.lisp"
    if not path.is_file():
        return None
    system = systems[name] = PackageInferredSystem(name, main.pathname)
    system.file, system.around_compile = main.file, main.around_compile
    system.components = [SourceFile(rest, system)]
    system.depends_on = [(needed, None) for package in packages_used(path) if (needed := system_of_package(package)) is not None]
    return system


def system_of_package(package: str) -> str | None:
    """The name of the system that defines the package; ``None`` if it is part of cramhy."""
    known = find_package(package)
    if package in _system_of_package:
        return _system_of_package[package]
    return None if known is not None and known.built_in else package.lower()


def packages_used(path: Path) -> list[str]:
    """The names of the packages that the first ``defpackage`` or ``define-package`` in the file takes symbols from, each once."""
    reader, end = NamesReader(path.read_text(encoding="utf-8", errors="replace"), str(path)), object()
    reader.quiet = False  # what is wrong with the text is told
    with binding(READTABLE, readtable_of_names()):
        while (form := reader.read(False, end)) is not end:
            if isinstance(form, Cons) and str(form.car).lower().rpartition(":")[2] in ("defpackage", "define-package"):
                return list(dict.fromkeys(_taken_from(list(form.cdr.cdr or ()))))
    return []


def _taken_from(options: list[Any]) -> list[str]:
    found = []
    for option in options:
        if isinstance(option, Cons) and isinstance(option.cdr, Cons):
            kind, names = str(option.car).lower(), [str(each).lstrip("#:").upper() for each in option.cdr]
            found += names if kind in _WITH_PACKAGES else names[:1] if kind in _WITH_ONE_PACKAGE else []
    return found


__all__ = ["infer", "packages_used", "register_system_packages", "system_of_package"]
