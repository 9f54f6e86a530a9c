"""Time is chosen in one way: ``--time``, then CRAMHY_TIME, then a form in the file; without them it is virtual for what runs to its end."""

import pytest

PLAIN = """\
(require cramhy *)
{form}
(import cramhy_runtime [kernel] cramhy_runtime.cpl *)
(top-level (sleep 0.05))
(print (if (. (kernel.active) clock virtual) "virtual" "wall"))
"""
FORMS = {"none": "", "macro": '(cramhy.time "wall")', "import": '(import cramhy)\n(cramhy.time "wall")'}


@pytest.mark.soak
@pytest.mark.parametrize("way", ["hy", "run"])
@pytest.mark.parametrize(
    ("form", "variables", "time"),
    [
        ("none", {}, "virtual"),
        ("macro", {}, "wall"),
        ("import", {}, "wall"),
        ("none", {"CRAMHY_TIME": "wall"}, "wall"),
        ("macro", {"CRAMHY_TIME": "virtual"}, "virtual"),
    ],
)
def test_a_file_and_the_variable_choose_it_for_hy_and_for_cramhy_run(write, program, way, form, variables, time):
    write("plan.hy", PLAIN.format(form=FORMS[form]))
    done = program(way, "plan.hy", **variables)
    assert (done.returncode, done.stdout, done.stderr) == (0, f"{time}\n", "")


@pytest.mark.soak
@pytest.mark.parametrize("way", ["hy", "run"])
def test_a_file_in_common_lisp_chooses_it_by_a_function(write, program, way):
    write(
        "plan.hy",
        '(require cramhy *)\n(in-package :cram-user)\n(princ (cramhy:time "wall"))\n(top-level (sleep 0.05))\n(print (cramhy:time :virtual))',
    )
    done = program(way, "plan.hy")
    assert (done.returncode, done.stdout, done.stderr) == (0, 'wall\n"virtual" ', "")


@pytest.mark.soak
def test_the_option_counts_before_the_variable_and_the_file(write, program):
    write("plan.hy", PLAIN.format(form=FORMS["macro"]))
    assert program("run", "plan.hy", "--time", "virtual", CRAMHY_TIME="wall").stdout == "virtual\n"


@pytest.mark.soak
def test_the_variable_counts_for_tests_of_pytest_and_the_option_before_it(write, python):
    write(
        "test_time.py",
        "from cramhy_runtime import kernel\nimport cramhy\n\ndef test_wall(request):\n    assert not kernel.active().clock.virtual\n",
    )
    words = ["-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "cramhy_runtime.pytest_plugin", "test_time.py"]
    alone = {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    assert python(*words, CRAMHY_TIME="wall", **alone).returncode == 0
    assert python(*words, **alone).returncode == 1
    assert python(*words, "--cramhy-time", "wall", CRAMHY_TIME="virtual", **alone).returncode == 0


@pytest.mark.soak
def test_another_word_is_refused(write, program):
    write("plan.hy", PLAIN.format(form='(cramhy.time "slow")'))
    complaint = 'The variable CRAMHY_TIME says "slow". Time is "virtual" or "wall".'
    done = program("run", "plan.hy", CRAMHY_TIME="slow")
    assert (done.returncode, done.stdout, done.stderr) == (2, "", f"cramhy: {complaint}\n")
    assert complaint in program("hy", "plan.hy", CRAMHY_TIME="slow").stderr
    assert '(cramhy:time ...) says "slow". Time is "virtual" or "wall".' in program("run", "plan.hy").stderr


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(("command", "time"), [("repl", "wall"), ("run", "virtual"), ("eval", "virtual"), ("test", "virtual")])
def test_the_help_of_each_command_names_its_default(python, command, time):
    text = " ".join(python("-m", "cramhy_runtime.cli", command, "--help").stdout.split())
    assert f"It counts before the variable CRAMHY_TIME ({time})" in text


def test_a_prompt_lives_in_wall_time_until_a_form_says_otherwise(python):
    lines = '(py:call "time.sleep" 0)\n(print (> (roslisp:ros-time) 1500000000))\n(cramhy:time "virtual")\n'
    said = python("-m", "cramhy_runtime.cli", "repl", input=lines).stdout
    assert "T \nT\n" in said and '"virtual"\n' in said
