"""Examples of Prolog and of the utilities."""

from example import Example

TOM_AND_BOB = "(def-fact-group family (parent) (<- (parent tom bob)))"
TOM_AND_BOB_IN_PYTHON = """
with fact_group("family", extends=[P.parent]) as family:
    family.fact(P.parent(P.tom, P.bob))
"""

PROLOG = {
    "def-fact-group": Example(
        """(def-fact-group family (parent) (<- (parent tom bob)) (<- (parent bob ann))
             (<- (grandparent ?x ?z) (parent ?x ?y) (parent ?y ?z)))
           (var-value '?who (first (force-ll (prolog '(grandparent tom ?who)))))""",
        """
        with fact_group("family", extends=[P.parent]) as family:
            family.fact(P.parent(P.tom, P.bob), P.parent(P.bob, P.ann))
            family.rule(P.grandparent(V.x, V.z), P.parent(V.x, V.y), P.parent(V.y, V.z))
        first(P.grandparent(P.tom, V.who)).who
        """,
        hy="""(def-fact-group family [parent] (<- (parent tom bob)) (<- (parent bob ann))
                (<- (grandparent ?x ?z) (parent ?x ?y) (parent ?y ?z)))
              (var-value '?who (cl.car (force-ll (prolog '(grandparent tom ?who)))))""",
    ),
    "<-": Example(
        """(def-fact-group numbers () (<- (even 2)) (<- (even 4)) (<- (big ?n) (even ?n) (prolog:> ?n 3)))
           (force-ll (lazy-mapcar (lambda (bindings) (var-value '?n bindings)) (prolog '(big ?n))))""",
        """
        with fact_group("numbers") as numbers:
            numbers.fact(P.even(2), P.even(4))
            numbers.rule(P.big(V.n), P.even(V.n), V.n > 3)
        findall(V.n, P.big(V.n))
        """,
    ),
    "def-prolog-handler": Example(
        """(def-prolog-handler one-or-two (bindings place)
             (lazy-mapcar (lambda (n) (add-bdg place n bindings)) '(1 2)))
           (def-fact-group g () (<- (fits ?n) (one-or-two ?n)))
           (force-ll (lazy-mapcar (lambda (bindings) (var-value '?n bindings)) (prolog '(fits ?n))))""",
        """
        @predicate
        def one_or_two():
            yield 1
            yield 2
        findall(V.n, one_or_two(V.n))
        """,
    ),
    "with-facts-asserted": Example(
        "(note (with-facts-asserted ('(on a b)) (if (rete-holds '(on a b)) 1 2))) (if (rete-holds '(on a b)) 1 2)",
        """
        with facts_asserted(P.on(P.a, P.b)):
            note(1 if holds(P.rete_holds(P.on(P.a, P.b))) else 2)
        1 if holds(P.rete_holds(P.on(P.a, P.b))) else 2
        """,
    ),
    "trace-prolog": Example(
        f"""{TOM_AND_BOB} (trace-prolog parent) (if (prolog '(parent tom bob)) "yes" "no")""",
        TOM_AND_BOB_IN_PYTHON
        + """
with trace(P.parent):
    result = "yes" if holds(P.parent(P.tom, P.bob)) else "no"
result
""",
    ),
    "untrace-prolog": Example(
        f"""{TOM_AND_BOB} (trace-prolog parent) (untrace-prolog parent) (if (prolog '(parent tom bob)) "yes" "no")""",
        TOM_AND_BOB_IN_PYTHON
        + """
with trace(P.parent):
    pass
"yes" if holds(P.parent(P.tom, P.bob)) else "no"
""",
    ),
    "def-production": Example(
        """(def-production stacked (on ?a ?b) (on ?b ?c))
           (with-production-handlers ((stacked (operation &key ?a ?b ?c) (note (list operation ?a ?b ?c))))
             (with-facts-asserted ('(on a b) '(on b c)) (note "body")))""",
        """
        def stacked(operation, a, b, c):
            note([operation, a, b, c])
        with facts_watched(stacked, P.on(V.a, V.b), P.on(V.b, V.c)), facts_asserted(P.on(P.a, P.b), P.on(P.b, P.c)):
            result = note("body")
        result
        """,
        hy="""(def-production stacked (on ?a ?b) (on ?b ?c))
              (with-production-handlers [[stacked [operation * ?a ?b ?c] (note [operation ?a ?b ?c])]]
                (with-facts-asserted [(lisp (on a b)) (lisp (on b c))] (note "body")))""",
    ),
    "with-productions": Example(
        """(with-productions ((seen (in ?what)))
             (with-production-handlers ((seen (operation &key ?what) (note (list operation ?what))))
               (with-facts-asserted ('(in cup)) (note "body"))))""",
        """
        with facts_watched(lambda operation, what: note([operation, what]), P["in"](V.what)), facts_asserted(P["in"](P.cup)):
            result = note("body")
        result
        """,
        hy="""(with-productions [[seen (in ?what)]]
                (with-production-handlers [[seen [operation * ?what] (note [operation ?what])]]
                  (with-facts-asserted [(lisp (in cup))] (note "body"))))""",
    ),
    "with-production-handlers": Example(
        """(def-production seen (in ?what))
           (with-production-handlers ((seen (operation &rest values) (note operation)))
             (with-facts-asserted ('(in cup)) (note "body")))""",
        """
        with facts_watched(lambda operation, **values: note(operation), P["in"](V.what)), facts_asserted(P["in"](P.cup)):
            result = note("body")
        result
        """,
        hy="""(def-production seen (in ?what))
              (with-production-handlers [[seen [operation #* values #** more] (note operation)]]
                (with-facts-asserted [(lisp (in cup))] (note "body")))""",
    ),
}

UTILITIES = {
    "lazy-list": Example("(force-ll (lazy-list ((i 1)) (if (< i 4) (cont (note i) (+ i 1)))))", "list(note(i) for i in range(1, 4))"),
    "with-lazy-list-dynamic-environment": Example(
        """(defvar *level* 7)
           (force-ll (with-lazy-list-dynamic-environment ((*level* 1)) (lazy-list ((n 0)) (if (< n 2) (cont n (+ n 1))))))""",
        """
        def numbers(level):
            n = 0
            while n < 2:
                yield n
                n += level
        list(numbers(level=1))
        """,
    ),
    "lazy-dolist": Example(
        "(lazy-dolist (x (lazy-mapcar #'1+ '(1 2 3))) (note x) (when (= x 3) (return (* 10 x))))",
        """
        for x in (n + 1 for n in (1, 2, 3)):
            note(x)
            if x == 3:
                result = 10 * x
                break
        result
        """,
    ),
    "delay": Example(
        "(defvar *promise* (delay (note 5))) (+ (force *promise*) (force *promise*))",
        """
        from functools import cache
        @cache
        def promise():
            return note(5)
        promise() + promise()
        """,
    ),
    "with-vars-bound": Example(
        "(with-vars-bound (?x ?y) '((?x . 1) (?y . 2)) (note ?x) ?y)",
        """
        answer = first(P["=="]([V.x, V.y], [1, 2]))
        note(answer.x)
        answer.y
        """,
    ),
    "with-vars-strictly-bound": Example(
        "(with-vars-strictly-bound (?x ?y) '((?x . 1) (?y . 2)) (note ?x) ?y)",
        """
        answer = first(P["=="]([V.x, V.y], [1, 2]))
        note(answer["x"])
        answer["y"]
        """,
    ),
    "with-pat-vars-bound": Example(
        "(with-pat-vars-bound (?x (?y)) '(1 (2)) (note ?x) ?y)",
        """
        match [1, [2]]:
            case [x, [y]]:
                note(x)
        y
        """,
    ),
    "assert-no-returning": Example(
        '(handler-case (assert-no-returning (note 1)) (error () "it returned"))',
        """
        try:
            note(1)
            raise AssertionError("it returned")
        except AssertionError as problem:
            result = str(problem)
        result
        """,
    ),
    "assert-no-nlx": Example(
        "(assert-no-nlx (note 1) 2)",
        """
        try:
            note(1)
        except BaseException as problem:
            raise AssertionError("the body was left by an exception") from problem
        2
        """,
    ),
    "flet*": Example(
        "(flet* ((one () 1) (two () (+ (one) 1))) (note (two)) (one))",
        """
        def one():
            return 1
        def two():
            return one() + 1
        note(two())
        one()
        """,
    ),
    "string-case": Example(
        '(string-case "Cup" ("plate" 1) ("cup" (note 2)))',
        """
        match "Cup".lower():
            case "plate":
                result = 1
            case "cup":
                result = note(2)
        result
        """,
    ),
    "destructure-case": Example(
        "(destructure-case (list :drive 3 4) ((:turn angle) angle) ((:drive speed time) (note speed) time))",
        """
        match [kw.drive, 3, 4]:
            case [kw.turn, angle]:
                result = angle
            case [kw.drive, speed, time]:
                note(speed)
                result = time
        result
        """,
        hy="""(destructure-case [(lisp :drive) 3 4] [[:turn angle] angle] [[:drive speed time] (note speed) time])""",
    ),
    "pop-if!": Example(
        "(defvar *l* (list 1 12 3 14)) (pop-if! (lambda (n) (> n 10)) *l*) *l*",
        """
        numbers = [1, 12, 3, 14]
        popped = numbers.pop(next(place for place, n in enumerate(numbers) if n > 10))
        numbers
        """,
        hy="(setv l (lisp (1 12 3 14))) (pop-if! (fn [n] (> n 10)) l) l",
    ),
    "with-file-cache": Example(
        '(with-file-cache text "notes.txt" (note "computed") (note text)) (with-file-cache text "notes.txt" (note "again") text)',
        """
        import os
        from functools import cache
        @cache
        def text(path, changed):
            return note("computed")
        note(text("notes.txt", os.stat("notes.txt").st_mtime_ns))
        text("notes.txt", os.stat("notes.txt").st_mtime_ns)
        """,
    ),
    "with-lock-held": Example(
        """(defvar *lock* (make-lock))
           (top-level (par (with-lock-held (*lock*) (sleep 2) (note 1)) (with-lock-held (*lock*) (note 2))))""",
        """
        from cramhy_runtime.utilities.locks import Lock
        lock = Lock()
        def slow():
            with lock:
                cpl.sleep(2)
                return note(1)
        def quick():
            with lock:
                return note(2)
        run(lambda: cpl.par(slow, quick))
        """,
    ),
    "with-hash-table-locked": Example(
        '(defvar *table* (make-synchronized-hash-table)) (with-hash-table-locked (*table*) (note "body") 3)',
        """
        from cramhy_runtime.utilities.locks import Lock
        table, lock = {}, Lock()
        with lock:
            note("body")
            result = 3
        result
        """,
    ),
    "with-synchronization-barrier": Example(
        """(top-level (with-synchronization-barrier (barrier 2)
                        (par (progn (sleep 2) (note 1) (enter-barrier barrier) 3) (progn (enter-barrier barrier) (note 2)))))""",
        """
        from cramhy_runtime.utilities.barriers import Barrier
        def main():
            with Barrier(2) as barrier:
                def slow():
                    cpl.sleep(2)
                    note(1)
                    barrier.enter()
                    return 3
                def quick():
                    barrier.enter()
                    return note(2)
                return cpl.par(slow, quick)
        run(main)
        """,
    ),
    "with-synchronization-barriers": Example(
        """(top-level (with-synchronization-barriers ((one 2) (two 1))
                        (par (progn (sleep 2) (note 1) (enter-barrier one) 3) (progn (enter-barrier one) (enter-barrier two) (note 2)))))""",
        """
        from cramhy_runtime.utilities.barriers import Barrier
        def main():
            with Barrier(2) as one, Barrier(1) as two:
                def slow():
                    cpl.sleep(2)
                    note(1)
                    one.enter()
                    return 3
                def quick():
                    one.enter()
                    two.enter()
                    return note(2)
                return cpl.par(slow, quick)
        run(main)
        """,
    ),
    "choose": Example(
        """(top-level (with-tags (choose grasp :parameters (x y) :generators (3 (+ x 1)) :body (seq (note x) y))))""",
        """
        def grasps():
            x = 3
            yield x, x + 1
        def grasp(parameters):
            x, y = parameters
            return cpl.seq(lambda: note(x), lambda: y)
        run(lambda: cpl.try_each_in_order(grasps(), grasp))
        """,
    ),
    "define-hook": Example(
        '(define-hook on-looking (thing) (:documentation "Looks.")) (on-looking 5)',
        """
        on_looking = []     # functions that are called with the thing
        [function(5) for function in on_looking]
        """,
    ),
}
