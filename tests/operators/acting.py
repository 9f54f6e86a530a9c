"""Examples of designators, process modules, projection and episodes."""

from example import Example

DRIVING = """(def-fact-group driving (motion-grounding)
               (<- (motion-grounding ?d (drive ?speed)) (desig-prop ?d (:type :driving)) (desig-prop ?d (:speed ?speed))))"""
IN_PYTHON = """
class Driving(Motion):
    speed: float
@motion_grounding(Driving)
def drive(motion):
    return [P.drive, motion.speed]
"""
PLACES = """(defun propose (place) (note "asked") '(1 2 3))"""

PLACES_IN_PYTHON = """
class Here(Location):
    pass
@location_generator(Here, priority=5)
def propose(place):
    note("asked")
    return [1, 2, 3]
"""

DESIGNATORS = {
    "a": Example(
        f"{DRIVING} (defvar ?speed 5) (reference (a motion (type driving) (speed ?speed)))",
        IN_PYTHON + "reference(Motion(type=kw.driving, speed=5))",
    ),
    "an": Example('(desig-prop-value (an object (type cup) (colour "red")) :colour)', 'Object(type=kw.cup, colour="red").colour'),
    "all": Example(
        "(desig-prop-value (all objects (type cup)) :type)",
        """
        cups = every(Object(type=kw.cup))
        cups.type
        """,
    ),
    "register-designator-class": Example(
        "(register-designator-class tool object-designator) (desig-prop-value (a tool (type knife)) :type)",
        """
        class Knife(Object):
            sharp: bool = True
        Knife().type
        """,
    ),
    "with-desig-props": Example(
        "(with-desig-props (type speed) (a motion (type driving) (speed 4)) (note speed) type)",
        """
        motion = Motion(type=kw.driving, speed=4)
        note(motion.speed)
        motion.type
        """,
    ),
    "with-equate-callback": Example(
        """(defvar *cup* (an object (type cup))) (defvar *mug* (an object (type mug)))
           (with-equate-callback (*cup* (lambda (other) (note "equated"))) (equate *cup* *mug*) (note "body"))""",
        """
        cup, mug = Object(type=kw.cup), Object(type=kw.mug)
        with equate_callback(cup, lambda other: note("equated")):
            equate(cup, mug)
            result = note("body")
        result
        """,
    ),
    "register-location-generator": Example(
        f"{PLACES} (register-location-generator 5 propose) (reference (a location (type here)))", PLACES_IN_PYTHON + "reference(Here())"
    ),
    "register-location-validation-function": Example(
        f"""{PLACES} (register-location-generator 5 propose)
            (defun big (place candidate) (if (> candidate 2) :accept :reject))
            (register-location-validation-function 5 big) (reference (a location (type here)))""",
        PLACES_IN_PYTHON
        + """
@location_validator(Here)
def big(place, candidate):
    return candidate > 2
reference(Here())
""",
    ),
    "with-designator-solution-filter": Example(
        f"""{PLACES} (register-location-generator 5 propose)
            (with-designator-solution-filter (lambda (candidate) (> candidate 1)) (reference (a location (type here))))""",
        PLACES_IN_PYTHON + "next(candidate for candidate in solutions(Here()) if candidate > 1)",
    ),
    "def-desig-package": Example(
        "(cram-designator-properties::def-desig-package my-words (:export shiny)) (a object (type cup)) 1",
        """
        cup = Object(type=kw.cup, shiny=kw.shiny)
        1
        """,
    ),
    "with-designators": Example(
        """(top-level (with-designators ((there :location '((:n 1))) (cup :object '((:type :cup))))
                        (note (desig-prop-value there :n)) (desig-prop-value cup :type)))""",
        """
        there = Location(n=1)
        cup = Object(type=kw.cup)
        note(there.n)
        cup.type
        """,
        hy="""(top-level (with-designators [[there :location (lisp ((:n 1)))] [cup :object (lisp ((:type :cup)))]]
                           (note (desig-prop-value there :n)) (desig-prop-value cup :type)))""",
    ),
    "with-equate-fluent": Example(
        """(defvar *cup* (an object (type cup))) (defvar *mug* (an object (type mug)))
           (top-level (par (with-equate-fluent (*cup* equated) (wait-for (pulsed equated)) (note "equated"))
                           (progn (sleep 3) (equate *cup* *mug*) (note "body"))))""",
        """
        cup, mug = Object(type=kw.cup), Object(type=kw.mug)
        equated = cpl.make_fluent(value=None)
        def watch():
            cpl.wait_for(equated)
            return note("equated")
        def change():
            cpl.sleep(3)
            equate(cup, mug)
            note("body")
        def main():
            with equate_callback(cup, lambda other: setattr(equated, "value", other)):
                return cpl.par(watch, change)
        run(main)
        """,
    ),
}

BASE = """(def-process-module base (input) (sleep 1) (note (desig-prop-value input :speed)))"""
BASE_IN_PYTHON = """
@process_module
def base(motion):
    cpl.sleep(1)
    return note(motion.speed)
"""

PROCESS_MODULES = {
    "def-process-module": Example(
        f"""{BASE}
            (top-level (with-process-modules-running (base) (pm-execute 'base (a motion (type driving) (speed 5)))))""",
        BASE_IN_PYTHON
        + """
def main():
    with process_modules(base):
        return execute(base, Motion(type=kw.driving, speed=5))
run(main)
""",
    ),
    "with-process-modules-running": Example(
        f"""{BASE}
            (top-level (with-process-modules-running ((left base) base)
                         (pm-execute 'left (a motion (speed 5))) (pm-execute 'base (a motion (speed 6)))))""",
        BASE_IN_PYTHON
        + """
def main():
    with process_modules(base, left=base):
        execute("left", Motion(speed=5))
        return execute(base, Motion(speed=6))
run(main)
""",
    ),
    "with-process-module-aliases": Example(
        f"""{BASE}
            (top-level (with-process-modules-running (base)
                         (with-process-module-aliases ((wheels base)) (pm-execute 'wheels (a motion (speed 5))))))""",
        BASE_IN_PYTHON
        + """
def main():
    with process_modules(base, wheels=base):
        return execute("wheels", Motion(speed=5))
run(main)
""",
    ),
    "with-process-module-registered-running": Example(
        f"""{BASE}
            (top-level (let ((module (make-instance 'base :name 'base)))
              (with-process-module-registered-running ('base module) (eq module (get-running-process-module 'base)))))""",
        BASE_IN_PYTHON
        + """
def main():
    with process_modules(base):
        return status(base).value is kw.waiting
run(main)
""",
        hy="""(def-process-module base [input] (sleep 1))
              (top-level (let [module (cl.make-instance (lisp base) (lisp :name) (lisp base))]
                (with-process-module-registered-running ['base module] (is module (get-running-process-module 'base)))))""",
    ),
    "def-asynchronous-process-module": Example(
        """(def-asynchronous-process-module belt ((held :initform 3 :reader held)))
           (defmethod synchronization-fluent ((self belt) input) (make-fluent :value t))
           (defmethod on-input ((self belt) input)
             (sleep 1) (note (+ (held self) (desig-prop-value input :count))) (finish-process-module self :designator input))
           (top-level (with-process-modules-running (belt) (pm-execute 'belt (a motion (type carrying) (count 2)))))""",
        """
        class Belt(AsynchronousModule):
            held = 3
            def on_input(self, motion):
                cpl.sleep(1)
                self.finish(motion, note(self.held + motion.count))
        def main():
            with process_modules(Belt):
                return execute(Belt, Motion(type=kw.carrying, count=2))
        run(main)
        """,
        hy="""(def-asynchronous-process-module belt [[held 3]]
                (defn on-input [self motion] (sleep 1) (.finish self motion (note (+ self.held motion.count)))))
              (top-level (with-process-modules-running [belt] (pm-execute 'belt (a motion (type carrying) (count 2)))))""",
    ),
}

IMAGINED = """(def-process-module imagined-arm (input) (note "imagined"))
              (proj:define-projection-environment imagined :process-module-definitions ((arm imagined-arm)) :startup (note "begins")
                :shutdown (note "ends"))"""

IMAGINED_IN_PYTHON = """
from cramhy_runtime.projection.python import *
@process_module
def imagined_arm(motion):
    note("imagined")
imagined = projection_environment(modules={"arm": imagined_arm}, startup=lambda: note("begins"), shutdown=lambda: note("ends"))
"""

PROJECTION = {
    "define-projection-environment": Example(
        f"""{IMAGINED}
            (proj:with-projection-environment imagined (top-level (pm-execute 'arm (a motion (type lifting))))) 1""",
        IMAGINED_IN_PYTHON
        + """
project(imagined, lambda: run(execute, "arm", Motion(type=kw.lifting)))
1
""",
    ),
    "define-special-projection-variable": Example(
        f"""{IMAGINED} (proj:define-special-projection-variable *belief* "inner")
            (proj:with-projection-environment imagined (note *belief*)) 1""",
        IMAGINED_IN_PYTHON
        + """
belief = projection_variable("belief", lambda: "inner")
project(imagined, lambda: note(belief.value))
1
""",
        hy="""(proj:define-projection-environment imagined :startup (note "begins") :shutdown (note "ends"))
              (proj:define-special-projection-variable *belief* "inner")
              (proj:with-projection-environment imagined (note *belief*.value)) 1""",
    ),
    "with-projection-environment": Example(
        f"{IMAGINED} (proj:with-projection-environment imagined (top-level (sleep 5) (note 7))) (note (progn (sleep 1) 2))",
        IMAGINED_IN_PYTHON
        + """
project(imagined, lambda: run(lambda: (cpl.sleep(5), note(7))))
kernel.sleep(1)
note(2)
""",
    ),
    "with-partially-ordered-clock-disabled": Example(
        """(defvar *clock* (make-instance 'proj:partially-ordered-clock))
           (proj:with-partially-ordered-clock-disabled *clock* (note 1) 2)""",
        """
        from cramhy_runtime.projection import PartiallyOrderedClock, with_partially_ordered_clock_disabled
        with_partially_ordered_clock_disabled(PartiallyOrderedClock(), lambda: (note(1), 2)[1])
        """,
    ),
}

EPISODE = """(def-top-level-cram-function fetch (thing) (sleep 1) (note thing)) (fetch "cup")
             (defun tasks () (if (cet:episode-knowledge-task-list) "tasks" "none"))"""

EPISODE_IN_PYTHON = """
from cramhy_runtime import episodes
@cpl.plan_function
def fetch(thing):
    cpl.sleep(1)
    note(thing)
cpl.named_top_level(lambda: fetch("cup"), "fetch")
def look():
    note(1)
    return "tasks" if episodes.current_episode().tree() else "none"
"""
FILES_OF_EPISODES = "files of episodes are in Lisp's notation, and Lisp's functions read and write them"

EPISODES = {
    "with-episode-knowledge": Example(
        f"""{EPISODE} (cet:with-episode-knowledge (cet:get-top-level-episode-knowledge 'fetch) (note 1) (tasks))""",
        EPISODE_IN_PYTHON + "episodes.with_episode_knowledge(episodes.get_top_level_episode_knowledge('fetch'), look)",
    ),
    "with-last-episode-knowledge": Example(
        f"{EPISODE} (cet:with-last-episode-knowledge (note 1) (tasks))", EPISODE_IN_PYTHON + "episodes.with_last_episode_knowledge(look)"
    ),
    "with-top-level-episode-knowledge": Example(
        f"{EPISODE} (cet:with-top-level-episode-knowledge fetch (note 1) (tasks))",
        EPISODE_IN_PYTHON + "episodes.with_top_level_episode_knowledge('fetch', look)",
    ),
    "with-offline-episode-knowledge": Example(
        f"""{EPISODE} (cet:save-last-episode-knowledge "fetch.ek") (cet:with-offline-episode-knowledge "fetch.ek" (note 1) (tasks))""",
        only=FILES_OF_EPISODES,
    ),
    "defstore-episode-knowledge-backend": Example(
        '(cet:defstore-episode-knowledge-backend (object :mine stream) (note object) 1) (note "defined")', only=FILES_OF_EPISODES
    ),
    "defrestore-episode-knowledge-backend": Example(
        '(cet:defrestore-episode-knowledge-backend (:mine stream) (note "restored") 1) (note "defined")', only=FILES_OF_EPISODES
    ),
}
