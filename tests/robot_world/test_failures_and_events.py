"""Failures, events and occasions. Source: mobile-manipulation.md, sections 2 and 5, and invariants 1, 2, 8 and 9."""

import pytest

LOW, HIGH = "Low-level failure happened", "High-level failure happened"
FAILURES = [
    ("low-level-failure", "cpl:simple-plan-failure", LOW),
    ("high-level-failure", "cpl:simple-plan-failure", HIGH),
    *(
        (name, "common-fail:" + parent, text)
        for parent, names, text in (
            (
                "low-level-failure",
                "actionlib-action-timed-out navigation-low-level-failure perception-low-level-failure ptu-low-level-failure "
                "manipulation-low-level-failure",
                LOW,
            ),
            ("navigation-low-level-failure", "navigation-pose-unreachable navigation-goal-not-reached", LOW),
            ("perception-low-level-failure", "perception-object-not-found", LOW),
            ("ptu-low-level-failure", "ptu-goal-unreachable ptu-goal-not-reached", LOW),
            (
                "manipulation-low-level-failure",
                "manipulation-goal-not-reached manipulation-pose-unreachable gripper-low-level-failure torso-low-level-failure",
                LOW,
            ),
            ("gripper-low-level-failure", "gripper-closed-completely gripper-goal-not-reached", LOW),
            ("torso-low-level-failure", "torso-goal-unreachable torso-goal-not-reached", LOW),
            (
                "high-level-failure",
                "navigation-high-level-failure looking-high-level-failure manipulation-goal-in-collision environment-unreachable "
                "environment-manipulation-impossible object-unreachable object-unfetchable object-undeliverable object-nowhere-to-be-found",
                HIGH,
            ),
            ("navigation-high-level-failure", "navigation-goal-in-collision", HIGH),
        )
        for name in names.split()
    ),
]


def test_each_failure_has_its_parent_and_its_text(lisp):
    wrong = []
    for name, parent, text in FAILURES:
        found = lisp(
            f"(let ((c (make-condition 'common-fail:{name}))) (list (subtypep 'common-fail:{name} '{parent}) (typep c 'cpl:plan-failure)"
            " (princ-to-string c)))"
        )
        if found != f'(T T "{text}")':
            wrong.append((name, found))
    assert not wrong


@pytest.mark.parametrize("text", ["Too far.", "Only 50~% of ~a", "100 % {sure} %s"])
@pytest.mark.parametrize("name", ["low-level-failure", "gripper-closed-completely", "object-unfetchable"])
def test_a_description_takes_the_place_of_the_text_as_it_stands(lisp, name, text):
    assert lisp(f'(princ-to-string (make-condition \'common-fail:{name} :description "{text}"))') == f'"{text}"'


@pytest.mark.parametrize(
    "name, initarg, reader",
    [
        ("navigation-pose-unreachable", "location", "navigation-failure-location"),
        ("perception-object-not-found", "object", "object-not-found-object"),
        ("gripper-goal-not-reached", "object", "gripper-failure-action"),
        ("navigation-goal-in-collision", "pose-stamped", "navigation-failure-pose-stamped"),
        ("object-unreachable", "object", "object-unreachable-object"),
        ("object-unfetchable", "object", "object-unfetchable-object"),
        ("object-undeliverable", "object", "object-undeliverable-object"),
        ("object-nowhere-to-be-found", "object", "object-nowhere-to-be-found-object"),
    ],
)
def test_a_failure_tells_what_it_is_about(lisp, name, initarg, reader):
    assert lisp(f"(common-fail:{reader} (make-condition 'common-fail:{name} :{initarg} 'it))") == "IT"
    assert lisp(f"(common-fail:{reader} (make-condition 'common-fail:{name}))") == "NIL"


def test_a_handler_of_the_parent_catches_the_failure(lisp):
    form = """(cpl:top-level
                (cpl:with-failure-handling
                    ((common-fail:manipulation-low-level-failure (e) (return (princ-to-string e))))
                  (cpl:fail 'common-fail:gripper-closed-completely :description "There was no object to grip")))"""
    assert lisp(form) == '"There was no object to grip"'


EVENTS = {
    "object-perceived-event": ("object-designator event-object-designator", "perception-source perception-source"),
    "object-updated-event": ("object-designator event-object-designator", "perception-source perception-source"),
    "object-attached": ("object-name event-object-name", "arm event-arm"),
    "object-detached": ("object-name event-object-name", "arm event-arm"),
    "object-articulation-event": ("object-designator event-object-designator", "opening-distance opening-distance"),
    **dict.fromkeys(
        ("container-opening-event", "container-closing-event"),
        (
            "joint-name environment-event-joint-name",
            "side environment-event-arm",
            "environment environment-event-object",
            "distance environment-event-distance",
        ),
    ),
}


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize("name", EVENTS)
def test_an_event_has_what_it_needs(lisp, name):
    slots = [slot.split() for slot in EVENTS[name]]
    given = [f":{initarg} {number}" for number, (initarg, _) in enumerate(slots)]
    read = " ".join(f"(cpoe:{reader} e)" for _, reader in slots)
    assert lisp(f"(let ((e (make-instance 'cpoe:{name} {' '.join(given)}))) (list (typep e 'cram-occasions-events:event) {read}))") == (
        f"(T {' '.join(map(str, range(len(slots))))})"
    )
    for missing in range(len(slots)):
        there = " ".join(given[:missing] + given[missing + 1 :])
        assert lisp(f"(make-instance 'cpoe:{name} {there})").startswith('"SIMPLE-ERROR: ')


def test_what_an_event_lacks_is_told(lisp):
    assert lisp("(make-instance 'cpoe:object-perceived-event :perception-source 1)") == (
        '"SIMPLE-ERROR: OBJECT-PERCEIVED-EVENT requires an object."'
    )
    assert lisp("(make-instance 'cpoe:object-perceived-event :object-designator 1)") == (
        '"SIMPLE-ERROR: OBJECT-PERCEIVED-EVENT requires a perception source."'
    )


def test_a_changed_robot_needs_nothing_and_a_removed_object_has_a_name(lisp):
    assert lisp("(typep (make-instance 'cpoe:robot-state-changed) 'cram-occasions-events:event)") == "T"
    assert lisp("(cpoe:event-object-name (make-instance 'cpoe:object-removed-event))") == ":OBJECT-NAME"


@pytest.mark.soak(all_but=3)
@pytest.mark.parametrize(
    "occasion",
    ["object-in-hand ?x", "object-placed-at ?x ?y", "object-picked ?x", "object-put ?x", "loc ?x ?y", "looking-at ?x", "arms-parked"],
)
def test_an_occasion_does_not_hold_until_somebody_says_so(lisp, occasion):
    name, *variables = occasion.split()
    goal, fact = f"(cpoe:{occasion})", f"(cpoe:{name} {' '.join('cup' for _ in variables)})"
    assert lisp(f"(cram-occasions-events:holds '{goal})") == "NIL"
    lisp(f"(prolog:def-fact-group belief-{name} (cpoe:{name}) (prolog:<- {fact}))")
    assert lisp(f"(and (cram-occasions-events:holds '{goal}) t)") == "T"
    lisp(f"(prolog:def-fact-group belief-{name} (cpoe:{name}))")
    assert lisp(f"(cram-occasions-events:holds '{goal})") == "NIL"
