"""Which names the package UIOP has. `complete` is called when a program first names something of it that is not there yet."""

from __future__ import annotations

from cramhy_runtime.lisp_core.conditions import Condition, handler_bind
from cramhy_runtime.lisp_core.data import list_from
from cramhy_runtime.lisp_core.functions import function_of
from cramhy_runtime.lisp_core.keyword_calls import lispify
from cramhy_runtime.lisp_core.packages import find_package_or_error, keyword, sym
from cramhy_runtime.lisp_core.restarts import find_restart, invoke_restart
from cramhy_runtime.kernel.typing_names import Any

from ..packages.face_definition import define_face
from ..pathnames.pathname_objects import RELATIVE, WILD, WILD_INFERIORS, Pathname
from ..pathnames.pathnames import make_pathname
from ..sbcl.atomics import define as define_macro
from ..streams import streams as standard_streams
from . import building, configuration, files, macros, packages, pathnames, processes, settings, streams, utilities


def call_with_muffled_conditions(thunk: Any, conditions: Any) -> Any:
    """``uiop:call-with-muffled-conditions``: the values of ``thunk``, in which conditions of these kinds are muffled."""

    def muffle(condition: Any) -> None:
        restart = find_restart(sym("MUFFLE-WARNING"))
        if restart is not None and utilities.match_any_condition_p(condition, conditions):
            invoke_restart(restart)

    return handler_bind([(Condition, muffle)], function_of(thunk))


def nothing(*arguments: object) -> None:
    """Functions that change how images are saved and files compiled, of which there is nothing here."""


_NAMED = {
    "length=n-p": utilities.length_is,
    "reduce/strcat": utilities.reduce_strcat,
    "timestamp<": utilities.timestamp_less,
    "timestamp<=": utilities.timestamp_not_more,
    "timestamps<": utilities.timestamps_rise,
    "lexicographic<": utilities.lexicographic_less,
    "lexicographic<=": utilities.lexicographic_not_more,
    "subpathname*": pathnames.subpathname_of_folder,
    "merge-pathnames*": pathnames.merge_pathnames_as_given,
    "translate-pathname*": pathnames.translate_pathname_or_function,
    "make-pathname*": make_pathname,
    "parse-unix-namestring": pathnames.parse_unix_namestring,
    "coerce-pathname": pathnames.parse_unix_namestring,
    "truename*": files.truename_if_any,
    "resolve-symlinks*": lambda path: files.truename_if_any(path) or path,
    "resolve-symlinks": lambda path: files.truename_if_any(path) or path,
    "truenamize": lambda path: files.truename_if_any(path) or path,
    "directorize-pathname-host-device": lambda path: path,
    "directory*": lambda path: files.directory(path, resolve_symlinks=None),
    "collect-sub*directories": files.collect_subfolders,
    "format!": streams.format_at_once,
    "safe-format!": streams.format_at_once,
    "read-file-form": streams.read_file_form,
    "read-file-line": streams.read_file_line,
    "read-file-lines": streams.read_file_lines,
    "read-file-string": streams.read_file_string,
    "intern*": packages.intern_,
    "export*": packages.export_,
    "import*": packages.import_,
    "shadowing-import*": packages.shadowing_import,
    "shadow*": packages.shadow,
    "unintern*": packages.unintern,
    "make-symbol*": packages.make_symbol_,
    "delete-package*": packages.delete_package_,
    "quit": processes.quit_,
    "compile-file-pathname*": configuration.compile_file_pathname_or_given,
    "version-deprecation": lambda version, *levels: None,
    "call-with-muffled-conditions": call_with_muffled_conditions,
    "compile-file-type": lambda: "fasl",
    "compile-file*": building.compile_file_or_complain,
    "load*": building.load_file_or_stream,
    "timestamp*<": settings.times_rise,
    **{name: building.not_here(name) for name in building.NOT_HERE},
    **dict.fromkeys(
        """call-image-restore-hook call-image-dump-hook register-image-restore-hook register-image-dump-hook setup-temporary-directory
        setup-stdin setup-stdout setup-stderr clear-configuration register-clear-configuration-hook proclaim-optimization-settings
        get-optimization-settings enable-deferred-warnings-check disable-deferred-warnings-check
        setup-command-line-arguments""".split(),
        nothing,
    ),
}
"""Functions whose names Python does not take, and those that stand for several."""
_CONDITIONS = "subprocess-error parameter-error not-implemented-error process-info invalid-configuration " + building.CONDITIONS
_CALLS = "package-defined"
_WILD = {
    "*wild*": WILD,
    "*wild-file*": Pathname(name=WILD, type=WILD),
    "*wild-directory*": Pathname(directory=(RELATIVE, WILD)),
    "*wild-inferiors*": Pathname(directory=(RELATIVE, WILD_INFERIORS)),
    "*wild-path*": Pathname(directory=(RELATIVE, WILD_INFERIORS), name=WILD, type=WILD),
    "*nil-pathname*": Pathname(),
    "*wild-file-for-directory*": Pathname(name=WILD, type=WILD),
}


def _functions(module: Any, names: str) -> dict[Any, Any]:
    return {module: " ".join(name for name in names.split() if name not in _NAMED)}


def complete() -> None:
    """Make the package UIOP complete."""
    muffled = list_from([sym("STYLE-WARNING")])
    define_face(
        "UIOP",
        functions={
            **_functions(utilities, utilities.FUNCTIONS),
            **_functions(pathnames, pathnames.FUNCTIONS),
            **_functions(files, files.FUNCTIONS),
            **_functions(streams, streams.FUNCTIONS),
            **_functions(processes, processes.FUNCTIONS),
            **_functions(packages, packages.FUNCTIONS),
            **_functions(configuration, configuration.FUNCTIONS),
            **_functions(building, building.FUNCTIONS),
            **_functions(settings, settings.FUNCTIONS),
            **_NAMED,
        },
        variables={
            **_WILD,
            "*stdin*": standard_streams.CONSOLE_INPUT,
            "*stdout*": standard_streams.CONSOLE_OUTPUT,
            "*stderr*": standard_streams.CONSOLE_ERROR,
            "*temporary-directory*": None,
            "*user-cache*": None,
            "*image-restore-hook*": None,
            "*image-dump-hook*": None,
            "*image-dumped-p*": None,
            "*image-entry-point*": None,
            "*lisp-interaction*": True,
            "*uiop-version*": "3.3.1",
            "*implementation-type*": keyword("CRAMHY"),
            "*default-encoding*": keyword("DEFAULT"),
            "*utf-8-external-format*": keyword("UTF-8"),
            "*default-stream-element-type*": sym("CHARACTER"),
            "*compile-file-failure-behaviour*": keyword("ERROR"),
            "*compile-file-warnings-behaviour*": keyword("WARN"),
            "*compile-check*": None,
            "*uninteresting-conditions*": None,
            "*usual-uninteresting-conditions*": muffled,
            "*uninteresting-compiler-conditions*": muffled,
            "*uninteresting-loader-conditions*": muffled,
            "*optimization-settings*": None,
            "*unspecific-pathname-type*": keyword("UNSPECIFIC"),
            "*output-translation-function*": sym("IDENTITY"),
            "*resolve-symlinks*": True,
            "*base-build-directory*": None,
            "*clear-configuration-hook*": None,
            "*encoding-detection-hook*": sym("UIOP::ALWAYS-DEFAULT-ENCODING"),
            "*encoding-external-format-hook*": sym("UIOP::DEFAULT-ENCODING-EXTERNAL-FORMAT"),
            "*here-directory*": None,
            "*ignored-configuration-form*": None,
            "*image-postlude*": None,
            "*image-prelude*": None,
            "*previous-optimization-settings*": None,
            "*uiop-debug-utility*": None,
            "*warnings-file-type*": None,
            "+character-types+": sym("VECTOR").function(sym("BASE-CHAR"), sym("CHARACTER")),
            "+max-character-type-index+": 1,
            "+non-base-chars-exist-p+": True,
            "+cr+": "\r",
            "+lf+": "\n",
            "+crlf+": "\r\n",
        },
        export=_CONDITIONS,
    )
    define_face("UIOP", functions={"package-defined": packages.define_package}, internal=_CALLS)
    home = find_package_or_error("UIOP")
    building.define_types()
    for name, expand in {**macros.MACROS, **building.MACROS}.items():
        symbol = home.intern(name)
        home.export(symbol)
        define_macro(symbol, expand)
    sym("UIOP::GETENV").setf_function = lispify(files.set_getenv)
