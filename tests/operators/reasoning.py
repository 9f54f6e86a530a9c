"""Examples of Prolog and of the utilities."""

from example import Example

PYTHON = "Python has its own: "

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
        only="facts are values of fluents, or a fact group",
    ),
    "trace-prolog": Example("(trace-prolog parent) (untrace-prolog parent)", only="`explain` tells why a goal has a solution or none"),
    "untrace-prolog": Example("(untrace-prolog)", only="`explain` tells why a goal has a solution or none"),
    "def-production": Example(
        """(def-production stacked (on ?a ?b) (on ?b ?c))
           (with-production-handlers ((stacked (operation &key ?a ?b ?c) (note (list operation ?a ?b ?c))))
             (with-facts-asserted ('(on a b) '(on b c)) (note "body")))""",
        only="`cpl.whenever` on a fluent",
        hy="""(def-production stacked (on ?a ?b) (on ?b ?c))
              (with-production-handlers [[stacked [operation * ?a ?b ?c] (note [operation ?a ?b ?c])]]
                (with-facts-asserted [(lisp (on a b)) (lisp (on b c))] (note "body")))""",
    ),
    "with-productions": Example(
        """(with-productions ((seen (in ?what)))
             (with-production-handlers ((seen (operation &key ?what) (note (list operation ?what))))
               (with-facts-asserted ('(in cup)) (note "body"))))""",
        only="`cpl.whenever` on a fluent",
        hy="""(with-productions [[seen (in ?what)]]
                (with-production-handlers [[seen [operation * ?what] (note [operation ?what])]]
                  (with-facts-asserted [(lisp (in cup))] (note "body"))))""",
    ),
    "with-production-handlers": Example(
        """(def-production seen (in ?what))
           (with-production-handlers ((seen (operation &rest values) (note operation)))
             (with-facts-asserted ('(in cup)) (note "body")))""",
        only="`cpl.whenever` on a fluent",
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
        only="a generator keeps its variables",
    ),
    "lazy-dolist": Example(
        "(lazy-dolist (x (lazy-mapcar #'1+ '(1 2 3))) (note x) (when (= x 3) (return (* 10 x))))", only=PYTHON + "`for`"
    ),
    "delay": Example("(defvar *promise* (delay (note 5))) (+ (force *promise*) (force *promise*))", only=PYTHON + "`functools.cache`"),
    "with-vars-bound": Example("(with-vars-bound (?x ?y) '((?x . 1) (?y . 2)) (note ?x) ?y)", only="answers have attributes"),
    "with-vars-strictly-bound": Example(
        "(with-vars-strictly-bound (?x ?y) '((?x . 1) (?y . 2)) (note ?x) ?y)", only="answers have attributes"
    ),
    "with-pat-vars-bound": Example("(with-pat-vars-bound (?x (?y)) '(1 (2)) (note ?x) ?y)", only=PYTHON + "`match`"),
    "assert-no-returning": Example(
        '(handler-case (assert-no-returning (note 1)) (error () "it returned"))', only="an `assert` behind the statement"
    ),
    "assert-no-nlx": Example("(assert-no-nlx (note 1) 2)", only="`try` with an `else`"),
    "flet*": Example("(flet* ((one () 1) (two () (+ (one) 1))) (note (two)) (one))", only=PYTHON + "`def`"),
    "string-case": Example('(string-case "Cup" ("plate" 1) ("cup" (note 2)))', only=PYTHON + "`match`"),
    "destructure-case": Example(
        "(destructure-case (list :drive 3 4) ((:turn angle) angle) ((:drive speed time) (note speed) time))",
        only=PYTHON + "`match`",
        hy="""(destructure-case [(lisp :drive) 3 4] [[:turn angle] angle] [[:drive speed time] (note speed) time])""",
    ),
    "pop-if!": Example(
        "(defvar *l* (list 1 12 3 14)) (pop-if! (lambda (n) (> n 10)) *l*) *l*",
        only="a list comprehension",
        hy="(setv l (lisp (1 12 3 14))) (pop-if! (fn [n] (> n 10)) l) l",
    ),
    "with-file-cache": Example(
        '(with-file-cache text "notes.txt" (note "computed") (note text)) (with-file-cache text "notes.txt" (note "again") text)',
        only=PYTHON + "`functools.cache`",
    ),
    "with-lock-held": Example(
        """(defvar *lock* (make-lock))
           (top-level (par (with-lock-held (*lock*) (sleep 2) (note 1)) (with-lock-held (*lock*) (note 2))))""",
        only="one task runs at a time, until it waits; `cpl.without_scheduling`",
    ),
    "with-hash-table-locked": Example(
        '(defvar *table* (make-synchronized-hash-table)) (with-hash-table-locked (*table*) (note "body") 3)',
        only="one task runs at a time, until it waits",
    ),
    "with-synchronization-barrier": Example(
        """(top-level (with-synchronization-barrier (barrier 2)
                        (par (progn (sleep 2) (note 1) (enter-barrier barrier) 3) (progn (enter-barrier barrier) (note 2)))))""",
        only="a fluent, or the end of a `par`",
    ),
    "with-synchronization-barriers": Example(
        """(top-level (with-synchronization-barriers ((one 2) (two 1))
                        (par (progn (sleep 2) (note 1) (enter-barrier one) 3) (progn (enter-barrier one) (enter-barrier two) (note 2)))))""",
        only="a fluent, or the end of a `par`",
    ),
    "choose": Example(
        """(top-level (with-tags (choose grasp :parameters (x y) :generators (3 (+ x 1)) :body (seq (note x) y))))""", only="a generator"
    ),
    "define-hook": Example(
        '(define-hook on-looking (thing) (:documentation "Looks.")) (on-looking 5)', only="`cramhy_runtime.ground.hooks`"
    ),
}
