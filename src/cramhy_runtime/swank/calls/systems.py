"""Calls about systems of ASDF: those of SLIME's contribution ``slime-asdf``, such as ``,load-system`` and ``,open-system`` in the REPL."""

from __future__ import annotations

import os

from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.lisp_core.packages import sym
from cramhy_runtime.languages.commonlisp.evaluation import evaluator
from cramhy_runtime.languages.commonlisp.systems import asdf, systems

from .. import indentation, places
from ..rpcs import Refused, rpc, text
from ..wire import Name
from .compiling import Notes, noted, time_now
from .evaluating import aborting


@rpc("operate-on-system-for-emacs", evaluates=True)
def operate_on_system(call, name, operation=None, *options):
    """Load, compile or test a system, with notes: ``M-x slime-load-system``, ``,test-system``. options: keywords of ``asdf:operate``."""
    wanted = str(operation or "load-op").rpartition(":")[2].upper()
    forced = dict(zip(options[::2], options[1::2], strict=False)).get(Name(":force"))
    system = text(name)
    if wanted == "LOAD-OP" and not forced:
        return _with_notes(call, lambda: call.session.load(system))
    return _with_notes(call, lambda: asdf.operate(sym(f"ASDF::{wanted}"), system, force=forced))


@rpc("reload-system", evaluates=True)
def reload_system(call, name):
    return _with_notes(call, lambda: asdf.load_system(text(name), force=True))


def _with_notes(call, thunk):
    notes, began = Notes(places.location_of), time_now()
    with noted(notes), binding(evaluator.PACKAGE, call.package):
        aborting(call, thunk)
    indentation.tell(call.connection)
    return notes.result(began)


@rpc("list-asdf-systems list-all-systems-in-central-registry list-all-systems-known-to-asdf")
def list_systems(call):
    return sorted(set(map(str, systems.known_systems())))


def _system(name):
    """The system called ``name``, whose definition is read. `Refused` if there is none."""
    try:
        return systems.find_system(text(name, "The name of a system").lower())
    except systems.MissingComponent as problem:
        raise Refused(problem.report()) from None


@rpc("asdf-system-files")
def system_files(call, name):
    """The files of a system, the ``.asd`` file first."""
    system = _system(name)
    found = [system.file, *(component.pathname for component in systems.files_of(system))]
    return [str(path) for path in found if path is not None and os.path.isfile(path)]


@rpc("asdf-system-directory")
def system_directory(call, name):
    return os.path.join(_system(name).folder, "")


@rpc("asdf-system-loaded-p")
def system_loaded(call, name):
    return text(name).lower() in systems.loaded or systems.is_provided(text(name).lower())


@rpc("asdf-determine-system")
def determine_system(call, path=None, package=None):
    """The system that the file ``path`` belongs to, as far as systems are loaded; else the one named like the buffer's ``package``."""
    if isinstance(path, str):
        wanted = os.path.realpath(path)
        for name, system in systems.systems.items():
            files = [system.file, *(component.pathname for component in systems.files_of(system))]
            if any(file is not None and os.path.realpath(file) == wanted for file in files):
                return name
    name = str(package or "").strip('#:"').lower()
    return name if name in systems.systems else None


@rpc("who-depends-on")
def who_depends_on(call, name):
    """The systems whose definitions are read and name this one in ``:depends-on``."""
    wanted = text(name).lower()
    return sorted(other for other, system in systems.systems.items() if wanted in [str(needed) for needed, _ in system.depends_on])


@rpc("delete-system-fasls")
def delete_fasls(call, name):
    """cramhy keeps compiled code beside its sources and knows when it is too old; so it is enough to load all files anew the next time."""
    systems.forget_system(_system(name).name)
    return f"{name} will be loaded anew."
