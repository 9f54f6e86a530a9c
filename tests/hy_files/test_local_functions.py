"""Functions that an operator gives its body have the names of functions of Lisp; in its body theirs count."""

from __future__ import annotations

import subprocess
import sys

import pytest


@pytest.mark.soak
def test_the_answer_of_a_service_is_that_of_the_callback(tmp_path):
    path = tmp_path / "add.hy"
    path.write_text(
        """(require cramhy *)
        (cramhy.time "virtual")
        (start-ros-node "n")
        (def-service-callback roscpp_tutorials-srv:TwoInts [a b] (make-response :sum (+ a b)))
        (register-service "add" roscpp_tutorials-srv:TwoInts)
        (with-fields [sum] (call-service "add" "roscpp_tutorials/TwoInts" :a 3 :b 4) (print "sum" sum))"""
    )
    done = subprocess.run([sys.executable, "-m", "hy", str(path)], capture_output=True, text=True)
    assert done.stdout.endswith("sum 7\n"), done.stdout + done.stderr


def test_a_response_has_several_fields(load):
    module = load("""(start-ros-node "n")
        (def-service-callback std_srvs-srv:SetBool [data] (make-response :success data :message (if (is data False) "off" "on")))
        (register-service "switch" std_srvs-srv:SetBool)
        (setv answer (call-service "switch" "std_srvs/SetBool" :data False))""")
    assert (module.answer.success, module.answer.message) == (False, "off")


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize(
    "call",
    [
        '(publish-msg (advertise "t" "std_msgs/Int8") :data 300)',
        '(publish (advertise "t" "std_msgs/Int8") (make-msg "std_msgs/Int8" :data 300))',
        '(call-service "add" "roscpp_tutorials/TwoInts" :a (** 2 70) :b 1)',
    ],
)
def test_an_integer_out_of_range_is_not_sent(load, call):
    with pytest.raises(ValueError, match="which is out of the range of int"):
        load(f"""(start-ros-node "n")
            (def-service-callback roscpp_tutorials-srv:TwoInts [a b] (make-response :sum (+ a b)))
            (register-service "add" roscpp_tutorials-srv:TwoInts)
            {call}""")
