"""Examples of the plan language."""

from example import Example

SUSPENDED_IN_PYTHON = """
def main():
    with cpl.par() as branches:
        task = branches.start(drive)
        cpl.sleep(1)
        with cpl.task_suspended(task):
            cpl.sleep(5)
    return task.result
run(main)
"""
RACE_IN_PYTHON = """
def quick():
    cpl.sleep(1)
    return note("over")
run(lambda: cpl.pursue(careful, quick))
"""

PLAN_LANGUAGE = {
    "top-level": Example("(top-level (note 1) (+ 2 3))", "run(lambda: (note(1), 2 + 3)[1])"),
    "named-top-level": Example(
        "(cpl-impl:named-top-level (:name lecture) (sleep 2) (+ 3 4))", "cpl.named_top_level(lambda: (cpl.sleep(2), 3 + 4)[1], 'lecture')"
    ),
    "seq": Example("(top-level (seq (note 1) (note 2)))", "run(lambda: cpl.seq(lambda: note(1), lambda: note(2)))"),
    "par": Example(
        '(top-level (par (progn (sleep 2) (note "slow")) (progn (sleep 1) (note "fast"))))',
        """
        def branch(seconds, name):
            cpl.sleep(seconds)
            return note(name)
        run(lambda: cpl.par(lambda: branch(2, "slow"), lambda: branch(1, "fast")))
        """,
    ),
    "pursue": Example(
        '(top-level (pursue (unwind-protect (sleep 9) (note "cleaned")) (progn (sleep 1) (note "won"))))',
        """
        def slow():
            try:
                cpl.sleep(9)
            finally:
                note("cleaned")
        def quick():
            cpl.sleep(1)
            return note("won")
        run(lambda: cpl.pursue(slow, quick))
        """,
    ),
    "try-all": Example('(top-level (try-all (fail "no") (progn (sleep 1) 5)))', "run(lambda: cpl.try_all(lambda: cpl.fail('no'), five))"),
    "try-in-order": Example(
        '(top-level (try-in-order (fail "no") (note 2) (note "never")))',
        "run(lambda: cpl.try_in_order(lambda: cpl.fail('no'), lambda: note(2), lambda: note('never')))",
    ),
    "try-each-in-order": Example(
        '(top-level (try-each-in-order (x (list 1 2 3)) (note x) (if (< x 2) (fail "too small") (* 10 x))))',
        "run(lambda: cpl.try_each_in_order([1, 2, 3], lambda x: (note(x), cpl.fail('too small') if x < 2 else 10 * x)[1]))",
    ),
    "par-loop": Example(
        "(top-level (par-loop (x (list 3 1 2)) (sleep x) (note x) (* 10 x)))",
        "run(lambda: cpl.par_loop([3, 1, 2], lambda x: (cpl.sleep(x), note(x), 10 * x)[2]))",
    ),
    "partial-order": Example(
        """(top-level (with-tags (partial-order ((:tag place (note "place")) (progn (sleep 1) (:tag grasp (note "grasp"))))
                                               (:order grasp place))))""",
        """
        def grasp_later():
            cpl.sleep(1)
            return grasp.run(note, "grasp")
        def main():
            return cpl.partial_order([lambda: place.run(note, "place"), grasp_later], [(grasp, place)])
        with cpl.plan():
            place, grasp = cpl.tag("place"), cpl.tag("grasp")
            result = main()
        result
        """,
    ),
    "with-parallel-childs": Example(
        """(top-level (cpl-impl::with-parallel-childs nil (running completed failed) ((progn (sleep 1) 7) (sleep 9))
                        (when completed (return "one is done"))))""",
        """
        def seven():
            cpl.sleep(1)
            return 7
        def main():
            with cpl.par() as branches:
                quick, slow = branches.start(seven), branches.start(cpl.sleep, 9)
                cpl.wait_for(cpl.fl_eq(quick.status_fluent, cpl.SUCCEEDED))
                slow.evaporate()
                return "one is done"
        run(main)
        """,
    ),
    "with-task-suspended": Example(
        """(top-level (with-tags (par (:tag drive (sleep 1) (sleep 1) (note "there"))
                                      (progn (with-task-suspended (drive :reason "look") (sleep 5) (note "looked")) nil))))""",
        """
        def drive():
            cpl.sleep(1)
            cpl.sleep(1)
            return note("there")
        def look(task):
            with cpl.task_suspended(task):
                cpl.sleep(5)
                note("looked")
        def main():
            with cpl.par() as branches:
                task = branches.start(drive)
                look(task)
            return task.result
        run(main)
        """,
    ),
    "with-task": Example(
        '(top-level (cpl-impl:with-task (:name "helper") (sleep 1) (note 1) 2))',
        "run(lambda: cpl.with_task(lambda: (cpl.sleep(1), note(1), 2)[2]))",
    ),
    "whenever": Example(
        """(defvar *n* (make-fluent :value nil))
           (top-level (par (whenever (*n*) (note (value *n*)) (if (> (value *n*) 1) (return)) (setf (value *n*) nil))
                           (progn (setf (value *n*) 1) (sleep 1) (setf (value *n*) 2) nil))
                      (value *n*))""",
        """
        n = cpl.make_fluent(value=None)
        def watch():
            for seen in cpl.whenever(n):
                note(n.value)
                if n.value > 1:
                    break
                n.value = None
        def change():
            n.value = 1
            cpl.sleep(1)
            n.value = 2
        run(lambda: (cpl.par(watch, change), n.value)[1])
        """,
    ),
    "def-cpl-parameter": Example(
        '(def-cpl-parameter *speed* 3 "metres a second") (setf *speed* 5) *speed*',
        "speed = cpl.make_fluent(value=3)\nspeed.value = 5\nspeed.value",
        hy='(def-cpl-parameter *speed* 3 "metres a second") (setv *speed*.value 5) *speed*.value',
    ),
    "on-suspension": Example(
        """(top-level (with-tags (par (:tag drive (on-suspension (note "stops") (sleep 2) (note "there")))
                                      (progn (sleep 1) (with-task-suspended (drive) (sleep 5)) nil))))""",
        """
def drive():
    with cpl.on_suspension(lambda: note("stops")):
        cpl.sleep(2)
        return note("there")
"""
        + SUSPENDED_IN_PYTHON,
    ),
    "retry-after-suspension": Example(
        """(top-level (with-tags (par (:tag drive (retry-after-suspension (note "begins") (sleep 2) (note "there")))
                                      (progn (sleep 1) (with-task-suspended (drive) (sleep 5)) nil))))""",
        """
def motion():
    note("begins")
    cpl.sleep(2)
    return note("there")
def drive():
    return cpl.retry_after_suspension(motion)
"""
        + SUSPENDED_IN_PYTHON,
    ),
    "without-scheduling": Example(
        '(top-level (pursue (without-scheduling (sleep 3) (note "through")) (progn (sleep 1) (note "over"))))',
        """
def careful():
    with cpl.without_scheduling():
        cpl.sleep(3)
        note("through")
"""
        + RACE_IN_PYTHON,
    ),
    "with-scheduling": Example(
        """(top-level (pursue (without-scheduling (with-scheduling (sleep 3)) (note "through"))
                              (progn (sleep 1) (note "over"))))""",
        """
def careful():
    with cpl.without_scheduling():
        with cpl.with_scheduling():
            cpl.sleep(3)
        note("through")
"""
        + RACE_IN_PYTHON,
    ),
    "define-task-variable": Example(
        '(define-task-variable *place* "home" "where") (top-level (par (progn (setf *place* "away") 1) 2) (note *place*))',
        """
        place = cpl.define_task_variable("place", "home")
        def away():
            place.value = "away"
        run(lambda: (cpl.par(away, lambda: 2), note(place.value))[1])
        """,
        hy="""(define-task-variable *place* "home" "where")
              (top-level (par (do (setv *place*.value "away") 1) 2) (note *place*.value))""",
    ),
    "with-failure-handling": Example(
        """(define-condition door-stuck (simple-plan-failure) ())
           (top-level (with-failure-handling ((door-stuck (e) (note "handler") (return "gave up")))
                        (unwind-protect (fail 'door-stuck) (note "cleanup"))))""",
        """
        class DoorStuck(cpl.PlanFailure):
            pass
        def handler(failure, retry):
            note("handler")
            retry.leave("gave up")
        @cpl.handling({DoorStuck: handler})
        def body():
            try:
                cpl.fail(DoorStuck())
            finally:
                note("cleanup")
        run(body)
        """,
    ),
    "with-retry-counters": Example(
        """(top-level (with-retry-counters ((tries 2))
                        (with-failure-handling ((simple-plan-failure (e) (do-retry tries (retry)) (return "gave up")))
                          (note "tries") (fail "no"))))""",
        """
        tries = cpl.RetryCounter(2)
        def again(failure, retry):
            if tries.use():
                retry()
            retry.leave("gave up")
        @cpl.handling({cpl.SimplePlanFailure: again})
        def body():
            note("tries")
            cpl.fail("no")
        run(body)
        """,
    ),
    "with-tags": Example(
        '(top-level (with-tags (par (:tag look (sleep 1) (note "looked")) (progn (wait-for (eq (status look) :succeeded)) (note "so")))))',
        """
        def main():
            look = cpl.tag("look")
            def looking():
                cpl.sleep(1)
                return note("looked")
            def waiting():
                cpl.wait_for(cpl.fl_eq(look.task.status_fluent, cpl.SUCCEEDED))
                return note("so")
            return cpl.par(lambda: look.run(looking), waiting)
        run(main)
        """,
    ),
    "with-task-tree-node": Example(
        """(top-level (cpl-impl::with-task-tree-node (:path-part '(foo 1) :name "FOO" :sexp '(bar) :lambda-list (a b) :parameters (list 1 2))
                        (note (+ a b)) b))""",
        """
        @cpl.plan_function
        def foo(a, b):
            note(a + b)
            return b
        run(foo, 1, 2)
        """,
    ),
    "replaceable-function": Example(
        "(top-level (cpl-impl::replaceable-function f (x) (list 1) '(f) (note x) (+ x 1)))",
        """
        @cpl.plan_function
        def f(x):
            note(x)
            return x + 1
        run(f, 1)
        """,
    ),
    "def-cram-function": Example(
        '(def-cram-function fetch (thing) "Fetches." (note thing) 7) (top-level (fetch "cup"))',
        """
        @cpl.plan_function
        def fetch(thing):
            note(thing)
            return 7
        run(fetch, "cup")
        """,
    ),
    "def-top-level-cram-function": Example(
        '(def-top-level-cram-function tidy (room) "Tidies." (sleep 1) (note room)) (tidy "kitchen")',
        """
        def tidy(room):
            cpl.sleep(1)
            return note(room)
        run(tidy, "kitchen")
        """,
    ),
    "def-plan": Example(
        '(def-plan fetch (thing) (note thing) 7) (top-level (fetch "cup"))',
        """
        @cpl.plan_function
        def fetch(thing):
            note(thing)
            return 7
        run(fetch, "cup")
        """,
    ),
    "def-top-level-plan": Example(
        '(def-top-level-plan tidy (room) (note room) 3) (tidy "kitchen")',
        """
        def tidy(room):
            note(room)
            return 3
        run(tidy, "kitchen")
        """,
    ),
    "declare-goal": Example(
        """(declare-goal at (place) (note "wanted"))
           (def-goal (at ?place) (note ?place) (succeed 5))
           (top-level (at "door"))""",
        """
        class At(Action):
            place: str
        def go(place):
            note(place)
            return 5
        @action_grounding(At)
        def how_to_be_at(action):
            note("wanted")
            return go, action.place
        run(perform, At(place="door"))
        """,
    ),
    "def-goal": Example(
        """(declare-goal loaded (thing place))
           (def-goal (loaded ?thing :tray) (note ?thing) "on the tray")
           (top-level (loaded "cup" :tray))""",
        """
        class Loaded(Action):
            thing: str
            place: object
        def load(thing):
            note(thing)
            return "on the tray"
        @action_grounding(Loaded)
        def how_to_load(action):
            if action.place is kw.tray:
                return load, action.thing
        run(perform, Loaded(thing="cup", place=kw.tray))
        """,
    ),
    "make-policy": Example(
        """(defvar *load* (make-fluent :value 0))
           (defvar *guard* (make-policy guard (limit) "Not too much." (:check (> (value *load*) limit)) (:recover (note "recovers"))))
           (top-level (handler-case (with-policy *guard* (3) (sleep 1) (setf (value *load*) 5) (sleep 1) "never")
                        (policy-failure () "too much")))""",
        """
        load = cpl.make_fluent(value=0)
        guard = cpl.make_policy("guard", check=lambda store, limit: load.value > limit, recover=lambda store, limit: note("recovers"))
        def main():
            try:
                with cpl.policy(guard, 3):
                    cpl.sleep(1)
                    load.value = 5
                    cpl.sleep(1)
                return "never"
            except cpl.PolicyFailure:
                return "too much"
        run(main)
        """,
    ),
    "define-policy": Example(
        """(define-policy calm (limit) "Never acts." (:init (note limit) t) (:check nil) (:clean-up (note "over")))
           (top-level (with-named-policy 'calm (2) (note "body") 7))""",
        """
        calm = cpl.make_policy("calm", init=lambda store, limit: note(limit), check=lambda store, limit: False,
                               clean_up=lambda store, limit: note("over"))
        def main():
            with cpl.policy(calm, 2):
                note("body")
                return 7
        run(main)
        """,
    ),
    "with-policy": Example(
        """(define-policy calm () "Never acts." (:check nil) (:clean-up (note "over")))
           (top-level (with-policy calm () (note "body") 7))""",
        """
        calm = cpl.make_policy("calm", check=lambda store: False, clean_up=lambda store: note("over"))
        def main():
            with cpl.policy(calm):
                note("body")
                return 7
        run(main)
        """,
    ),
    "with-named-policy": Example(
        """(define-policy calm () "Never acts." (:check nil) (:clean-up (note "over")))
           (top-level (with-named-policy 'calm () (note "body") 7))""",
        """
        policies = {"calm": cpl.make_policy("calm", check=lambda store: False, clean_up=lambda store: note("over"))}
        def main():
            with cpl.policy(policies["calm"]):
                note("body")
                return 7
        run(main)
        """,
    ),
    "with-policies": Example(
        """(define-policy inner () "Never acts." (:check nil) (:clean-up (note "inner")))
           (define-policy outer () "Never acts." (:check nil) (:clean-up (note "outer")))
           (top-level (with-policies ((outer ()) (inner ())) (note "body") 7))""",
        """
        inner = cpl.make_policy("inner", check=lambda store: False, clean_up=lambda store: note("inner"))
        outer = cpl.make_policy("outer", check=lambda store: False, clean_up=lambda store: note("outer"))
        def main():
            with cpl.policy(outer), cpl.policy(inner):
                note("body")
                return 7
        run(main)
        """,
    ),
    "with-named-policies": Example(
        """(define-policy inner () "Never acts." (:check nil) (:clean-up (note "inner")))
           (define-policy outer () "Never acts." (:check nil) (:clean-up (note "outer")))
           (top-level (with-named-policies (('outer ()) ('inner ())) (note "body") 7))""",
        """
        policies = {
            name: cpl.make_policy(name, check=lambda store: False, clean_up=lambda store, name=name: note(name)) for name in ("inner", "outer")
        }
        def main():
            with cpl.policy(policies["outer"]), cpl.policy(policies["inner"]):
                note("body")
                return 7
        run(main)
        """,
    ),
    "log-event": Example(
        """(cpl-impl::define-log-tags :my-robot)
           (cpl-impl:log-event (:context "Robot ~a" (note 1)) (:display "~a" (note 2)) (:tags :my-robot)) 1""",
        """
        import logging
        log = logging.getLogger("my_robot")
        if log.isEnabledFor(logging.DEBUG):
            log.debug("Robot %s %s", note(1), note(2))
        1
        """,
    ),
    "logging-enabled-p": Example(
        "(cpl-impl::define-log-tags :my-robot) (cpl-impl:logging-enabled-p :my-robot)",
        """
        import logging
        logging.getLogger("my_robot").isEnabledFor(logging.DEBUG)
        """,
    ),
    "define-log-tags": Example(
        "(cpl-impl::define-log-tags :one :two) (cpl-impl:logging-enabled-p :two)",
        """
        import logging
        one, two = logging.getLogger("one"), logging.getLogger("two")
        two.isEnabledFor(logging.DEBUG)
        """,
    ),
    "log-block": Example(
        """(defun begins (n) (note n) '(17 18)) (defun ends (id good) (note (list id good)))
           (cpl-impl::log-block begins (5) ends (cpl-impl::log-succeed) (note "body"))""",
        """
        from contextlib import contextmanager
        @contextmanager
        def logged(n):
            note(n)
            good = None
            try:
                yield
                good = True
            finally:
                note([17, good])
        with logged(5):
            result = note("body")
        result
        """,
    ),
}
