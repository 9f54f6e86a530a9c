"""Nothing in the source writes a file but through the room ``storage``; the exceptions stand here with their reasons."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from source_trees import nodes_of, tree_of

SOURCE = Path(__file__).parents[2] / "src" / "cramhy_runtime"
WRITERS = {
    "write_text",
    "write_bytes",
    "save",
    "mkstemp",
    "mkdtemp",
    "NamedTemporaryFile",
    "TemporaryFile",
    "copyfile",
    "copy",
    "copy2",
    "copytree",
    "move",
    "touch",
    "symlink_to",
    "FileIO",
}
RENAMERS = {"replace", "rename", "renames", "link"}
EXCEPT = {
    ("browser/pyodide_files.py", "write_bytes"): "into the folder of a site that is being made, which appears as a whole",
    ("browser/site.py", "write_bytes"): "as above",
    ("browser/packing.py", "write_bytes"): "into the memory of the Python that compiles a site's files",
    ("browser/site.py", "write_text"): "as above",
    ("browser/site.py", "copy2"): "as above",
    ("grading/sandbox/folders.py", "open"): "a folder, to allow it: nothing is written",
    ("grading/processes.py", "mkdtemp"): "the folder for those of submissions, which goes with the fork server",
    ("grading/watcher.py", "mkdtemp"): "the folder of a submission, which goes after it",
    ("grading/sandbox/removal.py", "open"): "a folder, to remove what is in it",
    ("grading/performing.py", "write_text"): "the files of a submission, in this folder",
    ("grading/tests_inside.py", "write_text"): "as above",
    ("cli/process_environment.py", "open"): "the null device, in place of a stream that is closed",
    (
        "languages/commonlisp/files/file_streams.py",
        "open",
    ): "Lisp's :append and :overwrite change a file where it is, as they should; devices, too",
    ("languages/commonlisp/files/files.py", "rename"): "rename-file renames a file that the user named",
    ("languages/commonlisp/uiop/files.py", "mkstemp"): "UIOP's files that a program wants for a moment, and its new, empty ones",
    ("languages/commonlisp/uiop/processes.py", "open"): "a file that another program appends to",
    ("repl/history.py", "open"): "forms are appended, each in a piece, to a file that sessions share",
    ("ros/roslisp/log_file.py", "open"): "a log is appended to, line by line",
    ("rosbridge/sessions.py", "fdopen"): "session files have rules of their own; they are written beside their place and renamed there",
    ("rosbridge/sessions.py", "mkstemp"): "as above",
    ("rosbridge/sessions.py", "replace"): "as above",
    ("rosbridge/encoding.py", "save"): "a picture in memory, for a page",
    ("turtlesim/stills.py", "save"): "into the file that storage gave",
    ("languages/commonlisp/faces/turtlesim/package.py", "save"): "pictures.save, of this room",
    ("cli/servers.py", "save"): "pictures.save",
    ("actionlib/client.py", "move"): "the state of a goal",
    ("languages/commonlisp/streams/stream_functions.py", "write_bytes"): "into a stream of Lisp's, which has opened its file",
    ("chronicle/chronicler.py", "move"): "a thing in a robot's world",
    ("swank/calls/compiling.py", "mkdtemp"): "a folder for what Emacs compiles, which goes with the connection",
    ("repl/answer_streams.py", "TemporaryFile"): "what a form prints, until its answer is sent",
    ("swank/sockets.py", "link"): "the name of a socket, which has no content",
    ("robot_world/pictures/stills.py", "save"): "into memory, from which storage writes it",
    ("languages/commonlisp/faces/robot_world/picture_calls.py", "save"): "Movie.save, which writes by way of storage",
    ("jupyter/pictures.py", "save"): "into memory, for a notebook",
    ("lsp/stdio.py", "fdopen"): "the standard output that the editor reads",
    ("robot/worlds.py", "save"): "as above",
}
MEMORY = {"np", "copy", "each"}


def _mode(call):
    """The mode that a call of ``open`` or ``fdopen`` names; "?" if it is computed."""
    given = call.args[1:2] + [word.value for word in call.keywords if word.arg in ("mode", "flags")]
    if not given:
        return "r"
    return given[0].value if isinstance(given[0], ast.Constant) else "?"


def writings(path):
    """The (line, name) of each call in a file that writes to a disk, or might."""
    for node in nodes_of(tree_of(path)):
        if not isinstance(node, ast.Call):
            continue
        function = node.func
        name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
        owner = getattr(getattr(function, "value", None), "id", "")
        if name in ("open", "fdopen") and (owner in ("", "os", "io", "gzip", "codecs") or name == "fdopen"):
            if node.args and owner == "os" and name == "open":
                if "O_RDONLY" not in ast.unparse(node):
                    yield node.lineno, name
            elif node.args and not set(_mode(node)).isdisjoint("wax+?"):
                yield node.lineno, name
        elif name in WRITERS and owner not in MEMORY and isinstance(function, ast.Attribute) and not _of_memory(name, node):
            yield node.lineno, name
        elif name in RENAMERS and (owner in ("os", "shutil") or len(node.args) == 1 and not node.keywords and "path" in owner.lower()):
            yield node.lineno, name


def _of_memory(name, call):
    """``dict.copy()`` and ``world.copy(other)``; one that copies a file is told two names."""
    return name == "copy" and len(call.args) < 2


FILES = [path for path in sorted(SOURCE.rglob("*.py")) if path.relative_to(SOURCE).parts[0] != "storage"]


def test_files_are_written_in_one_way():
    found = {(path.relative_to(SOURCE).as_posix(), name): line for path in FILES for line, name in writings(path)}
    assert {f"{path}:{line} {name}" for (path, name), line in found.items() if (path, name) not in EXCEPT} == set()
    assert set(EXCEPT) <= set(found), "an exception that is not needed any more"


@pytest.mark.parametrize(
    "text",
    [
        'open(path, "w")',
        'open(path, mode="wb")',
        'open(path, "a")',
        'open(path, "r+b")',
        "open(path, mode)",
        'io.open(path, "x")',
        'os.fdopen(handle, "w")',
        "os.open(path, os.O_WRONLY)",
        "Path(path).write_text(text)",
        "path.write_bytes(data)",
        "image.save(path)",
        "tempfile.mkstemp()",
        "os.replace(one, other)",
        "os.rename(one, other)",
        "shutil.copyfile(one, other)",
        "temporary_path.rename(other)",
    ],
)
def test_the_ways_that_are_found(tmp_path, text):
    (tmp_path / "x.py").write_text(f"def f():\n    {text}\n")
    assert [line for line, _ in writings(tmp_path / "x.py")] == [2]


@pytest.mark.parametrize(
    "text", ['open(path, "rb")', "open(path)", 'text.replace("a", "b")', "os.open(path, os.O_RDONLY)", "table.copy()", "world.copy(other)"]
)
def test_what_only_reads_is_no_way_of_writing(tmp_path, text):
    (tmp_path / "x.py").write_text(text)
    assert not list(writings(tmp_path / "x.py"))
