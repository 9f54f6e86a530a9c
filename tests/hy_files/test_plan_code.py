"""What a Hy program has beside what it says: each turn of a loop is a checkpoint, and ``finally`` runs to its end."""

import signal
import subprocess
import sys

import pytest

from .conftest import environment

LOOPS = """\
(require cramhy *)

(defn for-ever []
  (while True
    (setv i 1)))
(defn each-of [numbers]
  (for [i numbers]
    (when (= i -1) (break))
    (continue)))
(defn pairs []
  (for [a (range 1000000) b (range 1000000) :if (> b a 999999)] (print "never")))
(defn numbers [] (while True (yield 1)))
(defn of-a-generator [] (sum (gfor n (numbers) n)))
(defn with-else []
  (while False (else (while True))))
(defn next [] (print "a function of the user's"))

(for [loop [for-ever (fn [] (each-of (range 10000000000))) pairs of-a-generator with-else]]
  (print (top-level (pursue (do (sleep 1) "won") (loop)))))
"""


@pytest.mark.soak
@pytest.mark.parametrize("way", ["hy", "run"])
def test_a_loop_that_never_waits_can_be_ended(write, program, way):
    write("loops.hy", LOOPS)
    done = program(way, "loops.hy")
    assert (done.stdout, done.stderr) == ("won\n" * 5, "")


@pytest.mark.soak
def test_loops_of_a_module_that_python_imports_are_checkpoints_too(write, python):
    write("loops.hy", LOOPS)
    for _ in ("compiled", "kept"):
        done = python("-c", "import hy; import loops")
        assert (done.stdout, done.stderr) == ("won\n" * 5, "")


@pytest.mark.soak
def test_one_operator_alone_may_be_required(write, program):
    write("loops.hy", LOOPS.replace("cramhy *", "cramhy [top-level pursue sleep]"))
    assert program("hy", "loops.hy").stdout == "won\n" * 5


@pytest.mark.soak
def test_loops_run_without_a_plan_and_in_other_threads_as_they_always_did(write, program):
    write(
        "loops.hy",
        """\
(require cramhy *)
(import threading cramhy_runtime [kernel])
(defn count [n]
  (setv found [])
  (for [i (range n)]
    (when (% i 2) (continue))
    (.append found i)
    (when (> i 5) (break))
    (else (.append found "through")))
  (while (< (len found) 8)
    (.append found None)
    (else (.append found "end")))
  (try (return found) (finally (.append found "last"))))
(defclass Colour []
  (setv red 1)
  (while False 1)
  (for [i [1]] (continue))

  (defn [staticmethod] count [] (for [i (range 3)] i)))
(print (lfor name (vars Colour) :if (not (.startswith name "__")) name) (Colour.count))
(print (count 4))
(print (count 100))
(setv thread (threading.Thread :target (fn [] (print (count 4)) (for [_ (range 5000)]))))
(.start thread)
(.join thread)
(kernel.stop)
(print (count 4))
""",
    )
    few = "[0, 2, 'through', None, None, None, None, None, 'end', 'last']\n"
    many = "[0, 2, 4, 6, None, None, None, None, 'end', 'last']\n"
    done = program("hy", "loops.hy")
    assert (done.stdout, done.stderr) == ("['red', 'i', 'count'] None\n" + few + many + few + few, "")


CTRL_C = """\
(require cramhy *)
(cramhy.time "wall")
(defn for-ever []
  (print "begun" :flush True)
  (while True (setv i 1)))
(top-level
  (try (par (for-ever) (sleep 9))
    (finally (sleep 0.01) (print "cleaned up"))))
"""


@pytest.mark.soak
@pytest.mark.parametrize("text", [CTRL_C, CTRL_C.replace("(par (for-ever) (sleep 9))", "(for-ever)")], ids=["in a branch", "alone"])
def test_ctrl_c_ends_a_loop_that_never_waits(write, tmp_path, text):
    write("plan.hy", text)
    command = [sys.executable, "-m", "hy", "plan.hy"]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment()) as process:
        assert process.stdout.readline() == "begun\n"
        process.send_signal(signal.SIGINT)
        printed, told = process.communicate(timeout=60)
    assert (process.returncode, printed, told) == (130, "cleaned up\n", "")


CLEANUP = """\
(require cramhy *)
(setv log [])
(defn [(fn [f] f)] clean-up [seconds]
  (try
    "the body returned"
    (finally
      (sleep seconds)
      (.append log "cleaned up"))))
(defn tidy-numbers []
  (try
    (yield 1)
    (finally (yield 2))))
(print
  (top-level
    (with-failure-handling [[simple-plan-failure [e] (leave "the sibling failed")]]
      (par (clean-up 0.2) (do (sleep 0.1) (fail "no"))))))
(print log (list (tidy-numbers)))
(print
  (top-level
    (pursue
      (try (clean-up 0.2) (finally (clean-up 0.3) (.append log "twice")))
      (do (sleep 0.1) "won"))))
(print log)
(defn leaves [] (for [i [1 2]] (try 1 (finally (break)))) (try (/ 1 0) (finally (return "by return"))))
(print (leaves))
"""


@pytest.mark.soak
@pytest.mark.parametrize("way", ["hy", "run"])
def test_what_finally_does_runs_to_its_end(write, program, way):
    write("plan.hy", CLEANUP)
    done = program(way, "plan.hy")
    assert (done.stdout.splitlines(), done.stderr) == (
        ["the sibling failed", "['cleaned up'] [1, 2]", "won", "['cleaned up', 'cleaned up', 'cleaned up', 'twice']", "by return"],
        "",
    )


@pytest.mark.soak
def test_hy2py_shows_both_as_python(write, python):
    write("plan.hy", "(require cramhy *)\n(while True (try (f) (finally (g))))\n")
    done = python("-c", "from hy.cmdline import hy2py_main; hy2py_main()", "plan.hy")
    assert done.stdout.splitlines()[-10:] == [
        "while True:",
        "    for _cramhy_turn in _cramhy_calls_budget.ticks:",
        "        break",
        "    else:",
        "        _cramhy_calls_refill()",
        "    try:",
        "        _hy_anon_1 = f()",
        "    finally:",
        "        with _cramhy_calls_cleanup_here():",
        "            g()",
    ]
