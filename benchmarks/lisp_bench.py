"""What compiled Lisp costs: small programs, beside SBCL and beside Python code that does the same by hand.

    python benchmarks/lisp_bench.py [--repeat N]

Each figure is the best of N runs in milliseconds. SBCL compiles to machine code and stands there as the far end of the scale;
`-` where it is not installed. The column "Python" is what a Python programmer would write: the price of Lisp's semantics
(generic arithmetic, several values, symbols as functions, checkpoints) is the quotient of the first and the last.
"""

import argparse
import shutil
import subprocess
import time

from cramhy_runtime.lisp.data import Cons
from cramhy_runtime.repl.session import Session

PROGRAMS = {
    "fib 22": ("(defun fib (n) (if (< n 2) n (+ (fib (- n 1)) (fib (- n 2)))))", "(fib 22)"),
    "nested dotimes 300 x 300": ("(defun nested () (let ((s 0)) (dotimes (i 300 s) (dotimes (j 300) (setq s (+ s j))))))", "(nested)"),
    "push 100000, nreverse": ("(defun build () (let ((l nil)) (dotimes (i 100000) (push i l)) (length (nreverse l))))", "(build)"),
    "&key calls 50000": ("(defun area (&key (width 1) (height 1)) (* width height)) "
                         "(defun areas () (let ((s 0)) (dotimes (i 50000 s) (incf s (area :width i :height 2)))))", "(areas)"),
    "specials 100000": ("(defvar *count* 0) (defun counting () (let ((*count* 0)) (dotimes (i 100000) (incf *count*)) *count*))",
                        "(counting)"),
    "closures, mapcar 50000": ("(defun mapped () (let ((l (loop for i below 50000 collect i)) (k 3)) "
                               "(reduce #'+ (mapcar (lambda (x) (* x k)) l))))", "(mapped)"),
    "loop collect when 50000": ("(defun looped () (length (loop for i from 1 to 50000 when (evenp i) collect (* i i))))", "(looped)"),
    "assoc in a list of 50, 5000": ("(defun searched () (let ((a (loop for i below 50 collect (cons i i))) (s 0)) "
                                    "(dotimes (i 5000 s) (incf s (cdr (assoc (mod i 50) a))))))", "(searched)"),
    "hash table 50000": ("(defun hashed () (let ((h (make-hash-table))) (dotimes (i 50000) (setf (gethash i h) i)) "
                         "(hash-table-count h)))", "(hashed)"),
    "handler-case 20000": ("(defun handled () (let ((n 0)) (dotimes (i 20000 n) (handler-case (when (evenp i) (error \"x\")) "
                           "(error () (incf n))))))", "(handled)"),
    "return-from a closure 20000": ("(defun left () (let ((n 0)) (dotimes (i 20000 n) "
                                    "(block b (mapc (lambda (x) (when (= x 2) (return-from b nil)) (incf n)) '(1 2 3))))))", "(left)"),
}


def fib(n):
    return n if n < 2 else fib(n - 1) + fib(n - 2)


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
    return sum(area(width=i, height=2) for i in range(50000))


def counting():
    global count
    count = 0
    for _ in range(100000):
        count += 1
    return count


def mapped():
    k = 3
    return sum(map(lambda x: x * k, list(range(50000))))


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


PYTHON = dict(zip(PROGRAMS, (fib, nested, build, areas, counting, mapped, looped, searched, hashed, handled, left)))


def best(function, repeat):
    times = []
    for _ in range(repeat):
        before = time.perf_counter()
        function()
        times.append(time.perf_counter() - before)
    return min(times) * 1000


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


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--repeat", type=int, default=5)
    repeat = parser.parse_args().repeat
    session = Session(time="virtual", turtlesim=False)
    print(f"{'program':30}{'cramhy ms':>12}{'SBCL ms':>12}{'Python ms':>12}{'cramhy/Python':>15}")
    for name, (definition, call) in PROGRAMS.items():
        session.evaluate_text(definition)
        function = session.evaluate_text(f"#'{call.strip('()').split()[0]}")[0]
        arguments = [int(word) for word in call.strip("()").split()[1:]]
        ours = best(lambda: function(*arguments), repeat)
        native = sbcl(definition, call, repeat)
        hand = best(lambda: PYTHON[name](*arguments), repeat)
        far_end = "-" if native is None else f"{native:.2f}"
        print(f"{name:30}{ours:12.1f}{far_end:>12}{hand:12.1f}{ours / hand:15.1f}")


if __name__ == "__main__":
    main()
