"""Systems: ``.asd`` files, where they are found, and loading what they name in the right order.

A system is a set of files with an order, described by ``defsystem``. Packages (folders with a ``package.xml``) and systems
are found below the folders of ``ROS_PACKAGE_PATH``, below ``src`` of the workspace and in the current folder, and in
``tutorials``. Systems of CRAM and ROS that cramhy itself contains are known by name and need no file. Sources: the ASDF
manual; roslisp.md section 12.
"""

from __future__ import annotations

import functools
import os
from pathlib import Path

from cramhy_runtime.kernel.images import per_image
from cramhy_runtime.lisp_core.conditions import Error, SimpleError, error, handler_bind, handler_case, warn
from cramhy_runtime.lisp_core.dispatch.generic_errors import FunctionInTheWay
from cramhy_runtime.lisp_core.restarts import find_restart, invoke_restart
from cramhy_runtime.lisp_core.data import Cons, Symbol, list_from
from cramhy_runtime.lisp_core.dynamic import binding
from ..compiler.compilation_unit import compilation_unit
from ..evaluation.definitions import RedefinitionWarning
from ..evaluation.evaluator import PACKAGE, evaluate
from ..files.files import lisp_path
from ..reader.dispatch_macros import FEATURES
from ..streams.streams import ERROR_OUTPUT, output_stream
from cramhy_runtime.lisp_core.packages import Package, find_package, near_names, register, string_designator, sym
from . import loader, missing_messages, package_inferred, passed_over, performing
from .component_order import files_of
from .for_sbcl import lacking, read_for_sbcl, speaks_of_sbcl
from cramhy_runtime.storage.dependencies import file_state, unchanged
from cramhy_runtime.storage.dependency_tracing import is_library
from cramhy_runtime.ros import search_folders
from cramhy_runtime.ros.definition_files import package_name
from cramhy_runtime.ros.search_folders import crawls, look_again, crawling_once
from .system_definitions import PERFORM, LoadOp, System, define_system, systems


class SystemDefinitionError(SimpleError):
    lisp_name = "ASDF::SYSTEM-DEFINITION-ERROR"


class MissingComponent(SystemDefinitionError):
    lisp_name = "ASDF::MISSING-COMPONENT"


built_in: set = per_image(set())
"""Names of systems that are part of cramhy; rooms add theirs with `provide_system`."""
_finders: list = []
_read: dict = per_image({})
"""``.asd`` file → its time and size when it was read."""
_reading: list = per_image([])
_loading: list = per_image([])
CENTRAL_REGISTRY = sym("ASDF::*CENTRAL-REGISTRY*")
preferred: set = per_image(set())
"""Names of systems that `prefer` takes from ROS_PACKAGE_PATH, though cramhy contains one of that name."""
chosen: dict = per_image({})
"""Name of a system that cramhy contains, too → the ``.asd`` file that the user has loaded, or has put into the central registry."""
NOT_TO_BE_HAD = {
    "usocket": "it opens sockets by functions of the system; Python's socket module does its work",
    "osicat": "it calls functions of C, which cramhy cannot; Python's os module does its work",
    "gsll": "it calls the GNU Scientific Library; cram-math, and numpy by (py:import numpy), do its work",
    "cl-opengl": "it draws with functions of C; the page of cramhy shows worlds, and btr:save-picture writes pictures",
    "cl-glut": "it opens windows with functions of C; the page of cramhy shows worlds",
}
"""Systems that cannot be had here, and why."""
LEFT_OUT = {
    "cl-glx": "It opens windows for worlds on X11. The page of cramhy shows worlds.",
    "cram-semantic-map": "It reads the furniture from KnowRob. Here a URDF describes it.",
    "cram-semantic-map-utils": "It reads the furniture from KnowRob. Here a URDF describes it.",
    "synchronization-tools": "It waits for messages and transforms that belong together.",
}
"""Systems of CRAM that are empty here, with their descriptions: others list them, and nothing that runs here needs what they define."""


LAST = frozenset({"cram-pr2-pick-place-demo"})
"""Systems of `LIBRARIES` that stand for applications of CRAM: a checkout comes before them."""


def provide_system(names):
    """Note systems that cramhy contains, so that nothing is looked for or loaded: ``names`` is one text."""
    built_in.update(names.split())


def provide_systems_on_demand(find, names):
    """Systems that cramhy makes when somebody asks for them: ``find(name)`` tells whether there is one of that name and loads it,
    ``names()`` gives the names of all, for "did you mean"."""
    _finders.append((find, names))


def is_provided(name):
    """Whether the system ``name`` is part of cramhy, or was just made by it."""
    return name not in preferred and (name in built_in or any(find(name) for find, _ in _finders))


def is_built_in(name):
    """Whether the system ``name`` is part of cramhy, and nobody prefers another."""
    return name in built_in and name not in preferred


def prefer(name):
    """Take the system ``name`` from ROS_PACKAGE_PATH from now on, even if cramhy contains one of that name; an error if it is not there.

    The definitions of the system are made over those of cramhy's own, which stay where it defines nothing of that name.
    """
    name = string_designator(name).lower()
    if _find_below(f"{name}.asd", True) is None:
        where = ", ".join(map(str, search_folders.on_package_path())) or "it names no folder that can be read"
        return error(
            MissingComponent("There is no system ~S on ROS_PACKAGE_PATH that could be preferred", name),
            hint=f"ROS_PACKAGE_PATH: {where}. The system is a file {name}.asd in one of these folders, or below.",
        )
    preferred.add(name)
    systems.pop(name, None)
    return None


def choose_file(path):
    """Take the systems that the ``.asd`` file ``path`` defines from there, also those that cramhy contains; of these a line is told."""
    for name in [system.name for system in systems.values() if system.file == path]:
        if _contains(name) and chosen.get(name) != path:
            preferred.add(name)
            chosen[name] = path
            stream = output_stream(ERROR_OUTPUT.value)
            stream.fresh_line()
            stream.write(f"; The system {name} is that of {path}, not the one that cramhy contains.\n")
            stream.flush()


OF_ALL_LISPS = {"alexandria", "closer-mop", "cl-utilities", "s-xml", "split-sequence"}
"""Libraries that know nothing of CRAM, of which cramhy contains a rewritten form: a real one on ROS_PACKAGE_PATH comes first. All others
depend on how cramhy is made; `prefer` takes them from there."""

OF_EACH_GENERATION = frozenset(
    "cram-robot-interfaces cram-common-failures cram-designator-specification cram-common-designators cram-plan-occasions-events cram-tf"
    " cram-mobile-pick-place-plans cram-pr2-description cram-robot-pose-gaussian-costmap cram-bullet-reasoning-belief-state"
    " cram-btr-spatial-relations-costmap".split()
)
"""CRAM's interfaces and plans, which cramhy contains as CRAM's branch master has them. The branch devel has others under the same names,
and its demos are written for those. Where a checkout of devel is on ROS_PACKAGE_PATH, its own come first."""
SIGN_OF_DEVEL = "cram-manipulation-interfaces.asd"
"""A system that devel has, and master has not."""


def _contains(name):
    """Whether cramhy contains a system ``name``, be it in a file or not."""
    return name in built_in or f"{name}.asd" in libraries()


def _is_ours(system):
    return system.file is None or is_library(str(system.file))


def _ask_registry(name):
    """If the user's central registry or ROS_PACKAGE_PATH has a system ``name`` that cramhy contains, too, take that one."""
    if name in preferred or not _contains(name):
        return
    path = next((folder / f"{name}.asd" for folder in central_registry() if os.path.isfile(folder / f"{name}.asd")), None)
    if path is None and (name in OF_ALL_LISPS or name in OF_EACH_GENERATION and _find_below(SIGN_OF_DEVEL, True)):
        path = _find_below(f"{name}.asd", True)
    if path is not None:
        load_asd(path)
        choose_file(really_at(path))


def central_registry():
    """The folders that ``asdf:*central-registry*`` lists: strings, pathnames, or forms that give one."""
    entries = CENTRAL_REGISTRY.value
    values = [evaluate(entry) if isinstance(entry, (Cons, Symbol)) else entry for entry in (entries if isinstance(entries, Cons) else ())]
    return [Path(value) for value in values if value is not None]


LIBRARIES = Path(__file__).parents[3] / "libraries"
"""The libraries that come with cramhy, each a folder with a ``.asd``; they are loaded when somebody asks for them."""
LIBRARY_PACKAGES = {
    "ALEXANDRIA": "alexandria",
    "ALEXANDRIA-1": "alexandria",
    "ALEXANDRIA-2": "alexandria",
    "LISP-UNIT": "lisp-unit",
    "SPLIT-SEQUENCE": "split-sequence",
    "CL-UTILITIES": "cl-utilities",
    "CRAM-MATH": "cram-math",
    "CMA": "cram-math",
    "CL-BULLET": "cl-bullet",
    "BULLET": "cl-bullet",
    "CL-BULLET-VIS": "cl-bullet-vis",
    "BT-VIS": "cl-bullet-vis",
    "CL-URDF": "cl-urdf",
    "CRAM-PHYSICS-UTILS": "cram-physics-utils",
    "PHYSICS-UTILS": "cram-physics-utils",
    "CRAM-BULLET-REASONING": "cram-bullet-reasoning",
    "BTR": "cram-bullet-reasoning",
    "CRAM-BULLET-REASONING-UTILITIES": "cram-bullet-reasoning-utilities",
    "BULLET-REASONING-UTILITIES": "cram-bullet-reasoning-utilities",
    "BTR-UTILS": "cram-bullet-reasoning-utilities",
    "CRAM-BULLET-REASONING-BELIEF-STATE": "cram-bullet-reasoning-belief-state",
    "BTR-BELIEF": "cram-bullet-reasoning-belief-state",
    "CRAM-PR2-PROJECTION": "cram-pr2-projection",
    "PR2-PROJ": "cram-pr2-projection",
    "URDF-PROJ": "cram-pr2-projection",
    "JSON-PROLOG": "cram-json-prolog",
    "CRAM-CLOUD-LOGGER": "cram-cloud-logger",
    "CCL": "cram-cloud-logger",
    "CRAM-PR2-PROJECTION-REASONING": "cram-pr2-projection-reasoning",
    "PR2-PROJ-REASONING": "cram-pr2-projection-reasoning",
    "CRAM-PR2-FETCH-DELIVER-PLANS": "cram-pr2-fetch-deliver-plans",
    "PR2-FD-PLANS": "cram-pr2-fetch-deliver-plans",
    "CRAM-PR2-ENVIRONMENT-MANIPULATION": "cram-pr2-environment-manipulation",
    "PR2-EM": "cram-pr2-environment-manipulation",
    "PR2-ENV-MAN": "cram-pr2-environment-manipulation",
    "SB-BSD-SOCKETS": "sb-bsd-sockets",
    "SB-BSD-SOCKETS-INTERNAL": "sb-bsd-sockets",
    "SB-RT": "sb-rt",
    "SB-CONCURRENCY": "sb-concurrency",
    "SB-QUEUE": "sb-queue",
    "SB-CLTL2": "sb-cltl2",
    "S-XML": "s-xml",
    "SB-ROTATE-BYTE": "sb-rotate-byte",
    "FIVEAM": "fiveam",
    "5AM": "fiveam",
    "IT.BESE.FIVEAM": "fiveam",
    "BORDEAUX-THREADS": "bordeaux-threads",
    "BT": "bordeaux-threads",
    "BORDEAUX-THREADS-2": "bordeaux-threads",
    "BT2": "bordeaux-threads",
    "TRIVIAL-GARBAGE": "trivial-garbage",
    "TG": "trivial-garbage",
    "TRIVIAL-GRAY-STREAMS": "trivial-gray-streams",
    "CLOSER-MOP": "closer-mop",
    "C2MOP": "closer-mop",
    "CLOSER-COMMON-LISP": "closer-mop",
    "C2CL": "closer-mop",
    "CLOSER-COMMON-LISP-USER": "closer-mop",
    "C2CL-USER": "closer-mop",
    "CFFI": "cffi",
    "UFFI": "uffi",
    "CFFI-ROS-UTILS": "cffi-ros-utils",
    "CRAM-COMMON-FAILURES": "cram-common-failures",
    "COMMON-FAIL": "cram-common-failures",
    "CRAM-DESIGNATOR-SPECIFICATION": "cram-designator-specification",
    "SPEC": "cram-designator-specification",
    "CRAM-COMMON-DESIGNATORS": "cram-common-designators",
    "CRAM-PLAN-OCCASIONS-EVENTS": "cram-plan-occasions-events",
    "CPOE": "cram-plan-occasions-events",
    "CRAM-ROBOT-INTERFACES": "cram-robot-interfaces",
    "CRAM-TF": "cram-tf",
    "CRAM-OBJECT-INTERFACES": "cram-object-interfaces",
    "OBJ-INT": "cram-object-interfaces",
    "CRAM-MOBILE-PICK-PLACE-PLANS": "cram-mobile-pick-place-plans",
    "PP-PLANS": "cram-mobile-pick-place-plans",
    "CRAM-PR2-DESCRIPTION": "cram-pr2-description",
    "CRAM-KNOWROB-PICK-PLACE": "cram-knowrob-pick-place",
    "KR-PP": "cram-knowrob-pick-place",
    "CRAM-SIMPLE-ACTIONLIB-CLIENT": "cram-simple-actionlib-client",
    "ACTIONLIB-CLIENT": "cram-simple-actionlib-client",
    "CRAM-LOCATION-COSTMAP": "cram-location-costmap",
    "LOCATION-COSTMAP": "cram-location-costmap",
    "COSTMAP": "cram-location-costmap",
    "CRAM-ROBOT-POSE-GUASSIAN-COSTMAP": "cram-robot-pose-gaussian-costmap",
    "GAUSSIAN-COSTMAP": "cram-robot-pose-gaussian-costmap",
    "CRAM-BTR-VISIBILITY-COSTMAP": "cram-btr-visibility-costmap",
    "BTR-VIS-CM": "cram-btr-visibility-costmap",
    "CRAM-BTR-SPATIAL-RELATIONS-COSTMAP": "cram-btr-spatial-relations-costmap",
    "BTR-SPATIAL-CM": "cram-btr-spatial-relations-costmap",
    "CRAM-OCCUPANCY-GRID-COSTMAP": "cram-occupancy-grid-costmap",
    "OCCUPANCY-GRID-COSTMAP": "cram-occupancy-grid-costmap",
}
"""Their packages: the library is loaded when its package is first named."""
WITH_CFFI = {"BABEL": "babel", "BABEL-ENCODINGS": "babel"}
"""Packages of systems that the original's CFFI depends on, so that its users need not name them. They are loaded from ROS_PACKAGE_PATH, if
they are there, when the package is first named: compiling Babel takes longer than most programs that load CFFI."""


@functools.cache
def libraries():
    """The ``.asd`` files in `LIBRARIES`: the path there by the file's name."""
    return {path.name: path.relative_to(LIBRARIES) for path in LIBRARIES.glob("*/*.asd")}


def _asd_files(crawl):
    """Yield the ``.asd`` files below a folder; those of packages' sub-folders last."""
    for folders in (crawl.folders, crawl.insides):
        for folder in folders:
            if "roslisp_ignore" not in folder.entries:
                yield from folder.files(".asd")


def find_asd(name):
    """The ``.asd`` file that defines the system ``name`` (its file name, or its secondary name after the slash), or ``None``."""
    home = name.partition("/")[0]
    wanted = home + ".asd"
    if home in chosen:
        return chosen[home]
    if home in preferred and (found := _find_below(wanted, True)) is not None:
        return found
    if wanted in libraries() and home not in LAST:
        return LIBRARIES / libraries()[wanted]
    for folder in central_registry():
        if os.path.isfile(folder / wanted):
            return folder / wanted
    found = _find_below(wanted)
    if found is None and look_again():
        found = _find_below(wanted)
    if found is None and wanted in libraries():
        found = LIBRARIES / libraries()[wanted]
    if found is None:  # a package's system and its tests have a file each
        found = next((path.parent / wanted for path in (*_reading, *_read) if (path.parent / wanted).is_file()), None)
    return found


def _find_below(wanted, on_path_only=False):
    return next((path for crawl in crawls(on_path_only) for path in _asd_files(crawl) if path.name == wanted), None)


def find_package_folder(name):
    """The folder of the ROS package ``name``: its manifest says so, or it is called so and has a ``.asd``; ``None`` if there is none."""
    for folder in search_folders.crawl():
        called_so = os.path.basename(folder.path) == name
        if folder.manifest is not None and package_name(folder) == name or called_so and any(folder.files(".asd")):
            return Path(folder.path)
    return None


def known_systems():
    """Names of all systems that could be loaded, for "did you mean"."""
    return {
        *built_in,
        *(name for _, names in _finders for name in names()),
        *(name.removesuffix(".asd") for name in libraries()),
        *LEFT_OUT,
        *(path.stem for crawl in crawls() for path in _asd_files(crawl)),
    }


def load_library(name):
    """Load the system ``name`` because somebody named one of its packages; of `WITH_CFFI` only those that are there."""
    if name not in WITH_CFFI.values() or find_asd(name) is not None:
        load_system(name)


# --------------------------------------------------------------------------------------------------------------- reading


def load_asd(path, force=False):
    """Read a ``.asd`` file unless that was done and it has not changed: define its systems, evaluate its other forms."""
    path = really_at(path)
    state = file_state(path)
    if path in _reading or not force and unchanged(path, _read.get(path)):
        return
    _reading.append(path)
    try:
        _read_definitions(path)
    finally:
        _reading.remove(path)
    _read[path] = state


def really_at(path):
    """The file ``path`` from the root on; of a link that is called as its target, the target: the files of the system lie beside it."""
    path = Path(path).absolute()
    target = Path(os.path.realpath(path)) if path.is_symlink() else path
    return target if target.name == path.name else path


def _read_definitions(path):
    """Evaluate the forms of an ``.asd`` file: for SBCL, if what it then defines can be had here, else as a Lisp that it does not know."""
    text = path.read_text(encoding="utf-8")
    if not speaks_of_sbcl(text) or is_library(str(path)):
        return _evaluate_definitions(path, text)
    features = FEATURES.value
    with read_for_sbcl(True):
        _evaluate_definitions(path, text)
    made = [system for system in systems.values() if system.file == path]
    main = systems.get(path.stem)
    if main not in made or not (_not_had(main) or lacking(component.pathname for component in files_of(main))):
        return None
    for system in made:
        system.file = None
    FEATURES.value = features  # without those that the first reading has added
    with read_for_sbcl(False):  # one that is only for Lisps that it knows may say so by an error
        was_read = handler_case([(Error, lambda condition: False)], lambda: _evaluate_definitions(path, text) or True)
    for system in made:
        if system.file is None and system is not main:
            forget_system(system.name)
        system.without_sbcl = was_read and system.file is not None
    if main.file is None or not was_read:  # it is there for Lisps that it knows
        with read_for_sbcl(True):
            _evaluate_definitions(path, text)
    return None


def _not_had(system):
    """Names of parts of SBCL that a system depends on, and that cannot be had."""
    return [name for name, _ in system.depends_on if name.startswith("sb-") and not is_provided(name) and find_asd(name) is None]


def _evaluate_definitions(path, text):
    from ..reader.reader import Reader

    reader, end = Reader(text, filename=str(path)), object()
    with binding(PACKAGE, asdf_user(), loader.LOAD_PATHNAME, lisp_path(path), loader.LOAD_TRUENAME, lisp_path(os.path.realpath(path))):
        while (form := reader.read(eof_error=False, eof_value=end)) is not end:
            if isinstance(form, Cons) and isinstance(form.car, Symbol) and form.car.name == "DEFSYSTEM":
                define_system(form, path.parent, path, reader.positions, load_system)
            else:
                evaluate(form, str(path), reader.positions)


def asdf_user():
    """The package ASDF-USER, in which ``.asd`` files are read."""
    known = find_package("ASDF-USER")
    if known is not None:
        return known
    find_package("UIOP").complete()
    return register(Package("ASDF-USER", (), [find_package(name) for name in ("COMMON-LISP", "ASDF", "UIOP")]))


# ----------------------------------------------------------------------------------------------------------------- loading


def find_system(name, required_by=None):
    """The `System` called ``name``; an unknown one is an error that names who asked for it, where it was searched, and its neighbours."""
    if is_provided(name):
        return systems.setdefault(name, System(name, Path(__file__).parents[3]))
    path = find_asd(name)
    if path is None and "." in name and name not in systems:
        path = find_asd(name.rpartition(".")[0])  # cl-json.test stands in cl-json.asd
    if path is not None:
        load_asd(path)
    system = systems.get(name)
    if system is None:
        system = package_inferred.infer(name)
    if system is None and name in LEFT_OUT:
        system = System(name, Path(__file__).parents[3])
        system.options["DESCRIPTION"] = LEFT_OUT[name]
    if system is None:
        by = f", required by #<SYSTEM {required_by!r}>".replace("'", '"') if required_by else ""
        return error(MissingComponent(f"Component ~S not found{by}", name), hint=_why_missing(name, path, required_by))
    return system


def _why_missing(name, path, required_by):
    near = near_names(name, known_systems())
    hint = f" Did you mean {' or '.join(near)}?" if near else ""
    if required_by in systems and systems[required_by].file is not None:
        hint += f"\n{required_by} is defined in {systems[required_by].file}."
    if path is not None:
        there = ", ".join(sorted(system.name for system in systems.values() if system.file == really_at(path))) or "no system"
        return f"{path} defines {there}.{hint}"
    if name in NOT_TO_BE_HAD:
        return f"{name} cannot be had in cramhy: {NOT_TO_BE_HAD[name]}."
    of_messages = missing_messages.advice(name, missing_messages.wanted_by(required_by, files_of))
    if of_messages is not None:
        return of_messages + (hint if hint.startswith("\n") else hint.replace(" ", "\n", 1))
    where = ", ".join(str(folder) for folder in [*central_registry(), *search_folders.search_folders()])
    return f"There is no file {name.partition('/')[0]}.asd below {where}.{hint}"


def check_version(system, least, required_by):
    """Check that ``system`` is of version ``least`` or later; those that are part of cramhy are of any version."""
    if least is None or is_built_in(system.name) or "/libraries/" in str(system.file).replace(os.sep, "/"):
        return
    if system.version is None or _numbers(system.version) < _numbers(least):
        has = f"it is version {system.version}" if system.version else "it has no version"
        error(
            MissingComponent(f'Component ~S does not match version ~A, required by #<SYSTEM "{required_by}">', system.name, least),
            hint=f"In {system.file} {has}.",
        )


def _numbers(version):
    return [int(part) if part.isdigit() else 0 for part in version.split(".")]


def load_system(name, force=False, version=None):
    """Load the system ``name`` and what it depends on, each file that has changed or was not loaded yet.

    Returns the fingerprint of all that was loaded. A circle of dependencies is an error.
    """
    with compilation_unit("file"), crawling_once():
        return _load_system(name, force, version=version)


def _load_system(name, force=False, required_by=None, version=None):
    name = string_designator(name).lower()
    _ask_registry(name)
    if _contains(name) and name not in preferred and not (required_by in systems and _is_ours(systems[required_by])):
        ours = "cramhy itself" if name in built_in else LIBRARIES / name
        passed_over.warn_of_another(name, str(ours), _contains)
    if is_provided(name):
        return name
    if name in _loading:
        return error("Circular dependency: ~{~A~^ -> ~} -> ~A", list_from(_loading[_loading.index(name) :]), name)
    _loading.append(name)
    try:
        system = find_system(name, required_by)
        check_version(system, version, required_by)
        chain = "".join(_load_system(other, required_by=name, version=least) for other, least in system.depends_on)
        chain = _instead_of_ours(name, lambda: _load_components(system, chain, force))
        if force or loaded.get(name) != chain:
            loaded[name] = chain
            PERFORM(LoadOp(), system)
        return chain
    finally:
        _loading.pop()


def _load_components(system, chain, force):
    return chain if _is_replaced(system) else performing.load_components(system, chain, force)


def _is_replaced(system):
    """Whether the user has loaded a package of the library ``system`` from a file; then that counts, and a warning says so."""
    if not is_library(str(system.file)):
        return False
    names = [system.name.upper(), *(package for package, library in LIBRARY_PACKAGES.items() if library == system.name)]
    for package in filter(None, map(find_package, names)):
        if package.file is not None and not is_library(package.file):
            if system.name not in loaded:
                text = "The library ~A of ~A is not loaded, because ~A has defined its package ~A: that counts."
                warn(text, system.name, str(Path(system.file).parent), package.file, package.name)
            return True
    return False


def _instead_of_ours(name, load):
    """The value of ``load()``, which loads the files of the system ``name``. If it is preferred, it redefines ours and need not say so."""
    if name not in preferred or not (name in built_in or name in LIBRARY_PACKAGES.values()):
        return load()
    answers = [(FunctionInTheWay, lambda _: _choose("CONTINUE")), (RedefinitionWarning, lambda _: _choose("MUFFLE-WARNING"))]
    return handler_bind(answers, load)


def _choose(restart):
    found = find_restart(sym(restart))
    if found is not None:
        invoke_restart(found)


loaded: dict = per_image({})
"""Name of each system that was loaded → its fingerprint."""


def forget_system(name):
    """Forget the definition of the system ``name`` and that its files were loaded; whether there was one."""
    system = systems.pop(name, None)
    loaded.pop(name, None)
    if system is None:
        return False
    performing.forget_files(system)
    _read.pop(system.file, None)
    return True
