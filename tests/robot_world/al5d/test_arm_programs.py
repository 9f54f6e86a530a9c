"""What ``rosrun`` and ``roslaunch`` start of the arm's package, and the simulator that starts by itself."""

import sys

import pytest

from cramhy_runtime import kernel
from cramhy_runtime.cli import launch
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.messages import message_class_exact
from cramhy_runtime.ros.services import Refusal
from cramhy_runtime.ros_tools.hosting import Host

PACKAGE = "lynxmotion_al5d_description"
SPAWN = "spawn_brick -c color [-n name] [-x x] [-y y] [-z z] [-P pitch] [-R roll] [-Y yaw]"


@pytest.fixture
def run(table):
    """Runs a program of the package until it ends; its lines, without the time."""
    host, lines = Host(), []
    graph.active().node("terminal").subscribe("/cramhy/program_log", host.line_type, lambda message: lines.append(message.line))

    def ran(executable, words):
        del lines[:]
        _, _, before = host.start_program(PACKAGE, executable, words.split())
        kernel.sleep(0.5)
        return [line.partition("]: ")[2] for line in (*before, *lines) if line]

    return ran


def test_a_brick_is_brought_from_another_terminal(run, table):
    assert run("spawn_brick", "-c red -y 0.170") == ["Spawned brick [brick1] of color [red] at position (0.00 0.17 0.00 0.00 0.00 0.00)"]
    assert run("spawn_brick", "-n mine -c blue -x 0.1 -y 0.1 -z 0.05 -R 0 -P 0 -Y 1.57") == [
        "Spawned brick [mine] of color [blue] at position (0.10 0.10 0.05 0.00 0.00 1.57)"
    ]
    assert table.brick("mine") == pytest.approx((0.1, 0.1, 0, 1.57), abs=0.01)
    assert run("spawn_brick", "-c red -n mine") == ["Failed to call the service: Brick mine already exists."]


def test_a_brick_is_taken_away_from_another_terminal(run, table):
    table.spawn()
    assert run("kill_brick", "brick1") == ["Brick deleted successfully"] and not table.simulator.bricks
    assert run("kill_brick", "brick1") == ["Failed to call the service: Brick brick1 doesn't exist. On the table: no brick."]


@pytest.mark.parametrize(
    ("executable", "words", "status"),
    [("spawn_brick", "-c red -n mine", 0), ("spawn_brick", "-c pink", 1), ("kill_brick", "brick9", 1), ("spawn_brick", "-c red -n a/b", 1)],
)
def test_the_exit_status_of_a_refusal_is_1(run, executable, words, status):
    ended = []
    graph.active().node("other_terminal").subscribe("/cramhy/program_log", message_class_exact("cramhy_msgs/ProgramLine"), ended.append)
    run(executable, words)
    assert [message.status for message in ended if message.ended] == [status]


def test_a_program_that_has_done_its_work_has_left_the_graph(run):
    run("spawn_brick", "-c red")
    assert not [name for name in graph.active().nodes if "lego" in name]


def test_a_program_waits_until_there_is_a_simulator(run, table):
    table.simulator.shutdown()
    assert run("spawn_brick", "-c red") == ["waitForService: Service [/lynxmotion_al5d/spawn_brick] has not been advertised, waiting..."]
    run("simulator", "")
    kernel.sleep(0.5)
    assert list(graph.active().nodes["/lynxmotion_al5d"].program.bricks) == ["brick1"]


@pytest.mark.parametrize(
    ("executable", "words", "text"),
    [
        ("spawn_brick", "", SPAWN),
        ("spawn_brick", "-x 1", SPAWN),
        ("spawn_brick", "-c red -x here", SPAWN),
        ("spawn_brick", "-c", SPAWN),
        ("spawn_brick", "-q 3 -c red", SPAWN),
        ("kill_brick", "", "kill_brick name"),
        ("kill_brick", "a b", "kill_brick name"),
    ],
    ids=["nothing", "no colour", "no number", "no value", "no option", "no name", "two names"],
)
def test_words_that_are_not_understood_get_the_usage(run, executable, words, text):
    with pytest.raises(Refusal) as problem:
        run(executable, words)
    assert str(problem.value) == f"Usage: rosrun {PACKAGE} {text}"


def test_whoever_starts_the_sessions_own_arm_looks_on(run, table):
    table.spawn()
    name, there, lines = Host().start_program(PACKAGE, "simulator", [])
    assert (name, there) == ("/lynxmotion_al5d", True) and lines[0].endswith("The arm AL5D stands on its table, as /lynxmotion_al5d.")
    with pytest.raises(Refusal, match="^/lynxmotion_al5d is the session's own, and would end if another one took its name. "):
        Host().start_program(PACKAGE, "simulator", ["a:=b"])
    Host().start_program(PACKAGE, "simulator", ["__name:=other"])
    assert {"/lynxmotion_al5d", "/other"} <= set(graph.active().nodes) and table.simulator.bricks


def test_the_launch_file_of_the_course_starts_our_simulator(monkeypatch, tmp_path, capsys):
    """The course's own one starts Gazebo; it may stand in the workspace, too."""
    package = tmp_path / PACKAGE
    (package / "launch").mkdir(parents=True)
    (package / "package.xml").write_text(f"<package><name>{PACKAGE}</name></package>")
    (package / "launch" / "al5d_gazebo_control.launch").write_text(
        '<launch><include file="$(find gazebo_ros)/launch/empty.launch"/></launch>'
    )
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path))
    launched = launch.load([PACKAGE, "al5d_gazebo_control.launch"], {})
    assert [(program.package, program.executable) for program in launched.programs] == [(PACKAGE, "simulator")]
    assert launched.parameters["/robot_description"].startswith("<?xml")
    assert (
        capsys.readouterr().err == f"; al5d_gazebo_control.launch of cramhy is launched, since cramhy has its own programs for {PACKAGE}.\n"
    )


def test_in_a_session_the_arm_is_there_when_a_plan_asks_for_it():
    pytest.importorskip("mujoco", reason="needs MuJoCo (mujoco-core)")
    from cramhy_runtime.session.session import Session

    session = Session(time="virtual")
    try:
        session.evaluate_text('(roslisp:start-ros-node "plan") (defvar *commands*)')
        assert "/lynxmotion_al5d" not in graph.active().nodes
        commands = '(roslisp:advertise "/lynxmotion_al5d/joints_positions/command" "std_msgs/Float64MultiArray")'
        assert session.evaluate_text(f"(roslisp:num-subscribers (setf *commands* {commands}))") == [1]
        assert "/lynxmotion_al5d" in graph.active().nodes
    finally:
        kernel.stop()


def test_without_mujoco_the_one_who_asks_learns_how_to_install_it(monkeypatch, table):
    from cramhy_runtime.lisp_core.condition_types import SimpleError
    from cramhy_runtime.robot_world.al5d import demand

    monkeypatch.setitem(sys.modules, "cramhy_runtime.robot_world.al5d.node", None)
    table.simulator.shutdown()
    demand.start_when_asked_for()
    with pytest.raises(SimpleError) as problem:
        table.states()
    assert problem.value.report().startswith("The arm /lynxmotion_al5d cannot start. ")


def test_without_mujoco_a_client_of_another_process_gets_a_topic_without_messages(monkeypatch, table):
    from cramhy_runtime.robot_world.al5d import demand

    monkeypatch.setitem(sys.modules, "cramhy_runtime.robot_world.al5d.node", None)
    table.simulator.shutdown()
    demand.start_when_asked_for()
    heard = []
    kernel.post(lambda: heard.append(table.states()))
    kernel.sleep(0.1)
    assert heard == [[]] and "/lynxmotion_al5d" not in graph.active().nodes
