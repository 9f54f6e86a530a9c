"""Ways in which the code of a file can depend on the world while it is compiled, each as a folder of files and a change.

A row: how it is run, the files, the files after the change (``None``: the file is removed), and what else is another one then:
``variables`` of the environment, or the folder in which it is run (``cwd``). ``moves``: the answer is another one at each compilation.
"""

from __future__ import annotations

from typing import NamedTuple


class Case(NamedTuple):
    command: str
    files: dict[str, str]
    change: dict[str, str | None] = {}
    variables: dict[str, str] = {}
    cwd: str = "."
    moves: bool = False


LOADS = '(load (merge-pathnames "a.lisp" *load-truename*))\n(load (merge-pathnames "b.lisp" *load-truename*))\n'
READS = '(with-open-file (s (merge-pathnames "d.txt" *load-truename*) :if-does-not-exist nil) (and s (read s)))'


def pair(before, after, uses, **more):
    """A file whose definitions are loaded before a file that uses them is loaded."""
    return Case("run main.lisp", {"main.lisp": LOADS, "a.lisp": before, "b.lisp": uses}, {"a.lisp": after}, **more)


def alone(text, change=None, files=None, **more):
    return Case("run main.lisp", {"main.lisp": text, **(files or {})}, change or {}, **more)


HY = "(require cramhy *)\n"
IN_LISP = "(require cramhy *)\n(in-package :cl-user)\n"

CASES = {
    "a file that a macro reads": alone(
        f"(defmacro include () {READS})\n(defun f () (include))\n(print (f))", {"d.txt": "22"}, {"d.txt": "11"}
    ),
    "a file that #. reads": alone("(defun f () #." + READS + ")\n(print (f))", {"d.txt": "22"}, {"d.txt": "11"}),
    "a file that was not there": alone(
        '(defmacro there () (if (probe-file (merge-pathnames "d.txt" *load-truename*)) :there :missing))\n(defun f () (there))\n(print (f))',
        {"d.txt": "1"},
    ),
    "a folder that is listed": alone(
        '(defmacro many () (length (directory (merge-pathnames "parts/*.txt" *load-truename*))))\n(defun f () (many))\n(print (f))',
        {"parts/b.txt": "1"},
        {"parts/a.txt": "1"},
    ),
    "a variable of the environment": alone(
        '(defmacro var () (or (sb-ext:posix-getenv "KC_TEST") "none"))\n(defun f () (var))\n(print (f))', variables={"KC_TEST": "two"}
    ),
    "a variable of the environment, read by #.": alone(
        '(require :uiop)\n(defun f () #.(or (uiop:getenv "KC_TEST") "none"))\n(print (f))', variables={"KC_TEST": "two"}
    ),
    "the clock": alone('(defmacro now () (py:call "time.time_ns"))\n(defun f () (now))\n(print (f))', moves=True),
    "chance": alone("(defmacro any () (random 1000000000000))\n(defun f () (any))\n(print (list (f) (random 1000)))"),
    "a package that is there": pair(
        "nil",
        "(defpackage :kc-extra (:use :cl))",
        "(defmacro there () (if (find-package :kc-extra) :there :missing))\n(defun f () (there))\n(print (f))",
    ),
    "a function that is there": pair(
        "nil", "(defun extra () 1)", "(defmacro there () (if (fboundp 'extra) :there :missing))\n(defun f () (there))\n(print (f))"
    ),
    "a class that is there": pair(
        "nil",
        "(defclass extra () ())",
        "(defmacro there () (if (find-class 'extra nil) :there :missing))\n(defun f () (there))\n(print (f))",
    ),
    "the value of a variable": pair(
        "(defvar *width* 1)", "(defvar *width* 2)", "(defmacro width () *width*)\n(defun f () (width))\n(print (f))"
    ),
    "a variable that is bound": pair(
        "nil", "(defvar *extra* 2)", "(defmacro there () (boundp '*extra*))\n(defun f () (there))\n(print (f))"
    ),
    "a property of a symbol": pair(
        "(setf (get 'box :size) 1)", "(setf (get 'box :size) 2)", "(defmacro size (x) (get x :size))\n(defun f () (size box))\n(print (f))"
    ),
    "a hash table in a variable": pair(
        "(defvar *table* (make-hash-table)) (setf (gethash :a *table*) 1)",
        "(defvar *table* (make-hash-table)) (setf (gethash :a *table*) 2)",
        "(defmacro entry (x) (gethash x *table*))\n(defun f () (entry :a))\n(print (f))",
    ),
    "a file that a reader macro reads": alone(
        "(eval-when (:compile-toplevel :load-toplevel :execute)\n"
        f"(set-macro-character #\\! (lambda (s c) (declare (ignore s c)) {READS})))\n(defun f () !)\n(print (f))",
        {"d.txt": "22"},
        {"d.txt": "11"},
    ),
    "a counter of a macro": alone(
        "(defvar *count* 0)\n(defmacro next () (incf *count*))\n(defun f () (list (next) (next)))\n(defun g () (next))\n"
        "(print (list (f) (g) *count*))"
    ),
    "a list to which macros add": alone(
        "(defvar *all* nil)\n(defmacro note (x) (push x *all*) nil)\n(defmacro all () `',*all*)\n(note a)\n(note b)\n"
        "(defun f () (all))\n(print (list (f) *all*))"
    ),
    "another process": alone(
        '(defmacro said () (py:call "subprocess.getoutput" (format nil "cat ~A" (namestring (merge-pathnames "d.txt" *load-truename*)))))\n'
        "(defun f () (said))\n(print (f))",
        {"d.txt": "22"},
        {"d.txt": "11"},
    ),
    "a module of Python that a macro calls": alone(
        '(py:import "helper" :as h)\n(defmacro m () (py:call "helper.answer"))\n(defun f () (m))\n(print (f))'.replace(
            '(py:import "helper" :as h)\n',
            '(eval-when (:compile-toplevel :load-toplevel :execute) (py:call "sys.path.insert" 0 (directory-namestring *load-truename*)))\n',
        ),
        {"helper.py": "def answer():\n    return 22\n"},
        {"helper.py": "def answer():\n    return 10 + 1\n"},
    ),
    "the folder in which it is run": Case(
        "run ../main.lisp",
        {
            "main.lisp": '(defmacro include () (with-open-file (s (format nil "~A/d.txt" (py:call "os.getcwd"))) (read s)))\n'
            "(defun f () (include))\n(print (f))",
            "one/d.txt": "11",
            "two/d.txt": "22",
        },
        cwd="two",
    ),
    "how numbers are printed": pair(
        "nil",
        "(setf *print-base* 2)",
        "(defmacro text (n) (princ-to-string n))\n(defun f () (text 5))\n(let ((*print-base* 10)) (print (f)))",
    ),
    "a symbol that is there": pair(
        "(defpackage :kc-names (:use :cl))",
        "(defpackage :kc-names (:use :cl) (:export #:extra))",
        '(defmacro there () (if (find-symbol "EXTRA" :kc-names) :there :missing))\n(defun f () (there))\n(print (f))',
    ),
    "the size of a file": alone(
        '(defmacro size () (py:call "os.path.getsize" (namestring (merge-pathnames "d.txt" *load-truename*))))\n(defun f () (size))\n'
        "(print (f))",
        {"d.txt": "123"},
        {"d.txt": "1"},
    ),
    "a function that is called by its name": pair(
        "(defun helper () 1)", "(defun helper () 2)", '(defmacro m () (funcall (intern "HELPER" :cl-user)))\n(defun f () (m))\n(print (f))'
    ),
    "a table over which a macro closes": pair(
        "(let ((table (make-hash-table))) (setf (gethash :a table) 1) (defmacro entry (x) (gethash x table)))",
        "(let ((table (make-hash-table))) (setf (gethash :a table) 2) (defmacro entry (x) (gethash x table)))",
        "(defun f () (entry :a))\n(print (f))",
    ),
    "a table over which a compiler macro closes": pair(
        "(defun kc-one () 1) (let ((table (list 1))) (define-compiler-macro kc-one () (first table)))",
        "(defun kc-one () 1) (let ((table (list 2))) (define-compiler-macro kc-one () (first table)))",
        "(defun f () (kc-one))\n(print (f))",
    ),
    "a table over which a type closes": pair(
        "(let ((table (list 3))) (deftype small () `(integer 0 ,(first table))))",
        "(let ((table (list 9))) (deftype small () `(integer 0 ,(first table))))",
        "(defun f () (typep 5 'small))\n(print (f))",
    ),
    "a function that is called by its name for each": pair(
        "(defun helper (x) (list x 1))",
        "(defun helper (x) (list x 2))",
        "(defvar *helper* (quote helper))\n(defmacro m () `',(mapcar *helper* '(1 2)))\n(defun f () (m))\n(print (f))",
    ),
    "a file that is loaded while another is compiled": alone(
        '(defmacro loading () (load (merge-pathnames "part.lisp" *load-truename*)) *part*)\n(defvar *part* 0)\n(defun f () (loading))\n'
        "(print (f))",
        {"part.lisp": "(setf *part* 22)"},
        {"part.lisp": "(setf *part* 11)"},
    ),
    "a data file of a system under test": Case(
        "test k.asd",
        {
            "k.asd": '(defsystem "k" :depends-on ("fiveam") :components ((:file "macros") (:file "tests" :depends-on ("macros"))))',
            "macros.lisp": '(defpackage :k (:use :cl :fiveam))\n(in-package :k)\n(defmacro include () (with-open-file (s (merge-pathnames "d.txt" '
            "*load-truename*)) (read s)))\n",
            "tests.lisp": "(in-package :k)\n(test answer (is (= 11 (include))))\n",
            "d.txt": "11",
        },
        {"d.txt": "22"},
    ),
    "a module of Hy macros": Case(
        "hy main.hy",
        {"main.hy": HY + "(require m [answer])\n(print (answer))\n", "m.hy": "(defmacro answer [] 11)\n"},
        {"m.hy": "(defmacro answer [] 22)\n"},
    ),
    "a module of Python that a Hy macro uses": Case(
        "run main.hy",
        {
            "main.hy": HY + "(require m [answer])\n(print (answer))\n",
            "m.hy": "(import helper)\n(defmacro answer [] (helper.answer))\n",
            "helper.py": "def answer():\n    return 11\n",
        },
        {"helper.py": "def answer():\n    return 22\n"},
    ),
    "a Hy macro in the expansion of a Hy macro": Case(
        "python main.py",
        {
            "main.py": "import hy, cramhy, user\n",
            "user.hy": HY + "(require m [answer])\n(print (answer))\n",
            "m.hy": "(require n [number])\n(defn count [] (number))\n(defmacro answer [] (count))\n",
            "n.hy": "(defmacro number [] 11)\n",
        },
        {"n.hy": "(defmacro number [] 22)\n"},
    ),
    "a file that a Hy macro reads": Case(
        "python main.py",
        {
            "main.py": "import hy, cramhy, user\n",
            "user.hy": HY + '(defmacro include [] (with [f (open "d.txt")] (int (.read f))))\n(print (include))\n',
            "d.txt": "11",
        },
        {"d.txt": "22"},
    ),
    "a variable of the environment in a test in Hy": Case(
        "pytest test_it.hy",
        {"test_it.hy": '(defmacro var [] (import os) (.get os.environ "KC_TEST" "none"))\n(defn test-it [] (assert (= (var) "none")))\n'},
        variables={"KC_TEST": "two"},
    ),
    "a module of Hy macros in a test in Hy": Case(
        "pytest test_it.hy",
        {"test_it.hy": "(require m [answer])\n(defn test-it [] (assert (= (answer) 11)))\n", "m.hy": "(defmacro answer [] 11)\n"},
        {"m.hy": "(defmacro answer [] 22)\n"},
    ),
    "a folder that a Hy macro lists": Case(
        "run main.hy",
        {"main.hy": HY + '(defmacro many [] (import os) (len (os.listdir "parts")))\n(print (many))\n', "parts/a.txt": "1"},
        {"parts/b.txt": "1"},
    ),
    "a module of Hy macros that stands before another": Case(
        "python main.py",
        {
            "main.py": "import sys; sys.path.insert(0, 'first')\nimport hy, cramhy, user\n",
            "user.hy": HY + "(require m [answer])\n(print (answer))\n",
            "m.hy": "(defmacro answer [] 11)\n",
        },
        {"first/m.hy": "(defmacro answer [] 22)\n"},
    ),
    "the clock in a Hy macro": Case(
        "run main.hy", {"main.hy": HY + "(import time)\n(defmacro now [] (import time) (time.time-ns))\n(print (now))\n"}, moves=True
    ),
    "a file that is read while Hy compiles": Case(
        "run main.hy",
        {
            "main.hy": HY
            + '(eval-when-compile (setv read-then (.strip (.read (open "d.txt")))))\n(defmacro m [] read-then)\n(print (m))\n',
            "d.txt": "11",
        },
        {"d.txt": "22"},
    ),
    "a file that a Lisp macro in a .hy file reads": Case(
        "hy main.hy",
        {
            "main.hy": IN_LISP + '(defmacro include () (with-open-file (s "d.txt") (read s)))\n(defun f () (include))\n(print (f))\n',
            "d.txt": "11",
        },
        {"d.txt": "22"},
    ),
    "a file that do-mac looks for": Case(
        "hy main.hy",
        {"main.hy": HY + '(print (do-mac (do (import os) (if (os.path.exists "d.txt") "there" "missing"))))\n'},
        {"d.txt": "1"},
    ),
}
