"""UFFI and the strings of CFFI: what declares functions of C loads, strings are had, and a call is refused."""

import pytest

from cramhy_runtime.lisp_core.conditions import Condition


@pytest.fixture(autouse=True)
def loaded(values):
    """Both libraries are there before the reader meets their packages."""
    values('(asdf:load-system "uffi")')


@pytest.mark.parametrize(
    ("form", "told"),
    [
        ("(uffi:def-constant +size+ 4 t) +size+", "4"),
        ("(uffi:def-enum fruit (:apple (:pear 5) :plum)) (list fruit#apple fruit#pear fruit#plum)", "(0 5 6)"),
        ('(uffi:def-enum color (:red) :separator-string "-") color-red', "0"),
        ("(uffi:def-struct point (x :int) (y :int)) (uffi:def-foreign-type handle :pointer-void)", "HANDLE"),
        ('(uffi:def-function ("c_sin" c-sin) ((x :double)) :returning :double :module "m") (and (fboundp \'c-sin) t)', "T"),
        ('(uffi:with-cstring (s "grün") (list (uffi:convert-from-cstring s) (uffi:foreign-string-length s)))', '("grün" 5)'),
        ("(uffi:null-pointer-p (uffi:convert-to-cstring nil))", "T"),
        ("(mapcar #'uffi:null-char-p (list 0 (code-char 0) #\\0))", "(T T NIL)"),
        ('(uffi:find-foreign-library "no-such" "/no/such/")', "NIL"),
        ("(let ((p (cffi:foreign-string-alloc \"añb\"))) (list (cffi:pointerp p) (multiple-value-list (cffi:foreign-string-to-lisp p))))", '(T ("añb" 4))'),
        ('(cffi:foreign-string-to-lisp (cffi:foreign-string-alloc "abcdef" :start 1) :count 3)', '"bcd" 3'),
        ('(cffi:foreign-string-to-lisp (cffi:foreign-string-alloc "abcdef") :offset 2 :max-chars 2)', '"cd" 4'),
        ("(list (cffi:foreign-string-to-lisp (cffi:null-pointer)) (cffi:null-pointer-p (cffi:null-pointer)))", "(NIL T)"),
        ('(princ-to-string (cffi:foreign-string-alloc "ab"))', '"#<FOREIGN-POINTER to 3 octets>"'),
    ],
)  # fmt: skip
def test_what_needs_no_function_of_c_works(values, form, told):
    assert values(form) == told


@pytest.mark.parametrize(
    ("form", "told"),
    [
        ('(uffi:def-function "c_cos" ((x :double)) :returning :double) (c-cos 1d0)', 'C-COS cannot be called: cramhy calls no functions of C (here "c_cos").'),
        ('(uffi:def-foreign-var ("c_errno" c-errno) :int "m") c-errno', 'C-ERRNO cannot be called: cramhy calls no functions of C (here "c_errno").'),
        ("(uffi:allocate-foreign-object :int 3)", "ALLOCATE-FOREIGN-OBJECT cannot be called: cramhy calls no functions of C."),
        ("(uffi:with-foreign-object (p :int) (setf (uffi:deref-pointer p :int) 1))", "WITH-FOREIGN-OBJECT cannot be called: cramhy calls no functions of C."),
    ],
)  # fmt: skip
def test_what_needs_c_is_refused_by_name(values, form, told):
    with pytest.raises(Condition) as caught:
        values(form)
    assert caught.value.report().startswith(told)
