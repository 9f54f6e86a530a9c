"""Types and classes of objects answer as in SBCL 2.2.9: see ``test_numbers_against_sbcl.py`` for how to read this."""

# ruff: noqa: E501

from __future__ import annotations

from test_numbers_against_sbcl import check

TYPES = r"""
(defclass a () ())
(defclass b (a) ())
(defstruct tm a)
(deftype small (&optional (n 10)) `(integer 0 ,n))
(deftype ev () '(satisfies evenp))
(coerce 1 'float)
=> 1.0
(coerce 1 'single-float)
=> 1.0
(coerce 1 'double-float)
=> 1.0d0
(coerce 1.5 'integer)
=> SIMPLE-TYPE-ERROR: 1.5 can't be converted to type INTEGER.
(coerce 1/2 'float)
=> 0.5
(coerce 0.1 'double-float)
=> 0.10000000149011612d0
(coerce '(1 2) 'vector)
=> #(1 2)
(coerce #(1 2) 'list)
=> (1 2)
(coerce "abc" 'list)
=> (#\a #\b #\c)
(coerce '(#\a #\b) 'string)
=> "ab"
(coerce "a" 'character)
=> #\a
(coerce 'a 'character)
=> #\A
(coerce "ab" 'character)
=> SIMPLE-TYPE-ERROR: String is not of length one: "ab"
(coerce 'car 'function)
=> #<FUNCTION CAR>
(coerce 'nope 'function)
=> UNDEFINED-FUNCTION: The function COMMON-LISP-USER::NOPE is undefined.
(coerce 1 'complex)
=> 1
(coerce 1.0 'complex)
=> #C(1.0 0.0)
(coerce "a" 'integer)
=> SIMPLE-TYPE-ERROR: "a" can't be converted to type INTEGER.
(coerce 1 'number)
=> 1
(coerce 1 't)
=> 1
(coerce nil 'vector)
=> #()
(coerce '(1 2) '(vector t 2))
=> #(1 2)
(coerce '(1 2) '(vector * 3))
=> SIMPLE-TYPE-ERROR: The length requested (2) does not match the type restriction in (VECTOR * 3).
(coerce "abc" 'simple-vector)
=> #(#\a #\b #\c)
(coerce "abc" 'string)
=> "abc"
(coerce 5 'list)
=> SIMPLE-TYPE-ERROR: 5 can't be converted to type LIST.
(coerce 1 'nope)
=> SIMPLE-ERROR: unknown type specifier: NOPE
(coerce nil 'symbol)
=> NIL
(coerce 1 'string)
=> SIMPLE-TYPE-ERROR: 1 can't be converted to type STRING.
(coerce 'abc 'string)
=> SIMPLE-TYPE-ERROR: ABC can't be converted to type STRING.
(coerce '(1 2) 'string)
=> TYPE-ERROR: The value 1 is not of type CHARACTER when setting an element of (ARRAY CHARACTER)
(coerce '(1 0) 'bit-vector)
=> #*10
(coerce 1 '(or integer string))
=> 1
(coerce 1d0 'single-float)
=> 1.0
(coerce 1d0 'float)
=> 1.0d0
(coerce 3 '(double-float 0d0 10d0))
=> 3.0d0
(coerce '(1 2) 'list)
=> (1 2)
(coerce '(1 2) '(array * (*)))
=> #(1 2)
(coerce 97 'character)
=> SIMPLE-TYPE-ERROR: 97 cannot be coerced to a character.
(coerce 2 'rational)
=> 2
(coerce 2.5 'rational)
=> SIMPLE-TYPE-ERROR: 2.5 can't be converted to type RATIONAL.
(coerce #(1 2) 'sequence)
=> #(1 2)
(coerce '(1 2) 'array)
=> SIMPLE-TYPE-ERROR: (1 2) can't be converted to type ARRAY.
(coerce '(1 2) 'simple-array)
=> SIMPLE-TYPE-ERROR: (1 2) can't be converted to type SIMPLE-ARRAY.
(coerce 0 'bit)
=> 0
(coerce 5 'short-float)
=> 5.0
(coerce 5 'real)
=> 5
(typep 1 'bit)
=> T
(typep 5 '(integer 0 4))
=> NIL
(typep 5 '(integer 0 (5)))
=> NIL
(typep 1.5 '(float 0.0 2.0))
=> T
(typep 1.5 '(real 0 1))
=> NIL
(typep 3 '(mod 4))
=> T
(typep 3 '(unsigned-byte 2))
=> T
(typep -1 'unsigned-byte)
=> NIL
(typep -2 '(signed-byte 1))
=> NIL
(typep '(1 . "a") '(cons integer string))
=> T
(typep '(1) '(cons integer))
=> T
(typep "abc" '(string 3))
=> T
(typep "abc" '(vector character))
=> T
(typep "abc" '(array character (3)))
=> T
(typep "abc" '(simple-array character (*)))
=> T
(typep #(1) '(simple-array * (*)))
=> T
(typep #(1) '(vector t 1))
=> T
(typep #(1) 'simple-vector)
=> T
(typep #(1) '(simple-vector 2))
=> NIL
(typep 'car '(function))
=> NIL
(typep #'car 'function)
=> T
(typep 5 '(or string integer))
=> T
(typep 5 '(and integer (not (eql 5))))
=> NIL
(typep 5 '(member 1 5))
=> T
(typep 5 '(satisfies oddp))
=> T
(typep (make-instance 'b) 'a)
=> T
(typep nil 'list)
=> T
(typep nil 'symbol)
=> T
(typep nil 'boolean)
=> T
(typep t 'boolean)
=> T
(typep :a 'keyword)
=> T
(typep #\a 'base-char)
=> T
(typep #\a 'standard-char)
=> T
(typep "a" 'base-string)
=> NIL
(typep "a" 'simple-base-string)
=> NIL
(typep 1 'atom)
=> T
(typep (make-tm) 'structure-object)
=> T
(typep (make-tm) 'tm)
=> T
(typep (make-instance 'a) 'standard-object)
=> T
(typep (find-class 'a) 'class)
=> T
(typep 5 (find-class 'integer))
=> T
(typep 1 't)
=> T
(typep 1 nil)
=> NIL
(typep 1 '*)
=> T
(typep 5 '(values integer))
=> SIMPLE-ERROR: VALUES type illegal in this context: (VALUES INTEGER)
(typep *standard-output* 'stream)
=> T
(typep #'print-object 'generic-function)
=> T
(typep 1.0 'short-float)
=> T
(typep 1d0 'long-float)
=> T
(typep 1.0 'double-float)
=> NIL
(typep 1.0 'real)
=> T
(typep (lambda ()) 'compiled-function)
=> T
(typep "abc" 'sequence)
=> T
(typep 5 'fixnum)
=> T
(typep (expt 2 62) 'bignum)
=> T
(typep 5 '(integer * 5))
=> T
(typep 5 '(integer 6 *))
=> NIL
(subtypep 'integer 'number)
=> T | T
(subtypep 'number 'integer)
=> NIL | T
(subtypep 'b 'a)
=> T | T
(subtypep 'a 'b)
=> NIL | T
(subtypep '(integer 0 5) '(integer 0 10))
=> T | T
(subtypep '(integer 0 5) 'fixnum)
=> T | T
(subtypep 'null 'list)
=> T | T
(subtypep 'null 'symbol)
=> T | T
(subtypep '(or integer string) '(or number array))
=> T | T
(subtypep '(member 1 2) 'integer)
=> T | T
(subtypep 'integer '(or integer string))
=> T | T
(subtypep '(and integer (satisfies oddp)) 'integer)
=> T | T
(subtypep 'integer '(satisfies oddp))
=> NIL | NIL
(subtypep 'string 'vector)
=> T | T
(subtypep 'nil 'integer)
=> T | T
(subtypep 't 'integer)
=> NIL | T
(subtypep 'integer 't)
=> T | T
(subtypep 'tm 'structure-object)
=> T | T
(subtypep 'simple-error 'error)
=> T | T
(subtypep 'list 'sequence)
=> T | T
(subtypep 'keyword 'symbol)
=> T | T
(subtypep 'boolean 'symbol)
=> T | T
(subtypep 'nope 'symbol)
=> NIL | NIL
(subtypep 'cons 'list)
=> T | T
(subtypep 'list '(or cons null))
=> T | T
(subtypep '(not integer) '(not fixnum))
=> T | T
(subtypep 'float 'real)
=> T | T
(subtypep 'string 'list)
=> NIL | T
(subtypep '(eql 5) '(integer 0 3))
=> NIL | T
(subtypep 'character 'string)
=> NIL | T
(subtypep 'real '(or rational float))
=> T | T
(subtypep 'atom 'list)
=> NIL | T
(subtypep 'integer 'atom)
=> T | T
(subtypep 'bit 'fixnum)
=> T | T
(subtypep 'ev 'integer)
=> NIL | NIL
(subtypep '(vector integer) 'vector)
=> T | T
(subtypep 'simple-vector '(array t))
=> T | T
(subtypep (find-class 'b) (find-class 'a))
=> T | T
(subtypep 'a 'standard-object)
=> T | T
(subtypep '(cons integer) 'cons)
=> T | T
(upgraded-array-element-type 'integer)
=> T
(typep 5 "a")
=> SIMPLE-ERROR: bad thing to be a type specifier: "a"
(coerce #\a 'string)
=> SIMPLE-TYPE-ERROR: #\a can't be converted to type STRING.
(coerce "12" 'number)
=> SIMPLE-TYPE-ERROR: "12" can't be converted to type NUMBER.
"""


def test_types_answer_as_in_sbcl():
    check(TYPES)


CLASSES = r"""
(defmethod k ((x function)) :f)
(defmethod k ((x standard-object)) :s)
(defmethod k2 ((x generic-function)) :gf)
(defmethod k2 ((x method)) :m)
(k #'k)
=> :F
(k2 #'k)
=> :GF
(k2 (find-method #'k nil (list (find-class 'function))))
=> :M
(typep #'k 'standard-object)
=> T
(typep #'k 'generic-function)
=> T
(typep 5 'standard-object)
=> NIL
(find-class 'standard-class)
=> #<STANDARD-CLASS COMMON-LISP:STANDARD-CLASS>
(find-class 'structure-class)
=> #<STANDARD-CLASS COMMON-LISP:STRUCTURE-CLASS>
(find-class 't)
=> #<SB-PCL:SYSTEM-CLASS COMMON-LISP:T>
(find-class 'method)
=> #<STANDARD-CLASS COMMON-LISP:METHOD>
(find-class 'simple-error)
=> #<SB-PCL::CONDITION-CLASS COMMON-LISP:SIMPLE-ERROR>
(find-class 'built-in-class)
=> #<STANDARD-CLASS COMMON-LISP:BUILT-IN-CLASS>
(find-class 'function)
=> #<SB-PCL:SYSTEM-CLASS COMMON-LISP:FUNCTION>
(find-class 'sequence)
=> #<SB-PCL:SYSTEM-CLASS COMMON-LISP:SEQUENCE>
(find-class 'class)
=> #<STANDARD-CLASS COMMON-LISP:CLASS>
(find-class 'standard-object)
=> #<STANDARD-CLASS COMMON-LISP:STANDARD-OBJECT>
(find-class 'structure-object)
=> #<STRUCTURE-CLASS COMMON-LISP:STRUCTURE-OBJECT>
(find-class 'hash-table)
=> #<STRUCTURE-CLASS COMMON-LISP:HASH-TABLE>
(find-class 'stream)
=> #<SB-PCL:SYSTEM-CLASS COMMON-LISP:STREAM>
(find-class 'keyword nil)
=> NIL
(find-class 'random-state)
=> #<STRUCTURE-CLASS COMMON-LISP:RANDOM-STATE>
(subtypep 'generic-function 'function)
=> T | T
(subtypep 'standard-generic-function 'generic-function)
=> T | T
(subtypep 'error 'condition)
=> T | T
(subtypep 'arithmetic-error 'error)
=> T | T
(subtypep 'division-by-zero 'arithmetic-error)
=> T | T
(subtypep 'simple-vector 'sequence)
=> T | T
(subtypep '(or) 'integer)
=> T | T
(subtypep '(and) 'integer)
=> NIL | T
(subtypep '(integer 5 3) nil)
=> T | T
(subtypep '(not string) '(not string))
=> T | T
(subtypep 'string '(not integer))
=> T | T
(subtypep 'integer '(not (integer 0 5)))
=> NIL | T
(subtypep '(integer 6 9) '(not (integer 0 5)))
=> T | T
(subtypep '(float 0.0 1.0) 'float)
=> T | T
(subtypep '(single-float 0.0 1.0) '(single-float 0.0 (1.0)))
=> NIL | T
(subtypep 'null '(or null string))
=> T | T
(subtypep 'boolean '(member t nil))
=> T | T
(subtypep '(member t nil) 'boolean)
=> T | T
(subtypep 'list 'cons)
=> NIL | T
(subtypep '(array * (2 3)) 'array)
=> T | T
(subtypep '(array * (2 3)) '(array * (* 3)))
=> T | T
(subtypep '(array double-float) '(array *))
=> T | T
(subtypep 'rational '(or integer ratio))
=> T | T
(subtypep '(mod 5) '(integer 0 4))
=> T | T
(subtypep 'signed-byte 'integer)
=> T | T
(subtypep 'integer 'signed-byte)
=> T | T
(subtypep 'character '(or base-char extended-char))
=> T | T
"""


def test_classes_and_their_types_answer_as_in_sbcl():
    check(CLASSES)
