"""What compiled Lisp costs: small programs, beside Python code that does the same by hand, and beside SBCL.

    python benchmarks/lisp_bench.py [--repeat N]

Each program of the folder ``programs`` and its peer in Python run in turn, N times in one process; the figures are medians in
milliseconds, and the quotient is the price of Lisp's semantics (generic arithmetic, several values, functions that may be defined
again, checkpoints). SBCL compiles to machine code and stands there as the far end of the scale; `-` where it is not installed.

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
from programs import programs

from cramhy_runtime.languages.commonlisp.systems.loader import load_file
from cramhy_runtime.repl.session import Session


def timed(function):
    before = time.process_time()
    function()
    return (time.process_time() - before) * 1000


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
(let ((best nil) (inner 200))
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
    print(f"{'program':38}{'cramhy ms':>12}{'SBCL ms':>12}{'Python ms':>12}{'cramhy/Python':>15}")
    quotients = []
    for program in programs():
        if options.only not in program.name:
            continue
        session.evaluate_text(program.lisp)
        function = session.evaluate_text(f"#'{program.function}")[0]
        ours, hand = medians([functools.partial(each, *program.arguments) for each in (function, program.python)], options.repeat)
        native = sbcl(program.lisp, program.call, 3)
        far_end = "-" if native is None else f"{native:.2f}"
        quotients.append(ours / hand)
        print(f"{program.name:38}{ours:12.2f}{far_end:>12}{hand:12.2f}{ours / hand:15.1f}")
    if quotients:
        print(f"{'geometric mean':38}{statistics.geometric_mean(quotients):51.1f}")
    compiled, loaded = loading(3)
    print(f"1,000 lines of plan code: read and compiled in {compiled / 1000:.2f} s, loaded again in {loaded / 1000:.3f} s")


if __name__ == "__main__":
    main()
