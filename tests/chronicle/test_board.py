"""The topics and services of ``/cramhy``: merged to 60 messages a second, everything for late joiners, chapters of the past, the pace."""

from __future__ import annotations

import pytest

from cramhy_runtime import chronicle, kernel
from cramhy_runtime.chronicle import chronicler, history
from cramhy_runtime.ros import graph
from cramhy_runtime.ros.message_json import from_json, to_json
from cramhy_runtime.ros.messages import service_type_exact

STEPS = "(top-level (dotimes (i 10) (par (sleep 0.1) (sleep 0.05))))"


def test_nothing_is_there_before_somebody_asks(session):
    session.evaluate_text("(top-level (par (sleep 1)))")
    assert chronicler.there() is None and "/cramhy/tasks" not in graph.active().topics
    assert not kernel.active()._watchers


def test_afterwards_nothing_is_left(session):
    from cramhy_runtime.cpl.tree import finished_plans

    chronicle.start()
    chronicle.stop()
    assert chronicler.there() is None and "/cramhy" not in graph.active().nodes
    assert not kernel.active()._watchers and finished_plans.observers.value == ()
    session.evaluate_text("(top-level (par (sleep 1)))")
    assert finished_plans.newest.value.record is None


def test_starting_twice_is_starting_once(session):
    chronicle.start()
    first = chronicler.active()
    chronicle.start()
    assert chronicler.active() is first


def test_the_node_is_hidden(session, looker):
    looker.open_board()
    here = graph.active()
    assert "/cramhy" not in here.visible_nodes() and not [name for name in here.visible_topics() if name.startswith("/cramhy")]
    assert not [name for name in here.visible_services() if name.startswith("/cramhy")]


def test_changes_are_merged_until_it_is_time(session, looker, period):
    looker.open_board()
    heard = looker.listen("/cramhy/tasks", "cramhy_msgs/TaskTree")
    session.evaluate_text(STEPS)
    kernel.sleep(1)
    assert len(looker.told["tasks"]) > 20 and len(heard) == 1
    looker.wall += period
    kernel.sleep(1)
    assert len(heard) == 2
    assert len(heard[1].tasks) == len({task.id for task in heard[1].tasks}) == 21
    assert {task.state for task in heard[1].tasks} == {"SUCCEEDED"}


def test_a_page_is_told_of_the_newest_only_of_many_that_live_for_no_time(session, period):
    chronicle.start()
    made, wall = chronicler.active(), [0.0]
    made.board.wall = lambda: wall[0]
    kernel.call_every(0.1, lambda: wall.__setitem__(0, wall[0] + period))
    session.evaluate_text("(top-level (sleep 1) (dotimes (i 1000) (par 1 (par 2))) (sleep 1))")
    tasks = made.state.messages()["tasks"].tasks
    assert 40 < len(tasks) < 120
    assert {task.parent for task in tasks} - {task.id for task in tasks} == {""}


def test_merged_messages_lead_to_the_same_as_all_messages(session, looker, period):
    from cramhy_runtime.chronicle.merge import State

    looker.open_board()
    types = {"tasks": "cramhy_msgs/TaskTree", "fluents": "cramhy_msgs/Fluents", "world": "cramhy_msgs/World"}
    heard = {kind: looker.listen(f"/cramhy/{kind}", ros_type) for kind, ros_type in types.items()}
    for number in range(20):
        kernel.call_at(number / 7, lambda: setattr(looker, "wall", looker.wall + 1))
    session.evaluate_text("""(progn (roslisp:start-ros-node "n") (defparameter *f* (make-fluent :name "f"))
        (let ((pub (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist")))
          (top-level (dotimes (i 10) (setf (value *f*) i) (roslisp:publish pub (roslisp:make-message "geometry_msgs/Twist" (x linear) i))
                       (par (sleep 0.1) (sleep 0.05))))))""")
    kernel.sleep(2)
    looker.wall += 1
    kernel.sleep(1)
    added = State()
    for kind, messages in heard.items():
        assert 2 < len(messages) < 22
        for message in messages:
            added.add(kind, message)
    before = looker.chronicler.state.messages()
    for kind, message in added.messages().items():
        if kind != "modules":
            ours, theirs = to_json(message), to_json(before[kind])
            ours.pop("stamp"), theirs.pop("stamp")
            assert ours == theirs


def test_who_comes_late_gets_everything(session, looker):
    looker.open_board()
    session.evaluate_text("""(progn (roslisp:start-ros-node "n") (defparameter *f* (make-fluent :name "f" :value 5)) (sleep 0.1))""")
    session.evaluate_text(STEPS)
    state = looker.call("/cramhy/get_state", "cramhy_msgs/GetState")
    assert [turtle.name for turtle in state.world.turtles] == ["turtle1"]
    assert len(state.tasks.tasks) == 21 and state.tasks.complete is True
    assert ("f", "5", 5.0) in [(fluent.name, fluent.value, fluent.number) for fluent in state.fluents.fluents]
    assert state.pace.virtual is True and state.pace.busy is True


def test_a_plan_may_ask_in_its_middle(session, looker):
    looker.open_board()
    session.evaluate_text("""(defparameter *state* (top-level (par (sleep 2) (progn (sleep 1) (roslisp:start-ros-node "me")
                                                           (roslisp:call-service "/cramhy/get_state" 'cramhy_msgs-srv:getstate)))))""")
    state = looker.call("/cramhy/get_state", "cramhy_msgs/GetState")
    assert {task.state for task in state.tasks.tasks} == {"SUCCEEDED"}


@pytest.mark.parametrize("fluents", [0, 400])
def test_the_past_is_there_in_chapters(session, looker, period, fluents):
    """However much there is: a state that is larger than a chapter leaves room for what follows."""
    made = looker.open_board()
    session.evaluate_text(f"(defparameter *many* (loop repeat {fluents} collect (make-fluent :value 1)))")
    fluents = len(made.owner.sources["fluents"].watched)  # the process may hold some of other tests, too
    most = 200 + fluents * 5 // 4
    made.history = history.History(most=most, chapter=40)
    kernel.call_every(0.1, lambda: setattr(looker, "wall", looker.wall + period))
    session.evaluate_text(f"(top-level (dotimes (i {40 + fluents // 6}) (par (sleep 0.2) (sleep 0.1))))")
    newest = looker.call("/cramhy/get_history", "cramhy_msgs/GetHistory", chapter=0)
    assert newest.oldest > 1 and newest.chapter == newest.newest > newest.oldest
    assert made.history.size <= most
    earlier = looker.call("/cramhy/get_history", "cramhy_msgs/GetHistory", chapter=newest.newest - 1)
    assert earlier.end == newest.begin
    # a chapter's messages lead from the state at its beginning to that of the next
    tasks = {task.id: to_json(task) for task in earlier.tasks.tasks}
    for message in earlier.later_tasks:
        tasks.update({task.id: to_json(task) for task in message.tasks})
    later = {task.id: to_json(task) for task in newest.tasks.tasks}
    unlike = [number for number in later if later[number] != tasks.get(number)]
    assert len(unlike) <= 3  # those of the message that the next chapter begins with
    gone = looker.call("/cramhy/get_history", "cramhy_msgs/GetHistory", chapter=1)
    assert gone == f"There is no chapter 1: those from {newest.oldest} to {newest.newest} are kept."


def test_before_anything_was_published_there_is_no_chapter(session, looker):
    looker.open_board().history = history.History()
    assert looker.call("/cramhy/get_history", "cramhy_msgs/GetHistory") == "There is no chapter 0: nothing has been published yet."


def test_the_pace_is_told_to_late_subscribers_and_when_it_changes(session, looker):
    looker.open_board()
    session.evaluate_text("(sleep 0.1)")
    heard = looker.listen("/cramhy/pace", "cramhy_msgs/Pace")
    assert [(pace.virtual, pace.paused, pace.speed) for pace in heard] == [(True, False, 0.0)]
    answer = looker.call("/cramhy/set_pace", "cramhy_msgs/SetPace", speed=1000.0)
    assert (answer.pace.paused, answer.pace.speed) == (False, 1000.0)
    assert [(pace.paused, pace.speed) for pace in heard] == [(False, 0.0), (False, 1000.0)]
    kernel.pace().set_speed(None)
    assert heard[-1].speed == 0.0


def test_a_paused_session_goes_on_step_by_step(session, looker):
    looker.open_board()
    assert looker.call("/cramhy/set_pace", "cramhy_msgs/SetPace", paused=True).pace.paused is True
    assert looker.call("/cramhy/step", "cramhy_msgs/Step", seconds=0.5).pace.paused is True
    session.evaluate_text("(sleep 0.5)")
    assert kernel.now() == 0.5
    kernel.pace().resume()


def test_where_a_step_ended_is_told_though_nothing_else_has_changed(session, looker):
    looker.open_board()
    heard = looker.listen("/cramhy/pace", "cramhy_msgs/Pace")
    looker.call("/cramhy/set_pace", "cramhy_msgs/SetPace", paused=True)
    looker.call("/cramhy/step", "cramhy_msgs/Step", seconds=0.5)
    session.evaluate_text("(sleep 0.5)")
    kernel.pace().resume()
    assert [pace.stamp for pace in heard if pace.paused][-1] == 0.5


@pytest.mark.parametrize(
    "service, kind, request_, text",
    [
        (
            "set_pace",
            "SetPace",
            {"speed": -1.0},
            "A speed is a number of plan seconds per second, or 0, as fast as the machine computes, but not -1.",
        ),
        (
            "set_pace",
            "SetPace",
            {"speed": None},
            "A speed is a number of plan seconds per second, or 0, as fast as the machine computes, but not nan.",
        ),
        ("step", "Step", {"seconds": 0.0}, "A step takes a time above zero, in seconds, but not 0.0."),
        (
            "seek",
            "Seek",
            {"stamp": 0.0},
            "Time goes one way in a session with plans. /cramhy/get_history tells what was before; a recording (--record, cramhy replay) can "
            "be sought through.",
        ),
    ],
)
def test_what_cannot_be_is_refused_and_nothing_is_lost(session, looker, service, kind, request_, text):
    looker.open_board()
    made = from_json(service_type_exact(f"cramhy_msgs/{kind}").request, request_)
    fields = {field.name: value for field, value in zip(made.fields, made.values())}
    assert looker.call(f"/cramhy/{service}", f"cramhy_msgs/{kind}", **fields) == text
    session.evaluate_text("(sleep 1)")
    assert kernel.now() == 1.0


def test_wall_time_cannot_be_held_back():
    from cramhy_runtime.repl.session import Session

    Session(time="wall", turtlesim=False)
    try:
        chronicle.start()
        with pytest.raises(kernel.KernelError, match="Time is the wall's here"):
            chronicler.active().set_pace(True, None)
        with pytest.raises(kernel.KernelError, match="Time is the wall's here"):
            chronicler.active().step(1)
    finally:
        chronicle.stop()
        kernel.stop()
