"""The macros of `hyrule` around plan forms and inside of them."""

import pytest
import hy

FORMS = {
    "->": ("(top-level (-> 5 (inc) (par 2)))", 6),
    "->>": ("(top-level (->> (par 5 2) (- 1)))", -4),
    "as->": ("(top-level (as-> (par 5 2) it (seq it (* it 2))))", 10),
    "some->": ("(top-level (some-> (par None 2) (par 3)))", None),
    "doto": ("(top-level (doto (par [] 2) (.append (par 1 2)) (.append (pursue (sleep 9) 3))))", [1, 3]),
    "unless": ("(top-level (unless (par None 1) (seq 1 2)))", 2),
    "lif": ('(top-level (lif (par 0 1) (seq 1 "zero is true") "else"))', "zero is true"),
    "case": ('(top-level (case (par 2 1) 1 "one" 2 (seq "two" "second") else "none"))', "second"),
    "ecase": ("(top-level (ecase (lisp drive) (lisp turn) 1 (lisp drive) (par 2 3)))", 2),
    "branch": ("(top-level (branch (par (< it 3) 1) 5 (seq 1) 2 (seq 7)))", 7),
    "ebranch": ("(top-level (ebranch (in 3 it) [1 2] 1 [3] (par 2)))", 2),
    "ncut": ("(top-level (ncut (par [1 2 3 4] 1) 1:3))", [2, 3]),
    "loop": ("(top-level (loop [[i 5] [acc 1]] (seq 1 (if (= i 0) acc (recur (- i 1) (* acc i))))))", 120),
    "do-n": ("(do (setv seen []) (top-level (do-n 2 (sleep 1) (.append seen 1))) seen)", [1, 1]),
    "list-n": ("(top-level (list-n 2 (par 7 (sleep 1))))", [7, 7]),
    "cfor": ("(top-level (cfor list x [1 2] (par x 0)))", [1, 2]),
    "block": ("(block (for [x [1 2 3]] (when (= (top-level (par x 0)) 2) (block-ret x))))", 2),
    "comment": ("(top-level (par 1 (comment (fail))))", 1),
    "ap-if": ("(top-level (ap-if (par 3 1) (seq 1 it) 0))", 3),
    "ap-when": ("(top-level (ap-when (par 3 1) (seq 1 it)))", 3),
    "ap-map": ("(top-level (list (ap-map (par (* it 2) 0) [1 2])))", [2, 4]),
    "ap-map-when": ("(top-level (list (ap-map-when (fn [x] (> x 1)) (par 0 it) [1 2])))", [1, 0]),
    "ap-filter": ("(top-level (list (ap-filter (par (> it 1) 0) [1 2])))", [2]),
    "ap-reject": ("(top-level (list (ap-reject (par (> it 1) 0) [1 2])))", [1]),
    "ap-each": ("(do (setv seen []) (top-level (ap-each [1 2] (sleep it) (.append seen it))) seen)", [1, 2]),
    "ap-each-while": ("(do (setv seen []) (top-level (ap-each-while [1 2 3] (par (< it 3) 0) (.append seen it))) seen)", [1, 2]),
    "ap-dotimes": ("(do (setv seen []) (top-level (ap-dotimes 2 (par (.append seen it) 0))) seen)", [0, 1]),
    "ap-first": ("(top-level (ap-first (par (> it 5) 0) (range 10)))", 6),
    "ap-last": ("(top-level (ap-last (par (< it 5) 0) (range 10)))", 4),
    "ap-reduce": ("(top-level (ap-reduce (par (+ it acc) 0) (range 5)))", 10),
    "ap-with": ("(do (import contextlib [nullcontext]) (top-level (ap-with (nullcontext 4) (par it 0))))", 4),
    "let+": ("(top-level (let+ [[a b] (par [1 2] 0)] (seq a (+ a b))))", 3),
    "setv+": ('(top-level (do (setv+ {x "a"} (par {"a" 4} 0)) (seq x)))', 4),
    "fn+": ("((fn+ [[a b]] (top-level (par (+ a b) 0))) [1 2])", 3),
    "defn+": ("(do (defn+ both [[a b]] (top-level (par (+ a b) 0))) (both [1 2]))", 3),
    "dict=:": ("(top-level (get (dict=: [a b] (par [1 2] 0)) 'b))", 2),
    "meth": ("(do (defclass Robot [] (setv n 1) (meth go [by] (top-level (par (+= @n by) 0)) @n)) (.go (Robot) 2))", 3),
    "pun": ("(do (setv value 4) (top-level (. (pun (make-fluent :!value)) value)))", 4),
    "of": ("(top-level (par (of (par [1 2] 0) 1) 0))", 2),
    "smacrolet": ("(do (setv speed 5) (smacrolet [s speed] (top-level (par s 0))))", 5),
    "defmacro!": ("(do (defmacro! twice [form] `(do (setv ~g!x ~form) (par ~g!x ~g!x))) (top-level (twice (seq 1 3))))", 3),
    "def-gensyms": ("(do (defmacro once [form] (def-gensyms x) `(do (setv ~x ~form) (par ~x 0))) (top-level (once 3)))", 3),
    "defmacro-kwargs": (
        "(do (defmacro-kwargs after [form [seconds 1]] `(seq (sleep ~seconds) ~form)) (top-level (after :seconds 2 3)))",
        3,
    ),
}
NO_EXPRESSION = {
    "defmain": "is for a program's beginning",
    "ameth": "defines methods for asyncio",
    "seq": "the plan language has a seq, too: whichever is required last counts",
    "defseq": "defines a sequence by what hyrule's seq is",
    "sqlexec": "talks to a database",
}


def test_each_macro_of_hyrule_is_tried_or_has_a_reason():
    import hyrule  # Hy looks through the whole stack for each file of it, and pytest's is deep while tests are collected

    names = {hy.unmangle(name) for name in hyrule._hy_macros if not name.startswith("_")}
    assert set(FORMS) | set(NO_EXPRESSION) == names


@pytest.mark.soak
def test_the_macros_of_hyrule_work_around_plan_forms_and_inside(write, program):
    beginning = f"(require cramhy *)\n(require hyrule [{' '.join(FORMS)}])\n(import hyrule [inc recur])\n"
    write("all.hy", beginning + "\n".join(f'(print (hy.repr {form}) "{name}")' for name, (form, _) in FORMS.items()))
    done = program("hy", "all.hy")
    assert done.stderr == ""
    assert done.stdout.splitlines() == [f"{hy.repr(value)} {name}" for name, (_, value) in FORMS.items()]


@pytest.mark.soak
def test_the_seq_of_the_plan_language_has_its_prefix_beside_that_of_hyrule(write, program):
    write("both.hy", "(require cramhy * hyrule *)\n(import hyrule *)\n(print (get (seq [n] (** n 2)) 3) (cpl:top-level (cpl:seq 1 2)))\n")
    done = program("hy", "both.hy")
    assert (done.stdout, done.stderr) == ("9 2\n", "")
