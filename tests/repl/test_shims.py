"""``cramhy ros-shims``: functions for real shells, programs in a folder, and what is said of a ROS command without ``ros``."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cramhy_runtime.cli import options, shells, shims

NO_SESSION = (
    "No master is needed: the ROS graph lives in the process of roslisp_repl.\n"
    "No session serves here yet. Start one with: roslisp_repl --serve, or rosrun turtlesim turtlesim_node\n"
)
SHELLS = {  # how each reads a program: functions, then the commands that follow
    "bash": ["bash", "--norc", "--noprofile"],
    "zsh": ["zsh", "-f"],
    "dash": ["dash"],
    "mksh": ["mksh"],
    "busybox": ["busybox", "sh"],
    "fish": ["fish", "--no-config"],
    "pwsh": ["pwsh", "-NoProfile", "-NonInteractive", "-Command", "-"],
}
LANGUAGES = {"fish": "fish", "pwsh": "powershell"}  # of those that do not read POSIX's
STATUS = {"fish": "echo $status", "pwsh": "echo $LASTEXITCODE"}
WHERE = {"pwsh": "(Get-Location).Path"}
FOLDERS = ["plain", "with a space", """it's "$HOME" `id` \\ and * too"""]


IN_FOLDERS = [*(("bash", folder) for folder in FOLDERS[:2]), *((shell, FOLDERS[2]) for shell in SHELLS)]


@pytest.fixture
def clone(request, tmp_path):
    """A folder with the name of the test's parameter, in whose ``.venv`` the Python of these tests is installed once more."""
    folder = tmp_path / getattr(request, "param", FOLDERS[2])
    environment = folder / ".venv"
    (environment / "bin").mkdir(parents=True)
    mine = Path(sys.prefix)
    if sys.prefix == sys.base_prefix or os.name == "nt":
        pytest.skip("the tests do not run in a virtual environment of POSIX's, of which another could be made")
    (environment / "bin" / "python").symlink_to(os.path.realpath(sys.executable))
    (environment / "pyvenv.cfg").write_text((mine / "pyvenv.cfg").read_text())
    (environment / "lib").symlink_to(mine / "lib")
    return folder


def bare(tmp_path, **more):
    """An environment in which the PATH finds neither cramhy nor a ROS, and no session serves."""
    runtime = tmp_path / "run"
    runtime.mkdir(mode=0o700, exist_ok=True)
    kept = {key: value for key, value in os.environ.items() if key not in ("ROS_PACKAGE_PATH", "VIRTUAL_ENV", "PYTHONPATH")}
    return {**kept, "PATH": str(tmp_path / "nothing"), "XDG_RUNTIME_DIR": str(runtime), "HOME": str(tmp_path), "SHELL": "/bin/sh", **more}


def functions(clone, tmp_path, *words):
    """What ``cramhy ros-shims`` of that clone prints."""
    done = subprocess.run(
        [clone / ".venv/bin/python", "-m", "cramhy_runtime.cli", "ros-shims", *words],
        env=bare(tmp_path),
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def typed(shell, text, tmp_path, folder=None):
    """What a shell does that reads ``text`` from its input: (output, complaints, status)."""
    program = shutil.which(SHELLS[shell][0])
    if program is None:
        pytest.skip(f"{shell} is not installed here")
    done = subprocess.run(
        [program, *SHELLS[shell][1:]], input=text, text=True, capture_output=True, env=bare(tmp_path), timeout=120, cwd=folder or tmp_path
    )
    return done.stdout, done.stderr, done.returncode


@pytest.mark.soak
@pytest.mark.parametrize(("shell", "clone"), IN_FOLDERS, indirect=["clone"])
def test_the_functions_work_where_nothing_is_on_the_path(shell, clone, tmp_path):
    language, status, where = LANGUAGES.get(shell, "sh"), STATUS.get(shell, "echo $?"), WHERE.get(shell, "pwd")
    (tmp_path / "cramhy_runtime").mkdir(exist_ok=True)  # the current folder is not where modules are looked for
    (tmp_path / "cramhy_runtime" / "__init__.py").write_text("raise SystemExit('the wrong cramhy')")
    out, complaints, _ = typed(
        shell,
        functions(clone, tmp_path, "--shell", language)
        + f"""
roscore
rosversion 'no such package'
{status}
rosmsg show geometry_msgs/Point
cramhy run --eval '(print (quote (1 "a b" $HOME)))' --time virtual nothing.lisp
{status}
roscd turtlesim
{where}
roscd no_such_package
{status}
{where}
""",
        tmp_path,
    )
    lines = out.splitlines()
    folder = next(line for line in lines if line.endswith("/turtlesim"))
    assert lines == [*NO_SESSION.splitlines(), "1", "float64 x", "float64 y", "float64 z", "", "1", folder, "1", folder]
    assert complaints == (
        "Cannot locate [no such package]\n"
        f"cramhy: FILE-ERROR\n  Cannot load {tmp_path}/nothing.lisp: No such file or directory.\n"
        "roscd: No such package/stack 'no_such_package'\n"
    )


@pytest.mark.soak
@pytest.mark.parametrize("shell", SHELLS)
def test_roslisp_repl_serves_so_that_other_terminals_find_it(shell, clone, tmp_path):
    pytest.importorskip("uvicorn")
    out, complaints, status = typed(
        shell,
        functions(clone, tmp_path, "--shell", LANGUAGES.get(shell, "sh")) + "roslisp_repl --eval '(print (list 1 \"a b\"))'\n",
        tmp_path,
    )
    assert '(1 "a b")' in out and status == 0
    assert complaints.startswith("; Clients of rosbridge: ws://127.0.0.1:")


def test_eval_defines_them_as_the_readme_says(clone, tmp_path):
    script = clone / ".venv/bin/cramhy"
    script.write_text(f'#!/bin/sh\nexec {shlex.quote(str(clone / ".venv/bin/python"))} -m cramhy_runtime.cli "$@"\n')
    script.chmod(0o755)
    out, complaints, status = typed("bash", 'eval "$(.venv/bin/cramhy ros-shims)"\ncd /\nrosversion -d\n', tmp_path, clone)
    assert (out, complaints, status) == ("noetic\n", "", 0)


def test_every_command_of_the_slides_is_defined(tmp_path, clone):
    names = {line.partition("(")[0] for line in functions(clone, tmp_path).splitlines()}
    assert names == {"cramhy", "roslisp_repl", "roscd", *shims.TOOLS}


def test_the_shells_of_the_option_are_those_that_are_known():
    for shell in shells.FUNCTIONS:
        assert options.parser().parse_args(["ros-shims", "--shell", shell]).shell == shell
    with pytest.raises(SystemExit):
        options.parser().parse_args(["ros-shims", "--shell", "cobol"])


POWERSHELL_WORDS = {
    "plain": "'plain'",
    "": "''",
    "it's": "'it''s'",
    "C:\\a b\\$HOME `id`": "'C:\\a b\\$HOME `id`'",
    "J\xfcrgen": "('' + 'J' + [char]0xFC + 'rgen')",
    "\u2019": "('' + [char]0x2019)",  # which ends a text that begins with ', to PowerShell
    "\U0001f422 a": "('' + [char]::ConvertFromUtf32(0x1F422) + ' a')",
    "a\nb": "('' + 'a' + [char]0xA + 'b')",
}


@pytest.mark.parametrize("word", POWERSHELL_WORDS)
def test_powershell_reads_each_word_as_it_is(word):
    assert shells.powershell("cramhy", ["python", word]) == (
        "function cramhy { if ($MyInvocation.ExpectingInput) "
        f"{{ $input | & 'python' {POWERSHELL_WORDS[word]} @args }} else {{ & 'python' {POWERSHELL_WORDS[word]} @args }} }}\n"
    )


def test_in_powershell_roscd_changes_the_folder_only_when_there_is_one(clone, tmp_path):
    (line,) = [each for each in functions(clone, tmp_path, "--shell", "powershell").splitlines() if each.startswith("function roscd ")]
    assert line.startswith("function roscd { $to = & ") and line.isascii()
    assert line.endswith(" 'ros' 'roscd' @args; if ($LASTEXITCODE -eq 0) { Set-Location -LiteralPath $to } }")


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("shell", shells.FUNCTIONS)
def test_each_command_is_a_line_of_its_own(clone, tmp_path, shell):
    """`Invoke-Expression` and `source` may read them one by one."""
    assert len(functions(clone, tmp_path, "--shell", shell).splitlines()) == len({"cramhy", "roslisp_repl", "roscd", *shims.TOOLS})


@pytest.mark.parametrize(
    ("system", "shell", "line"),
    [
        ("posix", "/bin/bash", 'eval "$(a/cramhy ros-shims)"'),
        ("posix", "/usr/bin/zsh", 'eval "$(a/cramhy ros-shims)"'),
        ("posix", "/usr/bin/fish", "a/cramhy ros-shims --shell fish | source"),
        ("nt", "", "a/cramhy ros-shims | Invoke-Expression"),
        ("nt", "/usr/bin/bash", 'eval "$(a/cramhy ros-shims)"'),
    ],
)
def test_the_hint_is_a_line_of_the_users_shell(monkeypatch, system, shell, line):
    monkeypatch.setattr(shells.os, "name", system)
    monkeypatch.setenv("SHELL", shell)
    assert shells.line("a/cramhy") == line


# ------------------------------------------------------------------------------------------------------- without ``ros``


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    ("words", "meant"),
    [
        (["rostopic", "echo", "/turtle1/pose"], "ros rostopic echo /turtle1/pose"),
        (["rosservice", "call", "/spawn", "1 2"], "ros rosservice call /spawn '1 2'"),
        (["roscd"], "ros roscd"),
        (["catkin_make"], "ros catkin_make"),
        (["roslaunch", "-h"], "ros roslaunch -h"),
        (["roslisp_repl", "--view"], "repl --view"),
    ],
)
def test_a_ros_command_without_ros_is_told_its_right_shape(cramhy, monkeypatch, words, meant):
    monkeypatch.setenv("SHELL", "/bin/sh")
    done = cramhy(*words)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == (
        f"cramhy: {words[0]} is a command of ROS. Type: cramhy {meant}\n"
        'Or make it a command of this shell first: eval "$(cramhy ros-shims)"\n'
    )


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("words", [["rosbag"], ["rosnothing", "list"], ["catkin"]])
def test_another_word_is_refused_with_the_commands_that_there_are(cramhy, words):
    done = cramhy(*words)
    assert done.returncode == 2 and f"argument COMMAND: invalid choice: '{words[0]}'" in done.stderr


def test_ros_alone_tells_its_usage(cramhy):
    for words, status in ((["ros"], 2), (["ros", "--help"], 0)):
        done = cramhy(*words)
        assert done.returncode == status and "usage: cramhy ros COMMAND [WORD ...]" in done.stdout + done.stderr


@pytest.mark.parametrize(
    ("called", "on_path", "name"),
    [
        ("cramhy_runtime/cli/__main__.py", None, "cramhy"),
        (".venv/bin/cramhy", None, ".venv/bin/cramhy"),
        ("a b/cramhy", None, "'a b/cramhy'"),
        ("bin/cramhy", "bin", "cramhy"),
        ("bin/cramhy", "other", "bin/cramhy"),
    ],
)
def test_the_hint_calls_cramhy_as_the_user_did(tmp_path, monkeypatch, called, on_path, name):
    for folder in ("bin", "other"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "cramhy").write_text("#!/bin/sh\n")
        (tmp_path / folder / "cramhy").chmod(0o755)
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("PATH", str(tmp_path / on_path) if on_path else "")
    monkeypatch.setattr(sys, "argv", [called])
    assert shims.own_name() == name


# ------------------------------------------------------------------------------------------------------------ installed


@pytest.mark.soak
def test_they_are_installed_into_a_folder(clone, tmp_path):
    def install():
        return subprocess.run(
            [clone / ".venv/bin/python", "-m", "cramhy_runtime.cli", "ros-shims", "--install", tmp_path / "bin"],
            env=bare(tmp_path),
            text=True,
            capture_output=True,
            timeout=60,
        )

    first = install()
    assert (first.returncode, first.stderr) == (0, "") and first.stdout.startswith("Wrote cramhy, roslisp_repl, catkin_create_pkg, ")
    hint = first.stdout.rpartition("must be a shell function: ")[2]
    done = subprocess.run([tmp_path / "bin" / "roscore"], capture_output=True, text=True, env=bare(tmp_path), timeout=60)
    assert (done.returncode, done.stdout) == (0, NO_SESSION)
    done = subprocess.run(
        [tmp_path / "bin" / "cramhy", "ros", "rosversion", "-d"], capture_output=True, text=True, env=bare(tmp_path), timeout=60
    )
    assert (done.returncode, done.stdout) == (0, "noetic\n")
    assert typed("bash", f"{hint}\nrosversion -d", tmp_path) == ("noetic\n", "", 0)
    assert install().returncode == 0  # over our own, once more


def test_what_others_have_put_there_stays(cramhy, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "")
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "rostopic").write_text("#!/bin/sh\necho mine\n")
    done = cramhy("ros-shims", "--install", "bin")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == ("cramhy: bin/rostopic is there already, and not from cramhy. Nothing was written. Choose another folder.\n")
    assert os.listdir(tmp_path / "bin") == ["rostopic"]


def test_the_scripts_that_pip_made_stay(cramhy, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "")
    script = "#!/usr/bin/python3\nimport sys\nfrom cramhy_runtime.cli import main\nsys.exit(main())\n"
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin" / "cramhy").write_text(script)
    assert cramhy("ros-shims", "--install", "bin").returncode == 0
    assert (tmp_path / "bin" / "cramhy").read_text() == script and (tmp_path / "bin" / "rostopic").exists()


def test_a_folder_that_cannot_be_had_is_named(cramhy, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "")
    (tmp_path / "file").write_text("")
    done = cramhy("ros-shims", "--install", "file")
    assert (done.returncode, done.stderr) == (
        1,
        "cramhy: the programs cannot be written into file: file: File exists. Choose another name.\n",
    )
    done = cramhy("ros", "catkin_create_pkg", "file")
    assert (done.returncode, done.stderr) == (1, f"catkin_create_pkg: {tmp_path / 'file'}: File exists. Choose another name.\n")


# -------------------------------------------------------------------------------------------------- beside a real ROS


def pretend(folder, *names):
    """Programs of these names, as a real ROS has them."""
    folder.mkdir()
    for name in names:
        (folder / name).write_text("#!/bin/sh\necho real\n")
        (folder / name).chmod(0o755)
    return str(folder)


def test_a_real_ros_on_the_path_is_left_alone(cramhy, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", pretend(tmp_path / "real", "roscore"))
    done = cramhy("ros-shims")
    assert done.stderr == (
        "cramhy: a ROS is installed here, so roscore stays as it is. Those of cramhy are called like this: cramhy ros roscore\n"
    )
    assert "roscore()" not in done.stdout and "catkin_make()" in done.stdout


def test_the_functions_and_the_repl_of_a_real_ros_are_left_alone(cramhy, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", pretend(tmp_path / "real", "rospack", "roslisp_repl"))
    done = cramhy("ros-shims")
    assert done.stderr == (
        "cramhy: a ROS is installed here, so roslisp_repl, rospack, roscd, rosls stay as they are. "
        "Those of cramhy are called like this: cramhy ros rosls\n"
    )
    assert not {"roslisp_repl", "rospack", "roscd", "rosls"} & {line.partition("(")[0] for line in done.stdout.splitlines()}
    assert "cramhy() {" in done.stdout
