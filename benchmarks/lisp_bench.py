"""What compiled Lisp costs: small programs, beside Python code that does the same by hand, and beside SBCL.

    python benchmarks/lisp_bench.py [--repeat N]

Each program and its peer in Python run in turn, N times in one process; the figures are medians in milliseconds, and the quotient
is the price of Lisp's semantics (generic arithmetic, several values, functions that may be defined again, checkpoints). The
peers are what a Python programmer would write: `functools.singledispatch` and, beside it, a method call for generic dispatch, an
object with ``__slots__`` for a structure, f-strings for ``format``. SBCL compiles to machine code and stands there as the far end
of the scale; `-` where it is not installed.

Then 1,000 lines of plan code (``plan_text.py``): read and compiled, and loaded again from what was kept.
"""

import argparse
import functools
import shutil
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

from plan_text import plan_text

from cramhy_runtime.ground.data import Cons
from cramhy_runtime.languages.commonlisp.systems.loader import load_file
from cramhy_runtime.repl.session import Session

PROGRAMS = {
    "a recursive function: fib 20": ("(defun fib (n) (if (< n 2) n (+ (fib (- n 1)) (fib (- n 2)))))", "(fib 20)"),
    "loop over a vector of floats": (
        "(defvar *floats* (coerce (loop for i below 50000 collect (* i 0.5)) 'vector)) "
        "(defun energy (v) (loop for x across v sum (* x x))) (defun energies () (energy *floats*))",
        "(energies)",
    ),
    "mapcar with a closure": (
        "(defvar *numbers* (loop for i below 20000 collect i)) "
        "(defun scaled (k l) (mapcar (lambda (x) (* x k)) l)) (defun all-scaled () (scaled 3 *numbers*))",
        "(all-scaled)",
    ),
    "generic dispatch": (
        "(defclass arm () ()) (defclass left-arm (arm) ()) (defclass right-arm (arm) ()) (defgeneric side (arm)) "
        "(defmethod side ((arm left-arm)) 1) (defmethod side ((arm right-arm)) 2) "
        "(defvar *arms* (list (make-instance 'left-arm) (make-instance 'right-arm))) "
        "(defun sides () (let ((s 0)) (dotimes (i 10000 s) (dolist (arm *arms*) (incf s (side arm))))))",
        "(sides)",
    ),
    "struct access": (
        "(defstruct place x y) (defvar *places* (loop for i below 20000 collect (make-place :x i :y 2))) "
        "(defun areas-of-places () (let ((s 0)) (dolist (p *places* s) (setf (place-y p) 3) "
        "(incf s (* (place-x p) (place-y p))))))",
        "(areas-of-places)",
    ),
    "string building with format": (
        "(defun texts () (let ((l nil)) (dotimes (i 5000 (length l)) "
        '(push (format nil "~a goes to place ~d of ~s.~%" "Turtle" i :kitchen) l))))',
        "(texts)",
    ),
    "nested dotimes 300 x 300": ("(defun nested () (let ((s 0)) (dotimes (i 300 s) (dotimes (j 300) (setq s (+ s j))))))", "(nested)"),
    "push 100000, nreverse": ("(defun build () (let ((l nil)) (dotimes (i 100000) (push i l)) (length (nreverse l))))", "(build)"),
    "&key calls 50000": (
        "(defun area (&key (width 1) (height 1)) (* width height)) "
        "(defun areas () (let ((s 0)) (dotimes (i 50000 s) (incf s (area :width i :height 2)))))",
        "(areas)",
    ),
    "specials 100000": (
        "(defvar *count* 0) (defun counting () (let ((*count* 0)) (dotimes (i 100000) (incf *count*)) *count*))",
        "(counting)",
    ),
    "loop collect when 50000": ("(defun looped () (length (loop for i from 1 to 50000 when (evenp i) collect (* i i))))", "(looped)"),
    "assoc in a list of 50, 5000": (
        "(defun searched () (let ((a (loop for i below 50 collect (cons i i))) (s 0)) "
        "(dotimes (i 5000 s) (incf s (cdr (assoc (mod i 50) a))))))",
        "(searched)",
    ),
    "hash table 50000": (
        "(defun hashed () (let ((h (make-hash-table))) (dotimes (i 50000) (setf (gethash i h) i)) (hash-table-count h)))",
        "(hashed)",
    ),
    "handler-case 20000": (
        '(defun handled () (let ((n 0)) (dotimes (i 20000 n) (handler-case (when (evenp i) (error "x")) (error () (incf n))))))',
        "(handled)",
    ),
    "return-from in mapc 20000": (
        "(defun left () (let ((n 0)) (dotimes (i 20000 n) "
        "(block b (mapc (lambda (x) (when (= x 2) (return-from b nil)) (incf n)) '(1 2 3))))))",
        "(left)",
    ),
    "return-from a closure 20000": (
        "(defun call (f) (funcall f)) (defun escape () (let ((n 0)) (dotimes (i 20000 n) "
        "(block b (call (lambda () (incf n) (return-from b nil)))))))",
        "(escape)",
    ),
}


def fib(n):
    return n if n < 2 else fib(n - 1) + fib(n - 2)


floats = [i * 0.5 for i in range(50000)]


def energies():
    s = 0
    for x in floats:
        s += x * x
    return s


numbers = list(range(20000))


def all_scaled():
    k = 3
    return list(map(lambda x: x * k, numbers))


class Arm:
    pass


class LeftArm(Arm):
    def side(self):
        return 1


class RightArm(Arm):
    def side(self):
        return 2


@functools.singledispatch
def side(arm):
    raise TypeError(arm)


side.register(LeftArm, lambda arm: 1)
side.register(RightArm, lambda arm: 2)
arms = [LeftArm(), RightArm()]


def sides():
    s = 0
    for _ in range(10000):
        for arm in arms:
            s += side(arm)
    return s


def sides_by_methods():
    s = 0
    for _ in range(10000):
        for arm in arms:
            s += arm.side()
    return s


class Place:
    __slots__ = ("x", "y")

    def __init__(self, x, y):
        self.x, self.y = x, y


places = [Place(i, 2) for i in range(20000)]


def areas_of_places():
    s = 0
    for place in places:
        place.y = 3
        s += place.x * place.y
    return s


def texts():
    items, name, room = [], "Turtle", "kitchen"
    for i in range(5000):
        items.append(f"{name} goes to place {i} of {room!r}.\n")
    return len(items)


def nested():
    s = 0
    for _ in range(300):
        for j in range(300):
            s = s + j
    return s


def build():
    items = None
    for i in range(100000):
        items = Cons(i, items)
    done = None
    while items is not None:
        items.cdr, done, items = done, items, items.cdr
    return done


def area(*, width=1, height=1):
    return width * height


def areas():
    s = 0
    for i in range(50000):
        s += area(width=i, height=2)
    return s


def counting():
    global count
    count = 0
    for _ in range(100000):
        count += 1
    return count


def looped():
    return len([i * i for i in range(1, 50001) if i % 2 == 0])


def searched():
    pairs, s = [(i, i) for i in range(50)], 0
    for i in range(5000):
        s += next(value for key, value in pairs if key == i % 50)
    return s


def hashed():
    table = {}
    for i in range(50000):
        table[i] = i
    return len(table)


def handled():
    n = 0
    for i in range(20000):
        try:
            if i % 2 == 0:
                raise ValueError("x")
        except ValueError:
            n += 1
    return n


def left():
    n = 0
    for _ in range(20000):
        for x in (1, 2, 3):
            if x == 2:
                break
            n += 1
    return n


class Left(Exception):
    pass


def call(function):
    function()


def escape():
    n = 0

    def leave():
        nonlocal n
        n += 1
        raise Left

    for _ in range(20000):
        try:
            call(leave)
        except Left:
            pass
    return n


PYTHON = dict(
    zip(
        PROGRAMS,
        (
            fib,
            energies,
            all_scaled,
            sides,
            areas_of_places,
            texts,
            nested,
            build,
            areas,
            counting,
            looped,
            searched,
            hashed,
            handled,
            left,
            escape,
        ),
        strict=True,
    )
)
MORE = {"generic dispatch": ("  beside a method call", sides_by_methods)}


def timed(function):
    before = time.perf_counter()
    function()
    return (time.perf_counter() - before) * 1000


def medians(functions, repeat):
    """The median times in ms of ``functions``, which run in turn."""
    for function in functions:
        function()
    rounds = [[timed(function) for function in functions] for _ in range(repeat)]
    return [statistics.median(times) for times in zip(*rounds, strict=True)]


def sbcl(definition, call, repeat):
    """Milliseconds in SBCL, or ``None`` without it."""
    if not shutil.which("sbcl"):
        return None
    text = f"""(declaim (sb-ext:muffle-conditions warning compiler-note)) {definition}
(let ((best nil) (inner 20))
  (dotimes (i {repeat})
    (let ((before (get-internal-real-time)))
      (dotimes (k inner) {call})
      (let ((used (- (get-internal-real-time) before))) (when (or (null best) (< used best)) (setq best used)))))
  (format t "~f" (/ best internal-time-units-per-second inner 0.001)))"""
    result = subprocess.run(["sbcl", "--noinform", "--non-interactive", "--eval", f"(progn {text})"], capture_output=True, text=True)
    try:
        return float(result.stdout.split()[-1])
    except (ValueError, IndexError):
        return None


def loading(repeat):
    """Seconds to read and compile 1,000 lines, and to load them again."""
    compiled, loaded = [], []
    for number in range(repeat):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"plans{number}.lisp"
            path.write_text(plan_text(1000, f"plans-{number}"))
            for times in (compiled, loaded):
                times.append(timed(lambda path=path: load_file(path)))
    return statistics.median(compiled), statistics.median(loaded)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=9)
    parser.add_argument("--only", default="", help="part of a program's name")
    options = parser.parse_args()
    session = Session(time="virtual", turtlesim=False)
    print(f"{'program':32}{'cramhy ms':>12}{'SBCL ms':>12}{'Python ms':>12}{'cramhy/Python':>15}")
    for name, (definition, call_) in PROGRAMS.items():
        if options.only not in name:
            continue
        session.evaluate_text(definition)
        words = call_.strip("()").split()
        function = session.evaluate_text(f"#'{words[0]}")[0]
        arguments = [int(word) for word in words[1:]]
        label, second = MORE.get(name, ("", None))
        peers = [PYTHON[name], *([second] if second else [])]
        ours, *hands = medians([functools.partial(each, *arguments) for each in (function, *peers)], options.repeat)
        native = sbcl(definition, call_, 3)
        far_end = "-" if native is None else f"{native:.2f}"
        print(f"{name:32}{ours:12.2f}{far_end:>12}{hands[0]:12.2f}{ours / hands[0]:15.1f}")
        for hand in hands[1:]:
            print(f"{label:32}{'':24}{hand:12.2f}{ours / hand:15.1f}")
    compiled, loaded = loading(3)
    print(f"1,000 lines of plan code: read and compiled in {compiled / 1000:.2f} s, loaded again in {loaded / 1000:.3f} s")


if __name__ == "__main__":
    main()
