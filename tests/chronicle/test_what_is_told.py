"""What is told of a session: its tasks, fluents, process modules and turtles, at the end of every instant."""

from __future__ import annotations

import math

from cramhy_runtime import kernel
from cramhy_runtime.chronicle import chronicler, fluents, plans
from cramhy_runtime.ros.message_json import to_json


def states(looker, name):
    return [task.state for task in looker.tasks() if name in task.name]


PAR = """
(top-level
  (par (sleep 1)
       (progn (sleep 2) 42)))"""


def test_every_branch_is_told_with_its_form_place_times_and_result(session, looker):
    session.evaluate_text(PAR, "<repl>")
    last = {task.name: task for task in looker.tasks()}
    root, first, second = (last[name] for name in ("[TOP-LEVEL]", "[PAR-CHILD-#1/2]", "[PAR-CHILD-#2/2]"))
    assert (root.parent, root.operator, root.state, root.result) == ("", "TOP-LEVEL", "SUCCEEDED", "NIL")
    assert (first.parent, first.operator, first.began, first.ended) == (root.id, "PAR", 0.0, 1.0)
    assert (second.began, second.ended, second.result, second.place) == (0.0, 2.0, "42", "<repl>:4:15")


def test_what_a_task_waits_for_is_told_while_it_does(session, looker):
    session.evaluate_text(PAR, "<repl>")
    first = looker.told["tasks"][0]
    assert first.stamp == 0.0
    assert [(task.name, task.state, task.waits_for, task.place) for task in first.tasks] == [
        ("[TOP-LEVEL]", "RUNNING", "the branches of PAR", "<repl>:3:3"),
        ("[PAR-CHILD-#1/2]", "RUNNING", "the time 1 s (sleep 1)", "<repl>:3:8"),
        ("[PAR-CHILD-#2/2]", "RUNNING", "the time 2 s (sleep 2)", "<repl>:4:15"),
    ]
    assert all(math.isnan(task.ended) for task in first.tasks)


def test_a_task_that_lives_for_no_time_is_told_from_its_beginning_to_its_end(session, looker):
    session.evaluate_text("(top-level (par 1 (par 2 3)))")
    kernel.sleep(1)
    assert sorted(states(looker, "PAR-CHILD-#1/2")) == ["RUNNING", "RUNNING", "SUCCEEDED", "SUCCEEDED"]


def test_every_task_that_began_ended(session, looker):
    session.evaluate_text("""
      (top-level
        (dotimes (i 20)
          (pursue (sleep 0.1) (par (sleep 0.2) (sleep 0.01)) (wait-for (make-fluent :value nil)))))""")
    kernel.sleep(1)
    began = [task.id for task in looker.tasks() if task.state == "RUNNING"]
    ended = [task.id for task in looker.tasks() if task.state in ("SUCCEEDED", "FAILED", "EVAPORATED")]
    assert len(ended) == len(set(ended)) == 1 + 20 * 5 and set(began) == set(ended)


def test_a_failure_is_told_with_its_text_and_place(session, looker):
    session.evaluate_text(
        """(top-level (with-failure-handling ((simple-plan-failure (f) f (return)))
      (par (sleep 1) (fail "no ~a" "luck"))))""",
        "<repl>",
    )
    kernel.sleep(1)
    failed = [task for task in looker.tasks() if task.state == "FAILED"]
    assert [(task.name, task.result, task.place) for task in failed] == [
        ("[PAR-CHILD-#2/2]", "SIMPLE-PLAN-FAILURE, no luck", "<repl>:2:22")
    ]
    assert states(looker, "PAR-CHILD-#1/2")[-1] == "EVAPORATED"


def test_suspension_is_told(session, looker):
    session.evaluate_text("""(top-level (with-tags (par (:tag slow (sleep 2))
                                                        (progn (sleep 1) (cpl:suspend slow) (sleep 3) (cpl:wake-up slow)))))""")
    kernel.sleep(1)
    assert "SUSPENDED" in [task.state for task in looker.tasks()]


def test_a_dead_task_that_is_woken_up_is_not_told_again(session, looker):
    session.evaluate_text("(top-level (with-tags (par (:tag a (sleep 1)) (progn (sleep 2) (cpl:suspend a) (cpl:wake-up a) (sleep 1)))))")
    kernel.sleep(1)
    assert [task.state for task in looker.tasks() if "TAG" in task.operator or "A)" in task.name].count("SUCCEEDED") == 1


def test_names_are_those_of_describe_task_tree_and_do_not_change_them(session, looker):
    session.evaluate_text("(def-cram-function take-step (n) (sleep n))")
    session.evaluate_text("(top-level (take-step 3))")
    kernel.sleep(1)
    assert "[REPLACEABLE-FUNCTION-TAKE-STEP] (TAKE-STEP 3)" in {task.name for task in looker.tasks()}


def test_the_oldest_dead_are_forgotten(session, looker, monkeypatch):
    monkeypatch.setattr(plans, "MOST_DEAD", 10)
    session.evaluate_text("(top-level (dotimes (i 50) (par (sleep 0.1) 2)))")
    kernel.sleep(1)
    assert len(looker.chronicler.state.sums["tasks"]) == 10
    known = looker.chronicler.state.messages()["tasks"].tasks
    assert {task.parent for task in known} - {task.id for task in known} == {""}  # nobody's parent was forgotten


def test_a_storm_of_tasks_at_one_instant_is_not_kept_until_its_end(session, looker, monkeypatch):
    monkeypatch.setattr(plans, "MOST_EVENTS", 100)
    session.evaluate_text("(top-level (dotimes (i 200) (par 1 2)))")
    assert len(looker.told["tasks"]) > 4
    kernel.sleep(1)
    assert len([task for task in looker.tasks() if task.state == "SUCCEEDED"]) == 401


def test_a_plan_is_seen_when_somebody_begins_to_look_in_its_middle(session):
    from cramhy_runtime import chronicle
    from cramhy_runtime.chronicle import chronicler

    seen = []

    def look():
        chronicle.start()
        chronicler.active().listeners.append(lambda kind, message: seen.append((kind, message)))

    kernel.call_at(0.5, look)
    session.evaluate_text("(top-level (par (sleep 1) (progn (sleep 2) (par (sleep 1)))))")
    kernel.sleep(1)
    chronicler.active().listeners.clear()
    names = [task.name for kind, message in seen if kind == "tasks" for task in message.tasks if task.state == "SUCCEEDED"]
    assert sorted(names) == ["[PAR-CHILD-#1/1]", "[PAR-CHILD-#1/2]", "[PAR-CHILD-#2/2]", "[TOP-LEVEL]"]


def test_fluents_are_told_when_they_change_with_their_value_as_text_and_number(session, looker):
    session.evaluate_text("""
      (progn (defparameter *level* (make-fluent :name "level" :value 1))
             (sleep 1) (setf (value *level*) 2.5) (sleep 1)
             (setf (value *level*) :high) (sleep 1) (setf (value *level*) :high) (sleep 1))""")
    seen = [
        (message.stamp, fluent.name, fluent.value)
        for message in looker.told["fluents"]
        for fluent in message.fluents
        if fluent.name == "level"
    ]
    numbers = [fluent.number for message in looker.told["fluents"] for fluent in message.fluents if fluent.name == "level"]
    assert seen == [(0.0, "level", "1"), (1.0, "level", "2.5"), (2.0, "level", ":HIGH")]
    assert numbers[:2] == [1.0, 2.5] and math.isnan(numbers[2])


def test_a_fluent_that_holds_a_message_shows_its_fields(session, looker):
    session.evaluate_text("""(progn (defparameter *pose* (make-fluent :name "pose"))
        (setf (value *pose*) (roslisp:make-message "turtlesim/Pose" :x 1.25 :theta -0.5)) (sleep 1))""")
    values = [fluent.value for message in looker.told["fluents"] for fluent in message.fluents if fluent.name == "pose"]
    assert values[-1] == "x 1.25 y 0 theta -0.5 linear_velocity 0 angular_velocity 0"


def test_the_status_of_a_task_is_no_fluent_of_the_program(session, looker):
    def named():
        kernel.sleep(1)
        return {fluent.name for message in looker.told["fluents"] for fluent in message.fluents if "STATUS" in fluent.name}

    before = named()  # the process may hold fluents of other tests
    session.evaluate_text("(top-level (with-tags (par (:tag a (sleep 1)) (wait-for (eq (cpl-impl:status a) :succeeded)))))")
    assert named() == before


def test_a_fluent_that_is_gone_is_told(session, looker):
    session.evaluate_text("""(let ((f (make-fluent :name "short-lived" :value 1))) (sleep 1) (setf (value f) 2) (sleep 1))""")
    session.evaluate_text("(sleep 1)")
    ids = [fluent.id for message in looker.told["fluents"] for fluent in message.fluents if fluent.name == "short-lived"]
    assert ids[-1] in [gone for message in looker.told["fluents"] for gone in message.removed]


def test_a_fluent_that_is_only_garbage_is_not_told_to_who_begins_to_look(session):
    session.evaluate_text("""(let ((f (make-fluent :name "garbage" :value 1))) (setf (value f) (list f)) nil)""")
    made = chronicler.active()
    made.look()
    assert "garbage" not in [fluent.name for fluent in made.state.messages()["fluents"].fluents]
    chronicler.dismiss()


def test_only_fluents_that_were_told_are_told_to_be_gone(session, looker, monkeypatch):
    monkeypatch.setattr(fluents, "MOST", 10)
    session.evaluate_text('(defparameter *many* (loop for i below 30 collect (make-fluent :name (format nil "many-~a" i) :value i)))')
    session.evaluate_text("(sleep 1)")
    session.evaluate_text('(defparameter *more* (loop for i below 10 collect (make-fluent :name "more")))')
    session.evaluate_text("(sleep 1)")
    told = [fluent.id for message in looker.told["fluents"] for fluent in message.fluents]
    gone = [gone for message in looker.told["fluents"] for gone in message.removed]
    assert len(gone) >= 10 and set(gone) <= set(told)


MODULES = """
(top-level
  (cpm:with-process-modules-running (waiter)
    (par (cpm:pm-execute 'waiter (desig:a motion (type waiting) (duration 2)))
         (progn (sleep 0.5) (cpm:pm-execute 'waiter (desig:a motion (type waiting) (duration 1)))))))"""


def test_process_modules_are_told_with_what_they_execute_and_their_queue(session, looker):
    session.evaluate_text("(cpm:def-process-module waiter (motion) (sleep (desig:desig-prop-value motion :duration)))")
    session.evaluate_text(MODULES)
    kernel.sleep(1)
    seen = [
        [(module.name, module.state, module.executes, list(module.queue)) for module in message.modules]
        for message in looker.told["modules"]
    ]
    one, two = "#<A MOTION (TYPE WAITING) (DURATION 2)>", "#<A MOTION (TYPE WAITING) (DURATION 1)>"
    assert seen == [[("WAITER", "RUNNING", one, [])], [("WAITER", "RUNNING", one, [two])], [("WAITER", "RUNNING", two, [])], []]
    assert "[WAITER]" in {task.name for task in looker.tasks()}


def test_fluents_of_process_modules_are_told_apart_from_those_of_the_program(session, looker):
    session.evaluate_text("(cpm:def-process-module waiter (motion) (sleep (desig:desig-prop-value motion :duration)))")
    session.evaluate_text('(defparameter *mine* (make-fluent :name "waiter-status" :value 1))')
    session.evaluate_text(MODULES)
    told = {fluent.name: fluent.internal is True for message in looker.told["fluents"] for fluent in message.fluents}
    assert told["waiter-status"] is False
    assert {name: internal for name, internal in told.items() if name.startswith("WAITER-")} == dict.fromkeys(
        (f"WAITER-{what}" for what in ("INPUT", "STATUS", "CANCEL", "CALLER", "RESULT")), True
    )


EARLIER = """(progn
  (def-cram-function wall (n) (sleep n) n)
  (def-top-level-cram-function walls () (par (wall 1) (wall 2)))
  (walls) (top-level (wall 3))
  (handler-case (top-level (wall 1) (fail 'simple-plan-failure)) (simple-plan-failure () nil)))"""


def test_who_opens_the_board_late_is_told_of_the_plans_that_ended_and_recordings_are_not(session, looker):
    looker.chronicler.listeners.clear()
    chronicler.dismiss()  # so that nobody watches
    session.evaluate_text(EARLIER)
    late = type(looker)()
    late.open_board()
    told = late.call("/cramhy/get_state", "cramhy_msgs/GetState").tasks.tasks
    names = [(task.name, task.state, task.ended - task.began) for task in told]
    assert names[0] == ("[WALLS-TOP-LEVEL]", "SUCCEEDED", 2.0)
    assert ("[REPLACEABLE-FUNCTION-WALL] (WALL 2), call 2", "SUCCEEDED", 2.0) in names
    assert names[-2][:2] == ("[TOP-LEVEL]", "FAILED") and told[-2].result.startswith("SIMPLE-PLAN-FAILURE")
    known = {task.id for task in told}
    assert all(task.parent in known for task in told if task.parent) and told == sorted(told, key=lambda task: int(task.id))
    session.evaluate_text("(top-level (sleep 1))")
    kernel.sleep(1)
    assert {task.name for task in late.tasks()} == {"[TOP-LEVEL]"} and len({task.id for task in late.tasks()}) == 1


TURTLE = """(progn (roslisp:start-ros-node "driver") (sleep 1)
  (let ((pub (roslisp:advertise "/turtle1/cmd_vel" "geometry_msgs/Twist")))
    (roslisp:publish pub (roslisp:make-message "geometry_msgs/Twist" (x linear) 1 (z angular) 1))))"""


def test_the_turtles_are_told_as_they_move_with_what_their_pens_draw(session, looker):
    session.evaluate_text(TURTLE)
    session.evaluate_text("(sleep 0.5)")
    worlds = looker.told["world"]
    assert worlds[0].simulator == "/turtlesim"
    assert worlds[0].complete and [turtle.name for turtle in worlds[0].turtles] == ["turtle1"]
    moving = [world for world in worlds[1:] if world.strokes]
    assert len(moving) >= 30 and not any(world.complete for world in moving)
    for before, after in zip(moving, moving[1:]):
        assert (before.strokes[-1].x2, before.strokes[-1].y2) == (after.strokes[0].x1, after.strokes[0].y1)
    assert moving[-1].turtles[0].linear_velocity == 1.0


def test_a_clear_is_told_by_another_number(session, looker):
    session.evaluate_text(TURTLE)
    session.evaluate_text("""(progn (sleep 0.5) (roslisp:call-service "/clear" 'std_srvs-srv:Empty) (sleep 0.1))""")
    worlds = looker.told["world"]
    assert worlds[-1].clears == worlds[0].clears + 1
    state = looker.chronicler.state.messages()["world"]
    assert state.complete and 0 < len(state.strokes) < 10  # those since the clear, thinned out


def test_a_clean_paper_is_told_though_no_turtle_moves(session, looker):
    session.evaluate_text("""(progn (roslisp:start-ros-node "plan") (sleep 2) (turtlesim:press :up) (sleep 3))""")
    before = looker.told["world"][-1]
    session.evaluate_text("""(progn (roslisp:call-service "/clear" 'std_srvs-srv:Empty) (sleep 0.1))""")
    assert looker.told["world"][-1].clears == before.clears + 1
    assert [*map(str, looker.told["world"][-1].turtles)] == [*map(str, before.turtles)]


def test_what_goes_wrong_in_looking_ends_that_look_and_nothing_else(session, looker, monkeypatch, capsys):
    def broken():
        raise RuntimeError("no eyes")

    monkeypatch.setattr(looker.chronicler.sources["fluents"], "take", broken)
    session.evaluate_text(PAR)
    kernel.sleep(1)
    assert "Changes of fluents can be told no more: RuntimeError: no eyes" in " ".join(capsys.readouterr().err.split())
    assert states(looker, "PAR-CHILD-#2/2")[-1] == "SUCCEEDED"


def test_an_object_that_cannot_be_printed_is_told_as_that(session, looker):
    session.evaluate_text("""(progn (defclass shy () ()) (defmethod print-object ((s shy) stream) (sleep 1) (error "not me")))""")
    session.evaluate_text("""(defparameter *shy* (make-fluent :name "shy" :value (make-instance 'shy)))""")
    kernel.sleep(1)
    values = [fluent.value for message in looker.told["fluents"] for fluent in message.fluents if fluent.name == "shy"]
    assert [value.partition(":")[0] for value in values] == ["#<error printing a SHY"]


def test_texts_beyond_latin_come_out_as_they_were(session, looker):
    session.evaluate_text("""(defparameter *word* (make-fluent :name "größe" :value "Schildkröte 🐢"))""")
    kernel.sleep(1)
    told = [to_json(fluent) for message in looker.told["fluents"] for fluent in message.fluents if fluent.name.startswith("gr")]
    assert [(fluent["name"], fluent["value"]) for fluent in told] == [("größe", '"Schildkröte 🐢"')]


def test_looking_on_changes_nothing_that_the_program_prints(session, looker):
    from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

    session.evaluate_text("(defclass thing () ())")
    session.evaluate_text("""(defparameter *thing* (make-fluent :name "thing" :value (make-instance 'thing)))""")
    before = prin1_to_string(session.evaluate_text("(make-instance 'thing)")[0])
    kernel.sleep(1)
    after = prin1_to_string(session.evaluate_text("(make-instance 'thing)")[0])
    assert int(after[-12:-2], 16) - int(before[-12:-2], 16) == 0x40
    values = [fluent.value for message in looker.told["fluents"] for fluent in message.fluents if fluent.name == "thing"]
    assert values == ["#<THING {?}>"]


def test_who_prints_while_somebody_looks_on_prints_as_ever(session, looker):
    from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string

    looker.chronicler.listeners.clear()  # so that nobody looks but who asks
    looker.open_board()
    session.evaluate_text("""(progn (defclass slow () ()) (defmethod print-object ((s slow) stream) (sleep 1) (write-string "slow" stream))
                                    (defclass thing () ())
                                    (defparameter *slow* (make-fluent :name "slow" :value (make-instance (quote slow)))))""")
    states = []
    kernel.spawn(lambda: states.append(looker.call("/cramhy/get_state", "cramhy_msgs/GetState")))
    kernel.sleep(0.5)
    assert "{?}" not in prin1_to_string(session.evaluate_text("(make-instance 'thing)")[0])
    kernel.sleep(3)
    assert "slow" in [fluent.value for fluent in states[0].fluents.fluents]


def test_looking_at_a_task_gives_it_no_number(session, looker):
    session.evaluate_text("""(defparameter *who* (make-fluent :name "who"))""")
    session.evaluate_text("(top-level (par (progn (setf (value *who*) (cpl-impl:current-task)) (sleep 1)) (sleep 1)))")
    values = [fluent.value for message in looker.told["fluents"] for fluent in message.fluents if fluent.name == "who"]
    assert values[-1] == '#<TASK "[PAR-CHILD-#1/2]" {?}>' and "-#1/2]-" not in "".join(task.name for task in looker.tasks())
