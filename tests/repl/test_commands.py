"""``cramhy run`` and ``cramhy eval`` as programs: their answers, messages and exit statuses."""

from __future__ import annotations

import json
import os
import platform

import pytest
from systems import RUNS_HY_FILES, WHY_NO_HY_FILES

from cramhy_runtime import __version__, cli
from cramhy_runtime.session import Image

from .terminal import Terminal

BAD_REQUEST = {
    "output": "",
    "values": [],
    "error": {
        "type": "CRAMHY::BAD-REQUEST",
        "message": 'Not understood: a line must be a JSON object {"form": "..."}.',
        "restarts": ["ABORT"],
    },
}


@pytest.mark.soak
def test_version(cramhy):
    done = cramhy("--version")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith(f"cramhy {__version__} (Python {platform.python_version()}, Hy 1.")


class TestRun:
    @pytest.mark.soak
    def test_a_file_that_runs_has_status_0(self, cramhy, tmp_path):
        (tmp_path / "good.lisp").write_text('(format t "hello~%")')
        done = cramhy("run", "good.lisp", "--time", "virtual", "--eval", "(print 5)")
        assert (done.returncode, done.stdout, done.stderr) == (0, "hello\n\n5 ", "")

    @pytest.mark.soak
    def test_an_unhandled_error_has_status_1_and_a_message(self, cramhy, tmp_path):
        (tmp_path / "bad.lisp").write_text('(princ "first")\n(list\n  (car 5))\n(princ "never")')
        done = cramhy("run", "bad.lisp", "--time", "virtual")
        assert (done.returncode, done.stdout) == (1, "first\n")
        assert done.stderr == (
            "cramhy: TYPE-ERROR\n  The value\n    5\n  is not of type\n    LIST\n  when binding LIST\n"
            "  at bad.lisp:3:3\n"
            "      (car 5))\n      ^\n"
        )

    def test_a_failed_plan_has_status_1_and_a_message(self, cramhy, tmp_path):
        (tmp_path / "bad.lisp").write_text('(in-package :cram-user)\n(top-level (fail "Lost."))')
        done = cramhy("run", "bad.lisp", "--time", "virtual")
        assert done.returncode == 1
        assert done.stderr.startswith("cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n  Lost.\n  at bad.lisp:2:12\n")

    @pytest.mark.soak
    def test_hy_files_and_systems_run_too(self, cramhy, tmp_path):
        (tmp_path / "plan.hy").write_text("(require cramhy *)\n(in-package :cram-user)\n(print (top-level (par 1 2)))")
        (tmp_path / "my-system.asd").write_text('(defsystem my-system :components ((:file "plan")))')
        (tmp_path / "plan.lisp").write_text("(print :loaded)")
        assert cramhy("run", "plan.hy", "--time", "virtual").stdout == "\n1 "
        assert cramhy("run", "my-system.asd", "--time", "virtual").stdout == "\n:LOADED "

    @pytest.mark.soak
    @pytest.mark.skipif(not RUNS_HY_FILES, reason=WHY_NO_HY_FILES)
    def test_a_hy_file_that_goes_into_no_package_stays_hy(self, cramhy, tmp_path):
        (tmp_path / "plan.hy").write_text(
            "(require cramhy *)\n(import cramhy_runtime.cpl *)\n"
            '(setv slow [])\n(print (top-level (par (do (sleep 2) "one") (.append slow 2))) slow)\n'
            '(top-level (par (sleep 1) (fail "Lost.")))'
        )
        done = cramhy("run", "plan.hy", "--time", "virtual")
        assert (done.returncode, done.stdout) == (1, "one [2]\n")
        assert done.stderr.startswith("cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n  Lost.\n  at plan.hy:5:27\n")

    @pytest.mark.soak
    def test_exit_gives_the_status(self, cramhy, tmp_path):
        (tmp_path / "leave.lisp").write_text("(exit :code 7)")
        assert cramhy("run", "leave.lisp").returncode == 7

    @pytest.mark.soak(all_but=1)
    @pytest.mark.parametrize(
        ("name", "message"),
        [
            ("none.lisp", "cramhy: FILE-ERROR\n  Cannot load {folder}/none.lisp: No such file or directory.\n"),
            ("folder.lisp", "cramhy: FILE-ERROR\n  Cannot load {folder}/folder.lisp: Is a directory.\n"),
            (
                "note.txt",
                "cramhy: FILE-ERROR\n  Cannot load note.txt: what is loaded is a .lisp, .hy or .asd file, or a system by its name.\n",
            ),
            (
                "latin.lisp",
                "cramhy: FILE-ERROR\n  Cannot load {folder}/latin.lisp: it is no UTF-8 text (line 2, byte 10 of the file). "
                "Save it as UTF-8.\n",
            ),
        ],
    )
    def test_what_cannot_be_loaded(self, cramhy, tmp_path, name, message):
        (tmp_path / "folder.lisp").mkdir()
        (tmp_path / "note.txt").write_text("hello")
        (tmp_path / "latin.lisp").write_bytes(b'1\n(print "\xe9")')
        done = cramhy("run", name)
        assert (done.returncode, done.stdout, done.stderr) == (1, "", message.format(folder=tmp_path))

    @pytest.mark.soak
    def test_files_from_windows_are_read(self, cramhy, tmp_path):
        (tmp_path / "bom.lisp").write_bytes(b'\xef\xbb\xbf(princ "a\r\nb")\r\n; end\r\n')
        assert cramhy("run", "bom.lisp").stdout == "a\nb"

    @pytest.mark.soak
    def test_a_file_with_nul_bytes_is_an_error(self, cramhy, tmp_path):
        (tmp_path / "nul.lisp").write_bytes(b"(princ 1)\n\0\0\n(princ 2)")
        done = cramhy("run", "nul.lisp")
        assert done.returncode == 1 and "is unbound" in done.stderr

    @pytest.mark.soak
    def test_a_run_that_never_ends_is_ended_by_its_time_limit(self, cramhy, tmp_path):
        (tmp_path / "endless.lisp").write_text("(in-package :cram-user)\n(top-level (loop (sleep 1)))")
        done = cramhy("run", "endless.lisp", "--time", "virtual", "--time-limit", "60")
        assert done.returncode == 1
        assert done.stderr.startswith("cramhy: CRAMHY::TIME-LIMIT\n  The run reached its time limit of 60 s.\n")


@pytest.fixture
def answers(cramhy):
    """The answers of ``cramhy eval`` to lines; a line that is no text of JSON is wrapped into a request."""

    def answers(*forms, options=()):
        lines = [
            form if form[:1] in ("{", "[", '"') and form[-1:] in '}]"' and "form" in form[:8] else json.dumps({"form": form})
            for form in forms
        ]
        done = cramhy("eval", *options, input="\n".join(lines))
        assert done.returncode == 0, done.stderr
        return [json.loads(line) for line in done.stdout.splitlines()]

    return answers


class TestEval:
    @pytest.mark.soak
    @pytest.mark.parametrize("line", ["nonsense", '{"form": 3}', '{"from": "3"}', "[1]", '"x"', "null", '{"form": "1"', "[" * 100000])
    def test_a_line_that_is_no_request_gets_an_error_and_the_next_is_read(self, cramhy, line):
        done = cramhy("eval", input=f'{line}\n\n{{"form": "(+ 1 2)"}}\n')
        assert [json.loads(answer) for answer in done.stdout.splitlines()] == [BAD_REQUEST, {"output": "", "values": ["3"], "error": None}]
        assert (done.returncode, done.stderr) == (0, "")

    @pytest.mark.soak
    def test_binary_garbage_gets_an_error_too(self, cramhy):
        done = cramhy("eval", input=b'\xff\xfe\x00\x80 garbage\n{"form": "(+ 1 2)"}\n', text=False)
        assert [json.loads(answer)["values"] for answer in done.stdout.splitlines()] == [[], ["3"]]

    def test_the_values_of_the_last_form_and_all_output(self, answers):
        assert (
            answers('(princ "a") (princ "b") (values 1 :two)', "", ";only a comment")
            == [{"output": "ab", "values": ["1", ":TWO"], "error": None}] + [{"output": "", "values": [], "error": None}] * 2
        )

    @pytest.mark.soak
    def test_a_form_that_prints_and_fails(self, answers):
        (answer,) = answers('(progn (princ "before") (/ 1 0))')
        assert answer["error"]["type"] == "DIVISION-BY-ZERO" and answer["error"]["output"] == "before"
        assert answer["error"]["restarts"] == ["ABORT"] and answer["values"] == []

    def test_the_end_inside_a_string_or_a_list(self, answers):
        first, second = answers('(list "abc', "(list 1 (list 2)")
        assert first["error"]["type"] == second["error"]["type"] == "END-OF-FILE"
        assert second["error"]["hint"] == "The ( at line 1, column 1 is never closed."

    @pytest.mark.soak
    def test_forms_do_not_read_the_requests(self, answers):
        first, second = answers("(read-line)", "(+ 1 2)")
        assert first["error"]["type"] == "END-OF-FILE" and second["values"] == ["3"]

    @pytest.mark.soak
    def test_huge_forms(self, answers):
        text = "x" * 5_000_000
        length, nested, deep, after = answers(f'(length "{text}")', "'" + "(" * 20000 + ")" * 20000, "(+ 1 " * 20000 + ")" * 20000, "5")
        assert length["values"] == ["5000000"] and after["values"] == ["5"]
        assert nested["error"]["type"] == "STORAGE-CONDITION"
        assert deep["error"]["message"] == "The form is nested too deeply to be compiled."

    @pytest.mark.soak
    def test_a_form_that_never_ends_and_the_next(self, answers):
        first, second, third = answers("(loop)", "(loop (sleep 1))", "(+ 1 2)", options=("--time-limit", "10", "--package", "cram-user"))
        assert first["error"]["type"] == second["error"]["type"] == "CRAMHY::TIME-LIMIT" and third["values"] == ["3"]
        assert "main waits for the time" in second["error"]["message"]

    @pytest.mark.soak
    def test_a_seed_makes_random_numbers_the_same(self, answers):
        forms = ["(list (random 1000000) (random 1000000))"]
        assert answers(*forms, options=("--seed", "5")) == answers(*forms, options=("--seed", "5"))
        assert answers(*forms, options=("--seed", "5")) != answers(*forms, options=("--seed", "6"))

    @pytest.mark.soak(all_but=1)
    @pytest.mark.parametrize(
        ("options", "message"),
        [
            (("--load", "no-such-system"), 'cramhy: ASDF:MISSING-COMPONENT\n  Component "no-such-system" not found\n'),
            (
                ("--package", "no-such-package"),
                'cramhy: SB-EXT:PACKAGE-DOES-NOT-EXIST\n  The name "NO-SUCH-PACKAGE" does not designate any',
            ),
            (("--eval", "(+ 1"), "cramhy: END-OF-FILE\n"),
            (("--eval", '(cpl:fail "x")'), "cramhy: CRAM-LANGUAGE-IMPLEMENTATION:SIMPLE-PLAN-FAILURE\n  x\n"),
        ],
    )
    def test_options_that_cannot_be_followed(self, cramhy, options, message):
        done = cramhy("eval", *options, input='{"form": "1"}')
        assert (done.returncode, done.stdout) == (1, "") and done.stderr.startswith(message)


@pytest.mark.soak
@pytest.mark.parametrize(("form", "shown"), [("(print 1)", "\n1 \n"), ('(format t "a~%")', "a\n"), ("(+ 1 2)", "")])
def test_a_program_in_a_terminal_leaves_the_prompt_a_line_of_its_own_and_a_pipe_what_it_wrote(cramhy, tmp_path, form, shown):
    program = tmp_path / "x.lisp"
    program.write_text(form)
    with Terminal("run", str(program)) as terminal:
        assert terminal.status() == 0
        assert terminal.text == shown
    assert cramhy("run", "x.lisp").stdout == (shown if form != "(print 1)" else "\n1 ")


def test_a_folder_that_cannot_be_read_hides_no_packages_elsewhere(tmp_path, monkeypatch):
    from cramhy_runtime.cli import workspace

    for place in ("closed/mine", "open/yours"):
        (tmp_path / place).mkdir(parents=True)
        (tmp_path / place / "package.xml").write_text("")
    monkeypatch.setenv("ROS_PACKAGE_PATH", os.pathsep.join(str(tmp_path / name) for name in ("closed", "open")))
    monkeypatch.setattr(os, "access", lambda path, mode: path.name != "closed")
    found = workspace.packages()
    assert "yours" in found and "turtlesim" in found and "mine" not in found


class TestFilesThatAreMissing:
    """A command that is given a file which is not there says so, and does not speak of systems."""

    @pytest.mark.soak(all_but=3)
    @pytest.mark.parametrize(
        "words, told, hint",
        [
            (["run", "spiral.lsp"], "spiral.lsp: No such file or directory.", "Did you mean spiral.lisp?"),
            (["run", "spirl.lisp"], "spirl.lisp: No such file or directory.", "Did you mean spiral.lisp?"),
            (["run", "spiral"], "spiral: No such file or directory.", "Did you mean spiral.lisp?"),
            (
                ["run", "./nothing"],
                "nothing: No such file or directory.",
                "What is loaded is a .lisp, .hy or .asd file, or a system by its name.",
            ),
            (["run", "no/where.hy"], "no/where.hy: No such file or directory.", ""),
            (["run", "nothing.asd"], "nothing.asd: No such file or directory.", ""),
            (["run", "folder"], "folder: Is a directory.", "What is loaded is a .lisp, .hy or .asd file, or a system by its name."),
            (["test", "spiral.lsp"], "spiral.lsp: No such file or directory.", "Did you mean spiral.lisp?"),
            (["eval", "--load", "spiral.lsp"], "spiral.lsp: No such file or directory.", "Did you mean spiral.lisp?"),
        ],
    )
    def test_it_says_so(self, tmp_path, monkeypatch, capfd, words, told, hint):
        (tmp_path / "spiral.lisp").write_text("(print 1)\n")
        (tmp_path / "folder").mkdir()
        monkeypatch.chdir(tmp_path)
        with Image():
            assert cli.main(words) == 1
        shown = "".join(capfd.readouterr())
        assert shown == f"cramhy: FILE-ERROR\n  Cannot load {tmp_path}/{told}\n" + (f"  {hint}\n" if hint else "")

    @pytest.mark.parametrize("name", ["no-such-system", "alexandria/tests", "cram-math/nothing"])
    def test_a_name_without_a_file_is_that_of_a_system(self, tmp_path, monkeypatch, capfd, name):
        monkeypatch.chdir(tmp_path)
        with Image():
            assert cli.main(["run", name]) == 1
        shown = "".join(capfd.readouterr())
        assert f'ASDF:MISSING-COMPONENT\n  Component "{name}" not found' in shown
        assert f"  There is no file {name} in {tmp_path}, and no system of that name: " in shown
