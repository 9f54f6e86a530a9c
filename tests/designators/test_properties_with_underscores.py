"""In Hy and Python ``max_speed`` and ``:max-speed`` are one name of a property, wherever it is written; fields of messages keep theirs."""

import itertools
import types

import hy
import pytest

from cramhy_runtime.designators import Motion, make_designator, property_values
from cramhy_runtime.lisp_core.data import lisp_list
from cramhy_runtime.lisp_core.packages import keyword
from cramhy_runtime.prolog import kw

MADE = [
    "(a motion (type driving) (max_speed 5))",
    "(a motion (type driving) (:max_speed 5))",
    "(a motion (type driving) (max-speed 5))",
    "(desig-prop-value (an action (type going) (by_way_of (a motion (type driving) (max_speed 5)))) :by-way-of)",
    "(make-designator :motion '((:type :driving) (:max_speed 5)))",
    "(Motion :type (lisp :driving) :max-speed 5)",
    "(Motion :type (lisp :driving) :max_speed 5)",
]
READ = [
    "(desig-prop-value d :max_speed)",
    "(desig-prop-value d ':max_speed)",
    "(desig-prop-value d :max-speed)",
    "(get (desig-prop-values d :max_speed) 0)",
    "(with-desig-props [max_speed] d max_speed)",
    "(with-desig-props [max-speed] d max-speed)",
    "(var-value '?s (get (prolog `(desig-prop ~d (max_speed ?s))) 0))",
    "(var-value '?s (get (prolog `(and (desig-prop ~d (type driving)) (desig-prop ~d (:max_speed ?s)))) 0))",
    "(get (reference d) 1)",
    "d.max-speed",
    "d.max_speed",
    '(get d "max_speed")',
    '(get d "max-speed")',
]


def compiled(text):
    module = types.ModuleType("properties_with_underscores")
    hy.eval(
        hy.read_many("(require cramhy *)\n(import cramhy_runtime.designators [Motion])\n" + text), module=module, locals=module.__dict__
    )
    return module


@pytest.mark.soak
def test_each_way_of_writing_meets_each_way_of_reading():
    rule = """(def-fact-group speeds [motion-grounding]
      (<- (motion-grounding ?d [drive ?s]) (desig-prop ?d (type driving)) (desig-prop ?d (max_speed ?s))))"""
    found = compiled(
        f"{rule}\n(setv answers [])\n" + "\n".join(f"(do (setv d {m}) (.append answers {r}))" for m, r in itertools.product(MADE, READ))
    )
    assert found.answers == [5] * len(MADE) * len(READ)


def test_fields_of_messages_keep_their_underscores():
    assert compiled('(setv name (. (make-msg "geometry_msgs/PoseStamped" (:frame_id :header) "map") header frame_id))').name == "map"


def test_python_reads_underscores_that_lisp_code_has_written():
    motion = make_designator(kw.motion, lisp_list(lisp_list(keyword("MAX_SPEED"), 5)))
    assert motion.max_speed == motion["max-speed"] == 5 and property_values(motion, "max_speed") == [5] and "max_speed" in motion
    with pytest.raises(AttributeError, match="has no property 'min_speed'. Did you mean 'max_speed'"):
        motion.min_speed  # noqa: B018
    assert Motion(("max-speed", 1)).max_speed == Motion(("max_speed", 1)).max_speed == 1
