"""What the body of an operator assigns, returns and leaves, where a reader of Hy sees forms in a row and Python sees a function."""

from __future__ import annotations

import pytest

from cramhy_runtime import cpl

ASSIGNING = {
    "two branches": ("(setv a 0 b 0) (par (do (sleep 1) (setv a 1)) (do (sleep 2) (setv b (+ a 1)))) [a b]", [1, 2]),
    "a counter": ("(setv n 0) (par-loop [k [1 2 3]] (sleep k) (+= n k)) n", 6),
    "a clause": ('(setv why None) (with-failure-handling [[plan-failure [e] (setv why "w") (leave 1)]] (fail "x")) why', "w"),
    "only read outside": ("(with-failure-handling [] (setv pose 3) (sleep 1)) (+ pose 1)", 4),
    "a let": ("(let [found None] (pursue (do (sleep 1) (setv found 1)) (sleep 5)) found)", 1),
    "a let in a let": ("(let [x 0] (let [x 1] (par (setv x 2)) [x]))", [2]),
    "three deep": ('(setv last 0) (par (try-in-order (do (setv last 1) (fail "x")) (do (sleep 1) (setv last 2))) (sleep 5)) last', 2),
    "nonlocal as before": ("(setv found None) (par (do (nonlocal found) (setv found 1)) (sleep 1)) found", 1),
    "setx": ("(setv found None) (par (setx found 1) (sleep 1)) found", 1),
    "a branch that reads": ("(par (do (sleep 2) heard) (setv heard 5))", 5),
    "destructuring": ("(setv x 0 y 0) (par (setv [x y] [1 2]) (sleep 1)) [x y]", [1, 2]),
    "an attempt": ("(setv x 0) (par (setv x (try (/ 1 0) (except [ZeroDivisionError] (sleep 1) 7))) (sleep 3)) x", 7),
    "a function that reads": ("(defn shown [] state) (par (setv state 4) (sleep 1)) (shown)", 4),
    "deleted": ("(setv x 1) (par (do (del x) (setv x 2)) (sleep 1)) x", 2),
    "a comprehension": ("(setv last 0) (setv made (lfor n [1 2] (with-task [] (setv last n) n))) [last made]", [2, [1, 2]]),
    "tags": ("(setv found 0) (with-tags (par (:tag search (sleep 1) (setv found 1)) (sleep 2))) found", 1),
    "whenever": ("(setv f (make-fluent :value 1) n 0) (whenever [f] (+= n 1) (when (= n 3) (break))) n", 3),
    "a method": ("(defclass R [] (defn look [self] (setv found 0) (par (setv found 1)) found)) (.look (R))", 1),
    "a parameter": (
        '(defn g [p] (with-retry-counters [[n 2]] (with-failure-handling [[plan-failure [e] (do-retry n (+= p "x") (retry))]]'
        ' (when (!= p "axx") (fail "no")) p))) (g "a")',
        "axx",
    ),
    # what only the branches have is their own
    "its own": ("(par (do (setv mine 1) (sleep 2) mine) (do (sleep 1) (setv mine 2)))", 1),
    "its own in a loop": ("(par-loop [n [3 1 2]] (with-failure-handling [] (setv mine n)) (sleep n) mine)", 3),
    "the variable of the loop": ("(setv n 7) (par-loop [n [1 2]] (setv n (+ n 1)) (sleep 1)) n", 7),
    "the variables of for": ("(for [i [9]] i) (par (for [i [1 2]] (sleep 1)) (for [i [3 4]] (sleep 1.5))) i", 9),
    "the variables of except": (
        "(try (/ 1 0) (except [e Exception] 0)) (par (try (/ 1 0) (except [e Exception] (sleep 1) (str e))) 1)",
        "division by zero",
    ),
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("case", ASSIGNING)
def test_a_body_assigns_the_variables_of_the_function_around(load, case):
    text, value = ASSIGNING[case]
    assert cpl.top_level(load(f"(defn f [] {text})").f) == value


MODULES = {
    "assigned before": "(setv found None) (top-level (par (do (sleep 1) (setv found 1))))",
    "assigned by the plan": "(top-level (sleep 1) (setv found 1))",
    "of a let": "(let [it None] (top-level (par (do (sleep 1) (setv it 1)))) (setv found it))",
    "of a let, said nonlocal": "(let [it None] ((fn [] (nonlocal it) (top-level (setv it 1)))) (setv found it))",
    "said global": "(setv found 0) (defn go [] (global found) (par (setv found 1) (sleep 1))) (top-level (go))",
    "of a function": "(setv found 1) (defn go [] (setv found 2) (par (setv found 3))) (top-level (go))",
    "read by a function": "(setv found 1) (defn go [] (par (setv found 3) (sleep 1)) found) (top-level (go))",
    "of a process module": """(setv found 1) (def-process-module wheels [m] (setv found 9))
        (top-level (with-process-modules-running [wheels] (pm-execute 'wheels (desig:a motion (type driving)))))""",
    "of the branches": "(setv found 1) (top-level (par-loop [n [3 1 2]] (setv mine n) (sleep n) (assert (= mine n))))",
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("case", MODULES)
def test_a_body_assigns_the_variables_of_the_module(load, case):
    module = load(MODULES[case])
    assert module.found == 1 and not hasattr(module, "mine")


RETURNING = {
    "a clause": ('(+ "it " (with-failure-handling [[plan-failure [e] (when True (return "waits"))]] (fail "x")))', "it waits"),
    "a clause, nothing": ('(with-failure-handling [[plan-failure [e] (return)]] (fail "x")) 3', 3),
    "clauses in each other": (
        '(with-failure-handling [[plan-failure [e] (return "outer")]]'
        ' (setv got (with-failure-handling [[plan-failure [e] (return "inner")]] (fail "a"))) (fail "b ~a" got))',
        "outer",
    ),
    "a clause of a list": ("(with-failure-handling [[#(simple-plan-failure plan-failure) [e] (return 4)]] (fail 'plan-failure))", 4),
    "the last form": ("(with-task [] (for [x [1 2]] (when (= x 2) (return x))) None)", 2),
    "the last form of the last": ("(without-scheduling (with-failure-handling [] (when True (return 5)) 6))", 5),
    "a function in a branch": ('(par (do (defn g [x] (when x (return "big")) 1) (g 3)) (sleep 2))', "big"),
    "a loop in a branch": ("(par (do (for [x [1 2 3]] (sleep 1) (when (= x 2) (break))) 8) (sleep 1))", 8),
    "a generator in a branch": ("(par (do (defn g [] (yield 1) (yield 2)) (list (g))) (sleep 1))", [1, 2]),
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("case", RETURNING)
def test_return_break_and_yield_mean_what_is_around_them(load, case):
    text, value = RETURNING[case]
    assert cpl.top_level(load(f"(defn f [] {text})").f) == value


def test_plans_and_process_modules_return(load):
    module = load("""(def-cram-function fetch [n] (when (> n 1) (return "many")) "one")
        (def-process-module wheels [m] (when True (return "early")) "late")
        (defn drive [] (with-process-modules-running [wheels] (pm-execute 'wheels (desig:a motion (type driving)))))""")
    assert cpl.top_level(lambda: (module.fetch(2), module.drive())) == ("many", "early")


VALUE = "Let the value be that of the last form of the body, and return what the operator gives."
KEEP = "Keep the value by setv, or let it be that of the last form of the body."
LOOP = "is in no loop of that body; a loop around {} cannot be reached from it.\nNote it by (setv left True), and write (when left ({})) behind the operator."
REFUSED = {
    "(top-level (when True (return 1)) 2) 3": f"(return) in the body of top-level ends the body alone, and not the function around top-level.\n{VALUE}",
    "(pursue (do (sleep 1) (return 1)) 2)": f"(return) in the body of pursue ends the body alone, and not the function around pursue.\n{KEEP}",
    "(par (return 1) 2)": f"(return) in the body of par ends the body alone, and not the function around par.\n{KEEP}",
    "(with-tags (par (:tag a (return 1))))": f"(return) in the body of :tag ends the body alone, and not the function around :tag.\n{KEEP}",
    "(try-in-order (return 1) 2) 3": "(return) in the body of try-in-order ends the body alone, and not the function around try-in-order.\n"
    "(leave value) leaves the operator with that value.",
    "(for [x [1]] (par (sleep 1) (break)))": f"(break) in the body of par {LOOP.format('par', 'break')}",
    "(while True (with-failure-handling [[plan-failure [e] (continue)]] 1))": "(continue) in a clause of with-failure-handling "
    + LOOP.format("clause of with-failure-handling", "continue"),
    "(top-level (for [x [1 2]] (yield x)))": "(yield) in the body of top-level makes a generator of the body alone, which nobody runs, and "
    "not of the function around top-level.\nCollect the values in a list, or call a function that yields.",
    "(par (yield :from [1]))": "(yield) in the body of par makes a generator of the body alone, which nobody runs, and not of the function "
    "around par.\nCollect the values in a list, or call a function that yields.",
    "(top-level (await 1))": "(await) in the body of top-level is for functions of asyncio, and a plan waits without it: plan forms in the body "
    "park its task.\nAwait it before the operator, or call asyncio.run by run_blocking.",
}


@pytest.mark.soak(all_but=1)
@pytest.mark.parametrize("text", REFUSED)
def test_what_would_end_the_body_alone_is_refused_when_the_file_is_compiled(load, text):
    with pytest.raises(SyntaxError) as told:
        load(f"(defn f []\n  {text})")
    assert str(told.value) == REFUSED[text]
    assert told.value.lineno == 3


def test_a_prompt_assigns_its_variables_too(capsys):
    from cramhy_runtime.languages.hy import module_names
    import types

    from hy.compiler import hy_compile
    import hy

    module = types.ModuleType("a_prompt")
    hy.eval(hy.read("(require cramhy *)"), module=module)
    for text in ("(setv found 0)", "(top-level (par (setv found 1) (sleep 1)))", "(top-level (setv later 2))"):
        statements, expression = hy_compile(hy.read(text), module, get_expr=True)
        module_names.complete_at_prompt(statements, module)
        exec(compile(statements, "typed", "exec"), vars(module))
        eval(compile(expression, "typed", "eval"), vars(module))
    assert (module.found, module.later) == (1, 2)
