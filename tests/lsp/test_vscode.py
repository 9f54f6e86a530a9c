"""The extension of VS Code: its manifest fits its parts, its grammars colour texts, its client finds forms, and it can be packaged."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import cramhy_runtime

from .mistakes import COURSE, HIGH, HY, ROOT

EXTENSION = Path(__file__).parents[2] / "editors" / "vscode"
MANIFEST = json.loads((EXTENSION / "package.json").read_text(encoding="utf-8"))
CLIENT = (EXTENSION / "client" / "extension.js").read_text(encoding="utf-8")
node = pytest.mark.skipif(not shutil.which("node"), reason="node is missing")
grammars = pytest.mark.skipif(not (EXTENSION / "node_modules" / "vscode-textmate").is_dir(), reason="vscode-textmate is missing")


def test_the_manifest_names_what_there_is():
    contributed = MANIFEST["contributes"]
    for part in (*contributed["grammars"], *contributed["languages"]):
        assert (EXTENSION / (part.get("path") or part["configuration"])).is_file()
    assert (EXTENSION / MANIFEST["main"]).is_file()
    assert MANIFEST["version"] == cramhy_runtime.__version__ and MANIFEST["license"] == "BSD-3-Clause"
    commands = {each["command"] for each in contributed["commands"]}
    assert commands == set(re.findall(r'^    "(cramhy\.\w+)":', CLIENT, re.M))
    used = [*contributed["keybindings"], *contributed["menus"]["editor/context"]]
    assert {each["command"] for each in used} <= commands
    settings = {name.removeprefix("cramhy.") for name in contributed["configuration"]["properties"]}
    assert settings == set(re.findall(r'getConfiguration\("cramhy"\)\.get\("(\w+)"\)', CLIENT))
    assert "cramhy.interrupt" not in commands, "the server has that one, and a command has one owner"


def test_files_of_the_extension_are_those_of_cramhy():
    extensions = {each for language in MANIFEST["contributes"]["languages"] for each in language["extensions"]}
    assert {".lisp", ".asd", ".hy"} <= extensions
    assert not MANIFEST["capabilities"]["untrustedWorkspaces"]["supported"], "macros of the files run"
    assert "BSD" in (EXTENSION / "LICENSE").read_text(encoding="utf-8")


def run_node(program):
    done = subprocess.run(["node", "-e", program], capture_output=True, text=True, timeout=60, cwd=EXTENSION / "client")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


TEXT = """(in-package :tut)
;; (not a form
(defun f (x) "a ) in a string"
  (list #\\( x)) ; end
(broken (form
(g 1)
"""


@node
def test_the_form_at_the_cursor():
    text = json.dumps(TEXT)
    at = [TEXT.index("defun"), TEXT.index("; end"), TEXT.index("broken") + 1, len(TEXT), TEXT.index("not a")]
    found = run_node(f"const f = require('./forms'); console.log(JSON.stringify({at}.map((each) => f.formAt({text}, each))))")
    defun = TEXT[TEXT.index("(defun") : TEXT.index(" ; end")]
    assert found == [defun, defun, "", "(g 1)", ""]


@node
def test_the_editor_of_the_tab_finds_the_same_forms():
    """VS Code loads scripts of Node, a browser modules, so each has its own file: they agree at every tenth place of the course's files."""
    tab = Path(cramhy_runtime.__file__).parent / "browser" / "static" / "forms.js"
    texts = [TEXT, *(file.read_text(encoding="utf-8") for file in sorted(COURSE.rglob("*.hy"))[:6])]
    program = f"""const f = require('./forms');
        import("data:text/javascript;base64," + require('fs').readFileSync({json.dumps(str(tab))}).toString('base64')).then((t) => {{
          const differ = [];
          let looked = 0;
          for (const text of {json.dumps(texts)})
            for (let at = 0; at <= text.length; at += 10, looked++) {{
              const both = [[f.formAt(text, at), f.packageAt(text, at)], [t.formAt(text, at)?.text ?? "", t.surroundings(text, at, "x.lisp").name ?? ""]];
              if (JSON.stringify(both[0]) !== JSON.stringify(both[1])) differ.push([at, ...both]);
            }}
          console.log(JSON.stringify([looked > 300, differ]));
        }});"""
    assert run_node(program) == [True, []]


@node
def test_the_package_and_what_is_sent_to_the_prompt():
    text = json.dumps(TEXT)
    program = f"""const f = require('./forms');
        console.log(JSON.stringify([f.packageAt({text}, 0), f.packageAt({text}, 60), f.forPrompt('(a\\n\\n b)', 'tut'), f.forPrompt('(a)', ''),
                                    f.literal('C:\\\\x "y"')]))"""
    assert run_node(program) == ["", "tut", ['(cl:in-package "TUT")', "(a", " b)"], ["(a)"], '"C:\\\\x \\"y\\""']


@node
def test_the_program_and_the_page():
    program = """const p = require('./programs'), v = require('./view');
        const there = (name) => name === '/w/.venv/bin/cramhy';
        console.log(JSON.stringify([p.find('', ['/x', '/w'], 'linux', there), p.find('', ['/x'], 'linux', there), p.find('mine', ['/w'], 'linux', there),
          v.isOurs('http://127.0.0.1:8000/?token=1'), v.isOurs('https://example.org'), v.isOurs('x')]))"""
    assert run_node(program) == ["/w/.venv/bin/cramhy", "cramhy", "mine", True, False, False]


@pytest.mark.skipif(not shutil.which("sh"), reason="sh is missing")
def test_the_address_of_the_page_is_noted_for_the_user_alone(tmp_path):
    file = tmp_path / "address"
    script = EXTENSION / "client" / "note-address.sh"
    subprocess.run(
        ["sh", script, "http://127.0.0.1:1/?token=x&y='"], env={"CRAMHY_ADDRESS_FILE": str(file), "PATH": "/bin:/usr/bin"}, check=True
    )
    assert file.read_text() == "http://127.0.0.1:1/?token=x&y='\n" and file.stat().st_mode & 0o077 == 0


def scopes(scope, file):
    done = subprocess.run(
        ["node", Path(__file__).parent / "node" / "scopes.js", EXTENSION, scope, file], capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    return [tuple(token) for line in json.loads(done.stdout) for token in line]


@pytest.mark.soak
@node
@grammars
def test_the_grammars_colour_the_course(tmp_path):
    found = set(scopes("source.hy.cramhy", HIGH))
    inside = "meta.embedded.commonlisp "
    for text, kind in [
        ("defun", "storage.type.function.commonlisp"),
        ("draw-house", "entity.name.function.commonlisp"),
        ("with-failure-handling", "keyword.control.plan.commonlisp"),
        ("exe:perform", "keyword.control.plan.commonlisp"),
        ("desig:an", "keyword.control.plan.commonlisp"),
        ("?vertex", "variable.other.logic.commonlisp"),
        ("*turtle-pose*", "variable.other.special.commonlisp"),
        ("4.5", "constant.numeric.commonlisp"),
        ("~a", "string.quoted.double.commonlisp constant.other.placeholder.commonlisp"),
        ("&optional", "storage.modifier.commonlisp"),
        (";; the walls", "comment.line.semicolon.commonlisp"),
    ]:
        assert (text, inside + kind) in found, (text, [each for each in found if each[0] == text])
    found = set(scopes("source.hy.cramhy", HY))
    assert {("defn", "storage.type.function.hy"), ("pursue", "keyword.control.plan.hy"), ("while", "keyword.control.hy")} <= found
    assert not any("embedded" in kind for _, kind in found), "plain Hy stays Hy"
    file = tmp_path / "x.lisp"
    file.write_text('#| a #| nested |# b |# (f #\\( "x\\"y" :key 1/2 \'nil)\n', encoding="utf-8")
    found = scopes("source.commonlisp.cramhy", file)
    assert ("#\\(", "constant.character.commonlisp") in found and ("1/2", "constant.numeric.commonlisp") in found
    assert (":key", "constant.other.keyword.commonlisp") in found and ("nil", "constant.language.commonlisp") in found


@pytest.mark.soak
@node
@grammars
def test_no_file_of_the_course_confuses_the_grammars():
    for file in [ROOT / "spiral.lisp", *sorted(ROOT.glob("turtlesim_in_hy/*.hy"))[:3]]:
        scope = "source.hy.cramhy" if file.suffix == ".hy" else "source.commonlisp.cramhy"
        found = scopes(scope, file)
        code = "".join(text for text, kind in found if not kind.startswith(("comment", "string")))
        assert code.count("(") == code.count(")") and code.count("[") == code.count("]")


@pytest.mark.soak
@node
@grammars
def test_it_can_be_packaged(tmp_path):
    target = tmp_path / "cramhy.vsix"
    vsce = EXTENSION / "node_modules" / ".bin" / "vsce"
    done = subprocess.run(
        [vsce, "package", "--allow-missing-repository", "--out", target], cwd=EXTENSION, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr
    names = zipfile.ZipFile(target).namelist()
    assert "extension/client/extension.js" in names and "extension/syntaxes/hy.tmLanguage.json" in names
    assert any(name.startswith("extension/node_modules/vscode-languageclient/") for name in names)
    assert not any("vscode-textmate" in name or name.endswith("package-lock.json") for name in names)


@node
@pytest.mark.skipif(not (EXTENSION / "node_modules" / "vscode-languageclient").is_dir(), reason="vscode-languageclient is missing")
def test_the_client_speaks_with_the_server(tmp_path):
    """The extension's own code and the library of VS Code for such clients, with what VS Code offers them, start the real server."""
    course = tmp_path / "course"
    shutil.copytree(COURSE, course)
    file = course / "src" / HIGH.name
    file.write_text(file.read_text(encoding="utf-8").replace("(rotate-to goal)", "(rotate-too goal)"), encoding="utf-8")
    cramhy = Path(sys.executable).parent / "cramhy"
    words = ["node", Path(__file__).parent / "node" / "drive.js", EXTENSION, cramhy, file]
    done = subprocess.run(words, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr[-3000:]
    found = json.loads(done.stdout.splitlines()[-1])
    contributed = {each["command"] for each in MANIFEST["contributes"]["commands"]}
    assert set(found["commands"]) == contributed | {"cramhy.run", "cramhy.test", "cramhy.interrupt"}
    assert [(line, severity) for line, severity, _ in found["told"]] == [(63, 1)] and "ROTATE-TOO" in found["told"][0][2]
    assert {"registerCompletionItemProvider", "registerHoverProvider", "registerCodeLensProvider"} <= set(found["providers"])
    prompt, page = found["terminals"]
    assert prompt[0] == ["repl", "--time", "virtual"] and page[0] == [*prompt[0], "--view"]
    assert prompt[2][:2] == ['(cl:in-package "TUT")', "(defun perform-draw-house ()"] and prompt[2][-1] == f'(cl:load "{file}")'
    assert page[1] == ["BROWSER", "CRAMHY_ADDRESS_FILE"]
    assert found["ran"]["status"] == 0 and found["ran"]["what"] == "(tut::init) (tut::perform-draw-house)"
    assert found["interrupted"] == 0
