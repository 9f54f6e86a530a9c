"""The invariants of turtlesim.md, in its order, each as a student would try it: forms typed into a REPL, in virtual time."""

import math

import pytest

PEN, GROUND = (179, 184, 255), (69, 86, 255)
CENTRE, WALL = 5.544444561004639, 11.088889122009277
TURTLE = "Spawning turtle [turtle1] at x=[5.544445], y=[5.544445], theta=[0.000000]"


def teleport(typed, x, y, theta=0.0, turtle="turtle1"):
    """Two ticks later the turtle is there."""
    typed(f'(call-service "{turtle}/teleport_absolute" "turtlesim/TeleportAbsolute" :x {x} :y {y} :theta {theta}) (sleep 0.04)')


def warnings(typed):
    return [line for line in typed.log() if "hit the wall" in line]


@pytest.mark.law("turtlesim", 1, 2)
def test_a_fresh_turtle_and_what_the_simulator_says(typed):
    assert typed.pose() == (CENTRE, CENTRE, 0.0, 0.0, 0.0)
    assert typed.colour() == GROUND
    assert typed.log() == ["INFO Starting turtlesim with node name /turtlesim", f"INFO {TURTLE}"]


@pytest.mark.law("turtlesim", 3)
def test_the_background_are_parameters_of_the_node_and_one_that_is_set_already_stays(typed):
    assert typed('(mapcar #\'get-param \'("/turtlesim/background_r" "/turtlesim/background_g" "/turtlesim/background_b"))') == "(69 86 255)"
    typed("""(turtlesim:stop "/turtlesim")
             (delete-param "/turtlesim") (set-param "/turtlesim/background_r" 10)
             (turtlesim:start) (sleep 0.1)""")
    assert typed.colour() == (10, 86, 255)
    assert typed('(mapcar #\'get-param \'("/turtlesim/background_r" "/turtlesim/background_g" "/turtlesim/background_b"))') == "(10 86 255)"


@pytest.mark.law("turtlesim", 4)
def test_poses_and_colours_come_62_5_times_a_second_also_at_rest(typed):
    assert (
        typed("""(clrhash *poses*) (clrhash *colours*) (sleep 10)
                    (list (length (gethash "turtle1" *poses*)) (length (gethash "turtle1" *colours*)))""")
        == "(625 625)"
    )


@pytest.mark.law("turtlesim", 5, 6)
def test_one_command_ahead_lasts_a_second(typed):
    typed("(drive 2 0) (sleep 0.5)")
    assert typed.pose()[3:] == (2.0, 0.0)
    typed("(sleep 0.6)")
    assert typed.pose()[3:] == (0.0, 0.0)
    typed("(sleep 0.4)")
    assert typed.pose() == (pytest.approx(7.560444355, abs=1e-6), CENTRE, 0.0, 0.0, 0.0)


@pytest.mark.law("turtlesim", 7)
def test_backwards_the_speed_is_positive(typed):
    typed("(drive -2 0) (sleep 0.5)")
    assert typed.pose()[3] == 2.0
    typed("(sleep 1)")
    assert typed.pose()[0] == pytest.approx(3.528444529, abs=1e-6)


@pytest.mark.law("turtlesim", 8)
def test_turning_on_the_spot_moves_nothing_and_draws_nothing(typed):
    typed("(drive 0 2) (sleep 1.5)")
    assert typed.pose() == (CENTRE, CENTRE, pytest.approx(2.016, abs=1e-6), 0.0, 0.0)
    assert typed.colour() == GROUND and typed.paper.rgb() == bytes(GROUND) * 250_000


@pytest.mark.law("turtlesim", 9)
def test_sideways_is_up_for_a_turtle_that_looks_right(typed):
    typed("(drive 0 0 :sideways 1) (sleep 1.5)")
    assert typed.pose()[:3] == (CENTRE, pytest.approx(6.552444458, abs=1e-6), 0.0)


@pytest.mark.law("turtlesim", 10)
def test_an_arc(typed):
    typed("(drive 2 1.8) (sleep 1.5)")
    assert typed.pose()[:3] == pytest.approx((6.602816582, 6.938989639, 1.8144), abs=1e-6)


@pytest.mark.law("turtlesim", 11)
def test_repeated_commands_move_without_interruption(typed):
    typed("(dotimes (i 7) (drive 1 0) (sleep 0.5)) (sleep 1.1)")
    assert 3.9 <= typed.pose()[0] - CENTRE <= 4.1


@pytest.mark.law("turtlesim", 12)
def test_a_command_of_zeros_stops_the_turtle(typed):
    typed("(drive 5 0) (sleep 0.1) (drive 0 0) (sleep 1)")
    assert 0.4 <= typed.pose()[0] - CENTRE <= 0.6


@pytest.mark.law("turtlesim", 13)
def test_a_turtle_does_not_fly_roll_or_pitch(typed):
    before = typed.pose()
    typed("""(drive 0 0)
             (publish-msg (gethash "turtle1" *drivers*) (:z :linear) 1 (:x :angular) 2 (:y :angular) 3) (sleep 1.5)""")
    assert typed.pose() == before


@pytest.mark.law("turtlesim", 14)
def test_the_right_wall_holds_exactly_and_the_warning_tells_the_screens_y(typed):
    teleport(typed, 5.5, 2.0)
    typed.log()
    typed("(drive 20 0) (sleep 1.5)")
    assert typed.pose()[:2] == (WALL, 2.0)
    assert warnings(typed)[0] == "WARN Oh no! I hit the wall! (Clamping from [x=11.260000, y=9.088889])"


@pytest.mark.law("turtlesim", 15)
def test_the_warning_at_the_top_tells_a_negative_y(typed):
    teleport(typed, 5.5, 11.0, math.pi / 2)
    typed("(drive 2 0) (sleep 1.5)")
    assert typed.pose()[1] == WALL
    assert warnings(typed)[-1] == "WARN Oh no! I hit the wall! (Clamping from [x=5.500000, y=-0.032000])"


@pytest.mark.law("turtlesim", 16)
def test_against_a_wall_the_pose_tells_the_command_and_each_tick_warns(typed):
    teleport(typed, 11.088889, 5.5)
    typed.log()
    typed("(drive 1 0) (sleep 0.48)")
    assert typed.pose()[:4] == (WALL, 5.5, 0.0, 1.0)
    assert len(warnings(typed)) == 30


@pytest.mark.law("turtlesim", 17)
def test_a_teleport_answers_with_nothing_and_leaves_the_speed(typed):
    typed("(drive 0 1) (sleep 0.1)")
    answer = typed('(call-service "turtle1/teleport_absolute" "turtlesim/TeleportAbsolute" :x 1 :y 1 :theta 0)')
    assert answer == "[TURTLESIM-SRV:TELEPORTABSOLUTE-RESPONSE]"
    typed("(sleep 0.032)")
    x, y, theta, speed, turn = typed.pose()
    assert (x, y, speed, turn) == (1.0, 1.0, 0.0, 1.0)
    assert 0 < theta < 0.05


@pytest.mark.law("turtlesim", 18)
def test_teleports_beyond_the_walls(typed):
    typed.log()
    for x, y, there, expected in ((5, 20, (5.0, WALL), []), (5, -3, (5.0, 0.0), ["y=14.088889"]), (20, 5, (WALL, 5.0), ["x=20.000000"])):
        teleport(typed, x, y)
        assert typed.pose()[:2] == there
        told = warnings(typed)
        assert len(told) == len(expected)
        assert all(text in line for text, line in zip(expected, told))


@pytest.mark.law("turtlesim", 19, 20)
def test_angles_are_wrapped_at_a_pi_that_is_a_little_short(typed):
    teleport(typed, 5, 5, "3.1415927")
    assert typed.pose()[2] == pytest.approx(-3.1415925, abs=1e-6)
    typed("(dotimes (i 10) (drive 0 100) (sleep 0.5))")
    printed = typed("""(mapcar #'turtlesim-msg:theta (gethash "turtle1" *poses*))""")
    thetas = [float(word.replace("d", "e")) for word in printed[1:-1].split()]
    assert len(set(thetas)) > 100
    assert all(-3.1415927 <= theta <= 3.1415927 for theta in thetas)


RELATIVE = '(call-service "turtle1/teleport_relative" "turtlesim/TeleportRelative" :linear {} :angular {}) (sleep 0.04)'


@pytest.mark.law("turtlesim", 21)
def test_a_relative_teleport_turns_first(typed):
    teleport(typed, 1, 1)
    typed(RELATIVE.format(2, "(/ pi 2)"))
    assert typed.pose()[:3] == (pytest.approx(1.0, abs=1e-6), pytest.approx(3.0, abs=1e-6), 1.5707963705062866)


@pytest.mark.law("turtlesim", 22)
def test_a_relative_teleport_that_only_turns_paints_a_dot(typed):
    typed(RELATIVE.format(0, 0.5))
    assert typed.pose()[:3] == (CENTRE, CENTRE, 0.5)
    assert typed.colour() == PEN
    assert typed.paper.rgb().count(bytes(PEN)) == 9


@pytest.mark.law("turtlesim", 23)
def test_a_second_turtle_finds_the_first_ones_trail(typed):
    typed("""(call-service "spawn" "turtlesim/Spawn" :x 9 :y 9 :name "second") (watch "second")
             (call-service "second/set_pen" "turtlesim/SetPen" :off 1)""")
    teleport(typed, 2, 2)
    teleport(typed, 3.772, 3.772, turtle="second")
    assert typed.colour("second") == PEN
    teleport(typed, 3, 4, turtle="second")
    assert typed.colour("second") == GROUND


@pytest.mark.law("turtlesim", 24)
def test_the_pen_takes_colour_and_width(typed):
    typed('(call-service "turtle1/set_pen" "turtlesim/SetPen" :r 255 :width 5)')
    teleport(typed, 8, CENTRE)
    assert typed.colour() == (255, 0, 0)
    assert [typed.paper.pixel(300 / 45, row / 45) for row in range(500)].count((255, 0, 0)) == 5


@pytest.mark.law("turtlesim", 25, 26)
def test_a_pen_that_is_off_forgets_the_rest_of_the_request_and_comes_back_with_what_it_is_told(typed):
    typed('(call-service "turtle1/set_pen" "turtlesim/SetPen" :r 9 :g 9 :b 9 :width 9 :off 1) (drive 1 0) (sleep 1.5)')
    assert typed.colour() == GROUND
    typed('(call-service "turtle1/set_pen" "turtlesim/SetPen" :g 255)')
    teleport(typed, 9, CENTRE)
    assert [typed.paper.pixel(350 / 45, row / 45) for row in range(500)].count((0, 255, 0)) == 1
    assert bytes((9, 9, 9)) not in typed.paper.rgb()
    typed('(call-service "turtle1/set_pen" "turtlesim/SetPen" :off 0)')
    teleport(typed, 9, 9)
    assert typed.colour() == (0, 0, 0)  # neither the green nor the grey came back


@pytest.mark.law("turtlesim", 27)
def test_spawn_answers_with_the_name_and_logs(typed):
    typed.log()
    assert typed('(turtlesim-srv:name-val (call-service "spawn" "turtlesim/Spawn" :x 2 :y 2 :theta 0.2 :name ""))') == '"turtle2"'
    assert typed.log() == ["INFO Spawning turtle [turtle2] at x=[2.000000], y=[2.000000], theta=[0.200000]"]
    typed('(watch "turtle2") (sleep 0.1)')
    assert typed.pose("turtle2")[:3] == pytest.approx((2, 2, 0.2), abs=1e-6)


REFUSED = '(handler-case (call-service {}) (simple-error (problem) (format nil "~a" problem)))'


@pytest.mark.law("turtlesim", 28)
def test_a_name_that_is_taken_is_refused_and_nothing_changes(typed):
    typed.log()
    before = typed.pose()
    text = typed(REFUSED.format('"spawn" "turtlesim/Spawn" :x 2 :y 2 :name "turtle1"'))
    assert text.startswith('"service-call to 127.0.0.1:') and text.endswith('turtle1] failed with message: "')
    assert typed.log() == ["ERROR A turtled named [turtle1] already exists"]
    typed("(sleep 0.1)")
    assert typed.pose() == before


SPAWN = '(turtlesim-srv:name-val (call-service "spawn" "turtlesim/Spawn" :x 2 :y 2 :name "{}"))'


@pytest.mark.law("turtlesim", 29)
def test_the_next_free_number_is_taken(typed):
    assert typed(SPAWN.format("turtle2")) == '"turtle2"'
    assert typed(SPAWN.format("")) == '"turtle3"'


@pytest.mark.law("turtlesim", 30, 33)
def test_the_dead_leave_no_names_until_reset_which_begins_anew(typed):
    typed('(call-service "turtle1/set_pen" "turtlesim/SetPen" :r 255 :width 9)')
    teleport(typed, 9, 9)
    typed('(call-service "kill" "turtlesim/Kill" :name "turtle1")')
    assert typed(SPAWN.format("")) == '"turtle2"'
    typed('(drive 3 0 :turtle "turtle2") (sleep 0.5) (call-service "reset" "std_srvs/Empty") (sleep 0.1)')
    assert typed('(list (wait-for-service "turtle1/set_pen" 0.1) (wait-for-service "turtle2/set_pen" 0.1))') == "(T NIL)"
    assert typed.pose() == (CENTRE, CENTRE, 0.0, 0.0, 0.0)
    assert typed.paper.rgb() == bytes(GROUND) * 250_000
    assert typed(SPAWN.format("")) == '"turtle2"'
    typed("(drive 1 0) (sleep 1.5)")
    assert typed.colour() == PEN


@pytest.mark.law("turtlesim", 31)
def test_nobody_cannot_be_killed(typed):
    typed.log()
    assert "failed with message: " in typed(REFUSED.format('"kill" "turtlesim/Kill" :name "nobody"'))
    assert typed.log() == ["ERROR Tried to kill turtle [nobody], which does not exist"]


@pytest.mark.law("turtlesim", 32)
def test_the_killed_leave_the_graph_and_their_trail(typed):
    teleport(typed, 8, 8)
    typed('(call-service "spawn" "turtlesim/Spawn" :x 2 :y 2 :name "other") (call-service "kill" "turtlesim/Kill" :name "turtle1")')
    for service in ("set_pen", "teleport_absolute", "teleport_relative"):
        assert typed(f'(wait-for-service "turtle1/{service}" 0.1)') == "NIL"
        assert typed(f'(wait-for-service "other/{service}" 0.1)') == "T"
    typed("(clrhash *poses*) (clrhash *colours*) (sleep 0.1)")
    assert typed('(list (gethash "turtle1" *poses*) (gethash "turtle1" *colours*))') == "(NIL NIL)"
    assert bytes(PEN) in typed.paper.rgb()


@pytest.mark.law("turtlesim", 34, 35)
def test_clear_fills_the_paper_with_what_the_parameters_say_then(typed):
    teleport(typed, 8, 8)
    before = typed.pose()
    typed('(set-param "/turtlesim/background_r" 150) (sleep 0.1)')
    assert typed.colour() == PEN and typed.paper.pixel(0.0, 0.0) == GROUND
    typed('(call-service "clear" "std_srvs/Empty") (sleep 0.1)')
    assert typed.colour() == (150, 86, 255)
    assert typed.paper.rgb() == bytes((150, 86, 255)) * 250_000
    assert typed.pose() == before
    teleport(typed, 9, 9)
    assert typed.colour() == PEN


@pytest.mark.law("turtlesim", 36)
def test_two_simulators_in_two_name_spaces_know_nothing_of_each_other(typed):
    typed("""(turtlesim:start "__ns:=/a") (turtlesim:start "__ns:=/b") (watch "/a/turtle1") (watch "/b/turtle1")
             (drive 1 0 :turtle "/a/turtle1") (sleep 1.5)""")
    assert typed.pose("/a/turtle1")[0] == pytest.approx(CENTRE + 1.008, abs=1e-6)
    assert typed.pose("/b/turtle1")[0] == typed.pose()[0] == CENTRE
    typed('(call-service "/b/spawn" "turtlesim/Spawn" :x 2 :y 2)')
    assert typed('(list (wait-for-service "/a/turtle2/set_pen" 0.1) (wait-for-service "/b/turtle2/set_pen" 0.1))') == "(NIL T)"


HEARD = """(defvar *heard* nil)
(subscribe "{}" "geometry_msgs/Twist"
           (lambda (message) (with-fields ((x (x linear)) (z (z angular))) message (push (list x z) *heard*))))"""


@pytest.mark.law("turtlesim", 37)
def test_an_arrow_key_is_one_command(typed):
    typed(HEARD.format("turtle1/cmd_vel"))
    typed("(dolist (key '(:up :left :right :down)) (turtlesim:press key) (sleep 0.1))")
    typed("(ignore-errors (turtlesim:press :x))")
    assert typed("(sleep 0.1) (reverse *heard*)") == "((2.0d0 0.0d0) (0.0d0 2.0d0) (0.0d0 -2.0d0) (-2.0d0 0.0d0))"


@pytest.mark.law("turtlesim", 38)
def test_the_scale_is_a_parameter_that_is_read_at_the_start(typed):
    typed(HEARD.format("turtle1/cmd_vel"))
    typed("""(set-param "/scale_linear" 1.0) (turtlesim:press :up) (set-param "/scale_linear" 7.0) (turtlesim:press :up) (sleep 0.1)""")
    assert typed("(list (first (first *heard*)) (length *heard*))") == "(1.0d0 2)"


@pytest.mark.law("turtlesim", 39)
def test_a_square_begins_two_metres_ahead(typed):
    from cramhy_runtime.ros import graph

    teleport(typed, 3, 3, 1)
    typed("(turtlesim:draw-square) (sleep 3)")
    log = [line.split("]: ", 1)[1] for line in graph.active().nodes["/draw_square"].program.lines]
    assert log[0] == "New goal [7.544445 5.544445, 0.000000]"
    x, y, theta, *_ = typed.pose()
    assert math.hypot(x - 7.46, y - 5.544) < 0.12 and theta > 0


@pytest.mark.law("turtlesim", 40)
def test_who_mimics_drives_ahead_when_the_leader_drives_back(typed):
    typed(HEARD.format("turtle2/cmd_vel"))
    typed("""(call-service "spawn" "turtlesim/Spawn" :x 2 :y 2) (watch "turtle2")
             (turtlesim:mimic "turtle1" "turtle2") (drive -1 0) (sleep 0.5)""")
    assert typed("(first *heard*)") == "(1.0d0 0.0d0)"
    typed("(sleep 1)")
    assert typed.pose("turtle2")[0] == pytest.approx(2 + 1.008, abs=0.017)
    assert typed.pose()[0] == pytest.approx(CENTRE - 1.008, abs=1e-5)


@pytest.mark.law("turtlesim", 41)
def test_who_comes_late_gets_the_next_pose_and_nothing_older(typed):
    typed("""(call-service "spawn" "turtlesim/Spawn" :x 2 :y 2 :name "late") (sleep 1) (defvar *late* 0)
             (subscribe "late/pose" "turtlesim/Pose" (lambda (pose) (incf *late*)))""")
    assert typed("*late*") == "1"  # the one of the tick in which the turtle heard of the subscription
    assert typed("(sleep 0.016) *late*") == "2"


@pytest.mark.law("turtlesim", 42)
def test_of_the_commands_of_a_tick_the_last_one_counts(typed):
    typed("(drive 5 0) (drive 0 5) (drive 1 0) (sleep 0.05)")
    assert typed.pose()[3:] == (1.0, 0.0)
    assert typed.pose()[2] == 0.0


@pytest.mark.law("turtlesim", 43)
def test_who_is_spawned_outside_hits_the_wall_at_once(typed):
    typed.log()
    typed('(call-service "spawn" "turtlesim/Spawn" :x 12 :y 2 :name "far") (watch "far") (sleep 0.1)')
    assert warnings(typed) == ["WARN Oh no! I hit the wall! (Clamping from [x=12.000000, y=9.088889])"]
    assert typed.pose("far")[0] == WALL
