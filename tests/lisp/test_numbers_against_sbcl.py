"""Numbers answer as SBCL 2.2.9 answered: forms and what it printed, addresses and white space left out.

A form that is followed by ``=> answer`` is a question; other forms prepare it. All run in order in one image.
"""

# ruff: noqa: E501

from __future__ import annotations

import re

from cramhy_runtime import kernel
from cramhy_runtime.session import boot
from cramhy_runtime.lisp_core.conditions import Condition
from cramhy_runtime.lisp_core.data import all_values, one
from cramhy_runtime.lisp_core.dynamic import binding
from cramhy_runtime.languages.commonlisp.evaluation.evaluator import evaluate
from cramhy_runtime.languages.commonlisp.objects.classes import class_name
from cramhy_runtime.lisp_core.packages import find_package, sym
from cramhy_runtime.languages.commonlisp.printer.printer import prin1_to_string
from cramhy_runtime.languages.commonlisp.reader.reader import read_from_string

PACKAGE, PRETTY = sym("*PACKAGE*"), sym("*PRINT-PRETTY*")


def answers(program):
    """(form text, what SBCL answered, what we answer) for the forms of ``program`` that are followed by ``=> answer``."""
    boot()
    if kernel.active() is None:
        kernel.start()
    expected, text = [], []
    for line in program.strip().splitlines():
        if line.startswith("=> "):
            expected.append((text, line[3:]))
            text = []
        else:
            text.append(line)
    with binding(PACKAGE, find_package("COMMON-LISP-USER"), PRETTY, None):
        for lines, answer in expected:
            forms = [one(read_from_string(line)) for line in lines]
            for form in forms[:-1]:
                evaluate(form)
            yield lines[-1], answer, _answer(forms[-1])


def _answer(form):
    try:
        text = " | ".join(prin1_to_string(value) for value in all_values(evaluate(form)))
    except Condition as condition:
        text = f"{prin1_to_string(class_name(type(condition)))}: {condition}"
    return re.sub(r"\{[0-9A-F]+\}", "{}", re.sub(r"\s+", " ", text)).strip()


def check(program):
    """Assert that every answer is SBCL's; all differences are shown at once."""
    wrong = [f"{form}\n  SBCL: {expected}\n  here: {found}" for form, expected, found in answers(program) if expected != found]
    assert not wrong, f"{len(wrong)} answers differ:\n" + "\n".join(wrong)


NUMBERS = r"""
(+ 1 nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(+ nil 1)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(- nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(+ nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(* 2 "a")
=> TYPE-ERROR: The value "a" is not of type NUMBER
(/ 1 nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(/ nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(< 1 nil)
=> TYPE-ERROR: The value NIL is not of type REAL
(= 1 'a)
=> TYPE-ERROR: The value A is not of type NUMBER
(1+ nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(1- nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(max 1 nil)
=> TYPE-ERROR: The value NIL is not of type REAL
(abs nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(floor nil)
=> TYPE-ERROR: The value NIL is not of type REAL
(floor 1 nil)
=> TYPE-ERROR: The value NIL is not of type REAL
(zerop nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(plusp nil)
=> TYPE-ERROR: The value NIL is not of type REAL
(minusp 'a)
=> TYPE-ERROR: The value A is not of type REAL
(evenp 1.0)
=> TYPE-ERROR: The value 1.0 is not of type INTEGER
(oddp nil)
=> TYPE-ERROR: The value NIL is not of type INTEGER
(expt nil 2)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(expt 2 nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(sqrt nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(sqrt -4)
=> #C(0.0 2.0)
(sqrt 16)
=> 4.0
(sqrt -4d0)
=> #C(0.0d0 2.0d0)
(sqrt 1/4)
=> 0.5
(sin nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(log nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(log 0)
=> DIVISION-BY-ZERO: arithmetic error DIVISION-BY-ZERO signalled
(log 0.0)
=> DIVISION-BY-ZERO: arithmetic error DIVISION-BY-ZERO signalled
(log 8 2)
=> 3.0
(log -1)
=> #C(0.0 3.1415927)
(log 100 10)
=> 2.0
(log 8d0 2)
=> 3.0d0
(log 8 2d0)
=> 3.0d0
(exp nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(exp 1000)
=> FLOATING-POINT-OVERFLOW: arithmetic error FLOATING-POINT-OVERFLOW signalled
(exp 1000.0)
=> FLOATING-POINT-OVERFLOW: arithmetic error FLOATING-POINT-OVERFLOW signalled
(atan nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(atan 1 nil)
=> TYPE-ERROR: The value NIL is not of type REAL
(atan 1 1)
=> 0.7853982
(atan 1d0 1)
=> 0.7853981633974483d0
(acos 2d0)
=> #C(0.0d0 1.3169578969248166d0)
(atanh 2)
=> #C(0.54930615 1.5707964)
(acosh 0.5)
=> #C(0.0 1.0471976)
(asin 1)
=> 1.5707964
(isqrt 17)
=> 4
(ash -1 -5)
=> -1
(logand 1 nil)
=> TYPE-ERROR: The value NIL is not of type INTEGER
(float 1 1d0)
=> 1.0d0
(float 1d0)
=> 1.0d0
(float 1d0 1.0)
=> 1.0
(float 1/3 1d0)
=> 0.3333333333333333d0
(float 0.1 1d0)
=> 0.10000000149011612d0
(rational 0.1)
=> 13421773/134217728
(rationalize 0.1)
=> 1/10
(rationalize 0.1d0)
=> 1/10
(rational 0.5d0)
=> 1/2
(numerator 3/4)
=> 3
(phase -1)
=> 3.1415927
(phase -1d0)
=> 3.141592653589793d0
(cis 1)
=> #C(0.5403023 0.84147096)
(complex 1 0)
=> 1
(complex 1.0 0)
=> #C(1.0 0.0)
(signum -3)
=> -1
(signum -3.5)
=> -1.0
(signum 0d0)
=> 0.0d0
(signum nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(signum 2/3)
=> 1
(random 0)
=> SIMPLE-TYPE-ERROR: Argument is neither a positive integer nor a positive float: 0
(random -1)
=> SIMPLE-TYPE-ERROR: Argument is neither a positive integer nor a positive float: -1
(random nil)
=> SIMPLE-TYPE-ERROR: Argument is neither a positive integer nor a positive float: NIL
(random 1.0 5)
=> TYPE-ERROR: The value 5 is not of type RANDOM-STATE
(random "a")
=> SIMPLE-TYPE-ERROR: Argument is neither a positive integer nor a positive float: "a"
(min 1 2.0)
=> 1
(max 1 1.0)
=> 1
(max 1.0 2)
=> 2
(max 3 2.0)
=> 3
(floor 7 2)
=> 3 | 1
(floor -7 2)
=> -4 | 1
(floor 7.5)
=> 7 | 0.5
(floor 7.5 2)
=> 3 | 1.5
(floor 7 2.0)
=> 3 | 1.0
(floor 1/2)
=> 0 | 1/2
(floor 7/2 1/3)
=> 10 | 1/6
(round 2.5)
=> 2 | 0.5
(round 7 2)
=> 4 | -1
(round -2.5)
=> -2 | -0.5
(round 5/2)
=> 2 | 1/2
(truncate -7 2)
=> -3 | -1
(truncate -7.5)
=> -7 | -0.5
(ceiling 7 2)
=> 4 | -1
(ffloor 7 2)
=> 3.0 | 1
(ffloor 7.5)
=> 7.0 | 0.5
(ffloor 7 2d0)
=> 3.0d0 | 1.0d0
(fround 7 2)
=> 4.0 | -1
(ftruncate -7.5)
=> -7.0 | -0.5
(fceiling 7d0 2)
=> 4.0d0 | -1.0d0
(mod -7 2)
=> 1
(rem -7 2)
=> -1
(mod 7.5 2)
=> 1.5
(mod -7.5 2)
=> 0.5
(mod 5.5d0 2.0)
=> 1.5d0
(rem 7 -2.5)
=> 2.0
(mod nil 2)
=> TYPE-ERROR: The value NIL is not of type REAL
(rem 3 nil)
=> TYPE-ERROR: The value NIL is not of type REAL
(mod 1/2 1/3)
=> 1/6
(floor 1d20)
=> 100000000000000000000 | 0.0d0
(expt 2 10)
=> 1024
(expt 2 -2)
=> 1/4
(expt 2.0 3)
=> 8.0
(expt 2 0.5)
=> 1.4142135
(expt 4 1/2)
=> 2.0
(expt -8 1/3)
=> #C(1.0 1.7320508)
(expt -8 0.5)
=> #C(1.7319121e-16 2.828427)
(expt 2d0 2)
=> 4.0d0
(expt 0 0)
=> 1
(expt 0.0 0)
=> 1.0
(expt 2/3 2)
=> 4/9
(expt 2/3 -2)
=> 9/4
(= #c(1 0.0) 1)
=> T
(abs -1/2)
=> 1/2
(sinh 1)
=> 1.1752012
(asinh 1)
=> 0.8813736
(tanh 1d0)
=> 0.7615941559557649d0
(exp 1)
=> 2.7182817
(exp 1d0)
=> 2.718281828459045d0
(integer-length 255)
=> 8
(integer-length -1)
=> 0
(logcount 7)
=> 3
(ldb (byte 4 4) 255)
=> 15
(dpb 1 (byte 2 0) 0)
=> 1
(mask-field (byte 4 4) 255)
=> 240
(deposit-field 255 (byte 4 4) 0)
=> 240
(byte 4 2)
=> (4 . 2)
(byte-size (byte 4 2))
=> 4
(ldb-test (byte 1 1) 2)
=> T
(boole boole-and 3 5)
=> 1
boole-xor
=> 8
(logbitp 1 2)
=> T
(logtest 1 2)
=> NIL
(logandc1 1 3)
=> 2
(logeqv 1 2)
=> -4
(decode-float 1.5)
=> 0.75 | 1 | 1.0
(integer-decode-float 1.5)
=> 12582912 | -23 | 1
(integer-decode-float 1.5d0)
=> 6755399441055744 | -52 | 1
(scale-float 1.5 2)
=> 6.0
(float-digits 1.0)
=> 24
(float-digits 1d0)
=> 53
(float-radix 1.0)
=> 2
(float-sign -2.0)
=> -1.0
(float-sign -2.0 3.0)
=> -3.0
(float-precision 1.0)
=> 24
most-positive-fixnum
=> 4611686018427387903
most-negative-fixnum
=> -4611686018427387904
pi
=> 3.141592653589793d0
single-float-epsilon
=> 5.960465e-8
double-float-epsilon
=> 1.1102230246251568d-16
single-float-negative-epsilon
=> 2.9802326e-8
double-float-negative-epsilon
=> 5.551115123125784d-17
most-positive-single-float
=> 3.4028235e38
most-positive-double-float
=> 1.7976931348623157d308
least-positive-single-float
=> 1.4012985e-45
least-positive-double-float
=> 4.9406564584124654d-324
least-positive-normalized-single-float
=> 1.1754944e-38
least-positive-normalized-double-float
=> 2.2250738585072014d-308
most-positive-long-float
=> 1.7976931348623157d308
most-positive-short-float
=> 3.4028235e38
(random-state-p *random-state*)
=> T
(funcall '+ 1 nil)
=> TYPE-ERROR: The value NIL is not of type NUMBER
(float 1/3)
=> 0.33333334
(sin 1)
=> 0.84147096
(cos 1d0)
=> 0.5403023058681398d0
(tan 1.0)
=> 1.5574077
(= 1 1.0 1d0)
=> T
(/= 1 2 1)
=> NIL
(< 1 2 3)
=> T
(numberp nil)
=> NIL
(parse-integer "12")
=> 12 | 2
(sqrt 2)
=> 1.4142135
(sqrt 2.0)
=> 1.4142135
(sqrt -4.0)
=> #C(0.0 2.0)
(sqrt 15241578750190521)
=> 1.2345679e8
(exp -1000.0)
=> 0.0
(/ 1 2 3)
=> 1/6
(/ 4)
=> 1/4
(/ 0.5)
=> 2.0
"""


def test_numbers_answer_as_in_sbcl():
    check(NUMBERS)
